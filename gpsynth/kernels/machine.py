"""The lane machine: one instruction for a block of lanes, then the next.

`execute` is the table of operations once more, as numba sees it: its numbers are the rows of `operations.OPERATIONS`.
Each branch is a loop over vectors of WIDTH lanes (`vectors.py`), so a workspace has a multiple of WIDTH columns, and
what the columns behind the last lane hold is computed with and never read.
"""

from typing import Any

import numpy as np
from numba import types

from gpsynth.arrays import Floats, Ints
from gpsynth.kernels import trigonometry
from gpsynth.kernels.carried import on_vectors
from gpsynth.kernels.compile import CODE, INTEGERS, MATRIX, OUT_MATRIX, VECTOR, kernel, part, widest_vectors
from gpsynth.kernels.elementary import function_of
from gpsynth.kernels.pairs import JOINED, pair
from gpsynth.kernels.vectors import WIDTH, put, take
from gpsynth.operations import OPERATIONS

BLOCK = 64  # lanes; a workspace of some dozens of rows stays in the first-level cache
SINE_AND_COSINE = len(OPERATIONS)  # of one operand, into two rows: d and b

(  # the rows of the table in their order
    add, sub, mul, div, div_protected, neg, abs_, half, double, square, cube, sqrt, sqrt_protected, floor,
    sin, cos, tan, atan, atan2, asin, acos, exp, exp_protected, log, log_protected, tanh, cbrt, hypot, wrap,
    max_, min_, lt, le, eq, not_, where, limit, sign, identity, nop_square, signed_sqrt, nop_inverse,
    nop_exp, nop_log, tanh_half, step, sgn, nop_cube, nop_cbrt, clip_unit, signed_log1p, signed_expm1,
    signed_decay, signed_saturation, minus_cube, sigmoid, step_open, sgn_dead_zone, circle, notch, nop_mul,
    prob_sum, signed_hypot, signed_abs_sum, signed_abs_max,
) = (on_vectors(function_of(row.name)) for row in OPERATIONS)  # fmt: skip
sine_and_cosine = on_vectors(trigonometry.sine_and_cosine)


@part
def each1(function: Any, w: Any, lanes: int, d: int, a: int) -> None:
    """Row d = function(row a)."""
    for at in range(0, lanes, WIDTH):
        put(w, d, at, function(take(w, a, at)))


@part
def each2(function: Any, w: Any, lanes: int, d: int, a: int, b: int) -> None:
    """Row d = function(row a, row b)."""
    for at in range(0, lanes, WIDTH):
        put(w, d, at, function(take(w, a, at), take(w, b, at)))


@part
def each3(function: Any, w: Any, lanes: int, d: int, a: int, b: int, c: int) -> None:
    """Row d = function(row a, row b, row c)."""
    for at in range(0, lanes, WIDTH):
        put(w, d, at, function(take(w, a, at), take(w, b, at), take(w, c, at)))


