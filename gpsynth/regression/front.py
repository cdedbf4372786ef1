"""The Pareto front of error and size."""

import math
from collections.abc import Iterable
from typing import NamedTuple

from gpsynth.regression.expressions import Expression

EXACT = 1e-20  # errors below are rounding


class Candidate(NamedTuple):
    """A formula and how good it is."""

    expression: Expression
    error: float  # weighted squared residual as a share of y's deviation from its mean: 1 - R2
    size: int


class Front:
    """The best candidate of each size that no smaller one beats."""

    def __init__(self) -> None:
        self._best: dict[int, Candidate] = {}

    def add(self, candidates: Iterable[Candidate]) -> None:
        """Keep what is better than everything of its size."""
        for candidate in candidates:
            known = self._best.get(candidate.size)
            if candidate.error < (math.inf if known is None else known.error):
                self._best[candidate.size] = candidate

    def admits(self, size: int, error: float) -> bool:
        """Whether nothing of this size or smaller is as good; errors below EXACT count as equal."""
        return (
            not any(
                known <= size and candidate.error <= max(error, EXACT)
                for known, candidate in self._best.items()
            )
            and error < math.inf
        )

    def members(self) -> list[Candidate]:
        """From the smallest to the most accurate; errors below EXACT count as equal."""
        front: list[Candidate] = []
        for size in sorted(self._best):
            candidate = self._best[size]
            if not front or max(candidate.error, EXACT) < max(front[-1].error, EXACT):
                front.append(candidate)
        return front

    @property
    def error(self) -> float:
        """The least error so far."""
        return min((candidate.error for candidate in self._best.values()), default=math.inf)
