"""Exponential, logarithm, hyperbolic tangent and cube root as branch-free IEEE arithmetic, at most 2 ulp off.

Polynomials are minimax in relative error (Remez exchange in 50 digits, rounded to float64); the logarithm is arranged
as in fdlibm (Sun Microsystems, 1993).
"""

from gpsynth.kernels.bits import (
    MANTISSA,
    ROUND,
    bits_of,
    float_of,
    integer_of,
    power_of_two,
    scalar,
    with_sign,
)

INFINITY = float("inf")
NAN = float("nan")
LN2 = 0.6931471805598903  # 42 bits: its product with an exponent is exact
LN2_REST = 5.497923018708371e-14
PER_LN2 = 1.4426950408889634
TINY = 2.2250738585072014e-308  # smallest normal number
ONE_BITS = 0x3FF0000000000000
SQRT_HALF_BITS = 0x3FE6A09E667F3BCD
LN_LARGE = 18.420680743952367  # -ln 1e-8


@scalar
def exp(a: float) -> float:
    """Exponential; the power of two goes in as two factors, so that subnormal results round once."""
    shifted = a * PER_LN2 + ROUND
    n = shifted - ROUND
    r = (a - n * LN2) - n * LN2_REST
    p = 2.5000070582545002e-08
    p = p * r + 2.763023436031298e-07
    p = p * r + 2.755758627162417e-06
    p = p * r + 2.480149313503365e-05
    p = p * r + 0.00019841269506774855
    p = p * r + 0.0013888888943598715
    p = p * r + 0.008333333333494335
    p = p * r + 0.04166666666653026
    p = p * r + 0.16666666666666413
    p = p * r + 0.5000000000000011
    value = 1.0 + (r + r * r * p)
    half = 0.5 * n + ROUND
    rest = (n - (half - ROUND)) + ROUND
    scaled = value * power_of_two(half) * power_of_two(rest)
    above_zero = 0.0 if a < -746.0 else scaled
    return INFINITY if a > 710.0 else above_zero


@scalar
def exp_protected(a: float) -> float:
    """Exponential of min(a, 18.42...); NaN stays NaN."""
    return exp(LN_LARGE if a > LN_LARGE else a)


@scalar
def log(a: float) -> float:
    """Natural logarithm: a = 2^k (1 + f), 1 + f in [sqrt(1/2), sqrt(2)), s = f / (2 + f)."""
    subnormal = a < TINY
    x = a * 18014398509481984.0 if subnormal else a
    bits = bits_of(x) + (ONE_BITS - SQRT_HALF_BITS)
    k = integer_of(bits >> 52) - (1077.0 if subnormal else 1023.0)
    f = float_of((bits & MANTISSA) + SQRT_HALF_BITS) - 1.0
    s = f / (2.0 + f)
    z = s * s
    p = 0.14795965083287885
    p = p * z + 0.15314049090878307
    p = p * z + 0.181835643801577
    p = p * z + 0.22222198572206553
    p = p * z + 0.2857142874239651
    p = p * z + 0.3999999999941464
    p = p * z + 0.6666666666666734
    h = 0.5 * f * f
    value = k * LN2 - ((h - (s * (h + z * p) + k * LN2_REST)) - f)
    finite = value if a < INFINITY else a
    positive = finite if a != 0.0 else -INFINITY
    return NAN if a < 0.0 else positive


@scalar
def log_protected(a: float) -> float:
    """ln max(|a|, 1e-8); NaN stays NaN."""
    x = abs(a)
    return log(1e-8 if x < 1e-8 else x)


@scalar
def tanh(a: float) -> float:
    """Hyperbolic tangent: odd polynomial below 0.55, 1 - 2 / (e^2x + 1) above."""
    x = abs(a)
    z = x * x
    p = -1.9490333624275116e-05
    p = p * z + 8.33095572229502e-05
    p = p * z - 0.00023337687175581872
    p = p * z + 0.0005884426863291855
    p = p * z - 0.0014555424191689719
    p = p * z + 0.003592091965875118
    p = p * z - 0.008863232595216543
    p = p * z + 0.021869488385486063
    p = p * z - 0.05396825396374805
    p = p * z + 0.133333333333266
    p = p * z - 0.333333333333333
    near = x + x * z * p
    far = 1.0 - 2.0 / (exp(x + x) + 1.0)
    return with_sign(near if x < 0.55 else far, a)


@scalar
def cbrt(a: float) -> float:
    """Real cube root: a = 2^(3 q) f, f in [1/2, 4); f^(-1/3) by a polynomial and one cubic step, then Newton."""
    x = abs(a)
    subnormal = x < TINY
    bits = bits_of(x * 18014398509481984.0 if subnormal else x)
    exponent = integer_of(bits >> 52) - 1023.0
    m = float_of((bits & MANTISSA) | ONE_BITS)
    shifted = exponent * 0.3333333333333333 + ROUND
    remainder = exponent - 3.0 * (shifted - ROUND)
    doubled = 2.0 if remainder > 0.0 else 1.0
    doubled_root = 0.7937005259840998 if remainder > 0.0 else 1.0
    f = m * (0.5 if remainder < 0.0 else doubled)
    r = -0.04993692861995155
    r = r * m + 0.31775725488772205
    r = r * m - 0.8099605273188798
    r = r * m + 1.541887117417354
    r = r * (1.2599210498948732 if remainder < 0.0 else doubled_root)
    e = 1.0 - f * r * r * r
    r = r + r * e * (0.3333333333333333 + 0.2222222222222222 * e)
    y = f * r * r
    y = y - (y * y * y - f) * (r * r * 0.3333333333333333)
    scale = power_of_two(shifted) * (3.814697265625e-06 if subnormal else 1.0)
    root = with_sign(y * scale, a)
    ordinary = root if x < INFINITY else a
    return a if x == 0.0 else ordinary
