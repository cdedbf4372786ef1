"""Every row of the table against 60-digit arithmetic on its stated domain, guards on both sides."""

from collections.abc import Callable

import mpmath as mp
import numpy as np
import pytest

from gpsynth.operations import operation
from gpsynth.seeds import stream
from tests.kernels.elementary_loops import NAMES, bits, by_numba

LN_LARGE, CBRT_LARGE = 18.420680743952367, 464.1588833612782
NEAR_QUARTERS = (29, 58, 928, 1856, 29327, 204551, 1081409, 9206271, 18412542, 36825084)  # close to a float64
COUNT = 2000


def sgn(a):
    return 1 if a >= 0 else -1


def wide(low: float, high: float, seed: int) -> np.ndarray:
    """Both signs, magnitudes log-uniform in [low, high]."""
    rng = stream(21, seed)
    return rng.choice([-1.0, 1.0], COUNT) * np.exp(rng.uniform(np.log(low), np.log(high), COUNT))


def even(low: float, high: float, seed: int) -> np.ndarray:
    return stream(22, seed).uniform(low, high, COUNT)


def beside(*guards: float) -> np.ndarray:
    """The guards, their neighbors, and points within a thousandth; both signs."""
    g = np.array(guards)
    near = (g[:, None] * (1.0 + np.linspace(-1e-3, 1e-3, 50))).ravel()
    both = np.concatenate([g, np.nextafter(g, 0.0), np.nextafter(g, np.inf), near])
    return np.concatenate([both, -both])


def quarters() -> np.ndarray:
    """The float64 numbers nearest to multiples of pi / 2, up to 1e8."""
    spread = stream(23).integers(1, 63_661_977, 500)
    with mp.workdps(60):
        return np.array([float(int(n) * mp.pi / 2) for n in (*range(1, 300), *spread, *NEAR_QUARTERS)])


ANGLES = np.concatenate(
    [even(-8.0, 8.0, 1), wide(1e-300, 1e8, 2), even(-1e8, 1e8, 3), quarters(), -quarters()]
)
UNIT = np.concatenate(
    [even(-1.0, 1.0, 4), wide(1e-300, 1.0, 5), beside(0.5), 1.0 - np.abs(wide(1e-16, 0.1, 6))]
)
ALL = np.concatenate([even(-4.0, 4.0, 7), wide(5e-324, 1e308, 8)])
POSITIVE = np.abs(np.concatenate([ALL, 1.0 + wide(1e-16, 0.1, 9), beside(0.7071067811865476, 1.0, 2.0)]))
EXPONENTS = np.concatenate([even(-745.1, 709.7, 10), even(-746.0, -700.0, 11), wide(1e-300, 700.0, 12)])
DAILY = np.concatenate([even(-30.0, 30.0, 13), wide(1e-12, 1e12, 14), beside(1e-8, 0.01, 1.0, LN_LARGE, 1e8)])


def wrapped(a):
    """In [-pi, pi), exactly."""
    return a - 2 * mp.pi * mp.floor((a + mp.pi) / (2 * mp.pi))


def cube_root(a):
    return mp.sign(a) * mp.cbrt(abs(a))


