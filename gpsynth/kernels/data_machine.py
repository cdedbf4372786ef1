"""The data machine: one instruction for a block of rows, then the next; the whole population, then the next block.

Each branch is a loop over vectors of WIDTH rows (`vectors.py`), as in the lane machine, so data have a multiple of
WIDTH rows.
"""

from typing import Any

import numpy as np
from numba import types

from gpsynth.kernels.compile import CODE, MATRIX, OUT_MATRIX, VECTOR, kernel, part, widest_vectors
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
    FROM,
    HALF,
    JOINED,
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
from gpsynth.kernels.machine import (
    abs_,
    add,
    atan,
    cos,
    cube,
    div,
    double,
    each1,
    each2,
    exp,
    half,
    log,
    max_,
    min_,
    mul,
    neg,
    sin,
    sqrt,
    square,
    sub,
    tanh,
)
from gpsynth.kernels.vectors import WIDTH, aligned, put, put_away, take

BLOCK = 256  # rows; shorter blocks lose more to the choice of a branch than the caches give back


@part
def each_left(function: Any, w: Any, lanes: int, d: int, a: int, number: float) -> None:
    """Row d = function(row a, number)."""
    for at in range(0, lanes, WIDTH):
        put(w, d, at, function(take(w, a, at), number))


@part
def each_right(function: Any, w: Any, lanes: int, d: int, number: float, a: int) -> None:
    """Row d = function(number, row a)."""
    for at in range(0, lanes, WIDTH):
        put(w, d, at, function(number, take(w, a, at)))


@part
def joined(first: Any, second: Any, w: Any, lanes: int, d: int, a: int, b: int, c: int) -> None:
    """Row d = second(first(row a, row b), row c)."""
    for at in range(0, lanes, WIDTH):
        put(w, d, at, second(first(take(w, a, at), take(w, b, at)), take(w, c, at)))


@part
def take_from(a: Any, b: Any) -> Any:
    """b - a."""
    return b - a


@part
def add_up(w: Any, lanes: int, a: int, target: int, out: Any, d: int) -> None:
    """Add to row d of `out` the weighted sums of row a minus the number behind them: values, squares, products."""
    shift = out[d, 3 * WIDTH]
    values, squares, products = take(out, d, 0), take(out, d, WIDTH), take(out, d, 2 * WIDTH)
    for at in range(0, lanes, WIDTH):
        value = take(w, a, at) - shift
        weighted = value * take(w, target + 1, at)
        values = values + weighted
        squares = squares + weighted * value
        products = products + weighted * take(w, target, at)
    put(out, d, 0, values)
    put(out, d, WIDTH, squares)
    put(out, d, 2 * WIDTH, products)


