"""Explicit Runge-Kutta methods as data (Hairer, Norsett, Wanner: Solving Ordinary Differential Equations I, II.1)."""

from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from gpsynth.arrays import Floats, frozen


class Tableau(NamedTuple):
    """Butcher's arrays a (s, s), b (s,), c (s,)."""

    a: Floats
    b: Floats
    c: Floats
    order: int


def _tableau(a: list[list[float]], b: list[float], order: int) -> Tableau:
    rows = np.array(a, dtype=np.float64)
    return Tableau(frozen(rows), frozen(np.array(b, dtype=np.float64)), frozen(rows.sum(axis=1)), order)


TABLEAUS = MappingProxyType(
    {
        "euler": _tableau([[0.0]], [1.0], order=1),
        "heun": _tableau([[0.0, 0.0], [1.0, 0.0]], [1 / 2, 1 / 2], order=2),
        "rk4": _tableau(
            [[0.0, 0.0, 0.0, 0.0], [1 / 2, 0.0, 0.0, 0.0], [0.0, 1 / 2, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]],
            [1 / 6, 1 / 3, 1 / 3, 1 / 6],
            order=4,
        ),
    }
)
