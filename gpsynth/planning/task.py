"""A planning problem that laws are judged by."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from gpsynth.checks import check_kind, check_number
from gpsynth.errors import ProblemError
from gpsynth.evaluate import periods_of
from gpsynth.problem import Problem
from gpsynth.schedule import Schedule, Schedules


@dataclass(frozen=True, eq=False)
class Task:
    """From one start to a goal, among obstacles.

    Raises ProblemError for several starts, or one at the goal, for times that are none, and for schedules that do not
    fit the plant or each other.
    """

    problem: Problem
    least: float  # s, that a plan takes at least, or a time to compare with
    initial: Sequence[Schedule] | Schedules = ()  # where some particles of a search begin
    budget: float | None = None  # s, T+ at first; the horizon, if None

    def __post_init__(self) -> None:
        check_kind("the problem of a task", self.problem, Problem)
        _check_ends(self.problem)
        object.__setattr__(self, "least", _time("least time", self.least))
        if self.budget is not None:
            object.__setattr__(self, "budget", _time("budget", self.budget))
            if periods_of(self.problem, self.budget) < 1:
                raise ProblemError(
                    f"the budget of a task, {self.budget} s, is shorter than the period, {self.problem.period} s"
                )
        check_kind("the initial schedules of a task", self.initial, list, tuple, Schedules)
        states = self.problem.starts.shape[1]
        for number in range(len(self.schedules)):
            points = self.schedules[number].points  # which says what is wrong with its numbers
            if points.shape[1] != states:
                raise ProblemError(
                    f"an initial schedule of a task has points of shape {points.shape}; expected (k, {states})"
                )

    @cached_property
    def schedules(self) -> Schedules:
        """The initial schedules as arrays."""
        if isinstance(self.initial, Schedules):
            return self.initial
        states = self.problem.starts.shape[1]
        none = Schedules(np.empty((0, 0, states)), np.empty((0, 0)))
        return Schedules.of(self.initial) if self.initial else none


def tasks_of(tasks: Any, what: str) -> tuple[Task, ...]:
    """The tasks as a tuple; raises ProblemError if that is what they are not, or none."""
    check_kind(f"the tasks of {what}", tasks, list, tuple)
    for task in tasks:
        check_kind("a task", task, Task)
    if not tasks:
        raise ProblemError(f"{what} needs at least one task")
    return tuple(tasks)


def _check_ends(problem: Problem) -> None:
    if len(problem.starts) != 1:
        raise ProblemError(f"a task begins at one start; its problem has {len(problem.starts)}")
    ends = np.concatenate([problem.starts[0], problem.goal])
    if problem.arrival(ends[np.newaxis])[0, 0] <= 0.0:
        raise ProblemError("a task begins at its goal already, and there is nothing to plan")


def _time(name: str, time: Any) -> float:
    check_number(f"the {name} of a task", time)
    if not 0.0 < time < np.inf:
        raise ProblemError(f"the {name} of a task must be finite and greater than 0, not {time}")
    return float(time)
