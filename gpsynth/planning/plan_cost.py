"""What plans cost that are made with a law, without a search: in each task the cheapest of schedules that are given.

A law that settles fastest at a point that stays is not the one that plans are fast with, whose points move. To search a
plan for every law of a structure search would take hours; to roll out a dozen schedules takes as long as settling from
a dozen starts. The schedules are the same for all laws, so laws differ by nothing else.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from gpsynth.arrays import Floats, numbers, shaped
from gpsynth.checks import check_number
from gpsynth.errors import ProblemError
from gpsynth.evaluate import ROUNDING, Evaluator
from gpsynth.objective import costs_of
from gpsynth.planning.objective import obstacle_term
from gpsynth.planning.settings import PlanSettings
from gpsynth.planning.task import Task, tasks_of
from gpsynth.problem import Problem
from gpsynth.program import Program


@dataclass(frozen=True, eq=False)
class PlanCost:
    """The cost of a law in each task: the least over its initial schedules of what the problem says, and of obstacles.

    A problem that says nothing costs the time until arrival or the end of T+, with `stop=False` always the latter; give
    it terminal costs, so that a plan pays for not arriving as well. Raises ProblemError without tasks, for a task
    without schedules, or for weights that make no sense.
    """

    tasks: Sequence[Task]
    weight: float = 1.0  # of the mean over the tasks, beside that over the starts of a stabilizer
    gamma: float = PlanSettings.gamma  # s that C_obs of eq. 17 costs, at least 1 where a path is not clear
    margin: float = PlanSettings.margin  # m, clearance that counts as none

    def __post_init__(self) -> None:
        object.__setattr__(self, "tasks", tasks_of(self.tasks, "the cost of plans"))
        for task in self.tasks:
            Evaluator(task.problem, margin=self.margin)  # says what is wrong with the margin
            if not len(task.schedules):
                raise ProblemError(
                    "a task has no initial schedules; the cost of plans is that of the best of them"
                )
        for name in ("weight", "gamma"):
            value = getattr(self, name)
            check_number(f"the {name} of plans", value)
            if not 0.0 < value < np.inf:
                raise ProblemError(f"the {name} of plans must be finite and greater than 0, not {value}")
            object.__setattr__(self, name, float(value))

    @property
    def problems(self) -> tuple[Problem, ...]:
        """Those of the tasks."""
        return tuple(task.problem for task in self.tasks)

    def __call__(self, program: Program, vectors: Floats, most: Floats | None = None) -> Floats:
        """Costs (N, T) of a law under N parameter vectors (N, p); a mean above `most` (N,) may be infinity."""
        vectors = np.atleast_2d(numbers("parameters", vectors))
        costs = np.full((len(vectors), len(self.tasks)), np.inf)
        left, spent, limit = np.arange(len(vectors)), np.zeros(len(vectors)), np.full(len(vectors), np.inf)
        if most is not None and self.nonnegative:
            limit = shaped("most", most, (len(vectors),), finite=False) * (len(self.tasks) * (1.0 + ROUNDING))
        for number in range(len(self.tasks)):
            costs[left, number] = self._least(number, program, vectors[left])
            spent[left] += costs[left, number]
            left = left[spent[left] <= limit[left]]
            if not len(left):
                break
        return costs

    def __reduce__(self) -> tuple[type["PlanCost"], tuple[Any, ...]]:
        return PlanCost, (self.tasks, self.weight, self.gamma, self.margin)

    @cached_property
    def evaluators(self) -> tuple[Evaluator, ...]:
        """One for each task, of each process: what they cache would not survive the way to another."""
        return tuple(Evaluator(problem, margin=self.margin) for problem in self.problems)

    @cached_property
    def nonnegative(self) -> bool:
        """Whether no task can have a negative cost, so that the rest need not be tried when a mean is too high."""
        return all(problem.costs_nonnegative for problem in self.problems)

    def _least(self, number: int, program: Program, vectors: Floats) -> Floats:
        """The cost (N,) in a task."""
        task = self.tasks[number]
        rollouts = self.evaluators[number].of_plans(program, vectors, task.schedules, task.budget)
        covered = obstacle_term(rollouts.exposure, rollouts.depth)
        least: Floats = (costs_of(rollouts) + self.gamma * covered).min(axis=1)
        return least
