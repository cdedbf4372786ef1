"""A population as one program: equal subtrees are one value (hash-consing), dead values give their row back.

In an evolving population about three of every operator nodes are copies of another one; each is computed once, and what
no column enters not even once for each row.
"""

from typing import Any

import numpy as np
from numba import types

from gpsynth.kernels.bits import bits_of
from gpsynth.kernels.compile import INTEGERS, VECTOR, kernel, part
from gpsynth.kernels.data_code import (
    ADD,
    ADD_NUMBER,
    CONSTANT,
    DIV,
    DIV_NUMBER,
    EMIT,
    FILL,
    MUL,
    MUL_NUMBER,
    NUMBER_DIV,
    NUMBER_SUB,
    SCORE,
    SUB,
    SUB_NUMBER,
    VARIABLE,
)
from gpsynth.kernels.folding import folded
from gpsynth.kernels.genomes import arity

_INTEGERS = types.Array(types.int32, 1, "C")
_CODE = types.Array(types.int32, 2, "C")
_NUMBERS = types.Array(types.float64, 1, "C")
_NONE = -1
_FIRST = 0x9E3779B97F4A7C15 - 2**64  # odd multipliers of a multiplicative hash, as signed integers
_SECOND = 0xC2B2AE3D27D4EB4F - 2**64


@kernel(
    types.UniTuple(types.int64, 2)(
        *(INTEGERS, INTEGERS, INTEGERS, VECTOR, INTEGERS, types.int64, _INTEGERS, _INTEGERS),
        *(_INTEGERS, _INTEGERS, _INTEGERS, _NUMBERS, _INTEGERS, _INTEGERS),
    )
)
def share(
    ops: Any,
    a: Any,
    b: Any,
    numbers: Any,
    roots: Any,
    variables: int,
    table: Any,
    ids: Any,
    u_ops: Any,
    u_a: Any,
    u_b: Any,
    u_numbers: Any,
    output: Any,
    outputs: Any,
) -> tuple[int, int]:
    """Unique nodes of flat expressions, the variables and then the others as they appear, and how many are roots.

    An operation on numbers is a number. `ids` says which node each position is, `output` which output a node is or -1,
    `outputs` which of them each root is. `table` has a power of two of entries, more than positions, all zero.
    """
    mask = len(table) - 1
    count = variables
    for j in range(variables):
        u_ops[j], output[j] = VARIABLE - j, _NONE
    for t in range(len(ops)):
        op = int(ops[t])
        if op <= VARIABLE:
            ids[t] = VARIABLE - op
            continue
        operands = arity(op)
        x = np.int64(ids[a[t]] if operands > 0 else 0)
        y = np.int64(ids[b[t]] if operands > 1 else 0)
        if ((op == ADD) | (op == MUL)) & (x > y):
            x, y = y, x
        number = numbers[t]
        if operands > 0 and u_ops[x] == CONSTANT and (operands == 1 or u_ops[y] == CONSTANT):
            number = folded(op, u_numbers[x], u_numbers[y])
            op, x, y = CONSTANT, np.int64(0), np.int64(0)
        bits = np.int64(bits_of(number) if op == CONSTANT else 0)
        mixed = (op * 0x1000003 + x) * _FIRST + (y + bits) * _SECOND
        place = ((mixed >> 29) ^ mixed ^ (mixed >> 47)) & mask
        while True:
            found = table[place] - 1
            if found < 0:
                table[place] = count + 1
                u_ops[count], u_a[count], u_b[count] = op, x, y
                u_numbers[count] = number
                output[count] = _NONE
                found = count
                count += 1
                break
            same = (u_ops[found] == op) & (u_a[found] == x) & (u_b[found] == y)
            if same & ((op != CONSTANT) | (bits_of(u_numbers[found]) == bits)):
                break
            place = (place + 1) & mask
        ids[t] = found
    distinct = 0
    for p in range(len(roots)):
        node = ids[roots[p]]
        if output[node] < 0:
            output[node] = distinct
            distinct += 1
        outputs[p] = output[node]
    return count, distinct


@part
def _take_row(free: Any) -> Any:
    """The row given back last, or a new one. `free`: how many are free, how many rows there are, which are free."""
    if free[0] > 0:
        free[0] -= 1
        return free[2 + free[0]]
    free[1] += 1
    return free[1] - 1


@part
def _give_back(node: int, row: Any, free: Any) -> None:
    free[2 + free[0]] = row[node]
    free[0] += 1
    row[node] = _NONE


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
    may write where it reads. `code` has room for each node, each output and each number once more.
    """
    last, row = np.full((2, len(ops)), _NONE, np.int32)
    free = np.zeros(len(ops) + 2, np.int32)
    free[1] = variables
    for node in range(len(ops)):
        operands = arity(ops[node])
        if operands > 0:
            last[a[node]] = node
        if operands > 1:
            last[b[node]] = node
    length = 0
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
                    row[operand] = _take_row(free)
                    length = _write(code, immediate, length, FILL, row[operand], 0, 0, numbers[operand])
            first, second = row[x], row[y]
            for k in range(operands):
                operand = y if k else x
                if last[operand] == node and ops[operand] > VARIABLE and row[operand] >= 0:
                    _give_back(operand, row, free)
            row[node] = _take_row(free)
            length = _write(code, immediate, length, op, row[node], first, second, number)
        if output[node] >= 0:
            if row[node] < 0:
                row[node] = _take_row(free)
                length = _write(code, immediate, length, FILL, row[node], 0, 0, numbers[node])
            kind = SCORE if target >= 0 else EMIT
            length = _write(code, immediate, length, kind, output[node], row[node], max(target, 0), 0.0)
            if last[node] == _NONE and op > VARIABLE:
                _give_back(node, row, free)
    return length, free[1]
