"""The data machine: one instruction for a block of rows, then the next; the whole population, then the next block.

Each branch is a plain loop over the rows of a block, which LLVM turns into vector instructions. A destination is never
one of its sources, so those loops vectorize without a copy.
"""

from typing import Any

import numpy as np
from numba import types

from gpsynth.kernels import arithmetic, exponentials, trigonometry
from gpsynth.kernels.compile import CODE, MATRIX, OUT_MATRIX, VECTOR, kernel, widest_vectors
from gpsynth.kernels.data_code import (
    ABS,
    ADD,
    ADD_NUMBER,
    ATAN,
    COS,
    CUBE,
    DIV,
    DIV_NUMBER,
    DOUBLE,
    EMIT,
    EXP,
    FILL,
    HALF,
    LOG,
    MAX,
    MIN,
    MUL,
    MUL_NUMBER,
    NEG,
    NUMBER_DIV,
    NUMBER_SUB,
    SCORE,
    SIN,
    SQRT,
    SQUARE,
    SUB,
    SUB_NUMBER,
    TANH,
)

BLOCK = 256  # rows; a row of the workspace is 2 KiB, the dozen rows in use stay in the first-level cache
WIDTH = 8  # data are padded to a multiple of it


@kernel(types.void(CODE, VECTOR, types.int64, types.int64, OUT_MATRIX, types.int64, types.int64, OUT_MATRIX))
def execute(code: Any, numbers: Any, first: int, last: int, w: Any, lanes: int, begin: int, out: Any) -> None:
    """Run instructions [first, last) of code (c, 4) = operation, destination, operands, on columns of `w`.

    EMIT copies a row to row d of `out`. SCORE adds up, for a row of values minus their first, which it keeps, the
    weighted values, squares and products with row b; row b + 1 holds the weights.
    """
    widest_vectors()
    for index in range(first, last):
        operation, d, a, b = code[index, 0], code[index, 1], code[index, 2], code[index, 3]
        number = numbers[index]
        if operation == ADD:
            for lane in range(lanes):
                w[d, lane] = w[a, lane] + w[b, lane]
        elif operation == SUB:
            for lane in range(lanes):
                w[d, lane] = w[a, lane] - w[b, lane]
        elif operation == MUL:
            for lane in range(lanes):
                w[d, lane] = w[a, lane] * w[b, lane]
        elif operation == DIV:
            for lane in range(lanes):
                w[d, lane] = w[a, lane] / w[b, lane]
        elif operation == ADD_NUMBER:
            for lane in range(lanes):
                w[d, lane] = w[a, lane] + number
        elif operation == SUB_NUMBER:
            for lane in range(lanes):
                w[d, lane] = w[a, lane] - number
        elif operation == NUMBER_SUB:
            for lane in range(lanes):
                w[d, lane] = number - w[a, lane]
        elif operation == MUL_NUMBER:
            for lane in range(lanes):
                w[d, lane] = w[a, lane] * number
        elif operation == DIV_NUMBER:
            for lane in range(lanes):
                w[d, lane] = w[a, lane] / number
        elif operation == NUMBER_DIV:
            for lane in range(lanes):
                w[d, lane] = number / w[a, lane]
        elif operation == FILL:
            for lane in range(lanes):
                w[d, lane] = number
        elif operation == EMIT:
            for lane in range(lanes):
                out[d, begin + lane] = w[a, lane]
        elif operation == SCORE:
            if begin == 0:
                out[d, 3 * WIDTH] = w[a, 0]
            shift = out[d, 3 * WIDTH]
            for lane in range(0, lanes, WIDTH):
                for k in range(WIDTH):
                    value = w[a, lane + k] - shift
                    weighted = value * w[b + 1, lane + k]
                    out[d, k] += weighted
                    out[d, WIDTH + k] += weighted * value
                    out[d, 2 * WIDTH + k] += weighted * w[b, lane + k]
        elif operation == NEG:
            for lane in range(lanes):
                w[d, lane] = -w[a, lane]
        elif operation == ABS:
            for lane in range(lanes):
                w[d, lane] = abs(w[a, lane])
        elif operation == HALF:
            for lane in range(lanes):
                w[d, lane] = arithmetic.half(w[a, lane])
        elif operation == DOUBLE:
            for lane in range(lanes):
                w[d, lane] = arithmetic.double(w[a, lane])
        elif operation == SQUARE:
            for lane in range(lanes):
                w[d, lane] = arithmetic.square(w[a, lane])
        elif operation == CUBE:
            for lane in range(lanes):
                w[d, lane] = arithmetic.cube(w[a, lane])
        elif operation == SQRT:
            for lane in range(lanes):
                w[d, lane] = arithmetic.sqrt(w[a, lane])
        elif operation == SIN:
            for lane in range(lanes):
                w[d, lane] = trigonometry.sin(w[a, lane])
        elif operation == COS:
            for lane in range(lanes):
                w[d, lane] = trigonometry.cos(w[a, lane])
        elif operation == ATAN:
            for lane in range(lanes):
                w[d, lane] = trigonometry.atan(w[a, lane])
        elif operation == EXP:
            for lane in range(lanes):
                w[d, lane] = exponentials.exp(w[a, lane])
        elif operation == LOG:
            for lane in range(lanes):
                w[d, lane] = exponentials.log(w[a, lane])
        elif operation == TANH:
            for lane in range(lanes):
                w[d, lane] = exponentials.tanh(w[a, lane])
        elif operation == MAX:
            for lane in range(lanes):
                w[d, lane] = arithmetic.max_(w[a, lane], w[b, lane])
        elif operation == MIN:
            for lane in range(lanes):
                w[d, lane] = arithmetic.min_(w[a, lane], w[b, lane])


@kernel(types.void(CODE, VECTOR, MATRIX, types.int64, types.int64, OUT_MATRIX))
def run(code: Any, numbers: Any, columns: Any, rows: int, block: int, out: Any) -> None:
    """Outputs (u, N) of columns (m, N), N a multiple of WIDTH, in a workspace of `rows` rows; a block at a time."""
    w = np.zeros((rows, block))
    for begin in range(0, columns.shape[1], block):
        lanes = min(block, columns.shape[1] - begin)
        for j in range(len(columns)):
            for lane in range(lanes):
                w[j, lane] = columns[j, begin + lane]
        execute(code, numbers, 0, len(code), w, lanes, begin, out)
