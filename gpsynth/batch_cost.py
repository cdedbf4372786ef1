"""The cost function of a structure search."""

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cached_property
from itertools import groupby
from typing import Any

import numpy as np

from gpsynth.arrays import Floats
from gpsynth.evaluate import Evaluator
from gpsynth.law_cost import LawCost, PlanCases
from gpsynth.objective import PROBLEMS_OWN, Objective
from gpsynth.problem import Problem
from gpsynth.structure_search import Candidate


@dataclass(frozen=True, eq=False)
class BatchCost:
    """What candidates cost in every case; those with one program go to the kernel together."""

    problem: Problem
    threads: int = 1
    objective: Objective = PROBLEMS_OWN
    plans: PlanCases | None = None

    def __call__(self, batch: Sequence[Candidate[Any]]) -> Floats:
        """Costs (N, S) of N candidates, with plans (N, S + T)."""
        groups = [list(group) for _, group in groupby(batch, key=lambda candidate: id(candidate.program))]

        def of_group(group: list[Candidate[Any]]) -> Floats:
            values = np.array([candidate.values for candidate in group]).reshape(len(group), -1)
            bound = max(candidate.bound for candidate in group)
            return self.cost.cases(group[0].program, values, bound)

        with ThreadPoolExecutor(self.threads) as pool:
            return np.concatenate(list(pool.map(of_group, groups)))

    def __reduce__(self) -> tuple[type["BatchCost"], tuple[Any, ...]]:
        return BatchCost, (self.problem, self.threads, self.objective, self.plans)

    @cached_property
    def cost(self) -> LawCost:
        """One of each process: what its evaluator caches would not survive the way to another."""
        return LawCost(Evaluator(self.problem), self.objective, self.plans)
