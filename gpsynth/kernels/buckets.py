"""A broad phase for many circles at rest: which of them can be the nearest from anywhere in a cell of a grid.

Let g_k(p) be the gap between p and circle k, and c the center of a cell with half diagonal h. Along a chord that begins
in the cell and is at most `reach` long, no gap differs from that at c by more than h + reach. So the circle that is
nearest at some point of it has a gap at c of at most min_j g_j(c) + 2 (h + reach): only such ones are looked at there.
The least gap along the chord is that over all circles, to the last bit, as a minimum is one of its arguments.
"""

import math

import numpy as np
from numba import types

from gpsynth.arrays import Floats, Ints
from gpsynth.kernels.compile import MATRIX, OUT_INTEGERS, VECTOR, kernel, part
from gpsynth.kernels.layout import Buckets, sealed

MANY = 48  # circles at rest from which on the broad phase pays
CELLS = 16  # of the grid, a circle
AROUND = (
    0.15  # of their extent, that the grid reaches beyond their centers; farther out all of them are looked at
)
BLOCK = 8  # cells to a side of a block, which is laid out in one go
SLACK = 1e-6  # m, for rounding: of where a cell ends, and of gaps

NONE = sealed(Buckets(np.zeros(0, dtype=np.int32), np.zeros(0, dtype=np.int32), np.zeros(6)))


def buckets(circles: Floats) -> Buckets:
    """The buckets of circles at rest, (o, 5) x, y, vx, vy, radius; none where all of them are as soon looked at."""
    if len(circles) < MANY:
        return NONE
    low, high = circles[:, :2].min(axis=0), circles[:, :2].max(axis=0)
    low, high = low - AROUND * (high - low), high + AROUND * (high - low)
    side = math.sqrt(float(np.prod(high - low)) / (CELLS * len(circles)))
    if not side > SLACK:
        return NONE
    columns, rows = (int(count) for count in np.ceil((high - low) / side))
    lattice = np.array([low[0], low[1], side, columns, rows, 0.5 * side])
    firsts = np.zeros(columns * rows + 1, dtype=np.int32)
    around = np.empty(len(circles), dtype=np.int32)
    fill(circles, lattice, around, firsts, np.empty(0, dtype=np.int32))
    firsts = np.concatenate([[0], np.cumsum(firsts[1:])]).astype(np.int32)
    members = np.empty(firsts[-1], dtype=np.int32)
    fill(circles, lattice, around, firsts, members)
    return sealed(Buckets(firsts, members, lattice))


@part
def gap(circles: Floats, k: int, x: float, y: float) -> float:
    """How far circle k is from a point."""
    dx, dy = x - circles[k, 0], y - circles[k, 1]
    return float(math.sqrt(dx * dx + dy * dy) - circles[k, 4])


@kernel(types.void(MATRIX, VECTOR, OUT_INTEGERS, OUT_INTEGERS, OUT_INTEGERS))
def fill(circles: Floats, lattice: Floats, around: Ints, firsts: Ints, members: Ints) -> None:
    """Count the circles of every cell into `firsts`, one place behind; or if there are `members`, write their numbers.

    Those of a cell are sought among those of its block, which by the same argument are all that can be there. around:
    room for as many numbers as there are circles.
    """
    left, low, side, columns, rows = lattice[0], lattice[1], lattice[2], int(lattice[3]), int(lattice[4])
    margin, across = lattice[5] + SLACK, -(-columns // BLOCK)
    for block in range(-(-rows // BLOCK) * across):
        first_row, first_column = BLOCK * (block // across), BLOCK * (block % across)
        x, y = left + side * (first_column + 0.5 * BLOCK), low + side * (first_row + 0.5 * BLOCK)
        least, known = np.inf, 0
        for k in range(len(circles)):
            least = min(least, gap(circles, k, x, y))
        for k in range(len(circles)):
            if gap(circles, k, x, y) <= least + 2.0 * (BLOCK * side * math.sqrt(0.5) + margin):
                around[known] = k
                known += 1
        for row in range(first_row, min(first_row + BLOCK, rows)):
            for column in range(first_column, min(first_column + BLOCK, columns)):
                cell, count = row * columns + column, 0
                x, y = left + side * (column + 0.5), low + side * (row + 0.5)
                least = np.inf
                for n in range(known):
                    least = min(least, gap(circles, around[n], x, y))
                for n in range(known):
                    if gap(circles, around[n], x, y) <= least + 2.0 * (side * math.sqrt(0.5) + margin):
                        if len(members) > 0:
                            members[firsts[cell] + count] = around[n]
                        count += 1
                if len(members) == 0:
                    firsts[cell + 1] = count
