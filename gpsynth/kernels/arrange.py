"""A law put into its closed loop: dead instructions left out, others joined in pairs, rows used again.

What an instruction writes is needed until its last use; then the row is free for another result. So a workspace stays
in the first-level cache whatever the length of the code.
"""

from typing import Any

import numpy as np
from numba import types

from gpsynth.arrays import Ints
from gpsynth.kernels.compile import CODE, INTEGERS, OUT_CODE, kernel, part
from gpsynth.kernels.free_rows import give_back, take
from gpsynth.kernels.machine import SINE_AND_COSINE
from gpsynth.kernels.pairs import FIRST_NUMBERS, FIRSTS, JOINED, SECONDS, SQUARE
from gpsynth.operations import CODES

_SINE, _COSINE = CODES["sin"], CODES["cos"]
_INTEGER = types.int64
_OUT_INTEGERS = types.Array(types.int32, 1, "C")


@part
def _arity(operation: int, arities: Any) -> Any:
    """How many rows an instruction reads."""
    if operation < JOINED:
        return arities[operation]
    return arities[operation & (FIRST_NUMBERS - 1)] + (1 if (operation - JOINED) >> 8 < SQUARE else 0)


@part
def _release(code: Any, i: int, arities: Any, last: Any, moved: Any, free: Any, first: int) -> None:
    """Give the rows back that instruction i is the last to read."""
    for k in range(2, 2 + _arity(code[i, 0], arities)):
        row = code[i, k]
        if last[row] == i and moved[row] >= first:
            last[row] = -1
            give_back(moved[row], free)


@part
def _write(code: Any, i: int, end: int, last: Any, moved: Any, free: Any, out: Any) -> None:
    """Write instruction i; if it is a sine, together with the cosine of the same row in its part, or the reverse."""
    moved[code[i, 1]] = take(free)
    out[0], out[1] = code[i, 0], moved[code[i, 1]]
    for k in range(2, 5):
        out[k] = moved[code[i, k]]
    if code[i, 0] in (_SINE, _COSINE):
        for j in range(i + 1, end):
            other, is_partner = code[j, 1], code[j, 0] == _SINE + _COSINE - code[i, 0]
            if is_partner and code[j, 2] == code[i, 2] and last[other] >= 0 and moved[other] < 0:
                moved[other] = take(free)
                out[0], out[3] = SINE_AND_COSINE, moved[other]
                if code[i, 0] == _COSINE:
                    out[1], out[3] = out[3], out[1]
                return


@part
def _operand(number: Any, inputs: Any, first: int) -> Any:
    """The row of a value that has this number in the law."""
    return inputs[number] if number < len(inputs) else first + number - len(inputs)


@part
def _whole(before: Any, law: Any, outputs: Any, after: Any, inputs: Any, first: int, computed: int) -> Any:
    """The instructions in order, the law's operands being `inputs`, then rows from `first` on, its results `computed`.

    A negative operand behind the law is an output of it: -1 the first.
    """
    begin, end = len(before), len(before) + len(law)
    code = np.zeros((end + len(after), 5), np.int32)
    code[:begin], code[end:] = before, after
    for i in range(len(law)):
        code[begin + i, 0], code[begin + i, 1] = law[i, 0], computed + i
        for k in range(1, 4):
            code[begin + i, 1 + k] = _operand(max(law[i, k], 0), inputs, first)
    for i in range(end, len(code)):
        for k in range(2, 5):
            if code[i, k] < 0:
                code[i, k] = _operand(outputs[-1 - code[i, k]], inputs, first)
    return code


@part
def _last_uses(code: Any, kept: Any, arities: Any, rows: int) -> Any:
    """(rows,) the instruction that reads a row for the last time; -1: nobody who matters."""
    last = np.full(rows, -1, np.int32)
    for row in kept:
        last[row] = len(code)
    for i in range(len(code) - 1, -1, -1):
        if last[code[i, 1]] >= 0:
            for k in range(2, 2 + arities[code[i, 0]]):
                last[code[i, k]] = max(last[code[i, k]], i)
    return last


