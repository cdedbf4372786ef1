"""law: feedback law of the plant 'unicycle'."""

# sha256 3cafb29601e1af8c8574e3798686527122b3c9484f3572dba5e41c68aba79c89
# state[0], target[0]: x in m
# state[1], target[1]: y in m
# state[2], target[2]: theta in rad
# control[0]: v in m/s, from -0.5 to 0.5
# control[1]: omega in rad/s, from -0.5 to 0.5

import math
import struct
from collections.abc import Sequence

FARTHEST = 100000000.0
INFINITY = math.inf
LARGE = 100000000.0
LN2 = 0.6931471805598903
LN2_REST = 5.497923018708371e-14
MAGNITUDE = 0x7FFFFFFFFFFFFFFF
NAN = math.nan
PER_LN2 = 1.4426950408889634
PER_QUARTER = 0.6366197723675814
PER_TURN = 0.15915494309189535
PI = 3.141592653589793
PI_REST = 1.2246467991473532e-16
QUARTER_1 = 1.570796325802803
QUARTER_2 = 9.920935184482005e-10
QUARTER_3 = 6.123233932053594e-17
QUARTER_4 = 6.36831716351095e-25
ROUND = 6755399441055744.0
SIGN = -0x8000000000000000
SMALL = 1e-08


def abs_(a: float) -> float:
    """|a|."""
    return abs(a)


def float_of(bits: int) -> float:
    """The float64 that has these bits."""
    return float(struct.unpack("<d", struct.pack("<Q", bits & 0xFFFFFFFFFFFFFFFF))[0])


def bits_of(x: float) -> int:
    """The 64 bits of x as a signed integer."""
    return int(struct.unpack("<q", struct.pack("<d", x))[0])


def with_sign(magnitude: float, source: float) -> float:
    """|magnitude| with the sign of source."""
    return float_of(bits_of(magnitude) & MAGNITUDE | bits_of(source) & SIGN)


def divide(a: float, b: float) -> float:
    """a / b, with infinity or NaN where Python raises."""
    if b != 0.0:
        return a / b
    if a == 0.0 or math.isnan(a):
        return math.nan
    return math.copysign(math.inf, a) * math.copysign(1.0, b)


def angle_of_point(x: float, y: float, side: float) -> float:
    """The angle of (side x, y), side 1 or -1, x and y not negative; the polynomial sees ratios in [-1/2, 1/2] only."""
    steep = y > x + x
    flat = y + y <= x
    turned = -x if steep else y - x
    numerator = y if flat else turned
    summed = y if steep else y + x
    denominator = x if flat else summed
    t = side * divide(numerator, denominator)
    z = t * t
    p = 0.010117153920883797
    p = p * z - 0.02743541586851339
    p = p * z + 0.04186535408290721
    p = p * z - 0.051220177166211224
    p = p * z + 0.05858301819535206
    p = p * z - 0.06663811084160588
    p = p * z + 0.07692073962679588
    p = p * z - 0.09090896248266972
    p = p * z + 0.1111111065979265
    p = p * z - 0.14285714276389874
    p = p * z + 0.1999999999990316
    p = p * z - 0.3333333333333298
    turned_base = 0.5 * PI if steep else 0.25 * PI
    turned_rest = 0.5 * PI_REST if steep else 0.25 * PI_REST
    ahead = 0.0 if flat else turned_base
    ahead_rest = 0.0 if flat else turned_rest
    base = PI - ahead if side < 0.0 else ahead
    rest = PI_REST - ahead_rest if side < 0.0 else ahead_rest
    return base + (t * z * p + rest + t)


def atan2(a: float, b: float) -> float:
    """The angle of the point (b, a) in [-pi, pi]; zeros and infinities as in C99, annex F."""
    y = abs(a)
    x = abs(b)
    diagonal = (y == x) & (y > 0.0)
    scale = 0.25 if y > 1e300 else 1.0
    y = 1.0 if diagonal else y * scale
    x = 1.0 if diagonal else x * scale
    x_or_one = 1.0 if (x == 0.0) & (y == 0.0) else x
    return with_sign(angle_of_point(x_or_one, y, with_sign(1.0, b)), a)


def sine_of_quadrant(x: float, shifted: float, ahead: int) -> float:
    """sin(r + (n + ahead) pi / 2) with x = r + n pi / 2, |r| <= pi / 4, shifted = n + ROUND.

    Sine and cosine share one Horner scheme, base + base r^2 p, whose coefficients are chosen per lane.
    """
    n = shifted - ROUND
    quadrant = bits_of(shifted) + ahead
    cosine = quadrant & 1 != 0
    near = x - n * QUARTER_1 - n * QUARTER_2
    r = near - n * QUARTER_3
    r_rest = near - r - n * QUARTER_3 - n * QUARTER_4
    z = r * r
    base = 1.0 if cosine else r
    slope = -r if cosine else 1.0
    p = -1.1353281798241095e-11 if cosine else -7.57854031682011e-13
    p = p * z + (2.087558213831528e-09 if cosine else 1.6058363165081574e-10)
    p = p * z + (-2.755731311738154e-07 if cosine else -2.5052104881849487e-08)
    p = p * z + (2.480158728409498e-05 if cosine else 2.755731921406482e-06)
    p = p * z + (-0.0013888888888862001 if cosine else -0.000198412698412548)
    p = p * z + (0.04166666666666647 if cosine else 0.008333333333333323)
    p = p * z + (-0.5 if cosine else -0.16666666666666666)
    value = base + (base * z * p + slope * r_rest)
    return float_of(bits_of(value) ^ quadrant << 62 & SIGN)


