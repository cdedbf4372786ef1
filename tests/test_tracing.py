"""Tracing: a traced function computes what numpy computes, and what cannot be traced is named with its line."""

import functools
import math

import numpy as np
import pytest

from gpsynth.errors import TracingError
from gpsynth.program import Program
from gpsynth.seeds import stream
from gpsynth.tracing import inline, trace, where, wrap_angle

STATES = ("a", "b", "c")
CONTROLS = ("u", "v")
ARGUMENTS = (("x", STATES), ("u", CONTROLS))
GAIN = np.array([[1.0, -2.0, 0.5], [0.0, 3.0, -1.0]])
CENTER = np.array([0.1, 0.2, -0.3])


class Named(np.ndarray):
    """A row of numbers with attributes, as a traced function sees its arguments."""

    def __getattr__(self, name):
        return self[(*STATES, *CONTROLS).index(name) % 3]


def numbers(function, row):
    """The function run by numpy on plain numbers."""
    result = function(row[:3].copy().view(Named), row[3:].copy().view(Named))
    result = list(result.values()) if isinstance(result, dict) else result
    return np.array([float(value) for value in np.atleast_1d(np.asarray(result, dtype=np.float64))])


def rotated(x, u):
    turn = np.array([[np.cos(x.a), -np.sin(x.a)], [np.sin(x.a), np.cos(x.a)]])
    return turn @ (x - CENTER)[:2]


def unpacked(x, u):
    first, *rest = x
    total = first
    for value in rest:
        total += 2.0 * value
    return total, sum(u), len(x) * x[-1], x[0:2][1], x[np.int64(2)]


def in_place(x, u):
    error = x - CENTER
    error *= 2.0
    error[1] = 5.0
    x -= CENTER
    u += error[:2]
    return np.concatenate([x + error, u])


AGREEING = {
    "arithmetic": lambda x, u: (x.a + x.b - 3 * x.c / u.u, -x.a, +x.b, abs(x.c), 2 - x.a, 1 / x.b),
    "numpy_numbers": lambda x, u: (np.float32(0.5) * x.a, np.int8(3) - x.b, x.c / np.array(2.0), x.a * True),
    "powers": lambda x, u: (x.a**2, x.a**3, x.a**7, x.a**-2, x.a**0, x.a**1, x.c**2.0, np.power(x.a, 5)),
    "roots": lambda x, u: (abs(x.b) ** 0.5, np.sqrt(np.abs(x.c)), np.cbrt(u.v)),
    "vector_powers": lambda x, u: (x - CENTER) ** 2,
    "trigonometry": lambda x, u: (
        np.sin(x.a),
        np.cos(x.b),
        np.tan(x.c),
        np.arctan(u.u),
        np.arctan2(x.a, x.b),
    ),
    "inverse": lambda x, u: (np.arcsin(np.clip(x.a, -1, 1)), np.arccos(np.clip(x.b, -1.0, 1.0))),
    "exponentials": lambda x, u: (np.exp(x.a), np.log(abs(x.b)), np.tanh(u.u)),
    "roundings": lambda x, u: (np.floor(x.a), np.ceil(x.b), np.sign(x.c), np.fabs(u.u), np.absolute(u.v)),
    "products": lambda x, u: (np.hypot(x.a, x.b), np.square(x.c), np.reciprocal(u.u), np.negative(u.v)),
    "degrees": lambda x, u: (np.deg2rad(x.a), np.rad2deg(x.b), np.radians(x.c), np.degrees(u.u)),
    "comparisons": lambda x, u: (x.a > x.b, x.a < 0.5, x.b >= x.c, u.u <= u.v, x.a == 1.0, x.a != x.b),
    "bitwise": lambda x, u: ((x.a > 0) & (x.b > 0), (x.a > 0) | (x.c > 0), ~(x.b > 0), (x.a > 0) ^ (u.u > 0)),
    "bitwise_with_truth": lambda x, u: (True & (x.a > 0), (x.a > 0) | np.bool_(False)),
    "logical": lambda x, u: (
        np.logical_and(x.a, x.b > 0),
        np.logical_or(x.a > 9, x.b > 0),
        np.logical_not(x.a),
    ),
    "exclusive": lambda x, u: (np.logical_xor(x.a > 0, x.b), np.logical_xor(x.a > 0, x.b > 0)),
    "heaviside": lambda x, u: (np.heaviside(x.a, 0.5), np.heaviside(0.0 * x.a, 0.5)),
    "where": lambda x, u: (
        np.where(x.a > 0, x.b, x.c),
        where(x.a > 0, 1.0, x.c),
        where(x.a > x.b, -1.0, 1.0),
    ),
    "where_of_vectors": lambda x, u: where(x > 0, x, 0.0 * CENTER) + np.where(x > CENTER, 1.0, -1.0),
    "maximum": lambda x, u: (np.maximum(x.a, 0.1), np.minimum(0.1, x.b), np.maximum(x.b, x.c)),
    "clip": lambda x, u: (np.clip(x.a, -0.5, 0.5), np.clip(x.c, -0.5, x.a), np.clip(0.2, x.a, x.b)),
    "wrapped": lambda x, u: (wrap_angle(5.0 * x.a), np.sin(wrap_angle(x.b)), *wrap_angle(9.0 * (x - CENTER))),
    "vector": lambda x, u: (CENTER - x) * 2.0 / (1.0 + abs(x)),
    "vector_functions": lambda x, u: np.sin(x) + np.clip(x - CENTER, -1.0, 1.0) - np.maximum(x, 0.0),
    "matrix": lambda x, u: GAIN @ (x - CENTER) + GAIN @ x + np.dot(GAIN, x),
    "row_vectors": lambda x, u: (x @ GAIN.T, u @ GAIN)[1],
    "inner_products": lambda x, u: (x @ x, np.dot(x, CENTER), np.inner(x, x), (x - CENTER).dot(x - CENTER)),
    "sums": lambda x, u: (np.sum(x), (x - CENTER).sum(), np.mean(x), np.prod(x), np.sum(GAIN * x), x[:2] @ u),
    "sums_along": lambda x, u: np.sum(GAIN * x, axis=1),
    "extremes": lambda x, u: (np.max(np.abs(x)), np.min(x), (x - CENTER).max()),
    "all_and_any": lambda x, u: (np.all(x > -1), np.any(x > 0.5)),
    "norms": lambda x, u: (np.linalg.norm(x), np.linalg.norm(x[:2] - u), np.linalg.norm([x.a, u.v])),
    "cross": lambda x, u: np.cross(x, CENTER),
    "joined": lambda x, u: np.concatenate([x, u])[2:] + np.stack([x[:2], u])[1, 0] + np.hstack([x[:2], u.u]),
    "array_of_values": lambda x, u: np.sin(np.array([x.a, u.v])) * np.array([1.0, 2.0]),
    "asarray": lambda x, u: np.asarray(x)[1:] + np.asarray(u),
    "rotated": rotated,
    "unpacked": unpacked,
    "in_place": in_place,
    "dictionary": lambda x, u: {"first": x.a, "second": x.b * 1.0},
    "constants": lambda x, u: (1, np.float64(2.5), True, np.array(3.0), x.a, np.int32(4)),
    "one_number": lambda x, u: 7,
    "whole_vector": lambda x, u: x,
}


