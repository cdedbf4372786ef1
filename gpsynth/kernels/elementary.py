"""Every row of the table as one scalar function, the same source for the interpreter and for numba.

A function has the name of its row; `abs_`, `max_`, `min_` and `not_` leave Python's own names free.
"""

from collections.abc import Callable

import numpy as np

from gpsynth.kernels.arithmetic import *  # noqa: F403
from gpsynth.kernels.exponentials import *  # noqa: F403
from gpsynth.kernels.network_operator import *  # noqa: F403
from gpsynth.kernels.trigonometry import *  # noqa: F403
from gpsynth.operations import operation


def function_of(name: str) -> Callable[..., float]:
    """The scalar function of the row called `name`; raises OperationError if there is none."""
    row = operation(name).name
    found: Callable[..., float] = globals()[row if row in globals() else f"{row}_"]
    return found


def evaluate(name: str, *operands: float) -> float:
    """The value a kernel computes, bit for bit, in the interpreter; never raises on numbers."""
    with np.errstate(all="ignore"):
        return float(function_of(name)(*map(np.float64, operands)))
