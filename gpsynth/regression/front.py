"""The Pareto front of error and size."""

import math
from collections.abc import Iterable, Sequence
from typing import NamedTuple

from gpsynth.regression.expressions import Expression, variables

EXACT = 1e-20  # errors below are rounding


class Candidate(NamedTuple):
    """A formula and how good it is."""

    expression: Expression
    error: float  # weighted squared residual as a share of y's deviation from its mean: 1 - R2
    size: int


class Front:
    """The best candidate of each size that no smaller one beats.

    With `made_of`, what inputs each column is made of, only of those that read all `needed` inputs.
    """

    def __init__(self, made_of: Sequence[frozenset[int]] = (), needed: int = 0) -> None:
        self._best: dict[int, Candidate] = {}
        self._made_of, self._needed = made_of, needed

    def add(self, candidates: Iterable[Candidate]) -> None:
        """Keep what is better than everything of its size."""
        for candidate in candidates:
            known = self._best.get(candidate.size)
            better = candidate.error < (math.inf if known is None else known.error)
            if better and not self.missing(candidate.expression):
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

    def missing(self, expression: Expression) -> list[int]:
        """The inputs that are needed and not read."""
        if not self._needed:
            return []
        read = frozenset[int]().union(*(self._made_of[column] for column in variables(expression)))
        return sorted(frozenset(range(self._needed)) - read)

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
