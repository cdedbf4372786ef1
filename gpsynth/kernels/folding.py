"""An operation on numbers alone, with the bits that the data machine gives for columns of them."""

from typing import Any

from numba import types

from gpsynth.kernels import arithmetic, exponentials, trigonometry
from gpsynth.kernels.compile import kernel
from gpsynth.kernels.data_code import (
    ABS,
    ADD,
    ATAN,
    COS,
    CUBE,
    DIV,
    DOUBLE,
    EXP,
    HALF,
    LOG,
    MAX,
    MIN,
    MUL,
    NEG,
    SIN,
    SQRT,
    SQUARE,
    SUB,
    TANH,
)


@kernel(types.float64(types.int64, types.float64, types.float64))
def folded(op: int, x: float, y: float) -> Any:
    """The value of an operation of `data_code.NAMES`; one of one operand does not see y."""
    value = 0.0
    if op == ADD:
        value = x + y
    elif op == SUB:
        value = x - y
    elif op == MUL:
        value = x * y
    elif op == DIV:
        value = x / y
    elif op == NEG:
        value = -x
    elif op == ABS:
        value = abs(x)
    elif op == HALF:
        value = arithmetic.half(x)
    elif op == DOUBLE:
        value = arithmetic.double(x)
    elif op == SQUARE:
        value = arithmetic.square(x)
    elif op == CUBE:
        value = arithmetic.cube(x)
    elif op == SQRT:
        value = arithmetic.sqrt(x)
    elif op == SIN:
        value = trigonometry.sin(x)
    elif op == COS:
        value = trigonometry.cos(x)
    elif op == ATAN:
        value = trigonometry.atan(x)
    elif op == EXP:
        value = exponentials.exp(x)
    elif op == LOG:
        value = exponentials.log(x)
    elif op == TANH:
        value = exponentials.tanh(x)
    elif op == MAX:
        value = arithmetic.max_(x, y)
    elif op == MIN:
        value = arithmetic.min_(x, y)
    return value