@pytest.mark.parametrize("function", AGREEING.values(), ids=AGREEING)
def test_a_traced_function_computes_what_numpy_computes(function):
    program = trace(function, ARGUMENTS)
    rows = stream(21).normal(0.0, 1.5, (50, 5))
    expected = np.array([numbers(function, row) for row in rows])
    # Two roundings or a few more lie between the two ways; tan has a pole, where 1 ulp of cos is seen enlarged.
    np.testing.assert_allclose(program(rows), expected, rtol=1e-14, atol=1e-15)


def test_the_function_runs_once():
    calls = []
    trace(lambda x: calls.append(1) or x.a, [("x", STATES)])
    assert len(calls) == 1


def test_inputs_are_the_names_in_order():
    program = trace(lambda x, u, t: x.a + u.v * t, [*ARGUMENTS, ("t", "t")], unread=("goal",))
    assert program.inputs == (*STATES, *CONTROLS, "t", "goal")
    assert program(np.array([[1.0, 0, 0, 0, 2.0, 10.0, 99.0]])).item() == 21.0


def test_attributes_may_differ_from_inputs():
    program = trace(lambda x, target: target.a - x.a, [("x", ("a",)), ("target", {"a": "a_target"})])
    assert program.inputs == ("a", "a_target")


def distance(x, u):
    return np.hypot(x.a, x.b)


@pytest.mark.parametrize(
    ("function", "given", "expected"),
    [
        (distance, None, ("distance",)),
        (rotated, None, ("rotated_0", "rotated_1")),
        (distance, ["d"], ("d",)),
        (lambda x, u: x.a, None, ("y",)),
        (lambda x, u: (x.a, x.b), None, ("y_0", "y_1")),
        (lambda x, u: {"left": x.a, "right": 1.0}, None, ("left", "right")),
        (functools.partial(distance), None, ("y",)),
    ],
)
def test_outputs_have_good_names(function, given, expected):
    assert trace(function, ARGUMENTS, given).names == expected


def test_integer_powers_are_multiplications():
    used = {row.name for row, _ in trace(lambda x, u: (x.a**-13, x.b**6), ARGUMENTS).instructions}
    assert used == {"div", "square", "cube", "mul"}


