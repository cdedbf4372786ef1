"""What laws cost in every case: from each start of a problem, and in plans, where those count as well."""

from dataclasses import dataclass
from typing import Any, Protocol, runtime_checkable

import numpy as np

from gpsynth.arrays import Floats
from gpsynth.checks import check_kind
from gpsynth.errors import ProblemError
from gpsynth.evaluate import ROUNDING, Evaluator
from gpsynth.objective import PROBLEMS_OWN, Objective, score
from gpsynth.problem import Problem
from gpsynth.program import Program


@runtime_checkable
class PlanCases(Protocol):
    """What plans cost that are made with a law, in each of some tasks; `gpsynth.planning.PlanCost` is one."""

    @property
    def problems(self) -> tuple[Problem, ...]:
        """Those of the T tasks."""

    @property
    def weight(self) -> float:
        """How much their mean counts beside that of the starts."""

    @property
    def nonnegative(self) -> bool:
        """Whether no plan can have a negative cost, so that a law may lose by its starts alone."""

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
        bound = bound if self.plans is None or self.plans.nonnegative else np.inf
        starts = score(self.evaluator, program, vectors, self.objective, bound)
        if self.plans is None:
            return starts
        weight, means = self.plans.weight, starts.mean(axis=1)
        bound += ROUNDING * abs(bound)  # of the sum, which may be far more than what is left for plans
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


def check_plans(plans: Any, problem: Problem) -> None:
    """Raises ProblemError unless the cost of plans is one, or None, and a law of the problem can be judged by it.

    The plant of a plan may be another, with the same controls, and then sees its states through features of its own.
    """
    check_kind("plans, a PlanCost,", plans, PlanCases, optional=True)
    names, controls = problem.features.names, problem.plant.control_names
    for number, each in enumerate(() if plans is None else plans.problems):
        features, theirs = each.features, each.plant.control_names
        if (features.names, theirs) != (names, controls):
            raise ProblemError(
                f"the problem of plan {number} has features {features.names} and controls {theirs}; expected {names} "
                f"and {controls}, those of the problem"
            )
        if features.inputs == problem.features.inputs and features != problem.features:
            raise ProblemError(
                f"the features of plan {number} have the names of the problem's but are others; give its problem "
                "features=problem.features"
            )
