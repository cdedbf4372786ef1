"""What a law is worth to plans: how near to the least time it arrives in small searches, the same ones for all laws.

A law that goes to one point fastest need not be the one that plans are fast with: between points that move it pays to
drive at the limits. Every task is searched with the same random numbers whatever the law (common random numbers: Law,
Simulation Modeling and Analysis, section 11.2), so that laws differ by less than searches do.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from gpsynth.arrays import Floats
from gpsynth.checks import check_kind, check_whole
from gpsynth.law import Law
from gpsynth.planning.rounds import plan
from gpsynth.planning.settings import PlanSettings
from gpsynth.planning.task import Task, tasks_of

STAGE = 4  # of the random streams


@dataclass(frozen=True, eq=False)
class Worth:
    """The mean over the tasks of least time / arrival time of the plan that is found, 0 without a plan."""

    tasks: Sequence[Task]
    settings: PlanSettings = PlanSettings(particles=32, iterations=10, rounds=5)
    seed: int = 0

    def __post_init__(self) -> None:
        object.__setattr__(self, "tasks", tasks_of(self.tasks, "the worth of a law"))
        check_kind("settings", self.settings, PlanSettings)
        check_whole("seed", self.seed, 0)

    def __call__(self, law: Law) -> float:
        """The worth of a law for the plant and features of the tasks; raises ProblemError if it is for others."""
        return float(self.shares(law).mean())

    def shares(self, law: Law) -> Floats:
        """Least time / arrival time in each task (T,)."""
        check_kind("law", law, Law)
        return np.array([self._share(law, number) for number in range(len(self.tasks))])

    def _share(self, law: Law, number: int) -> float:
        task = self.tasks[number]
        plant = task.problem.plant
        if law.plant.control_names == plant.control_names:
            law = law.with_limits(plant.lower, plant.upper)
        found = plan(
            *(task.problem, law, self.settings),
            seed=self.seed,
            path=(STAGE, number),
            initial=task.initial,
            budget=task.budget,
        )
        return task.least / found.arrival_time if found.is_free else 0.0