def test_maximum_with_a_constant_keeps_nan_as_numpy_does():
    program = trace(
        lambda x: (np.maximum(x.a, 0.0), np.minimum(1.0, x.a), np.clip(x.a, 0.0, 1.0)), [("x", ("a",))]
    )
    assert np.all(np.isnan(program(np.array([[np.nan]]))))


def test_comparisons_with_nan_are_those_of_numpy():
    def compared(x):
        return x.a < x.b, x.a <= x.b, x.a > x.b, x.a >= x.b, x.a == x.b, x.a != x.b, ~(x.a < x.b)

    rows = np.array([[np.nan, 1.0], [1.0, np.nan], [np.nan, np.nan], [-0.0, 0.0], [np.inf, np.inf]])
    a, b = rows.T
    expected = np.column_stack([a < b, a <= b, a > b, a >= b, a == b, a != b, ~(a < b)])
    assert np.array_equal(trace(compared, [("x", ("a", "b"))])(rows), expected)


def test_equal_values_are_computed_once():
    assert trace(lambda x, u: np.sin(x.a) * np.sin(x.a), ARGUMENTS).complexity == 2


class Callable:
    def __call__(self, x, u):
        return x.a - u.u


@pytest.mark.parametrize("function", [Callable(), functools.partial(distance), np.subtract])
def test_any_callable_can_be_traced(function):
    arguments = ARGUMENTS if function is not np.subtract else (("x", "a"), ("u", "u"))
    assert isinstance(trace(function, arguments), Program)


def test_where_and_wrap_angle_take_numbers_and_arrays():
    assert where(True, 1.0, 2.0) == 1.0
    assert np.array_equal(where(np.array([1.0, 0.0]), [5.0, 6.0], 7.0), [5.0, 7.0])
    assert wrap_angle(np.pi) == -np.pi
    angles = stream(22).uniform(-50.0, 50.0, (7, 3))
    # numpy's sine and arc tangent round the same angle twice
    np.testing.assert_allclose(wrap_angle(angles), np.arctan2(np.sin(angles), np.cos(angles)), atol=2e-14)
    traced = trace(lambda x: wrap_angle(x.a), [("x", ("a",))])
    assert np.array_equal(traced(angles[:, :1])[:, 0], wrap_angle(angles)[:, 0])


def with_if(x, u):
    if x.a > 0:
        return x.a
    return x.b


def helper_with_if(value):
    return 1.0 if value > 0 else 0.0


def calls_helper(x, u):
    return x.a + helper_with_if(x.b)


def floats_changed(x, u):
    total = np.zeros(3)
    total += x
    return total


