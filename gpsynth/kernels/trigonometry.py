"""Sine to arc cosine as branch-free IEEE arithmetic, at most 2 ulp from the exact value.

Reduction after Cody and Waite (1980): a quarter turn is the sum of three parts that end at 2^-26, 2^-53 and 2^-80,
whose products with n < 2^26 are exact, and a rest. Polynomials are minimax in relative error (Remez exchange in 50
digits, rounded to float64).
"""

from gpsynth.kernels.arithmetic import sqrt
from gpsynth.kernels.bits import ROUND, SIGN, bits_of, float_of, scalar, with_sign

NAN = float("nan")
PI = 3.141592653589793
PI_REST = 1.2246467991473532e-16  # pi - PI
QUARTER_1 = 1.570796325802803
QUARTER_2 = 9.920935184482005e-10
QUARTER_3 = 6.123233932053594e-17
QUARTER_4 = 6.36831716351095e-25
PER_QUARTER = 0.6366197723675814  # 2 / pi
PER_TURN = 0.15915494309189535  # 1 / (2 pi)
FARTHEST = 1e8  # n < 2^26 up to here


@scalar
def sine_of_quadrant(x: float, shifted: float, ahead: int) -> float:
    """sin(r + (n + ahead) pi / 2) with x = r + n pi / 2, |r| <= pi / 4, shifted = n + ROUND.

    Sine and cosine share one Horner scheme, base + base r^2 p, whose coefficients are chosen per lane.
    """
    n = shifted - ROUND
    quadrant = bits_of(shifted) + ahead
    cosine = (quadrant & 1) != 0
    near = (x - n * QUARTER_1) - n * QUARTER_2  # exact
    r = near - n * QUARTER_3
    r_rest = ((near - r) - n * QUARTER_3) - n * QUARTER_4
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
    return float_of(bits_of(value) ^ ((quadrant << 62) & SIGN))


@scalar
def sin(a: float) -> float:
    """Sine; NaN if |a| > 1e8."""
    x = abs(a)
    value = sine_of_quadrant(x, x * PER_QUARTER + ROUND, 0)
    odd = float_of(bits_of(value) ^ (bits_of(a) & SIGN))
    return odd if x <= FARTHEST else NAN


@scalar
def cos(a: float) -> float:
    """Cosine; NaN if |a| > 1e8."""
    x = abs(a)
    value = sine_of_quadrant(x, x * PER_QUARTER + ROUND, 1)
    return value if x <= FARTHEST else NAN


@scalar
def sine_and_cosine(a: float) -> tuple[float, float]:
    """Both, bit for bit as `sin` and `cos` give them, from one reduction."""
    x = abs(a)
    shifted = x * PER_QUARTER + ROUND
    n = shifted - ROUND
    quadrant = bits_of(shifted)
    near = (x - n * QUARTER_1) - n * QUARTER_2  # exact
    r = near - n * QUARTER_3
    r_rest = ((near - r) - n * QUARTER_3) - n * QUARTER_4
    z = r * r
    p = -7.57854031682011e-13
    q = -1.1353281798241095e-11
    p = p * z + 1.6058363165081574e-10
    q = q * z + 2.087558213831528e-09
    p = p * z + -2.5052104881849487e-08
    q = q * z + -2.755731311738154e-07
    p = p * z + 2.755731921406482e-06
    q = q * z + 2.480158728409498e-05
    p = p * z + -0.000198412698412548
    q = q * z + -0.0013888888888862001
    p = p * z + 0.008333333333333323
    q = q * z + 0.04166666666666647
    p = p * z + -0.16666666666666666
    q = q * z + -0.5
    sine_of_r = r + (r * z * p + r_rest)
    cosine_of_r = 1.0 + (z * q + -r * r_rest)
    odd = (quadrant & 1) != 0
    sine = float_of(bits_of(cosine_of_r if odd else sine_of_r) ^ ((quadrant << 62) & SIGN))
    cosine = float_of(bits_of(sine_of_r if odd else cosine_of_r) ^ (((quadrant + 1) << 62) & SIGN))
    signed = float_of(bits_of(sine) ^ (bits_of(a) & SIGN))
    return signed if x <= FARTHEST else NAN, cosine if x <= FARTHEST else NAN


