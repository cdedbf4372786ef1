"""Explicit Runge-Kutta methods as data (Hairer, Norsett, Wanner: Solving Ordinary Differential Equations I, II.1).

Each stage leaves from the derivative of the stage before it alone: a[i, i - 1] = c[i], all other a are 0.
"""

from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from gpsynth.arrays import Floats, frozen


class Tableau(NamedTuple):
    """Butcher's arrays b (s,) and c (s,)."""

    b: Floats
    c: Floats
    order: int


def _tableau(b: list[float], c: list[float], order: int) -> Tableau:
    return Tableau(frozen(np.array(b, dtype=np.float64)), frozen(np.array(c, dtype=np.float64)), order)


TABLEAUS = MappingProxyType(
    {
        "euler": _tableau([1.0], [0.0], order=1),
        "heun": _tableau([1 / 2, 1 / 2], [0.0, 1.0], order=2),
        "rk4": _tableau([1 / 6, 1 / 3, 1 / 3, 1 / 6], [0.0, 1 / 2, 1 / 2, 1.0], order=4),
    }
)