UNTRACEABLE = {
    "if": (with_if, "gpsynth.where", 1),
    "if_in_helper": (calls_helper, "gpsynth.where", -3),
    "conditional": (lambda x, u: 1.0 if x.a else 0.0, "gpsynth.where", 0),
    "and": (lambda x, u: x.a > 0 and x.b > 0, "gpsynth.where", 0),
    "max": (lambda x, u: max(x.a, x.b), "np.maximum", 0),
    "math": (lambda x, u: math.sin(x.a), "math.sin cannot be traced; use numpy's sin", 0),
    "math_atan2": (lambda x, u: math.atan2(x.a, x.b), "use numpy's arctan2", 0),
    "float": (lambda x, u: float(x.a), "float", 0),
    "int": (lambda x, u: int(x.a), "int", 0),
    "round": (lambda x, u: round(x.a), "np.floor", 0),
    "range": (lambda x, u: sum(range(x.a)), "range", 0),
    "index": (lambda x, u: [1.0, 2.0][x.a], "index", 0),
    "complex": (lambda x, u: complex(x.a), "complex", 0),
    "unknown_name": (lambda x, u: x.speed, "x has no 'speed'; its names are a, b, c", 0),
    "unknown_index": (lambda x, u: x[3], "x has 3 values, a, b, c; no index 3", 0),
    "unknown_attribute": (lambda x, u: x.a.real, "real", 0),
    "function": (lambda x, u: np.sinh(x.a), "np.sinh cannot be traced.*tanh", 0),
    "array_function": (lambda x, u: np.argmax(x), "np.argmax cannot be traced", 0),
    "accumulate": (lambda x, u: np.add.accumulate(x), "add.accumulate", 0),
    "setting": (lambda x, u: np.add(x, 1.0, where=np.array([True, False, True])), "without where", 0),
    "one_armed_where": (lambda x, u: np.where(x.a > 0), "three arguments", 0),
    "power": (lambda x, u: x.a**0.3, "integers, 0.5", 0),
    "exponent": (lambda x, u: 2.0**x.a, "np.exp", 0),
    "remainder": (lambda x, u: x.a % 6.28, "wrap_angle", 0),
    "floor_division": (lambda x, u: x.a // 2.0, "np.floor", 0),
    "nan": (lambda x, u: x.a + np.nan, "nan is not a finite", 0),
    "infinity": (lambda x, u: np.minimum(x.a, np.inf), "inf is not a finite", 0),
    "large_integer": (lambda x, u: x.a + 10**400, "not a finite", 0),
    "nan_in_matrix": (lambda x, u: np.array([1.0, np.nan, 0.0]) @ x, "nan", 0),
    "text": (lambda x, u: x.a + "b", "expected a number, got 'b'", 0),
    "imaginary": (lambda x, u: x.a * 1j, "expected a number", 0),
    "bits_of_numbers": (lambda x, u: x.a & x.b, "comparisons only", 0),
    "float_array": (lambda x, u: np.array([x.a], dtype=float), "arrays of floats", 0),
    "in_place": (floats_changed, "x = x \\+ 1", 2),
    "users_error": (lambda x, u: {}["gain"], "KeyError: 'gain'", 0),
    "users_division": (lambda x, u: x.a / (1 // 0), "ZeroDivisionError", 0),
    "too_many_values": (lambda x, u: distance(*x), "TypeError.*positional", 0),
}


@pytest.mark.parametrize(("function", "message", "offset"), UNTRACEABLE.values(), ids=UNTRACEABLE)
def test_what_cannot_be_traced_is_named_with_file_and_line(function, message, offset):
    line = function.__code__.co_firstlineno + offset
    with pytest.raises(TracingError, match=rf"(?s)^{__file__}, line {line}: .*{message}") as caught:
        trace(function, ARGUMENTS)
    assert "\n" not in str(caught.value)
    assert caught.value.__cause__ is None


RESULTS = {
    "none": (lambda x, u: None, "expected a number, got None"),
    "text": (lambda x, u: "speed", "expected a number, got 'speed'"),
    "nothing": (lambda x, u: [], "returns no value"),
    "nan": (lambda x, u: (x.a, np.nan), "nan is not a finite"),
    "table": (lambda x, u: (x - CENTER)[:, None], "expected a number"),
    "names": (lambda x, u: {"two words": x.a}, "'two words' is not a name"),
}


@pytest.mark.parametrize(("function", "message"), RESULTS.values(), ids=RESULTS)
def test_a_result_that_is_no_number_is_an_error(function, message):
    with pytest.raises(
        TracingError, match=rf"test_tracing.py, line {function.__code__.co_firstlineno}.*{message}"
    ):
        trace(function, ARGUMENTS)


def test_another_number_of_values_than_names_is_an_error():
    with pytest.raises(
        TracingError, match=r"rotated \(.*test_tracing.py, line \d+\) returns 2 values; expected 3: p, q, r"
    ):
        trace(rotated, ARGUMENTS, ["p", "q", "r"])


def test_a_dictionary_is_read_by_the_names_wanted():
    program = trace(lambda x, u: {"right": x.b, "left": x.a}, ARGUMENTS, ["left", "right"])
    assert program == trace(lambda x, u: (x.a, x.b), ARGUMENTS, ["left", "right"])
    with pytest.raises(TracingError, match="returns right, up; expected left, right"):
        trace(lambda x, u: {"right": x.b, "up": x.a}, ARGUMENTS, ["left", "right"])
    with pytest.raises(TracingError, match="returns no value; expected left"):
        trace(lambda x, u: {}, ARGUMENTS, ["left"])


@pytest.mark.parametrize("function", [lambda x: x.a, lambda x, u, more: x.a])
def test_another_number_of_arguments_is_an_error(function):
    with pytest.raises(TracingError, match="must take 2 arguments: x, u"):
        trace(function, ARGUMENTS)


def test_a_value_kept_from_another_run_is_an_error():
    kept = []
    trace(lambda x, u: kept.append(x.a) or x.a, ARGUMENTS)
    with pytest.raises(TracingError, match="another function's run"):
        trace(lambda x, u: x.b + kept[0], ARGUMENTS)


def test_a_program_inlined_is_what_it_computes():
    inner = trace(lambda p: (np.sin(p.a) + 2.0 * p.b, p.a * p.b), [("p", ("a", "b"))], ["sum", "product"])
    outer = trace(lambda x, u: [value + x.a for value in inline(inner, [x.b, 3.0])], ARGUMENTS, ["y", "z"])
    rows = stream(5).normal(size=(20, len(outer.inputs)))
    a, b = rows[:, outer.inputs.index("a")], rows[:, outer.inputs.index("b")]
    expected = inner(np.column_stack([b, np.full(20, 3.0)])) + a[:, None]
    np.testing.assert_array_equal(outer(rows), expected)


def test_inlining_without_a_traced_value_is_an_error():
    inner = trace(lambda p: p.a, [("p", ("a",))])
    with pytest.raises(TracingError, match=r"inline takes traced values; got \[1.0\]"):
        inline(inner, [1.0])
