"""What numpy's functions mean in operations of the table, as functions of traced values."""

import math
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Protocol, TypeVar

import numpy as np

from gpsynth.errors import TracingError


class Value(Protocol):
    """What these functions need of a traced value."""

    is_truth: bool  # a comparison, the number 1 or 0

    @property
    def number(self) -> float | None:
        """The number, if the value is a constant."""

    def lifted(self: "V", number: float) -> "V":
        """A constant beside this value."""

    def apply(self: "V", name: str, *others: "V") -> "V":
        """An operation of the table, this value being its first operand."""

    def as_truth(self: "V") -> "V":
        """The same value, known to be 1 or 0."""


V = TypeVar("V", bound=Value)


def _operation(name: str) -> Callable[..., Value]:
    return lambda first, *others: first.apply(name, *others)


def _scaled(factor: float) -> Callable[[Value], Value]:
    return lambda a: a.apply("mul", a.lifted(factor))


def _power(base: Value, exponent: Value) -> Value:
    number = exponent.number
    if number is None:
        raise TracingError(
            "a power with a traced exponent cannot be traced; use np.exp(exponent * np.log(base))"
        )
    if number == 0.5:
        return base.apply("sqrt")
    if not number.is_integer():
        raise TracingError(
            f"the power {number} cannot be traced; possible are integers, 0.5, np.cbrt and "
            "np.exp(exponent * np.log(base))"
        )
    power = _integer_power(base, abs(int(number)))
    return base.lifted(1.0).apply("div", power) if number < 0 else power


def _integer_power(base: Value, exponent: int) -> Value:
    if exponent <= 1:
        return base if exponent == 1 else base.lifted(1.0)
    if exponent <= 3:
        return base.apply("square" if exponent == 2 else "cube")
    power = _integer_power(base, exponent // 2).apply("square")
    return power.apply("mul", base) if exponent % 2 else power


def _maximum(a: Value, b: Value) -> Value:
    # A constant stands first, because the table's max and min keep the NaN of their second operand only.
    return a.apply("max", b) if b.number is None else b.apply("max", a)


def _minimum(a: Value, b: Value) -> Value:
    return a.apply("min", b) if b.number is None else b.apply("min", a)


def _truth(a: Value) -> Value:
    return a if a.is_truth else a.apply("not").apply("not")


def _and(a: Value, b: Value) -> Value:
    return _truth(a).apply("min", _truth(b)).as_truth()


def _or(a: Value, b: Value) -> Value:
    return _truth(a).apply("max", _truth(b)).as_truth()


def _unequal(a: Value, b: Value) -> Value:
    return a.apply("eq", b).apply("not")


def _heaviside(a: Value, at_zero: Value) -> Value:
    zero = a.lifted(0.0)
    return a.apply("eq", zero).apply("where", at_zero, zero.apply("lt", a))


def _of_comparisons(function: Callable[..., Value]) -> Callable[..., Value]:
    """A bitwise operator, which takes other values no more than it takes floats."""

    def checked(*operands: Value) -> Value:
        if not all(operand.is_truth for operand in operands):
            raise TracingError("& | ^ ~ work on comparisons only; write (x > 0) & (y > 0)")
        return function(*operands)

    return checked


# Functions whose operation has another name, or the same.
_RENAMED = MappingProxyType(
    {
        **{"add": "add", "subtract": "sub", "multiply": "mul", "divide": "div", "negative": "neg"},
        **{"absolute": "abs", "fabs": "abs", "less": "lt", "less_equal": "le", "equal": "eq"},
        **{"arcsin": "asin", "arccos": "acos", "arctan": "atan", "arctan2": "atan2", "wrap_angle": "wrap"},
    }
)
_SAME = (
    *("square", "sqrt", "cbrt", "hypot", "sin", "cos", "tan", "exp", "log", "tanh"),
    *("floor", "sign", "where"),
)

FUNCTIONS: Mapping[str, Callable[..., Value]] = MappingProxyType(
    {
        **{name: _operation(operation) for name, operation in _RENAMED.items()},
        **{name: _operation(name) for name in _SAME},
        "positive": lambda a: a,
        "reciprocal": lambda a: a.lifted(1.0).apply("div", a),
        "ceil": lambda a: a.apply("neg").apply("floor").apply("neg"),
        **dict.fromkeys(("power", "float_power"), _power),
        **dict.fromkeys(("deg2rad", "radians"), _scaled(math.pi / 180.0)),
        **dict.fromkeys(("rad2deg", "degrees"), _scaled(180.0 / math.pi)),
        "maximum": _maximum,
        "minimum": _minimum,
        "clip": lambda a, low, high: _minimum(_maximum(a, low), high),
        "greater": lambda a, b: b.apply("lt", a),
        "greater_equal": lambda a, b: b.apply("le", a),
        "not_equal": _unequal,
        "heaviside": _heaviside,
        "logical_and": _and,
        "logical_or": _or,
        "logical_xor": lambda a, b: _unequal(_truth(a), _truth(b)),
        "logical_not": lambda a: a.apply("not"),
        "bitwise_and": _of_comparisons(_and),
        "bitwise_or": _of_comparisons(_or),
        "bitwise_xor": _of_comparisons(_unequal),
        "invert": _of_comparisons(lambda a: a.apply("not")),
    }
)
REDUCTIONS: Mapping[str, np.ufunc] = MappingProxyType(
    {
        **{"sum": np.add, "prod": np.multiply, "all": np.logical_and, "any": np.logical_or},
        **dict.fromkeys(("max", "amax"), np.maximum),
        **dict.fromkeys(("min", "amin"), np.minimum),
    }
)
# Functions of arrays that numpy itself carries out by adding, multiplying and moving what the arrays hold.
REARRANGEMENTS = frozenset(
    {
        *("dot", "inner", "outer", "cross", "norm", "mean", "diff"),
        *("concatenate", "stack", "hstack", "vstack", "append"),
        *("reshape", "ravel", "transpose", "atleast_1d"),
    }
)
_UNNAMED = frozenset(  # operators and second spellings
    {
        *("add", "subtract", "multiply", "divide", "negative", "positive", "power", "float_power"),
        *("less", "less_equal", "equal", "not_equal", "greater", "greater_equal"),
        *("bitwise_and", "bitwise_or", "bitwise_xor", "invert"),
        *("amax", "amin", "degrees", "radians", "wrap_angle"),
    }
)


def unsupported(name: str) -> TracingError:
    """The sentence about a function of numpy that has no meaning here."""
    if name in {"remainder", "fmod", "divmod"}:
        return TracingError(
            "% cannot be traced; use gpsynth.wrap_angle for angles, else a - b * np.floor(a / b)"
        )
    if name == "floor_divide":
        return TracingError("// cannot be traced; use np.floor(a / b)")
    possible = sorted({*FUNCTIONS, *REDUCTIONS, *REARRANGEMENTS} - _UNNAMED)
    return TracingError(f"np.{name} cannot be traced; possible are operators and np. {', '.join(possible)}")