@kernel(types.void(CODE, types.int64, types.int64, OUT_MATRIX, types.int64))
def execute(code: Any, first: int, last: int, w: Any, lanes: int) -> None:
    """Run instructions [first, last) of code (c, 5) = operation, destination row, operand rows, on columns of `w`.

    `lanes` columns are computed, and those up to the next multiple of WIDTH, which `w` must have.
    """
    widest_vectors()
    for number in range(first, last):
        index = np.uint64(number)  # never negative, so nobody needs to count from the end
        operation = code[index, 0]
        d, a, b, c = code[index, 1], code[index, 2], code[index, 3], code[index, 4]
        if operation >= JOINED:
            pair(operation, w, lanes, d, a, b, c)
        elif operation == 0:
            each2(add, w, lanes, d, a, b)
        elif operation == 1:
            each2(sub, w, lanes, d, a, b)
        elif operation == 2:
            each2(mul, w, lanes, d, a, b)
        elif operation == 3:
            each2(div, w, lanes, d, a, b)
        elif operation == 4:
            each2(div_protected, w, lanes, d, a, b)
        elif operation == 5:
            each1(neg, w, lanes, d, a)
        elif operation == 6:
            each1(abs_, w, lanes, d, a)
        elif operation == 7:
            each1(half, w, lanes, d, a)
        elif operation == 8:
            each1(double, w, lanes, d, a)
        elif operation == 9:
            each1(square, w, lanes, d, a)
        elif operation == 10:
            each1(cube, w, lanes, d, a)
        elif operation == 11:
            each1(sqrt, w, lanes, d, a)
        elif operation == 12:
            each1(sqrt_protected, w, lanes, d, a)
        elif operation == 13:
            each1(floor, w, lanes, d, a)
        elif operation == 14:
            each1(sin, w, lanes, d, a)
        elif operation == 15:
            each1(cos, w, lanes, d, a)
        elif operation == 16:
            each1(tan, w, lanes, d, a)
        elif operation == 17:
            each1(atan, w, lanes, d, a)
        elif operation == 18:
            each2(atan2, w, lanes, d, a, b)
        elif operation == 19:
            each1(asin, w, lanes, d, a)
        elif operation == 20:
            each1(acos, w, lanes, d, a)
        elif operation == 21:
            each1(exp, w, lanes, d, a)
        elif operation == 22:
            each1(exp_protected, w, lanes, d, a)
        elif operation == 23:
            each1(log, w, lanes, d, a)
        elif operation == 24:
            each1(log_protected, w, lanes, d, a)
        elif operation == 25:
            each1(tanh, w, lanes, d, a)
        elif operation == 26:
            each1(cbrt, w, lanes, d, a)
        elif operation == 27:
            each2(hypot, w, lanes, d, a, b)
        elif operation == 28:
            each1(wrap, w, lanes, d, a)
        elif operation == 29:
            each2(max_, w, lanes, d, a, b)
        elif operation == 30:
            each2(min_, w, lanes, d, a, b)
        elif operation == 31:
            each2(lt, w, lanes, d, a, b)
        elif operation == 32:
            each2(le, w, lanes, d, a, b)
        elif operation == 33:
            each2(eq, w, lanes, d, a, b)
        elif operation == 34:
            each1(not_, w, lanes, d, a)
        elif operation == 35:
            each3(where, w, lanes, d, a, b, c)
        elif operation == 36:
            each3(limit, w, lanes, d, a, b, c)
        elif operation == 37:
            each1(sign, w, lanes, d, a)
        elif operation == 38:
            each1(identity, w, lanes, d, a)
        elif operation == 39:
            each1(nop_square, w, lanes, d, a)
        elif operation == 40:
            each1(signed_sqrt, w, lanes, d, a)
        elif operation == 41:
            each1(nop_inverse, w, lanes, d, a)
        elif operation == 42:
            each1(nop_exp, w, lanes, d, a)
        elif operation == 43:
            each1(nop_log, w, lanes, d, a)
        elif operation == 44:
            each1(tanh_half, w, lanes, d, a)
        elif operation == 45:
            each1(step, w, lanes, d, a)
        elif operation == 46:
            each1(sgn, w, lanes, d, a)
        elif operation == 47:
            each1(nop_cube, w, lanes, d, a)
        elif operation == 48:
            each1(nop_cbrt, w, lanes, d, a)
        elif operation == 49:
            each1(clip_unit, w, lanes, d, a)
        elif operation == 50:
            each1(signed_log1p, w, lanes, d, a)
        elif operation == 51:
            each1(signed_expm1, w, lanes, d, a)
        elif operation == 52:
            each1(signed_decay, w, lanes, d, a)
        elif operation == 53:
            each1(signed_saturation, w, lanes, d, a)
        elif operation == 54:
            each1(minus_cube, w, lanes, d, a)
        elif operation == 55:
            each1(sigmoid, w, lanes, d, a)
        elif operation == 56:
            each1(step_open, w, lanes, d, a)
        elif operation == 57:
            each1(sgn_dead_zone, w, lanes, d, a)
        elif operation == 58:
            each1(circle, w, lanes, d, a)
        elif operation == 59:
            each1(notch, w, lanes, d, a)
        elif operation == 60:
            each2(nop_mul, w, lanes, d, a, b)
        elif operation == 61:
            each2(prob_sum, w, lanes, d, a, b)
        elif operation == 62:
            each2(signed_hypot, w, lanes, d, a, b)
        elif operation == 63:
            each2(signed_abs_sum, w, lanes, d, a, b)
        elif operation == 64:
            each2(signed_abs_max, w, lanes, d, a, b)
        elif operation == SINE_AND_COSINE:
            for at in range(0, lanes, WIDTH):
                sine, cosine = sine_and_cosine(take(w, a, at))
                put(w, d, at, sine)
                put(w, b, at, cosine)


@kernel(types.void(CODE, INTEGERS, VECTOR, INTEGERS, MATRIX, MATRIX, types.int64, OUT_MATRIX))
def run(
    code: Any,
    constant_rows: Any,
    constants: Any,
    outputs: Any,
    inputs: Any,
    parameters: Any,
    rows: int,
    out: Any,
) -> None:
    """Outputs (N, m) of inputs (N, n) and parameters (1 or N, p), a block of lanes at a time."""
    w = np.zeros((rows, BLOCK))
    n, p = inputs.shape[1], parameters.shape[1]
    for k in range(len(constants)):
        w[constant_rows[k], :] = constants[k]
    for begin in range(0, len(inputs), BLOCK):
        lanes = min(BLOCK, len(inputs) - begin)
        for lane in range(lanes):
            vector = begin + lane if len(parameters) > 1 else 0
            for i in range(n):
                w[i, lane] = inputs[begin + lane, i]
            for k in range(p):
                w[n + k, lane] = parameters[vector, k]
        execute(code, 0, len(code), w, lanes)
        for lane in range(lanes):
            for k in range(len(outputs)):
                out[begin + lane, k] = w[outputs[k], lane]


def evaluate(code: Ints, constants: Floats, outputs: Ints, inputs: Floats, parameters: Floats) -> Floats:
    """A program's outputs (N, m); code (c, 4) as in `Program`, inputs (N, n), parameters (1 or N, p)."""
    before = inputs.shape[1] + parameters.shape[1]
    placed = place(code, before + len(constants))
    out = np.empty((len(inputs), len(outputs)))
    constant_rows = np.arange(before, before + len(constants), dtype=np.int32)
    rows = before + len(constants) + len(code)
    run(placed, constant_rows, constants, outputs, inputs, parameters, rows, out)
    return out


def place(code: Ints, first: int, rows: Ints | None = None) -> Ints:
    """Code (c, 5) whose results go to the rows from `first` on; operands go through `rows` if that is given."""
    placed = np.empty((len(code), 5), dtype=np.int32)
    placed[:, 0] = code[:, 0]
    placed[:, 1] = np.arange(first, first + len(code))
    placed[:, 2:] = code[:, 1:] if rows is None else np.where(code[:, 1:] < 0, 0, rows[code[:, 1:]])
    return placed
