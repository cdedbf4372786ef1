"""The lane machine: one instruction for a block of lanes, then the next.

`execute` is the table of operations once more, as numba sees it: its numbers are the rows of `operations.OPERATIONS`.
Each branch is a plain loop over lanes, which LLVM turns into vector instructions.
"""

from typing import Any

import numpy as np
from numba import types

from gpsynth.arrays import Floats, Ints
from gpsynth.kernels import arithmetic, exponentials, network_operator, trigonometry
from gpsynth.kernels.compile import CODE, INTEGERS, MATRIX, OUT_MATRIX, VECTOR, kernel, widest_vectors

BLOCK = 64  # lanes; a workspace of some dozens of rows stays in the first-level cache


@kernel(types.void(CODE, types.int64, types.int64, OUT_MATRIX, types.int64))
def execute(code: Any, first: int, last: int, w: Any, lanes: int) -> None:
    """Run instructions [first, last) of code (c, 5) = operation, destination row, operand rows, on columns of `w`."""
    widest_vectors()
    for index in range(first, last):
        operation = code[index, 0]
        d, a, b, c = code[index, 1], code[index, 2], code[index, 3], code[index, 4]
        if operation == 0:
            for lane in range(lanes):
                w[d, lane] = arithmetic.add(w[a, lane], w[b, lane])
        elif operation == 1:
            for lane in range(lanes):
                w[d, lane] = arithmetic.sub(w[a, lane], w[b, lane])
        elif operation == 2:
            for lane in range(lanes):
                w[d, lane] = arithmetic.mul(w[a, lane], w[b, lane])
        elif operation == 3:
            for lane in range(lanes):
                w[d, lane] = arithmetic.div(w[a, lane], w[b, lane])
        elif operation == 4:
            for lane in range(lanes):
                w[d, lane] = arithmetic.div_protected(w[a, lane], w[b, lane])
        elif operation == 5:
            for lane in range(lanes):
                w[d, lane] = arithmetic.neg(w[a, lane])
        elif operation == 6:
            for lane in range(lanes):
                w[d, lane] = arithmetic.abs_(w[a, lane])
        elif operation == 7:
            for lane in range(lanes):
                w[d, lane] = arithmetic.half(w[a, lane])
        elif operation == 8:
            for lane in range(lanes):
                w[d, lane] = arithmetic.double(w[a, lane])
        elif operation == 9:
            for lane in range(lanes):
                w[d, lane] = arithmetic.square(w[a, lane])
        elif operation == 10:
            for lane in range(lanes):
                w[d, lane] = arithmetic.cube(w[a, lane])
        elif operation == 11:
            for lane in range(lanes):
                w[d, lane] = arithmetic.sqrt(w[a, lane])
        elif operation == 12:
            for lane in range(lanes):
                w[d, lane] = arithmetic.sqrt_protected(w[a, lane])
        elif operation == 13:
            for lane in range(lanes):
                w[d, lane] = arithmetic.floor(w[a, lane])
        elif operation == 14:
            for lane in range(lanes):
                w[d, lane] = trigonometry.sin(w[a, lane])
        elif operation == 15:
            for lane in range(lanes):
                w[d, lane] = trigonometry.cos(w[a, lane])
        elif operation == 16:
            for lane in range(lanes):
                w[d, lane] = trigonometry.tan(w[a, lane])
        elif operation == 17:
            for lane in range(lanes):
                w[d, lane] = trigonometry.atan(w[a, lane])
        elif operation == 18:
            for lane in range(lanes):
                w[d, lane] = trigonometry.atan2(w[a, lane], w[b, lane])
        elif operation == 19:
            for lane in range(lanes):
                w[d, lane] = trigonometry.asin(w[a, lane])
        elif operation == 20:
            for lane in range(lanes):
                w[d, lane] = trigonometry.acos(w[a, lane])
        elif operation == 21:
            for lane in range(lanes):
                w[d, lane] = exponentials.exp(w[a, lane])
        elif operation == 22:
            for lane in range(lanes):
                w[d, lane] = exponentials.exp_protected(w[a, lane])
        elif operation == 23:
            for lane in range(lanes):
                w[d, lane] = exponentials.log(w[a, lane])
        elif operation == 24:
            for lane in range(lanes):
                w[d, lane] = exponentials.log_protected(w[a, lane])
        elif operation == 25:
            for lane in range(lanes):
                w[d, lane] = exponentials.tanh(w[a, lane])
        elif operation == 26:
            for lane in range(lanes):
                w[d, lane] = exponentials.cbrt(w[a, lane])
        elif operation == 27:
            for lane in range(lanes):
                w[d, lane] = arithmetic.hypot(w[a, lane], w[b, lane])
        elif operation == 28:
            for lane in range(lanes):
                w[d, lane] = trigonometry.wrap(w[a, lane])
        elif operation == 29:
            for lane in range(lanes):
                w[d, lane] = arithmetic.max_(w[a, lane], w[b, lane])
        elif operation == 30:
            for lane in range(lanes):
                w[d, lane] = arithmetic.min_(w[a, lane], w[b, lane])
        elif operation == 31:
            for lane in range(lanes):
                w[d, lane] = arithmetic.lt(w[a, lane], w[b, lane])
        elif operation == 32:
            for lane in range(lanes):
                w[d, lane] = arithmetic.le(w[a, lane], w[b, lane])
        elif operation == 33:
            for lane in range(lanes):
                w[d, lane] = arithmetic.eq(w[a, lane], w[b, lane])
        elif operation == 34:
            for lane in range(lanes):
                w[d, lane] = arithmetic.not_(w[a, lane])
        elif operation == 35:
            for lane in range(lanes):
                w[d, lane] = arithmetic.where(w[a, lane], w[b, lane], w[c, lane])
        elif operation == 36:
            for lane in range(lanes):
                w[d, lane] = arithmetic.limit(w[a, lane], w[b, lane], w[c, lane])
        elif operation == 37:
            for lane in range(lanes):
                w[d, lane] = arithmetic.sign(w[a, lane])
        elif operation == 38:
            for lane in range(lanes):
                w[d, lane] = network_operator.identity(w[a, lane])
        elif operation == 39:
            for lane in range(lanes):
                w[d, lane] = network_operator.nop_square(w[a, lane])
        elif operation == 40:
            for lane in range(lanes):
                w[d, lane] = network_operator.signed_sqrt(w[a, lane])
        elif operation == 41:
            for lane in range(lanes):
                w[d, lane] = network_operator.nop_inverse(w[a, lane])
        elif operation == 42:
            for lane in range(lanes):
                w[d, lane] = network_operator.nop_exp(w[a, lane])
        elif operation == 43:
            for lane in range(lanes):
                w[d, lane] = network_operator.nop_log(w[a, lane])
        elif operation == 44:
            for lane in range(lanes):
                w[d, lane] = network_operator.tanh_half(w[a, lane])
        elif operation == 45:
            for lane in range(lanes):
                w[d, lane] = network_operator.step(w[a, lane])
        elif operation == 46:
            for lane in range(lanes):
                w[d, lane] = arithmetic.sgn(w[a, lane])
        elif operation == 47:
            for lane in range(lanes):
                w[d, lane] = network_operator.nop_cube(w[a, lane])
        elif operation == 48:
            for lane in range(lanes):
                w[d, lane] = network_operator.nop_cbrt(w[a, lane])
        elif operation == 49:
            for lane in range(lanes):
                w[d, lane] = network_operator.clip_unit(w[a, lane])
        elif operation == 50:
            for lane in range(lanes):
                w[d, lane] = network_operator.signed_log1p(w[a, lane])
        elif operation == 51:
            for lane in range(lanes):
                w[d, lane] = network_operator.signed_expm1(w[a, lane])
        elif operation == 52:
            for lane in range(lanes):
                w[d, lane] = network_operator.signed_decay(w[a, lane])
        elif operation == 53:
            for lane in range(lanes):
                w[d, lane] = network_operator.signed_saturation(w[a, lane])
        elif operation == 54:
            for lane in range(lanes):
                w[d, lane] = network_operator.minus_cube(w[a, lane])
        elif operation == 55:
            for lane in range(lanes):
                w[d, lane] = network_operator.sigmoid(w[a, lane])
        elif operation == 56:
            for lane in range(lanes):
                w[d, lane] = network_operator.step_open(w[a, lane])
        elif operation == 57:
            for lane in range(lanes):
                w[d, lane] = network_operator.sgn_dead_zone(w[a, lane])
        elif operation == 58:
            for lane in range(lanes):
                w[d, lane] = network_operator.circle(w[a, lane])
        elif operation == 59:
            for lane in range(lanes):
                w[d, lane] = network_operator.notch(w[a, lane])
        elif operation == 60:
            for lane in range(lanes):
                w[d, lane] = network_operator.nop_mul(w[a, lane], w[b, lane])
        elif operation == 61:
            for lane in range(lanes):
                w[d, lane] = network_operator.prob_sum(w[a, lane], w[b, lane])
        elif operation == 62:
            for lane in range(lanes):
                w[d, lane] = network_operator.signed_hypot(w[a, lane], w[b, lane])
        elif operation == 63:
            for lane in range(lanes):
                w[d, lane] = network_operator.signed_abs_sum(w[a, lane], w[b, lane])
        elif operation == 64:
            for lane in range(lanes):
                w[d, lane] = network_operator.signed_abs_max(w[a, lane], w[b, lane])


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
    placed[:, 2:] = code[:, 1:] if rows is None else rows[code[:, 1:]]
    return placed
