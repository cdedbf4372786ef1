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
from gpsynth.objective import PROBLEMS_OWN, Objective, score
from gpsynth.problem import Problem
from gpsynth.structure_search import Candidate


@dataclass(frozen=True, eq=False)
class BatchCost:
    """What candidates cost from each start; those with one program go to the kernel together."""

    problem: Problem
    threads: int = 1
    objective: Objective = PROBLEMS_OWN

    def __call__(self, batch: Sequence[Candidate[Any]]) -> Floats:
        """Costs (N, S) of N candidates."""
        groups = [list(group) for _, group in groupby(batch, key=lambda candidate: id(candidate.program))]

        def of_group(group: list[Candidate[Any]]) -> Floats:
            values = np.array([candidate.values for candidate in group]).reshape(len(group), -1)
            bound = max(candidate.bound for candidate in group)
            return score(self.evaluator, group[0].program, values, self.objective, bound)

        with ThreadPoolExecutor(self.threads) as pool:
            return np.concatenate(list(pool.map(of_group, groups)))

    def __reduce__(self) -> tuple[type["BatchCost"], tuple[Problem, int, Objective]]:
        return BatchCost, (self.problem, self.threads, self.objective)

    @cached_property
    def evaluator(self) -> Evaluator:
        """One of each process: what it caches would not survive the way to another."""
        return Evaluator(self.problem)
