"""Small variations of a network operator: four kinds of change that keep any matrix valid (Diveev 2012)."""

from typing import NamedTuple

import numpy as np

from gpsynth.arrays import Ints
from gpsynth.encodings import solution
from gpsynth.encodings.solution import Functions

REPLACE_UNARY, REPLACE_BINARY, ADD_EDGE, DELETE_EDGE = range(4)


class Variation(NamedTuple):
    """w = [w1, w2, w3, w4]; (0, 0, 0, ·) changes nothing."""

    kind: int
    row: int
    column: int
    function: int  # number of a unary or binary function


IDENTITY = Variation(REPLACE_UNARY, 0, 0, 0)


def applies(psi: Ints, variation: solution.Variation) -> bool:
    """Whether the guard of this variation lets it change the matrix."""
    kind, row, column, _ = variation
    if kind in (REPLACE_UNARY, REPLACE_BINARY):
        return bool(psi[row, column] != 0)
    if kind == ADD_EDGE:
        return bool(psi[row, column] == 0 and psi[column, column] != 0)
    incoming = np.count_nonzero(psi[:column, column])
    outgoing = np.count_nonzero(psi[row, row + 1 :])
    return bool(incoming > 1 and outgoing > 1)


def vary(psi: Ints, variations: tuple[solution.Variation, ...]) -> Ints:
    """A copy of the matrix after these variations in their order; those whose guard fails are passed over."""
    varied = psi.copy()
    for variation in variations:
        if applies(varied, variation):
            kind, row, column, function = variation
            varied[row, column] = 0 if kind == DELETE_EDGE else function
    return varied


def random_variation(psi: Ints, functions: Functions, rng: np.random.Generator) -> Variation:
    """Any kind, any place of it, any of the functions; often one that does not apply, as in the 2022 program."""
    unary, binary = functions
    kind = int(rng.integers(4))
    size = len(psi)
    if kind == REPLACE_BINARY:
        row = int(rng.integers(size))
        while psi[row, row] == 0:
            row = (row + 1) % size
        return Variation(kind, row, row, binary[int(rng.integers(len(binary)))])
    row = int(rng.integers(size - 1))
    column = row + 1 + int(rng.integers(size - row - 1))
    return Variation(kind, row, column, unary[int(rng.integers(len(unary)))])


def is_variation(variation: solution.Variation, size: int, functions: Functions) -> bool:
    """Whether this could be drawn for a matrix of `size` nodes, or changes nothing."""
    if len(variation) != 4 or not all(type(entry) is int for entry in variation):
        return False
    if variation == IDENTITY:
        return True
    unary, binary = functions
    kind, row, column, function = variation
    if kind == REPLACE_BINARY:
        return 0 <= row == column < size and function in binary
    return 0 <= kind <= DELETE_EDGE and 0 <= row < column < size and function in unary
