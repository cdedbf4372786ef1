"""Trees of a population in postfix order, one row of an array each: grown, crossed and mutated.

Whatever is random is drawn by the caller; a row of uniforms in [0, 1) decides one tree.
"""

from typing import Any

from numba import types

from gpsynth.kernels.compile import CODE, INTEGERS, MATRIX, kernel
from gpsynth.kernels.data_code import CONSTANT, DIV, MAX, MIN, VARIABLE

_INTEGERS = types.Array(types.int32, 1, "C")
_GENOMES = types.Array(types.int32, 2, "C")
_NUMBERS = types.Array(types.float64, 2, "C")
_FLAT = types.Array(types.float64, 1, "C")
LEAVES, UNARIES = 0.35, 0.6  # cumulative odds of a leaf, a function of one operand, of two
NUMBERS = 0.2  # share of leaves that are numbers
RANGE = 5.0  # new numbers lie in [-RANGE, RANGE)
DRAWS = 3  # uniforms for one node that is grown
CHOICES = 8  # uniforms for one child


@kernel(types.int64(types.int64))
def arity(op: int) -> int:
    """Operands of an operation; leaves have none."""
    if op < 0:
        return 0
    return 2 if (op <= DIV) | (op == MAX) | (op == MIN) else 1


@kernel(types.void(INTEGERS, INTEGERS, types.int64, INTEGERS, MATRIX, _GENOMES, _NUMBERS))
def grow(
    unary: Any, binary: Any, variables: int, lengths: Any, uniforms: Any, genomes: Any, numbers: Any
) -> None:
    """Random trees of the given lengths (odd where there are no functions of one operand)."""
    for i in range(len(lengths)):
        open_ = 0
        for t in range(lengths[i]):
            remaining = lengths[i] - t - 1
            kind, which, value = (
                uniforms[i, DRAWS * t],
                uniforms[i, DRAWS * t + 1],
                uniforms[i, DRAWS * t + 2],
            )
            can_leaf = open_ <= remaining and (open_ == 0 or len(binary) > 0)  # else nobody takes two
            can_unary = (open_ >= 1) & (open_ - 1 <= remaining) & (len(unary) > 0)
            can_binary = (open_ >= 2) & (len(binary) > 0)
            numbers[i, t] = 0.0
            if can_leaf and (kind < LEAVES or not (can_unary or can_binary)):
                if value < NUMBERS:
                    genomes[i, t] = CONSTANT
                    numbers[i, t] = (2.0 * which - 1.0) * RANGE
                else:
                    genomes[i, t] = VARIABLE - int(which * variables)
                open_ += 1
            elif can_unary and (kind < UNARIES or not can_binary):
                genomes[i, t] = unary[int(which * len(unary))]
            else:
                genomes[i, t] = binary[int(which * len(binary))]
                open_ -= 1


@kernel(types.int64(_GENOMES, types.int64, types.int64))
def subtree(genomes: Any, i: int, last: int) -> int:
    """The first position of the subtree of tree i that ends at `last`."""
    missing, position = 1, last
    while missing > 0:
        missing += arity(genomes[i, position]) - 1
        position -= 1
    return position + 1


@kernel(
    types.void(
        *(INTEGERS, INTEGERS, types.int64, _GENOMES, _NUMBERS, INTEGERS, _GENOMES, _NUMBERS, INTEGERS, CODE),
        *(MATRIX, _GENOMES, _NUMBERS, _INTEGERS),
    )
)
def vary(
    unary: Any,
    binary: Any,
    variables: int,
    genomes: Any,
    numbers: Any,
    lengths: Any,
    donors: Any,
    donor_numbers: Any,
    donor_lengths: Any,
    mates: Any,
    choices: Any,
    children: Any,
    child_numbers: Any,
    child_lengths: Any,
) -> None:
    """Children (c, L): tree mates[c, 0], a subtree replaced by one of donor mates[c, 1], then perhaps a node changed.

    A child that would be too long is its first parent. choices (c, CHOICES): two cuts, whether to change a node, which,
    how, and how much.
    """
    longest = genomes.shape[1]
    for c in range(len(mates)):
        mother, father = mates[c, 0], mates[c, 1]
        last = int(choices[c, 0] * lengths[mother])
        first = subtree(genomes, mother, last)
        donor_last = int(choices[c, 1] * donor_lengths[father])
        donor_first = subtree(donors, father, donor_last)
        taken = donor_last - donor_first + 1
        length = lengths[mother] - (last - first + 1) + taken
        if length > longest or choices[c, 5] < 0.1:
            first, last, taken, length = 0, -1, 0, lengths[mother]
        for t in range(first):
            children[c, t], child_numbers[c, t] = genomes[mother, t], numbers[mother, t]
        for t in range(taken):
            children[c, first + t] = donors[father, donor_first + t]
            child_numbers[c, first + t] = donor_numbers[father, donor_first + t]
        for t in range(last + 1, lengths[mother]):
            place = t - last - 1 + first + taken
            children[c, place], child_numbers[c, place] = genomes[mother, t], numbers[mother, t]
        child_lengths[c] = length
        if choices[c, 2] < 0.4 or taken == 0:
            place = int(choices[c, 3] * length)
            op = children[c, place]
            if op == CONSTANT:
                child_numbers[c, place] = (
                    child_numbers[c, place] * (0.5 + choices[c, 4]) + choices[c, 6] - 0.5
                )
            elif op <= VARIABLE:
                children[c, place] = VARIABLE - int(choices[c, 4] * variables)
            elif arity(op) == 2:
                children[c, place] = binary[int(choices[c, 4] * len(binary))]
            else:
                children[c, place] = unary[int(choices[c, 4] * len(unary))]


@kernel(
    types.int64(_GENOMES, _NUMBERS, INTEGERS, _INTEGERS, _INTEGERS, _INTEGERS, _FLAT, _INTEGERS, _INTEGERS)
)
def flatten(
    genomes: Any, numbers: Any, lengths: Any, ops: Any, a: Any, b: Any, values: Any, roots: Any, stack: Any
) -> int:
    """The trees one after the other with their operands' positions; returns how many positions there are."""
    count = 0
    for i in range(len(lengths)):
        depth = 0
        for t in range(lengths[i]):
            op = genomes[i, t]
            ops[count], values[count] = op, numbers[i, t]
            a[count], b[count] = count, count
            operands = arity(op)
            if operands == 2:
                a[count], b[count] = stack[depth - 2], stack[depth - 1]
                depth -= 2
            elif operands == 1:
                a[count], b[count] = stack[depth - 1], stack[depth - 1]
                depth -= 1
            stack[depth] = count
            depth += 1
            count += 1
        roots[i] = count - 1
    return count
