"""The cost function of a structure search, over all starts of a problem or over some."""

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import groupby
from typing import Any, TypeVar, cast

import numpy as np
import numpy.typing as npt

from gpsynth.arrays import Floats
from gpsynth.evaluate import Evaluator
from gpsynth.objective import PROBLEMS_OWN, Objective, score
from gpsynth.problem import Problem
from gpsynth.structure_search import Candidate

Array = TypeVar("Array", bound=npt.NDArray[Any])
Group = list[Candidate[Any]]  # that share a program


@dataclass(frozen=True, eq=False)
class BatchCost:
    """What candidates cost from each start; those with one program go to the kernel together."""

    problem: Problem
    threads: int = 1
    objective: Objective = PROBLEMS_OWN

    def __call__(self, batch: Sequence[Candidate[Any]]) -> Floats:
        """Costs (N, S) of N candidates."""

        def of_group(group: Group) -> Floats:
            bound = max(candidate.bound for candidate in group)
            return score(self.evaluator, group[0].program, _vectors(group), self.objective, bound)

        return self._of_groups(of_group, batch)

    def of(self, rows: Sequence[int]) -> "BatchCost":
        """The cost from these starts alone, by number."""
        return replace(self, problem=self.problem.of(rows))

    def missed(self, batch: Sequence[Candidate[Any]]) -> npt.NDArray[np.bool_]:
        """From which starts N candidates do not come to stay at the goal, (N, S)."""

        def of_group(group: Group) -> npt.NDArray[np.bool_]:
            return ~self.evaluator.stays(self.evaluator.of_program(group[0].program, _vectors(group)))

        return self._of_groups(of_group, batch)

    def _of_groups(self, function: Callable[[Group], Array], batch: Sequence[Candidate[Any]]) -> Array:
        groups = [list(group) for _, group in groupby(batch, key=lambda candidate: id(candidate.program))]
        with ThreadPoolExecutor(self.threads) as pool:
            return cast(Array, np.concatenate(list(pool.map(function, groups))))

    def __reduce__(self) -> tuple[type["BatchCost"], tuple[Problem, int, Objective]]:
        return BatchCost, (self.problem, self.threads, self.objective)

    @cached_property
    def evaluator(self) -> Evaluator:
        """One of each process: what it caches would not survive the way to another."""
        return Evaluator(self.problem)


def _vectors(group: Group) -> Floats:
    return np.array([candidate.values for candidate in group]).reshape(len(group), -1)
