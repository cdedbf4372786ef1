"""A planning problem that laws are judged by."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gpsynth.checks import check_kind, check_number
from gpsynth.errors import ProblemError
from gpsynth.problem import Problem
from gpsynth.schedule import Schedule, Schedules


@dataclass(frozen=True, eq=False)
class Task:
    """From one start to a goal, among obstacles; raises ProblemError for a time that is none."""

    problem: Problem
    least: float  # s, that a plan takes at least, or a time to compare with
    initial: Sequence[Schedule] | Schedules = ()  # where some particles of a search begin
    budget: float | None = None  # s, T+ at first; the horizon, if None

    def __post_init__(self) -> None:
        check_kind("the problem of a task", self.problem, Problem)
        for name, time in (("least time", self.least), ("budget", self.budget)):
            if time is not None:
                check_number(f"{name} of a task", time)
                if not 0.0 < time < np.inf:
                    raise ProblemError(f"the {name} of a task must be finite and greater than 0, not {time}")

    @cached_property
    def schedules(self) -> Schedules:
        """The initial schedules as arrays."""
        if isinstance(self.initial, Schedules):
            return self.initial
        states = self.problem.starts.shape[1]
        none = Schedules(np.empty((0, 0, states)), np.empty((0, 0)))
        return Schedules.of(self.initial) if self.initial else none
