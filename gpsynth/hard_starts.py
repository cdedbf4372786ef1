"""Starts that the best laws of a search miss are starts to search on: a law that only fits its training loses.

A law may arrive from everywhere but from a small region, where it stands still or goes to and fro; a few dozen starts
are likely to miss that region, and the search then keeps to such laws. So it is tried on many starts now and then, and
trained on those it missed: inductive synthesis guided by counterexamples (Solar-Lezama et al. 2006).
"""

from collections.abc import Sequence
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from gpsynth.arrays import Floats
from gpsynth.structure_search import Candidate

SHARE = 0.125  # of the starts that a search sees; the most that may be new each time


class StartsCost(Protocol):
    """A cost that knows its starts, as `BatchCost` does."""

    def __call__(self, batch: Sequence[Candidate[Any]]) -> Floats:
        """Costs (N, S)."""
        ...

    def of(self, rows: Sequence[int]) -> "StartsCost":
        """The same from some of the starts."""
        ...

    def missed(self, batch: Sequence[Candidate[Any]]) -> npt.NDArray[np.bool_]:
        """From which starts (N, S) a law does not come to stay at the goal."""
        ...


def harder(cost: StartsCost, laws: Sequence[Candidate[Any]], seen: tuple[int, ...]) -> tuple[int, ...]:
    """The starts to search on next, as many as are `seen` now: those that the laws miss come first.

    They take the places of the last ones, which leave.
    """
    missed = cost.missed(laws)
    missed[:, list(seen)] = False
    new = covering(missed, round(SHARE * len(seen)))
    return (*new, *seen[: len(seen) - len(new)])


def covering(missed: npt.NDArray[np.bool_], most: int) -> tuple[int, ...]:
    """At most so many of the starts of `missed` (N, S), such that each law misses one of them if it misses any.

    One after the other, the start that the most laws miss, a law counting 1/(k + 1) that misses k of those chosen.
    """
    chosen: list[int] = []
    covered = np.zeros(len(missed))
    left = missed.copy()
    while len(chosen) < most and left.any():
        start = int(np.argmax((1.0 / (1.0 + covered)) @ left))
        chosen.append(start)
        covered += missed[:, start]
        left[:, start] = False
    return tuple(chosen)
