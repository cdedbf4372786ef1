"""What a law is worth to plans: how near to the least time it arrives in small searches, the same ones for all laws.

A law that goes to one point fastest need not be the one that plans are fast with: between points that move it pays to
drive at the limits. Every task is searched with the same random numbers whatever the law (common random numbers: Law,
Simulation Modeling and Analysis, section 11.2), so that laws differ by less than searches do.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from gpsynth.arrays import Floats
from gpsynth.checks import check_number, check_whole
from gpsynth.errors import OptimizerError, ProblemError
from gpsynth.law import Law
from gpsynth.optimizers import CMAES
from gpsynth.planning.rounds import plan
from gpsynth.planning.settings import PlanSettings
from gpsynth.problem import Problem
from gpsynth.refitting import improved
from gpsynth.schedule import Schedule, Schedules

STAGE = 4  # of the random streams
REACH, SMALLEST, STEP = (
    10.0,
    0.1,
    0.005,
)  # a number moves by REACH (|number| + SMALLEST); first step, share of it all


@dataclass(frozen=True, eq=False)
class Task:
    """A planning problem that laws are judged by."""

    problem: Problem
    least: float  # s, that a plan takes at least, or a time to compare with
    initial: Sequence[Schedule] | Schedules = ()  # where some particles begin
    budget: float | None = None  # s, T+ at first; the horizon, if None

    def __post_init__(self) -> None:
        check_number("least time of a task", self.least)
        if not 0.0 < self.least < np.inf:
            raise ProblemError(
                f"the least time of a task must be finite and greater than 0, not {self.least}"
            )


@dataclass(frozen=True, eq=False)
class Worth:
    """The mean over the tasks of least time / arrival time of the plan that is found, 0 without a plan."""

    tasks: tuple[Task, ...]
    settings: PlanSettings = PlanSettings(particles=32, iterations=10, rounds=5)
    seed: int = 0

    def __post_init__(self) -> None:
        check_whole("seed", self.seed, 0)
        if not self.tasks:
            raise ProblemError("the worth of a law needs at least one task")

    def __call__(self, law: Law) -> float:
        """The worth of a law for the plant and features of the tasks; raises ProblemError if it is for others."""
        return float(self.shares(law).mean())

    def shares(self, law: Law) -> Floats:
        """Least time / arrival time in each task (T,)."""
        return np.array([self._share(law, number) for number in range(len(self.tasks))])

    def _share(self, law: Law, number: int) -> float:
        task = self.tasks[number]
        plant = task.problem.plant
        found = plan(
            *(task.problem, law.with_limits(plant.lower, plant.upper), self.settings),
            seed=self.seed,
            path=(STAGE, number),
            initial=task.initial,
            budget=task.budget,
        )
        return task.least / found.arrival_time if found.is_free else 0.0


def refit_to_plans(
    law: Law,
    worth: Callable[[Law], float],
    *,
    missed: Callable[[Law], float],
    seed: int = 0,
    budget: int = 100,
) -> Law:
    """The law with the parameters that CMA-ES finds of most worth, never of less than those it has.

    `missed` is the share of what a stabilizer must not fail at that a law fails at; only a law that misses nothing is
    asked for its worth. Raises OptimizerError if the law itself misses something, or for a budget of none.
    """
    check_whole("seed", seed, 0, OptimizerError)
    check_whole("budget", budget, 1, OptimizerError)
    if missed(law) > 0.0:
        raise OptimizerError("a law that is refitted to plans must miss nothing to begin with")
    values = law.parameters
    if len(values) == 0:
        return law

    def cost(vectors: Floats) -> Floats:
        return np.array([_cost(replace(law, parameters=each), worth, missed) for each in vectors])

    reach = REACH * (np.abs(values) + SMALLEST)
    optimizer = CMAES(values - reach, values + reach, x0=values, sigma=STEP, restarts=0)
    found = improved(cost, values, optimizer, seed=seed, budget=budget, path=(STAGE,))
    return law if found is values else replace(law, parameters=found)


def _cost(law: Law, worth: Callable[[Law], float], missed: Callable[[Law], float]) -> float:
    """Between -1 and 0 for a law that misses nothing, else what it misses."""
    share = missed(law)
    return share if share > 0.0 else -worth(law)
