"""The bits of a float64, and the typed decorator of scalar functions; both work in the interpreter and under numba."""

from collections.abc import Callable
from typing import Any, TypeVar

import numpy as np
from numba.extending import register_jitable

Function = TypeVar("Function", bound=Callable[..., Any])


def scalar(function: Function) -> Function:
    """A plain Python function that kernels inline, so that the loop around it can be vectorized."""
    return register_jitable(error_model="numpy", forceinline=True)(function)


SIGN = -(2**63)
MAGNITUDE = 2**63 - 1
MANTISSA = 2**52 - 1
ROUND = 1.5 * 2.0**52  # adding and subtracting it rounds to an integer, which the low bits of the sum hold


@scalar
def bits_of(x: float) -> int:
    """The 64 bits of x as a signed integer."""
    return np.float64(x).view(np.int64)  # type: ignore[return-value]


@scalar
def float_of(bits: int) -> float:
    """The float64 that has these bits."""
    return np.int64(bits).view(np.float64)


@scalar
def with_sign(magnitude: float, source: float) -> float:
    """|magnitude| with the sign of source."""
    return float_of((bits_of(magnitude) & MAGNITUDE) | (bits_of(source) & SIGN))


@scalar
def power_of_two(shifted: float) -> float:
    """2^n of shifted = n + ROUND; n in [-1022, 1023]."""
    return float_of((bits_of(shifted) + 1023) << 52)


@scalar
def integer_of(small: int) -> float:
    """The float64 of an integer in [0, 2^52), without a conversion instruction."""
    return float_of(small | 0x4330000000000000) - 4503599627370496.0