def cos(a: float) -> float:
    """Cosine; NaN if |a| > 1e8."""
    x = abs(a)
    value = sine_of_quadrant(x, x * PER_QUARTER + ROUND, 1)
    return value if x <= FARTHEST else NAN


def cube(a: float) -> float:
    """a a a, from the left."""
    return a * a * a


def sgn(a: float) -> float:
    """1 if a >= 0 else -1; sgn(-0.0) = 1."""
    return 1.0 if a >= 0.0 else -1.0


def div_protected(a: float, b: float) -> float:
    """a / b, but a sgn(b) 1e8 if |b| <= 1e-8."""
    quotient = divide(a, b)
    limited = a * sgn(b) * LARGE
    return limited if abs(b) <= SMALL else quotient


def limit(a: float, b: float, c: float) -> float:
    """a kept in [b, c]; NaN counts as 0."""
    number = a if a == a else 0.0
    lifted = b if number < b else number
    return c if number > c else lifted


def sin(a: float) -> float:
    """Sine; NaN if |a| > 1e8."""
    x = abs(a)
    value = sine_of_quadrant(x, x * PER_QUARTER + ROUND, 0)
    odd = float_of(bits_of(value) ^ bits_of(a) & SIGN)
    return odd if x <= FARTHEST else NAN


def sqrt(a: float) -> float:
    """The square root, correctly rounded; NaN below 0."""
    return math.sqrt(a) if a >= 0.0 else math.nan


def sqrt_protected(a: float) -> float:
    """The square root of |a|."""
    return sqrt(abs(a))


def square(a: float) -> float:
    """a a."""
    return a * a


def power_of_two(shifted: float) -> float:
    """2^n of shifted = n + ROUND; n in [-1022, 1023]."""
    return float_of(bits_of(shifted) + 1023 << 52)


def exp(a: float) -> float:
    """Exponential; the power of two goes in as two factors, so that subnormal results round once."""
    shifted = a * PER_LN2 + ROUND
    n = shifted - ROUND
    r = a - n * LN2 - n * LN2_REST
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
    rest = n - (half - ROUND) + ROUND
    scaled = value * power_of_two(half) * power_of_two(rest)
    above_zero = 0.0 if a < -746.0 else scaled
    return INFINITY if a > 710.0 else above_zero


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
    far = 1.0 - divide(2.0, exp(x + x) + 1.0)
    return with_sign(near if x < 0.55 else far, a)


def wrap(a: float) -> float:
    """a + 2 pi k in [-PI, PI), so PI goes to -PI; NaN if |a| > 1e8."""
    n = 4.0 * (a * PER_TURN + ROUND - ROUND)
    near = a - n * QUARTER_1 - n * QUARTER_2
    r = near - n * QUARTER_3 - n * QUARTER_4
    lowered = r - 2.0 * PI - 2.0 * PI_REST if r >= PI else r
    kept = r + 2.0 * PI + 2.0 * PI_REST if r < -PI else lowered
    inside = (kept >= -PI) & (kept < PI)
    wrapped = kept if inside else -PI
    return wrapped if abs(a) <= FARTHEST else NAN


def control(state: Sequence[float], target: Sequence[float]) -> tuple[float, ...]:
    """The saturated controls at a state and a target."""
    r1 = float(state[0])  # x
    r2 = float(state[1])  # y
    r3 = float(state[2])  # theta
    r4 = float(target[0])  # x_target
    r5 = float(target[1])  # y_target
    r6 = float(target[2])  # theta_target
    r7 = r4 - r1
    r8 = r5 - r2
    r9 = r6 - r3
    r10 = cos(r3)
    r11 = sin(r3)
    r12 = r7 * r10
    r13 = r8 * r11
    r14 = r12 + r13  # ahead
    r15 = r8 * r10
    r16 = r7 * r11
    r17 = r15 - r16  # aside
    r18 = wrap(r9)  # error_theta
    r19 = r17 * 0.7
    r20 = abs_(r14)
    r21 = r20 + 0.001
    r22 = atan2(r19, r21)
    r23 = r22 - r18
    r24 = r23 * 2.25
    r25 = tanh(r24)
    r26 = r14 * 3.1
    r27 = square(r25)
    r28 = 1.0 - r27
    r29 = r26 * r28
    r30 = sqrt_protected(r14)
    r31 = div_protected(r25, r30)
    r32 = cube(r17)
    r33 = -r32
    r34 = r31 + r33
    r35 = limit(r29, -0.5, 0.5)
    r36 = limit(r34, -0.5, 0.5)
    return r35, r36