WITHIN_TWO_ULP: dict[str, tuple[Callable, np.ndarray]] = {
    "sqrt": (mp.sqrt, POSITIVE),
    "sqrt_protected": (lambda a: mp.sqrt(abs(a)), ALL),
    "sin": (mp.sin, ANGLES),
    "cos": (mp.cos, ANGLES),
    "tan": (mp.tan, ANGLES),
    "atan": (mp.atan, np.concatenate([ALL, beside(0.5, 2.0)])),
    "asin": (mp.asin, UNIT),
    "acos": (mp.acos, UNIT),
    "exp": (mp.exp, EXPONENTS),
    "exp_protected": (lambda a: mp.exp(min(a, LN_LARGE)), np.concatenate([EXPONENTS, DAILY])),
    "log": (mp.log, POSITIVE),
    "log_protected": (lambda a: mp.log(max(abs(a), 1e-8)), np.concatenate([ALL, DAILY])),
    "tanh": (mp.tanh, np.concatenate([ALL, even(-1.0, 1.0, 15), even(-25.0, 25.0, 16), beside(0.55)])),
    "cbrt": (cube_root, ALL),
    "signed_sqrt": (lambda a: sgn(a) * mp.sqrt(abs(a)), ALL),
    "nop_inverse": (lambda a: sgn(a) * mp.mpf(1e8) if abs(a) <= 1e-8 else 1 / a, DAILY),
    "nop_exp": (lambda a: mp.mpf(LN_LARGE) if a > LN_LARGE else mp.exp(a), DAILY),
    "nop_log": (
        lambda a: -mp.mpf(LN_LARGE) if abs(a) < mp.exp(-8) else mp.log(abs(a)),
        np.concatenate([DAILY, beside(0.00033546262790251185)]),
    ),
    "tanh_half": (lambda a: mp.mpf(sgn(a)) if abs(a) > LN_LARGE else mp.tanh(a / 2), DAILY),
    "nop_cbrt": (lambda a: sgn(a) * mp.mpf(1e-8) if abs(a) < 1e-8 else cube_root(a), DAILY),
    "signed_decay": (lambda a: sgn(a) * (mp.mpf(1e-8) if abs(a) > 1e8 else mp.exp(-abs(a))), DAILY),
}

# Sums and differences of rounded terms: the error is counted in units of the largest term.
ROUNDED_TERMS: dict[str, tuple[Callable, Callable, np.ndarray]] = {
    "signed_log1p": (lambda a: sgn(a) * mp.log(abs(a) + 1), lambda a: 1 + mp.log(abs(a) + 1), DAILY),
    "signed_expm1": (
        lambda a: sgn(a) * (mp.mpf(1e8) if abs(a) > LN_LARGE else mp.exp(abs(a)) - 1),
        lambda a: mp.exp(min(abs(a), 19)),
        DAILY,
    ),
    "signed_saturation": (lambda a: sgn(a) * (1 - mp.exp(-abs(a))), lambda a: mp.mpf(1), DAILY),
    "sigmoid": (
        lambda a: mp.mpf(1) if a > 1e8 else mp.mpf(0) if mp.exp(-a) > 1e8 else 1 / (1 + mp.exp(-a)),
        lambda a: mp.mpf(1),
        DAILY,
    ),
    "circle": (
        lambda a: sgn(a) * (mp.mpf(1) if abs(a) > 1 else 1 - mp.sqrt(1 - a * a)),
        lambda a: 1 / mp.sqrt(max(1 - a * a, mp.mpf(2) ** -53)),
        np.concatenate([UNIT, beside(1.0)]),
    ),
    "notch": (
        lambda a: a * (1 - mp.mpf(1e-8) if a * a > LN_LARGE else 1 - mp.exp(-a * a)),
        abs,
        np.concatenate([DAILY[np.abs(DAILY) < 1e100], beside(4.2919319)]),
    ),
    "minus_cube": (
        lambda a: -sgn(a) * mp.mpf(1e8) if abs(a) > 1e8 else a - a**3,
        lambda a: abs(a) + abs(a) ** 3,
        DAILY,
    ),
    "cube": (lambda a: a**3, lambda a: abs(a) ** 3, DAILY),
    "nop_cube": (
        lambda a: sgn(a) * mp.mpf(1e8) if abs(a) > CBRT_LARGE else a**3,
        lambda a: abs(a) ** 3,
        np.concatenate([DAILY, beside(CBRT_LARGE)]),
    ),
}