@kernel(types.void(CODE, VECTOR, types.int64, types.int64, OUT_MATRIX, types.int64, types.int64, OUT_MATRIX))
def execute(code: Any, numbers: Any, first: int, last: int, w: Any, lanes: int, begin: int, out: Any) -> None:
    """Run instructions [first, last) of code (c, 4) = operation, destination, operands, on columns of `w`.

    EMIT copies a row to row d of `out`, which then must be `aligned`. SCORE adds up, for a row of values minus their
    first, which it keeps, the weighted values, squares and products with row b; row b + 1 holds the weights.
    """
    widest_vectors()
    for position in range(first, last):
        index = np.uint64(position)  # never negative, so nobody needs to count from the end
        operation, d, a, b = code[index, 0], code[index, 1], code[index, 2], code[index, 3]
        number = numbers[index]
        if operation == ADD:
            each2(add, w, lanes, d, a, b)
        elif operation == SUB:
            each2(sub, w, lanes, d, a, b)
        elif operation == MUL:
            each2(mul, w, lanes, d, a, b)
        elif operation == DIV:
            each2(div, w, lanes, d, a, b)
        elif operation == ADD_NUMBER:
            each_left(add, w, lanes, d, a, number)
        elif operation == SUB_NUMBER:
            each_left(sub, w, lanes, d, a, number)
        elif operation == NUMBER_SUB:
            each_right(sub, w, lanes, d, number, a)
        elif operation == MUL_NUMBER:
            each_left(mul, w, lanes, d, a, number)
        elif operation == DIV_NUMBER:
            each_left(div, w, lanes, d, a, number)
        elif operation == NUMBER_DIV:
            each_right(div, w, lanes, d, number, a)
        elif operation == JOINED + 4 * ADD + ADD:
            joined(add, add, w, lanes, d, a, b, code[index, 4])
        elif operation == JOINED + 4 * ADD + SUB:
            joined(add, sub, w, lanes, d, a, b, code[index, 4])
        elif operation == JOINED + 4 * ADD + MUL:
            joined(add, mul, w, lanes, d, a, b, code[index, 4])
        elif operation == JOINED + 4 * ADD + FROM:
            joined(add, take_from, w, lanes, d, a, b, code[index, 4])
        elif operation == JOINED + 4 * SUB + ADD:
            joined(sub, add, w, lanes, d, a, b, code[index, 4])
        elif operation == JOINED + 4 * SUB + SUB:
            joined(sub, sub, w, lanes, d, a, b, code[index, 4])
        elif operation == JOINED + 4 * SUB + MUL:
            joined(sub, mul, w, lanes, d, a, b, code[index, 4])
        elif operation == JOINED + 4 * SUB + FROM:
            joined(sub, take_from, w, lanes, d, a, b, code[index, 4])
        elif operation == JOINED + 4 * MUL + ADD:
            joined(mul, add, w, lanes, d, a, b, code[index, 4])
        elif operation == JOINED + 4 * MUL + SUB:
            joined(mul, sub, w, lanes, d, a, b, code[index, 4])
        elif operation == JOINED + 4 * MUL + MUL:
            joined(mul, mul, w, lanes, d, a, b, code[index, 4])
        elif operation == JOINED + 4 * MUL + FROM:
            joined(mul, take_from, w, lanes, d, a, b, code[index, 4])
        elif operation == FILL:
            for at in range(0, lanes, WIDTH):
                put(w, d, at, number)
        elif operation == EMIT:
            for at in range(0, lanes, WIDTH):
                put_away(out, d, begin + at, take(w, a, at))
        elif operation == SCORE:
            if begin == 0:
                out[d, 3 * WIDTH] = w[a, 0]
            add_up(w, lanes, a, b, out, d)
        elif operation == NEG:
            each1(neg, w, lanes, d, a)
        elif operation == ABS:
            each1(abs_, w, lanes, d, a)
        elif operation == HALF:
            each1(half, w, lanes, d, a)
        elif operation == DOUBLE:
            each1(double, w, lanes, d, a)
        elif operation == SQUARE:
            each1(square, w, lanes, d, a)
        elif operation == CUBE:
            each1(cube, w, lanes, d, a)
        elif operation == SQRT:
            each1(sqrt, w, lanes, d, a)
        elif operation == SIN:
            each1(sin, w, lanes, d, a)
        elif operation == COS:
            each1(cos, w, lanes, d, a)
        elif operation == ATAN:
            each1(atan, w, lanes, d, a)
        elif operation == EXP:
            each1(exp, w, lanes, d, a)
        elif operation == LOG:
            each1(log, w, lanes, d, a)
        elif operation == TANH:
            each1(tanh, w, lanes, d, a)
        elif operation == MAX:
            each2(max_, w, lanes, d, a, b)
        elif operation == MIN:
            each2(min_, w, lanes, d, a, b)


@kernel(types.void(CODE, VECTOR, MATRIX, types.int64, types.int64, OUT_MATRIX))
def run(code: Any, numbers: Any, columns: Any, rows: int, block: int, out: Any) -> None:
    """Outputs (u, N) of columns (m, N), N a multiple of WIDTH, in a workspace of `rows` rows; a block at a time.

    Or scores (u, 3 WIDTH + 1), zero before, if the code has SCORE in place of EMIT.
    """
    w = aligned(rows, block)
    for begin in range(0, columns.shape[1], block):
        lanes = min(block, columns.shape[1] - begin)
        for j in range(len(columns)):
            for at in range(0, lanes, WIDTH):
                put(w, j, at, take(columns, j, begin + at))
        execute(code, numbers, 0, len(code), w, lanes, begin, out)


@kernel(types.void(MATRIX, types.float64, types.float64, types.float64, OUT_MATRIX))
def best_lines(scores: Any, weight: float, mean: float, total: float, out: Any) -> None:
    """Error, slope and constant (u, 3) of the lines slope * value + constant that come nearest to y (Keijzer 2003).

    scores (u, 3 WIDTH + 1) as SCORE leaves them, weight: sum of the weights, mean: of y, total: weighted squares of y
    minus its mean, of which an error is a share; infinite where a value is not finite.
    """
    for d in range(len(scores)):
        values, squares, products = 0.0, 0.0, 0.0
        for lane in range(WIDTH):
            values += scores[d, lane]
            squares += scores[d, WIDTH + lane]
            products += scores[d, 2 * WIDTH + lane]
        center = values / weight
        variance = squares - values * center
        slope = products / variance if variance > 1e-28 * squares else 0.0
        left = total - slope * products
        known = np.isfinite(squares) and np.isfinite(left)
        out[d, 0] = max(left, 0.0) / (total if total > 0.0 else 1.0) if known else np.inf
        out[d, 1] = slope
        out[d, 2] = mean - slope * (scores[d, 3 * WIDTH] + center)
