"""Interval arithmetic on programs (Moore, Kearfott & Cloud 2009): what every output can be for inputs in a box.

Rows are independent, and every result is widened by as much as rounding may have cost it. Of an operation that is not
in the table, of a root or logarithm of what may be negative and of a quotient by what may be 0 nothing is known; such
a value may be NaN too, and so may what is computed from it.
"""

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from gpsynth.arrays import Floats
from gpsynth.operations import Operation
from gpsynth.program import Leaf, Program

WIDER = 16.0 * 2.0**-53  # share of its size that a bound is widened by; elementary functions are within 2 ulp
TINY = 1e-300
FARTHEST = 1e8  # rad; beyond it a sine is NaN


class Interval(NamedTuple):
    """Bounds (N,) of a value; both infinite where nothing is known."""

    low: Floats
    high: Floats


def enclose(
    program: Program, low: Floats, high: Floats, parameters: Floats | None = None
) -> tuple[Floats, Floats]:
    """Bounds (N, m) of the outputs for inputs between `low` and `high` (N, n) and parameters (p,)."""
    count = len(low)
    given = np.empty(0) if parameters is None else parameters

    def leaf(item: Leaf) -> Interval:
        if item.kind == "input":
            return Interval(low[:, item.index], high[:, item.index])
        value = np.full(count, item.value if item.kind == "constant" else given[item.index])
        return Interval(value, value)

    outputs = program.fold(leaf, _node)
    return np.column_stack([each.low for each in outputs]), np.column_stack([each.high for each in outputs])


def _node(operation: Operation, operands: tuple[Interval, ...]) -> Interval:
    rule = RULES.get(operation.name)
    unknown = [np.isinf(each.low) & np.isinf(each.high) for each in operands]
    if operation.name == "limit":  # which makes a number of NaN
        unknown = unknown[1:]
    if operation.name == "mul" and operands[0] is operands[1]:
        rule = RULES["square"]
    lost = np.any(unknown, axis=0)
    if rule is None:
        lost = np.ones_like(lost)
        low, high = operands[0]
    else:
        low, high = rule(*operands)
    wrong = lost | np.isnan(low) | np.isnan(high)
    low = low - WIDER * np.abs(low) - TINY
    high = high + WIDER * np.abs(high) + TINY
    return Interval(np.where(wrong, -np.inf, low), np.where(wrong, np.inf, high))


def _rising(function: Callable[[Floats], Floats]) -> Callable[[Interval], Interval]:
    """The rule of a function that nowhere falls; NaN where it is not defined."""
    return lambda a: Interval(function(a.low), function(a.high))


def _hull(*values: Floats) -> Interval:
    return Interval(np.minimum.reduce(values), np.maximum.reduce(values))


def _add(a: Interval, b: Interval) -> Interval:
    return Interval(a.low + b.low, a.high + b.high)


def _sub(a: Interval, b: Interval) -> Interval:
    return Interval(a.low - b.high, a.high - b.low)


def _mul(a: Interval, b: Interval) -> Interval:
    return _hull(a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high)


def _div(a: Interval, b: Interval) -> Interval:
    free = (b.low > TINY) | (b.high < -TINY)
    inverse = Interval(np.where(free, 1.0 / b.high, np.nan), np.where(free, 1.0 / b.low, np.nan))
    return _mul(a, inverse)


def _abs(a: Interval) -> Interval:
    around = (a.low <= 0.0) & (a.high >= 0.0)
    ends = _hull(np.abs(a.low), np.abs(a.high))
    return Interval(np.where(around, 0.0, ends.low), ends.high)


def _square(a: Interval) -> Interval:
    size = _abs(a)
    return Interval(size.low * size.low, size.high * size.high)


def _cos(a: Interval) -> Interval:
    """1 where a multiple of 2 pi is inside, -1 where an odd one of pi is; in doubt it is."""
    doubt = 1e-15 * (1.0 + np.abs(a.low) + np.abs(a.high))
    low, high = (a.low - doubt) / np.pi, (a.high + doubt) / np.pi
    ends = _hull(np.cos(a.low), np.cos(a.high))
    has_top = np.floor(0.5 * high) >= np.ceil(0.5 * low)
    has_bottom = np.floor(0.5 * (high - 1.0)) >= np.ceil(0.5 * (low - 1.0))
    far = (np.abs(a.low) > FARTHEST) | (np.abs(a.high) > FARTHEST)
    bottom, top = np.where(has_bottom, -1.0, ends.low - WIDER), np.where(has_top, 1.0, ends.high + WIDER)
    return Interval(np.where(far, np.nan, bottom), np.where(far, np.nan, top))


def _sin(a: Interval) -> Interval:
    """The cosine a quarter turn earlier."""
    doubt = WIDER * (1.0 + np.maximum(np.abs(a.low), np.abs(a.high)))
    return _cos(Interval(a.low - 0.5 * np.pi - doubt, a.high - 0.5 * np.pi + doubt))


def _tan(a: Interval) -> Interval:
    cosine = _cos(a)
    free = ((cosine.low > WIDER) | (cosine.high < -WIDER)) & (a.high - a.low < np.pi)
    return Interval(np.where(free, np.tan(a.low), np.nan), np.where(free, np.tan(a.high), np.nan))


def _max(a: Interval, b: Interval) -> Interval:
    return Interval(np.maximum(a.low, b.low), np.maximum(a.high, b.high))


def _min(a: Interval, b: Interval) -> Interval:
    return Interval(np.minimum(a.low, b.low), np.minimum(a.high, b.high))


def _limit(a: Interval, b: Interval, c: Interval) -> Interval:
    return Interval(
        np.minimum(np.maximum(a.low, b.low), c.low), np.minimum(np.maximum(a.high, b.high), c.high)
    )


def _hypot(a: Interval, b: Interval) -> Interval:
    a, b = _abs(a), _abs(b)
    return Interval(np.hypot(a.low, b.low), np.hypot(a.high, b.high))


def _compared(a: Interval, b: Interval) -> Interval:
    return Interval(np.zeros_like(a.low), np.ones_like(b.low))


def _where(a: Interval, b: Interval, c: Interval) -> Interval:
    holds, fails = (a.low > 0.0) | (a.high < 0.0), (a.low == 0.0) & (a.high == 0.0)
    both = _hull(b.low, b.high, c.low, c.high)
    low = np.where(holds, b.low, np.where(fails, c.low, both.low))
    return Interval(low, np.where(holds, b.high, np.where(fails, c.high, both.high)))


RULES: Mapping[str, Callable[..., Interval]] = MappingProxyType(
    {
        "add": _add,
        "sub": _sub,
        "mul": _mul,
        "div": _div,
        "neg": lambda a: Interval(-a.high, -a.low),
        "abs": _abs,
        "half": _rising(lambda x: 0.5 * x),
        "double": _rising(lambda x: 2.0 * x),
        "identity": _rising(lambda x: x),
        "square": _square,
        "cube": _rising(lambda x: x * x * x),
        "sqrt": _rising(np.sqrt),
        "sin": _sin,
        "cos": _cos,
        "tan": _tan,
        "atan": _rising(np.arctan),
        "exp": _rising(np.exp),
        "log": _rising(lambda x: np.log(np.where(x > 0.0, x, np.nan))),
        "tanh": _rising(np.tanh),
        "cbrt": _rising(np.cbrt),
        "hypot": _hypot,
        "max": _max,
        "min": _min,
        "lt": _compared,
        "le": _compared,
        "limit": _limit,
        "where": _where,
    }
)