A, B = wide(1e-9, 1e9, 31), wide(1e-9, 1e9, 32)
EXACT: dict[str, Callable] = {  # one rounding, or none: numpy's own operations are the reference
    "add": lambda a, b: a + b,
    "sub": lambda a, b: a - b,
    "mul": lambda a, b: a * b,
    "div": lambda a, b: a / b,
    "div_protected": lambda a, b: np.where(np.abs(b) <= 1e-8, a * np.where(b >= 0, 1e8, -1e8), a / b),
    "neg": lambda a: -a,
    "abs": np.abs,
    "half": lambda a: a / 2,
    "double": lambda a: a * 2,
    "square": lambda a: a * a,
    "floor": np.floor,
    "max": lambda a, b: np.where(a >= b, a, b),
    "min": lambda a, b: np.where(a < b, a, b),
    "lt": lambda a, b: (a < b) * 1.0,
    "le": lambda a, b: (a <= b) * 1.0,
    "eq": lambda a, b: (a == b) * 1.0,
    "not": lambda a: (a == 0) * 1.0,
    "where": lambda a, b, c: np.where(a != 0, b, c),
    "limit": np.clip,
    "sign": np.sign,
    "identity": lambda a: a,
    "nop_square": lambda a: np.where(np.abs(a) > 1e4, 1e8, a * a),
    "step": lambda a: (a >= 0) * 1.0,
    "sgn": lambda a: np.where(a >= 0, 1.0, -1.0),
    "clip_unit": lambda a: np.clip(a, -1.0, 1.0),
    "step_open": lambda a: (a > 0) * 1.0,
    "sgn_dead_zone": lambda a: np.where(np.abs(a) < 0.01, 0.0, np.where(a >= 0, 1.0, -1.0)),
    "nop_mul": lambda a, b: np.clip(a * b, -1e8, 1e8),
    "prob_sum": lambda a, b: a + b - a * b,
    "hypot": lambda a, b: np.sqrt(a * a + b * b),
    "signed_hypot": lambda a, b: np.where(a + b >= 0, 1.0, -1.0) * np.sqrt(a * a + b * b),
    "signed_abs_sum": lambda a, b: np.where(a + b >= 0, 1.0, -1.0) * (np.abs(a) + np.abs(b)),
    "signed_abs_max": lambda a, b: np.where(a + b >= 0, 1.0, -1.0) * np.maximum(np.abs(a), np.abs(b)),
}


def ulp(exact) -> mp.mpf:
    """The distance of float64 numbers around `exact`."""
    exponent = mp.frexp(exact)[1] - 1 if exact != 0 else -1022
    return mp.mpf(2) ** (max(exponent, -1022) - 52)


def worst(values: np.ndarray, exact: list, units: list) -> float:
    """The largest error in the units given."""
    assert np.all(np.isfinite(values))
    return max(float(abs(mp.mpf(v) - e) / u) for v, e, u in zip(values.tolist(), exact, units, strict=True))


@pytest.fixture(autouse=True)
def _sixty_digits():
    with mp.workdps(60):
        yield


@pytest.mark.parametrize("name", WITHIN_TWO_ULP)
def test_within_two_ulp(name):
    function, points = WITHIN_TWO_ULP[name]
    exact = [function(mp.mpf(a)) for a in points.tolist()]
    assert worst(by_numba(name, [points]), exact, [ulp(e) for e in exact]) <= 2.0


@pytest.mark.parametrize("name", ROUNDED_TERMS)
def test_within_two_ulp_of_the_largest_term(name):
    function, term, points = ROUNDED_TERMS[name]
    exact = [function(mp.mpf(a)) for a in points.tolist()]
    units = [max(ulp(e), ulp(term(mp.mpf(a)))) for e, a in zip(exact, points.tolist(), strict=True)]
    assert worst(by_numba(name, [points]), exact, units) <= 2.0


@pytest.mark.parametrize("name", EXACT)
def test_exact(name):
    operands = [np.concatenate([A, DAILY[:500], [0.0] * 99]), np.concatenate([B, DAILY[1:501], DAILY[-99:]])]
    operands.append(operands[1] + np.abs(operands[0]))
    used = operands[: operation(name).arity]
    assert np.array_equal(by_numba(name, used), EXACT[name](*used))


@pytest.mark.parametrize("scale", [1.0, 1e-310, 1e300])
def test_atan2_within_two_ulp(scale):
    y, x = wide(1e-4, 1e7, 41) * scale, wide(1e-4, 1e7, 42) * scale
    exact = [mp.atan2(mp.mpf(a), mp.mpf(b)) for a, b in zip(y.tolist(), x.tolist(), strict=True)]
    assert worst(by_numba("atan2", [y, x]), exact, [ulp(e) for e in exact]) <= 2.0


