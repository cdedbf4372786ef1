"""Unique nodes as instructions of the data machine: numbers inside them, rows used again, two operations in one."""

from typing import Any

import numpy as np
from numba import types

from gpsynth.kernels.compile import INTEGERS, VECTOR, kernel, part
from gpsynth.kernels.data_code import (
    ADD,
    ADD_NUMBER,
    CONSTANT,
    DIV,
    DIV_NUMBER,
    EMIT,
    FILL,
    FROM,
    JOINED,
    MUL,
    MUL_NUMBER,
    NUMBER_DIV,
    NUMBER_SUB,
    SCORE,
    SUB,
    SUB_NUMBER,
    VARIABLE,
)
from gpsynth.kernels.free_rows import give_back, take
from gpsynth.kernels.genomes import arity

_INTEGERS = types.Array(types.int32, 1, "C")
_CODE = types.Array(types.int32, 2, "C")
_NUMBERS = types.Array(types.float64, 1, "C")
_NONE = -1


@part
def _write(code: Any, immediate: Any, at: int, op: int, d: int, a: int, b: int, number: float) -> Any:
    """Write an instruction; where the next one goes."""
    code[at, 0], code[at, 1], code[at, 2], code[at, 3] = op, d, a, b
    immediate[at] = number
    return at + 1


@part
def _with_number(op: int, left: bool) -> Any:
    """The operation whose left or right operand is a number."""
    if op == ADD:
        return ADD_NUMBER
    if op == SUB:
        return NUMBER_SUB if left else SUB_NUMBER
    if op == MUL:
        return MUL_NUMBER
    return NUMBER_DIV if left else DIV_NUMBER


@part
def _join(code: Any, at: int, op: int, d: int, c: int) -> None:
    """Make the instruction at `at` one with the operation that takes what it gives and row c."""
    code[at, 0] = JOINED + 4 * code[at, 0] + op
    code[at, 1], code[at, 4] = d, c


@part
def _last_uses(ops: Any, a: Any, b: Any) -> Any:
    """The node that takes each node last, or -1."""
    last = np.full(len(ops), _NONE, np.int32)
    for node in range(len(ops)):
        operands = arity(ops[node])
        if operands > 0:
            last[a[node]] = node
        if operands > 1:
            last[b[node]] = node
    return last


@kernel(
    types.UniTuple(types.int64, 2)(
        *(INTEGERS, INTEGERS, INTEGERS, VECTOR, INTEGERS, types.int64, types.int64),
        *(_CODE, _NUMBERS),
    )
)
def place(
    ops: Any,
    a: Any,
    b: Any,
    numbers: Any,
    output: Any,
    variables: int,
    target: int,
    code: Any,
    immediate: Any,
) -> tuple[int, int]:
    """Instructions of unique nodes, numbers as immediates, rows given back by their last use: (length, rows).

    `output` is the output a node is, or -1; outputs are scored against row `target` unless that is -1. An instruction
    may write where it reads. Where an addition, subtraction or product is only taken by the next one, the two are one
    instruction, whose first result is never stored. `code` has room for each node, each output and each number once
    more.
    """
    last, row = _last_uses(ops, a, b), np.full(len(ops), _NONE, np.int32)
    free = np.zeros(len(ops) + 2, np.int32)
    free[1] = variables
    length, recent = 0, _NONE  # instructions, and the node that the latest one computes
    for node in range(len(ops)):
        op, x, y = ops[node], a[node], b[node]
        if op <= VARIABLE:
            row[node] = VARIABLE - op
        elif op >= 0:
            operands, number = arity(op), 0.0
            left, right = ops[x] == CONSTANT, operands == 2 and ops[y] == CONSTANT
            if op <= DIV and (left or right):
                number = numbers[x] if left else numbers[y]
                op, operands = _with_number(op, left), 1
                x = y if left else x
            y = y if operands == 2 else x
            for k in range(operands):
                operand = y if k else x
                if row[operand] < 0:
                    row[operand] = take(free)
                    length = _write(code, immediate, length, FILL, row[operand], 0, 0, numbers[operand])
            first, second = row[x], row[y]
            for k in range(operands):
                operand = y if k else x
                if last[operand] == node and ops[operand] > VARIABLE and row[operand] >= 0:
                    give_back(row[operand], free)
                    row[operand] = _NONE
            row[node] = take(free)
            before, other = (x, second) if x == recent else (y, first)
            follows = x != y and before == recent and last[before] == node
            if follows and op <= MUL and code[length - 1, 0] <= MUL:
                _join(code, length - 1, FROM if op == SUB and before == y else op, row[node], other)
            else:
                length = _write(code, immediate, length, op, row[node], first, second, number)
            recent = node
        if output[node] >= 0:
            if row[node] < 0:
                row[node] = take(free)
                length = _write(code, immediate, length, FILL, row[node], 0, 0, numbers[node])
            kind = SCORE if target >= 0 else EMIT
            length = _write(code, immediate, length, kind, output[node], row[node], max(target, 0), 0.0)
            if last[node] == _NONE and op > VARIABLE:
                give_back(row[node], free)
                row[node] = _NONE
    return length, free[1]
