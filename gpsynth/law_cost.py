"""What laws cost in every case: from each start of a problem, and in plans, where those count as well."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from gpsynth.arrays import Floats
from gpsynth.evaluate import Evaluator
from gpsynth.objective import PROBLEMS_OWN, Objective, score
from gpsynth.problem import Problem
from gpsynth.program import Program


class PlanCases(Protocol):
    """What plans cost that are made with a law, in each of some tasks; `gpsynth.planning.PlanCost` is one."""

    @property
    def problems(self) -> tuple[Problem, ...]:
        """Those of the T tasks."""

    @property
    def weight(self) -> float:
        """How much their mean counts beside that of the starts."""

    def __call__(self, program: Program, vectors: Floats, most: Floats | None = None) -> Floats:
        """Costs (N, T) of a law under N parameter vectors (N, p); a mean above `most` (N,) may be infinity."""


@dataclass(frozen=True, eq=False)
class LawCost:
    """The mean over the cases is that over the starts, and with `plans` their weighted mean over the tasks besides."""

    evaluator: Evaluator
    objective: Objective = PROBLEMS_OWN
    plans: PlanCases | None = None

    def cases(self, program: Program, vectors: Floats, bound: float = np.inf) -> Floats:
        """Costs (N, S) or (N, S + T) of a law under N parameter vectors (N, p); see `score` for the bound."""
        starts = score(self.evaluator, program, vectors, self.objective, bound)
        if self.plans is None:
            return starts
        weight, means = self.plans.weight, starts.mean(axis=1)
        tasks = np.full((len(vectors), len(self.plans.problems)), np.inf)
        near = np.isfinite(means) & (means <= bound)
        if near.any():
            tasks[near] = self.plans(program, vectors[near], (bound - means[near]) / weight)
        cases = starts.shape[1] + tasks.shape[1]
        shares = cases / starts.shape[1], weight * cases / tasks.shape[1]
        return np.hstack([shares[0] * starts, shares[1] * tasks])

    def means(self, program: Program, vectors: Floats) -> Floats:
        """The mean over the cases (N,)."""
        means: Floats = self.cases(program, vectors).mean(axis=1)
        return means