def test_atan2_of_zeros_and_infinities_is_that_of_c():
    edges = np.array([0.0, -0.0, 1.0, -1.0, np.inf, -np.inf, 1e308, -1e308, 5e-324, np.nan])
    y, x = (axis.ravel().copy() for axis in np.meshgrid(edges, edges))
    # numpy calls the C library here
    np.testing.assert_array_equal(by_numba("atan2", [y, x]), np.arctan2(y, x))
    zero = (y == 0.0) & ~np.isnan(x)
    assert np.array_equal(np.signbit(by_numba("atan2", [y, x]))[zero], np.signbit(y)[zero])


def test_wrap_within_two_ulp_and_inside():
    values = by_numba("wrap", [ANGLES])
    exact = [wrapped(mp.mpf(a)) for a in ANGLES.tolist()]
    turned = [
        e + 2 * mp.pi * mp.nint((v - e) / (2 * mp.pi)) for e, v in zip(exact, values.tolist(), strict=True)
    ]
    assert worst(values, turned, [ulp(e) for e in turned]) <= 2.0
    assert values.min() >= -np.pi
    assert values.max() < np.pi
    inside = even(-np.pi, np.pi, 17)
    assert np.array_equal(by_numba("wrap", [inside]), inside)


@pytest.mark.parametrize("name", ["sin", "cos", "tan", "wrap"])
def test_beyond_the_domain_is_nan(name):
    beyond = np.array([np.nextafter(1e8, np.inf), -1e9, 1e300, np.inf, -np.inf, np.nan])
    assert np.all(np.isnan(by_numba(name, [beyond])))
    assert np.all(np.isfinite(by_numba(name, [np.array([1e8, -1e8])])))


def test_ends_of_the_range():
    ends = np.array([0.0, 709.7827128933841, -745.2, -np.inf, np.inf])
    assert by_numba("exp", [ends]).tolist() == [1.0, np.inf, 0.0, 0.0, np.inf]
    assert by_numba("log", [np.array([1.0, 0.0, -0.0, np.inf])]).tolist() == [0.0, -np.inf, -np.inf, np.inf]
    assert np.all(np.isnan(by_numba("log", [np.array([-1.0, -np.inf, np.nan])])))
    assert np.all(np.isnan(by_numba("asin", [np.array([1.0000000000000002, -2.0, np.nan])])))
    assert by_numba("tanh", [np.array([40.0, -np.inf])]).tolist() == [1.0, -1.0]
    assert by_numba("cos", [np.array([0.0, -0.0])]).tolist() == [1.0, 1.0]
    assert by_numba("cbrt", [np.array([8.0, -27.0, np.inf])]).tolist() == [2.0, -3.0, np.inf]


@pytest.mark.parametrize("name", ["sin", "tan", "atan", "asin", "tanh", "cbrt", "wrap", "sqrt", "floor"])
def test_odd_functions_keep_the_sign_of_zero(name):
    assert np.signbit(by_numba(name, [np.array([-0.0, 0.0])])).tolist() == [True, False]


def test_limit_of_nan_is_the_number_nearest_to_zero():
    low, high = np.array([-1.0, 2.0, -3.0]), np.array([1.0, 3.0, -2.0])
    assert by_numba("limit", [np.full(3, np.nan), low, high]).tolist() == [0.0, 2.0, -2.0]


def test_every_row_is_checked():
    assert {*WITHIN_TWO_ULP, *ROUNDED_TERMS, *EXACT, "atan2", "wrap"} == set(NAMES)


def test_ties_and_nan_of_max_and_min_follow_the_written_comparison():
    a, b = np.array([0.0, -0.0, 1.0, np.nan]), np.array([-0.0, 0.0, np.nan, 1.0])
    assert np.array_equal(bits(by_numba("max", [a, b])), bits(np.array([0.0, -0.0, np.nan, 1.0])))
    assert np.array_equal(bits(by_numba("min", [a, b])), bits(np.array([-0.0, 0.0, np.nan, 1.0])))
