"""Derivatives of an expression by all its numbers at once: reverse mode over a block of rows.

One pass forward keeps every value, one pass backward gives each position the derivative of the root by it; the cost is
about three evaluations for any number of constants (Griewank and Walther 2008, chapter 3).
"""

from typing import Any

from numba import types

from gpsynth.kernels import trigonometry
from gpsynth.kernels.arithmetic import sgn
from gpsynth.kernels.compile import CODE, MATRIX, OUT_MATRIX, kernel, widest_vectors
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


@kernel(types.void(CODE, types.int64, types.int64, MATRIX, OUT_MATRIX, types.int64))
def backward(code: Any, first: int, last: int, v: Any, g: Any, lanes: int) -> None:
    """Rows of g: derivative of the value at position last - 1 by each position; v holds the values."""
    widest_vectors()
    for t in range(first, last):
        for lane in range(lanes):
            g[t, lane] = 1.0 if t == last - 1 else 0.0
    for t in range(last - 1, first - 1, -1):
        op, a, b = code[t, 0], code[t, 2], code[t, 3]
        if op == ADD:
            for lane in range(lanes):
                g[a, lane] += g[t, lane]
            for lane in range(lanes):
                g[b, lane] += g[t, lane]
        elif op == SUB:
            for lane in range(lanes):
                g[a, lane] += g[t, lane]
            for lane in range(lanes):
                g[b, lane] -= g[t, lane]
        elif op == MUL:
            for lane in range(lanes):
                g[a, lane] += g[t, lane] * v[b, lane]
            for lane in range(lanes):
                g[b, lane] += g[t, lane] * v[a, lane]
        elif op == DIV:
            for lane in range(lanes):
                g[a, lane] += g[t, lane] / v[b, lane]
            for lane in range(lanes):
                g[b, lane] -= g[t, lane] * v[t, lane] / v[b, lane]
        elif op == NEG:
            for lane in range(lanes):
                g[a, lane] -= g[t, lane]
        elif op == ABS:
            for lane in range(lanes):
                g[a, lane] += g[t, lane] * sgn(v[a, lane])
        elif op == HALF:
            for lane in range(lanes):
                g[a, lane] += g[t, lane] * 0.5
        elif op == DOUBLE:
            for lane in range(lanes):
                g[a, lane] += g[t, lane] * 2.0
        elif op == SQUARE:
            for lane in range(lanes):
                g[a, lane] += g[t, lane] * (2.0 * v[a, lane])
        elif op == CUBE:
            for lane in range(lanes):
                g[a, lane] += g[t, lane] * (3.0 * v[a, lane] * v[a, lane])
        elif op == SQRT:
            for lane in range(lanes):
                g[a, lane] += g[t, lane] * (0.5 / v[t, lane])
        elif op == SIN:
            for lane in range(lanes):
                g[a, lane] += g[t, lane] * trigonometry.cos(v[a, lane])
        elif op == COS:
            for lane in range(lanes):
                g[a, lane] -= g[t, lane] * trigonometry.sin(v[a, lane])
        elif op == ATAN:
            for lane in range(lanes):
                g[a, lane] += g[t, lane] / (1.0 + v[a, lane] * v[a, lane])
        elif op == EXP:
            for lane in range(lanes):
                g[a, lane] += g[t, lane] * v[t, lane]
        elif op == LOG:
            for lane in range(lanes):
                g[a, lane] += g[t, lane] / v[a, lane]
        elif op == TANH:
            for lane in range(lanes):
                g[a, lane] += g[t, lane] * (1.0 - v[t, lane] * v[t, lane])
        elif op == MAX:
            for lane in range(lanes):
                g[a, lane] += g[t, lane] if v[a, lane] >= v[b, lane] else 0.0
            for lane in range(lanes):
                g[b, lane] += 0.0 if v[a, lane] >= v[b, lane] else g[t, lane]
        elif op == MIN:
            for lane in range(lanes):
                g[a, lane] += g[t, lane] if v[a, lane] < v[b, lane] else 0.0
            for lane in range(lanes):
                g[b, lane] += 0.0 if v[a, lane] < v[b, lane] else g[t, lane]
