"""Arithmetic, order and choice: one function per row of the table, under the row's name.

A trailing underscore keeps a Python name free. Every comparison is written out, so NaN and signed zeros take the same
way in Python, numba and C.
"""

import numpy as np

from gpsynth.kernels.bits import scalar, with_sign

LARGE = 1e8  # INF of the network-operator library
SMALL = 1e-8  # its EPS


@scalar
def sgn(a: float) -> float:
    """1 if a >= 0 else -1; sgn(-0.0) = 1."""
    return 1.0 if a >= 0.0 else -1.0


@scalar
def add(a: float, b: float) -> float:
    """a + b."""
    return a + b


@scalar
def sub(a: float, b: float) -> float:
    """a - b."""
    return a - b


@scalar
def mul(a: float, b: float) -> float:
    """a b."""
    return a * b


@scalar
def div(a: float, b: float) -> float:
    """a / b."""
    return a / b


@scalar
def div_protected(a: float, b: float) -> float:
    """a / b, but a sgn(b) 1e8 if |b| <= 1e-8."""
    quotient = a / b
    limited = a * sgn(b) * LARGE
    return limited if abs(b) <= SMALL else quotient


@scalar
def neg(a: float) -> float:
    """-a."""
    return -a


@scalar
def abs_(a: float) -> float:
    """|a|."""
    return abs(a)


@scalar
def half(a: float) -> float:
    """a / 2."""
    return 0.5 * a


@scalar
def double(a: float) -> float:
    """2 a."""
    return 2.0 * a


@scalar
def square(a: float) -> float:
    """a a."""
    return a * a


@scalar
def cube(a: float) -> float:
    """a a a, from the left."""
    return a * a * a


@scalar
def sqrt(a: float) -> float:
    """The square root, correctly rounded; NaN below 0."""
    return np.sqrt(a)  # type: ignore[no-any-return]


@scalar
def sqrt_protected(a: float) -> float:
    """The square root of |a|."""
    return sqrt(abs(a))


@scalar
def floor(a: float) -> float:
    """The largest integer not above a."""
    nearest = with_sign((abs(a) + 4503599627370496.0) - 4503599627370496.0, a)
    below = nearest - 1.0
    integer = below if nearest > a else nearest
    return integer if abs(a) < 4503599627370496.0 else a


@scalar
def hypot(a: float, b: float) -> float:
    """sqrt(a a + b b)."""
    return sqrt(a * a + b * b)


@scalar
def max_(a: float, b: float) -> float:
    """a if a >= b else b."""
    return a if a >= b else b


@scalar
def min_(a: float, b: float) -> float:
    """a if a < b else b."""
    return a if a < b else b


@scalar
def lt(a: float, b: float) -> float:
    """1 if a < b else 0."""
    return 1.0 if a < b else 0.0


@scalar
def le(a: float, b: float) -> float:
    """1 if a <= b else 0."""
    return 1.0 if a <= b else 0.0


@scalar
def eq(a: float, b: float) -> float:
    """1 if a = b else 0."""
    return 1.0 if a == b else 0.0


@scalar
def not_(a: float) -> float:
    """1 if a = 0 else 0."""
    return 1.0 if a == 0.0 else 0.0


@scalar
def where(a: float, b: float, c: float) -> float:
    """b if a != 0 else c."""
    return b if a != 0.0 else c


@scalar
def limit(a: float, b: float, c: float) -> float:
    """a kept in [b, c]; NaN counts as 0."""
    number = a if a == a else 0.0
    lifted = b if number < b else number
    return c if number > c else lifted


@scalar
def sign(a: float) -> float:
    """-1, 0 or 1; 0 for NaN."""
    negative = -1.0 if a < 0.0 else 0.0
    return 1.0 if a > 0.0 else negative