@part
def _uses(code: Any, kept: Any, arities: Any, last: Any) -> Any:
    """(rows,) how often a row is read by instructions that matter; one that is read from outside counts as two."""
    uses = np.zeros(len(last), np.int32)
    for row in kept:
        uses[row] = 2
    for i in range(len(code)):
        if last[code[i, 1]] >= 0:
            for k in range(2, 2 + arities[code[i, 0]]):
                uses[code[i, k]] += 1
    return uses


@part
def _leads(code: Any, i: int, begin: int, end: int) -> bool:
    """Whether instruction i of part [begin, end) can be the first of a pair."""
    operation = code[i, 0]
    if operation in (_SINE, _COSINE):  # both of one value are worth more
        for k in range(begin, end):
            if code[k, 0] == _SINE + _COSINE - operation and code[k, 2] == code[i, 2]:
                return False
    return bool(operation < JOINED and FIRSTS[operation])


@part
def _pair(code: Any, i: int, j: int, k: int, arities: Any, last: Any) -> None:
    """Make instruction j a pair with i, which gives its operand k."""
    count, first, second, other = arities[code[i, 0]], code[i, 0], code[j, 0], code[j, 3 - k]
    code[j, 0] = JOINED + FIRST_NUMBERS * SECONDS[second, k] + first
    for operand in range(2, 2 + count):
        code[j, operand] = code[i, operand]
        last[code[i, operand]] = max(last[code[i, operand]], j)
    if arities[second] == 2:
        code[j, 2 + count] = other
    last[code[i, 1]] = -1


@part
def _join(code: Any, ends: Any, kept: Any, arities: Any, last: Any) -> None:
    """Join instructions of one part in pairs: the second takes the first along, whose value nobody else reads."""
    uses, writer = _uses(code, kept, arities, last), np.full(len(last), -1, np.int32)
    begin = 0
    for end in ends:
        for j in range(begin, end):
            for k in range(min(arities[code[j, 0]], 2)):
                row = code[j, 2 + k]
                matters = last[code[j, 1]] >= 0 and uses[row] == 1 and writer[row] >= begin
                if matters and SECONDS[code[j, 0], k] >= 0 and _leads(code, writer[row], begin, end):
                    _pair(code, writer[row], j, k, arities, last)
                    break
            writer[code[j, 1]] = j
        begin = end


@kernel(
    _INTEGER(
        *(CODE, CODE, INTEGERS, CODE, INTEGERS, _INTEGER, _INTEGER, INTEGERS, INTEGERS),
        *(OUT_CODE, _OUT_INTEGERS, _OUT_INTEGERS),
    )
)
def arrange(
    before: Ints,
    law: Ints,
    outputs: Ints,
    after: Ints,
    inputs: Ints,
    first: int,
    computed: int,
    kept: Ints,
    arities: Ints,
    out: Ints,
    ends: Ints,
    moved: Ints,
) -> int:
    """Write the shorter code into `out` and in `moved` where each row is now; the result is the number of rows.

    before, after: (., 5) instructions around the law, which is (l, 4) with its outputs as in Program; its operands are
    the rows `inputs`, then those from `first` on, its results those from `computed` on. kept: rows read from outside;
    arities: of the operations. ends: of the parts, as counted before; they become what they are in `out`. Rows that no
    instruction writes come first and in their order; rows of dropped results become -1.
    """
    code = _whole(before, law, outputs, after, inputs, first, computed)
    last = _last_uses(code, kept, arities, len(moved))
    _join(code, ends, kept, arities, last)
    moved[:] = 0
    for i in range(len(code)):
        moved[code[i, 1]] = -1
    total = 0
    for row in range(len(moved)):
        if moved[row] == 0:
            moved[row] = total
            total += 1
    free = np.empty(len(code) + 2, np.int32)
    free[0], free[1] = 0, total
    begin = written = 0
    for k in range(len(ends)):
        for i in range(begin, ends[k]):
            if last[code[i, 1]] >= 0:
                _release(code, i, arities, last, moved, free, total)
                if moved[code[i, 1]] < 0:  # else it came with its partner
                    _write(code, i, ends[k], last, moved, free, out[written])
                    written += 1
        begin, ends[k] = ends[k], written
    return int(free[1])
