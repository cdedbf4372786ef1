"""A population as one program: equal subtrees are one value (hash-consing), dead values give their row back.

In an evolving population about three of every operator nodes are copies of another one; each is computed once.
"""

from typing import Any

import numpy as np
from numba import types

from gpsynth.kernels.bits import bits_of
from gpsynth.kernels.compile import INTEGERS, VECTOR, kernel
from gpsynth.kernels.data_code import (
    ADD,
    ADD_NUMBER,
    CONSTANT,
    DIV,
    DIV_NUMBER,
    EMIT,
    FILL,
    MAX,
    MIN,
    MUL,
    MUL_NUMBER,
    NUMBER_DIV,
    NUMBER_SUB,
    SCORE,
    SUB,
    SUB_NUMBER,
    VARIABLE,
)

_INTEGERS = types.Array(types.int32, 1, "C")
_CODE = types.Array(types.int32, 2, "C")
_NUMBERS = types.Array(types.float64, 1, "C")
_NONE = -1
_FIRST = 0x9E3779B97F4A7C15 - 2**64  # odd multipliers of a multiplicative hash, as signed integers
_SECOND = 0xC2B2AE3D27D4EB4F - 2**64


@kernel(
    types.int64(
        *(INTEGERS, INTEGERS, INTEGERS, VECTOR, _INTEGERS, _INTEGERS),
        *(_INTEGERS, _INTEGERS, _INTEGERS, _NUMBERS),
    )
)
def share(
    ops: Any,
    a: Any,
    b: Any,
    numbers: Any,
    table: Any,
    ids: Any,
    u_ops: Any,
    u_a: Any,
    u_b: Any,
    u_numbers: Any,
) -> int:
    """Unique nodes of flat expressions, in order of first appearance; `ids` says which each position is.

    `table` has a power of two of entries, at least twice the positions, all zero.
    """
    mask = len(table) - 1
    count = 0
    for t in range(len(ops)):
        op = np.int64(ops[t])
        x = np.int64(ids[a[t]] if op >= 0 else 0)
        y = np.int64(ids[b[t]] if (op >= 0) & ((op <= DIV) | (op == MAX) | (op == MIN)) else 0)
        if ((op == ADD) | (op == MUL)) & (x > y):
            x, y = y, x
        bits = np.int64(bits_of(numbers[t]) if op == CONSTANT else 0)
        mixed = (op * 0x1000003 + x) * _FIRST + (y + bits) * _SECOND
        place = ((mixed >> 29) ^ mixed ^ (mixed >> 47)) & mask
        while True:
            found = table[place] - 1
            if found < 0:
                table[place] = count + 1
                u_ops[count], u_a[count], u_b[count] = op, x, y
                u_numbers[count] = numbers[t]
                found = count
                count += 1
                break
            same = (u_ops[found] == op) & (u_a[found] == x) & (u_b[found] == y)
            if same & ((op != CONSTANT) | (bits_of(u_numbers[found]) == bits)):
                break
            place = (place + 1) & mask
        ids[t] = found
    return count


@kernel(
    types.UniTuple(types.int64, 2)(
        *(INTEGERS, INTEGERS, INTEGERS, VECTOR, INTEGERS, types.int64, types.int64),
        *(_INTEGERS, _INTEGERS, _INTEGERS, _CODE, _NUMBERS),
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
    last: Any,
    row: Any,
    free: Any,
    code: Any,
    immediate: Any,
) -> tuple[int, int]:
    """Instructions of unique nodes, numbers as immediates, rows given back after their last use: (length, rows).

    `output` is the output a node is, or -1; outputs are scored against row `target` unless that is -1. `last`, `row`
    and `free` are scratch of one entry for each node.
    """
    for node in range(len(ops)):
        last[node] = _NONE
        if ops[node] >= 0:
            last[a[node]] = node
            if (ops[node] <= DIV) | (ops[node] == MAX) | (ops[node] == MIN):
                last[b[node]] = node
    length, rows, freed = 0, variables, 0
    for node in range(len(ops)):
        op, x, y = ops[node], a[node], b[node]
        binary = (op >= 0) & ((op <= DIV) | (op == MAX) | (op == MIN))
        if op <= VARIABLE:
            row[node] = VARIABLE - op
        elif op == CONSTANT:
            row[node] = _NONE
        else:
            number = 0.0
            left = ops[x] == CONSTANT
            right = binary & (ops[y] == CONSTANT) if binary else False
            if binary and op <= DIV and left != right:
                number = numbers[x] if left else numbers[y]
                if op == ADD:
                    op = ADD_NUMBER
                elif op == SUB:
                    op = NUMBER_SUB if left else SUB_NUMBER
                elif op == MUL:
                    op = MUL_NUMBER
                else:
                    op = NUMBER_DIV if left else DIV_NUMBER
                x = y if left else x
                y = x
                binary = False
            for k in range(2 if binary else 1):
                operand = y if k else x
                if ops[operand] == CONSTANT and row[operand] < 0:
                    if freed:
                        freed -= 1
                        row[operand] = free[freed]
                    else:
                        row[operand] = rows
                        rows += 1
                    code[length, 0], code[length, 1], code[length, 2], code[length, 3] = (
                        FILL,
                        row[operand],
                        0,
                        0,
                    )
                    immediate[length] = numbers[operand]
                    length += 1
            if freed:
                freed -= 1
                row[node] = free[freed]
            else:
                row[node] = rows
                rows += 1
            code[length, 0], code[length, 1] = op, row[node]
            code[length, 2], code[length, 3] = row[x], row[y] if binary else row[x]
            immediate[length] = number
            length += 1
            for k in range(2 if binary else 1):
                operand = y if k else x
                if (last[operand] == node) & (ops[operand] > VARIABLE) & (row[operand] >= 0):
                    free[freed] = row[operand]
                    freed += 1
                    row[operand] = _NONE
        if output[node] >= 0:
            if row[node] < 0:
                row[node] = rows
                rows += 1
                code[length, 0], code[length, 1], code[length, 2], code[length, 3] = FILL, row[node], 0, 0
                immediate[length] = numbers[node]
                length += 1
            code[length, 0], code[length, 1], code[length, 2], code[length, 3] = (
                SCORE if target >= 0 else EMIT,
                output[node],
                row[node],
                max(target, 0),
            )
            immediate[length] = 0.0
            length += 1
            if (last[node] == _NONE) & (op > VARIABLE):
                free[freed] = row[node]
                freed += 1
    return length, rows