@scalar
def tan(a: float) -> float:
    """Tangent; NaN if |a| > 1e8. In odd quarters it is -1 / tan(a - pi / 2)."""
    x = abs(a)
    shifted = x * PER_QUARTER + ROUND
    n = shifted - ROUND
    near = (x - n * QUARTER_1) - n * QUARTER_2  # exact
    r = near - n * QUARTER_3
    r_rest = ((near - r) - n * QUARTER_3) - n * QUARTER_4
    z = r * r
    p = 9.710992939729935e-06
    p = p * z - 2.3879693802618004e-05
    p = p * z + 4.784296700348429e-05
    p = p * z - 2.4687489303360134e-05
    p = p * z + 6.647659046492796e-05
    p = p * z + 8.39666496171902e-05
    p = p * z + 0.00024359232554861614
    p = p * z + 0.0005889089054090903
    p = p * z + 0.001456036722921464
    p = p * z + 0.003592102113233612
    p = p * z + 0.008863237805395703
    p = p * z + 0.021869488406486375
    p = p * z + 0.05396825397264337
    p = p * z + 0.13333333333325817
    p = p * z + 0.33333333333333376
    t = r + (r * z * p + (1.0 + z) * r_rest)
    turned = (bits_of(shifted) & 1) != 0
    value = (-1.0 if turned else t) / (t if turned else 1.0)
    odd = float_of(bits_of(value) ^ (bits_of(a) & SIGN))
    return odd if x <= FARTHEST else NAN


@scalar
def wrap(a: float) -> float:
    """a + 2 pi k in [-PI, PI), so PI goes to -PI; NaN if |a| > 1e8."""
    n = 4.0 * ((a * PER_TURN + ROUND) - ROUND)
    near = (a - n * QUARTER_1) - n * QUARTER_2  # exact
    r = (near - n * QUARTER_3) - n * QUARTER_4
    lowered = r - 2.0 * PI - 2.0 * PI_REST if r >= PI else r
    kept = r + 2.0 * PI + 2.0 * PI_REST if r < -PI else lowered
    inside = (kept >= -PI) & (kept < PI)
    wrapped = kept if inside else -PI
    return wrapped if abs(a) <= FARTHEST else NAN


@scalar
def angle_of_point(x: float, y: float, side: float) -> float:
    """The angle of (side x, y), side 1 or -1, x and y not negative; the polynomial sees ratios in [-1/2, 1/2] only."""
    steep = y > x + x
    flat = y + y <= x
    turned = -x if steep else y - x
    numerator = y if flat else turned
    summed = y if steep else y + x
    denominator = x if flat else summed
    t = side * (numerator / denominator)
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
    return base + ((t * z * p + rest) + t)


@scalar
def atan(a: float) -> float:
    """Arc tangent."""
    return with_sign(angle_of_point(1.0, abs(a), 1.0), a)


@scalar
def atan2(a: float, b: float) -> float:
    """The angle of the point (b, a) in [-pi, pi]; zeros and infinities as in C99, annex F."""
    y = abs(a)
    x = abs(b)
    diagonal = (y == x) & (y > 0.0)  # infinities among them
    scale = 0.25 if y > 1e300 else 1.0  # keeps y + x finite
    y = 1.0 if diagonal else y * scale
    x = 1.0 if diagonal else x * scale
    x_or_one = 1.0 if (x == 0.0) & (y == 0.0) else x
    return with_sign(angle_of_point(x_or_one, y, with_sign(1.0, b)), a)


@scalar
def arc_sine_excess(s: float, z: float) -> float:
    """asin s - s, 0 <= s <= 1/2, z = s s."""
    p = 0.03262901061703242
    p = p * z - 0.02099970435329421
    p = p * z + 0.021707920228459555
    p = p * z + 0.003706204531682829
    p = p * z + 0.010780310035087089
    p = p * z + 0.011398901294855211
    p = p * z + 0.013980821994055898
    p = p * z + 0.01735161188156408
    p = p * z + 0.022372214995754387
    p = p * z + 0.030381942707465328
    p = p * z + 0.044642857174619174
    p = p * z + 0.07499999999970791
    p = p * z + 0.1666666666666676
    return s * z * p


@scalar
def asin(a: float) -> float:
    """Arc sine; beyond 1/2 by asin x = pi/2 - 2 asin sqrt((1 - x) / 2)."""
    x = abs(a)
    far = x > 0.5
    z = 0.5 - 0.5 * x if far else x * x
    s = sqrt(z) if far else x
    excess = arc_sine_excess(s, z)
    complement = (0.5 * PI - 2.0 * s) - (2.0 * excess - 0.5 * PI_REST)
    return with_sign(complement if far else s + excess, a)


@scalar
def acos(a: float) -> float:
    """Arc cosine; beyond 1/2 by acos x = 2 asin sqrt((1 - x) / 2)."""
    x = abs(a)
    far = x > 0.5
    z = 0.5 - 0.5 * x if far else x * x
    s = sqrt(z) if far else x
    t = s + arc_sine_excess(s, z)
    near = 0.5 * PI - (with_sign(t, a) - 0.5 * PI_REST)
    behind = PI - (2.0 * t - PI_REST)
    ahead = 2.0 * t
    beyond = behind if a < 0.0 else ahead
    return beyond if far else near
