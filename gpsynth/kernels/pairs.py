"""Two instructions in one: the value of the first goes to the second in registers, without a row between them.

The number of a pair is JOINED + FIRST_NUMBERS * second + first, `first` being a row of the table and `second` one of
the numbers below: what is done with the value, and with one more row where there is a second operand. Each of both is
rounded by itself, so a pair gives the bits that its two instructions give.
"""

from typing import Any

import numpy as np

from gpsynth.arrays import frozen
from gpsynth.kernels.carried import on_vectors
from gpsynth.kernels.compile import part
from gpsynth.kernels.elementary import function_of
from gpsynth.kernels.vectors import WIDTH, put, take
from gpsynth.operations import CODES, OPERATIONS

JOINED, FIRST_NUMBERS = 1 << 16, 1 << 8
ADD, SUB, FROM, MUL, MAX, MAX_OF, MIN, MIN_OF, SQUARE, ABS, NEG = range(
    11
)  # FROM, _OF: the value comes second
_NEVER = -1

_SECONDS = {
    **{"add": (ADD, ADD), "sub": (SUB, FROM), "mul": (MUL, MUL), "max": (MAX, MAX_OF), "min": (MIN, MIN_OF)},
    **{"square": (SQUARE, _NEVER), "abs": (ABS, _NEVER), "neg": (NEG, _NEVER)},
}
_FIRSTS = (
    "add",
    "sub",
    "mul",
    "div",
    "div_protected",
    "max",
    "min",
    "square",
    "abs",
    "neg",
    "sin",
    "cos",
    "tanh",
)

SECONDS = frozen(np.array([_SECONDS.get(row.name, (_NEVER, _NEVER)) for row in OPERATIONS], dtype=np.int32))
FIRSTS = frozen(np.array([row.name in _FIRSTS for row in OPERATIONS]))

_add, _sub, _mul, _div, _div_protected, _max, _min, _square, _abs, _neg, _sin, _cos, _tanh = (
    on_vectors(function_of(name)) for name in _FIRSTS
)
_ADD, _SUB, _MUL, _DIV, _DIV_PROTECTED, _MAX, _MIN, _SQUARE, _ABS, _NEG, _SIN, _COS, _TANH = (
    CODES[name] for name in _FIRSTS
)


@part
def _then(second: int, value: Any, w: Any, row: int, lane: int) -> Any:  # noqa: PLR0911 a table
    """What the second instruction makes of the value and of a row."""
    if second == ADD:
        return _add(value, take(w, row, lane))
    if second == SUB:
        return _sub(value, take(w, row, lane))
    if second == FROM:
        return _sub(take(w, row, lane), value)
    if second == MUL:
        return _mul(value, take(w, row, lane))
    if second == MAX:
        return _max(value, take(w, row, lane))
    if second == MAX_OF:
        return _max(take(w, row, lane), value)
    if second == MIN:
        return _min(value, take(w, row, lane))
    if second == MIN_OF:
        return _min(take(w, row, lane), value)
    if second == SQUARE:
        return _square(value)
    if second == ABS:
        return _abs(value)
    return _neg(value)


@part
def _pair1(function: Any, second: int, w: Any, lanes: int, d: int, a: int, b: int) -> None:
    """Row d = second(function(row a), row b)."""
    for at in range(0, lanes, WIDTH):
        put(w, d, at, _then(second, function(take(w, a, at)), w, b, at))


@part
def _pair2(function: Any, second: int, w: Any, lanes: int, d: int, a: int, b: int, c: int) -> None:
    """Row d = second(function(row a, row b), row c)."""
    for at in range(0, lanes, WIDTH):
        put(w, d, at, _then(second, function(take(w, a, at), take(w, b, at)), w, c, at))


@part
def pair(number: int, w: Any, lanes: int, d: int, a: int, b: int, c: int) -> None:
    """Carry out the pair of this number."""
    first, second = number & (FIRST_NUMBERS - 1), (number - JOINED) >> 8
    if first == _ADD:
        _pair2(_add, second, w, lanes, d, a, b, c)
    elif first == _SUB:
        _pair2(_sub, second, w, lanes, d, a, b, c)
    elif first == _MUL:
        _pair2(_mul, second, w, lanes, d, a, b, c)
    elif first == _DIV:
        _pair2(_div, second, w, lanes, d, a, b, c)
    elif first == _DIV_PROTECTED:
        _pair2(_div_protected, second, w, lanes, d, a, b, c)
    elif first == _MAX:
        _pair2(_max, second, w, lanes, d, a, b, c)
    elif first == _MIN:
        _pair2(_min, second, w, lanes, d, a, b, c)
    elif first == _SQUARE:
        _pair1(_square, second, w, lanes, d, a, b)
    elif first == _ABS:
        _pair1(_abs, second, w, lanes, d, a, b)
    elif first == _NEG:
        _pair1(_neg, second, w, lanes, d, a, b)
    elif first == _SIN:
        _pair1(_sin, second, w, lanes, d, a, b)
    elif first == _COS:
        _pair1(_cos, second, w, lanes, d, a, b)
    elif first == _TANH:
        _pair1(_tanh, second, w, lanes, d, a, b)
