"""The functions of the network operator that the table does not have elsewhere (Diveev and Shmalko, library of 2022).

The guard of each function is tested first; INF = 1e8, EPS = 1e-8, sgn(0) = +1.
"""

from gpsynth.kernels.arithmetic import LARGE, SMALL, max_, sgn, sqrt
from gpsynth.kernels.bits import scalar
from gpsynth.kernels.exponentials import LN_LARGE, cbrt, exp, log, tanh

CBRT_LARGE = 464.1588833612782  # exp(ln(1e8) / 3) as the library computes it


@scalar
def identity(a: float) -> float:
    """a; rho 1."""
    return a


@scalar
def nop_square(a: float) -> float:
    """a a, but 1e8 if |a| > 1e4; rho 2."""
    return LARGE if abs(a) > 1e4 else a * a


@scalar
def signed_sqrt(a: float) -> float:
    """sgn(a) sqrt|a|; rho 4."""
    return sgn(a) * sqrt(abs(a))


@scalar
def nop_inverse(a: float) -> float:
    """1 / a, but sgn(a) 1e8 if |a| <= 1e-8; rho 5."""
    inverse = 1.0 / a
    return sgn(a) * LARGE if abs(a) <= SMALL else inverse


@scalar
def nop_exp(a: float) -> float:
    """e^a, but 18.42... if a > 18.42...; rho 6."""
    return LN_LARGE if a > LN_LARGE else exp(a)


@scalar
def nop_log(a: float) -> float:
    """ln|a|, but -18.42... if |a| < e^-8; rho 7."""
    x = abs(a)
    return -LN_LARGE if x < 0.00033546262790251185 else log(x)


@scalar
def tanh_half(a: float) -> float:
    """tanh(a / 2), sgn(a) if |a| > 18.42...; rho 8."""
    return sgn(a) if abs(a) > LN_LARGE else tanh(0.5 * a)


@scalar
def step(a: float) -> float:
    """1 if a >= 0 else 0; rho 9."""
    return 1.0 if a >= 0.0 else 0.0


@scalar
def nop_cube(a: float) -> float:
    """a a a, but sgn(a) 1e8 if |a| > 464.158...; rho 14."""
    return sgn(a) * LARGE if abs(a) > CBRT_LARGE else a * a * a


@scalar
def nop_cbrt(a: float) -> float:
    """sgn(a) |a|^(1/3), but sgn(a) 1e-8 if |a| < 1e-8; rho 15."""
    return sgn(a) * SMALL if abs(a) < SMALL else cbrt(a)


@scalar
def clip_unit(a: float) -> float:
    """a if |a| < 1 else sgn(a); rho 16."""
    return a if abs(a) < 1.0 else sgn(a)


@scalar
def signed_log1p(a: float) -> float:
    """sgn(a) ln(|a| + 1); rho 17."""
    return sgn(a) * log(abs(a) + 1.0)


@scalar
def signed_expm1(a: float) -> float:
    """sgn(a) (e^|a| - 1), but sgn(a) 1e8 if |a| > 18.42...; rho 18."""
    x = abs(a)
    return sgn(a) * (LARGE if x > LN_LARGE else exp(x) - 1.0)


@scalar
def signed_decay(a: float) -> float:
    """sgn(a) e^-|a|, but sgn(a) 1e-8 if |a| > 1e8; rho 19."""
    x = abs(a)
    return sgn(a) * (SMALL if x > LARGE else exp(-x))


@scalar
def signed_saturation(a: float) -> float:
    """sgn(a) (1 - e^-|a|); rho 22."""
    return sgn(a) * (1.0 - exp(-abs(a)))


@scalar
def minus_cube(a: float) -> float:
    """a - a (a a), but -sgn(a) 1e8 if |a| > 1e8; rho 23."""
    return -sgn(a) * LARGE if abs(a) > LARGE else a - a * (a * a)


@scalar
def sigmoid(a: float) -> float:
    """1 / (1 + e^-a), 1 if a > 1e8, 0 if e^-a > 1e8; rho 24."""
    e = exp(-a)
    value = 1.0 / (1.0 + e)
    positive = 0.0 if e > LARGE else value
    return 1.0 if a > LARGE else positive


@scalar
def step_open(a: float) -> float:
    """1 if a > 0 else 0; rho 25."""
    return 1.0 if a > 0.0 else 0.0


@scalar
def sgn_dead_zone(a: float) -> float:
    """0 if |a| < 0.01 else sgn(a); rho 26."""
    return 0.0 if abs(a) < 0.01 else sgn(a)


@scalar
def circle(a: float) -> float:
    """sgn(a) (1 - sqrt(1 - a a)), but sgn(a) if |a| > 1; rho 27."""
    arc = 1.0 - sqrt(1.0 - a * a)
    return sgn(a) * (1.0 if abs(a) > 1.0 else arc)


@scalar
def notch(a: float) -> float:
    """a (1 - e^(-a a)), but a (1 - 1e-8) if a a > 18.42...; rho 28."""
    square = a * a
    depth = 1.0 - exp(-square)
    return a * (1.0 - SMALL if square > LN_LARGE else depth)


@scalar
def nop_mul(a: float, b: float) -> float:
    """a b, kept in [-1e8, 1e8]; chi 2."""
    product = a * b
    lowered = LARGE if product > LARGE else product
    return -LARGE if product < -LARGE else lowered


@scalar
def prob_sum(a: float, b: float) -> float:
    """a + b - a b; chi 5."""
    return (a + b) - a * b


@scalar
def signed_hypot(a: float, b: float) -> float:
    """sgn(a + b) sqrt(a a + b b); chi 6."""
    return sgn(a + b) * sqrt(a * a + b * b)


@scalar
def signed_abs_sum(a: float, b: float) -> float:
    """sgn(a + b) (|a| + |b|); chi 7."""
    return sgn(a + b) * (abs(a) + abs(b))


@scalar
def signed_abs_max(a: float, b: float) -> float:
    """sgn(a + b) max(|a|, |b|); chi 8."""
    return sgn(a + b) * max_(abs(a), abs(b))
