"""A population as one program: equal subtrees are one node (hash-consing).

In an evolving population about three of every operator nodes are copies of another one; each is computed once, and what
no column enters not even once for each row.
"""

from typing import Any

import numpy as np
from numba import types

from gpsynth.kernels.bits import bits_of
from gpsynth.kernels.compile import INTEGERS, VECTOR, kernel
from gpsynth.kernels.data_code import ADD, CONSTANT, MUL, VARIABLE
from gpsynth.kernels.folding import folded
from gpsynth.kernels.genomes import arity

_INTEGERS = types.Array(types.int32, 1, "C")
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
