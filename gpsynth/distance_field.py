"""Exact Euclidean distances on a grid, and lower bounds between its nodes (`kernels/field.py`).

What is occupied is a set of cells, closed squares between neighboring nodes, or any shape whose distance is known. The
point of a square that is nearest to a node is a node itself, so the distances of nodes from cells are those among
nodes: a Euclidean distance transform (Felzenszwalb & Huttenlocher 2012) gives them without any error.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt
from scipy.ndimage import distance_transform_edt

from gpsynth.arrays import Floats, frozen, shaped
from gpsynth.checks import check_number
from gpsynth.errors import ProblemError

FAR = 1e6  # m, from nothing
ROUNDING = 2.0**-53  # u
Cells = npt.NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class DistanceField:
    """Squared distances of a square grid's nodes from what is occupied; inside it, from what is not, negated.

    All that is occupied must lie within the grid.

    Raises ProblemError if these are no numbers, or fewer than two rows or columns.
    """

    squares: Floats  # (r, c), in row i and column j those of the node at corner + spacing (j, i)
    corner: Floats  # (2,) m, of the first node
    spacing: float  # m

    def __post_init__(self) -> None:
        check_number("the spacing of a distance field", self.spacing)
        if not 0.0 < self.spacing < np.inf:
            raise ProblemError(f"the spacing of a distance field must be positive, got {self.spacing}")
        object.__setattr__(self, "squares", shaped("squares", self.squares, (-1, -1)))
        object.__setattr__(self, "corner", shaped("corner", self.corner, (2,)))
        if min(self.squares.shape) < 2:
            raise ProblemError(
                f"a distance field has shape {self.squares.shape}; expected at least two rows and columns"
            )

    @cached_property
    def grid(self) -> Floats:
        """x, y of the first node and the spacing (3,)."""
        return frozen(np.array([*self.corner, self.spacing]))

    @cached_property
    def nodes(self) -> Floats:
        """x, y of the nodes (r, c, 2)."""
        rows, columns = self.squares.shape
        x = self.corner[0] + self.spacing * np.arange(columns)
        y = self.corner[1] + self.spacing * np.arange(rows)
        return np.stack(np.meshgrid(x, y), axis=-1)

    def at(self, points: Floats) -> Floats:
        """Lower bounds on the distances (...) of points (..., 2), negative inside; see `along`."""
        return self.along(points, points)

    def along(self, heads: Floats, tails: Floats) -> Floats:
        """Lower bounds on the least distances (...) along the straight lines between points (..., 2).

        At nodes they are exact but for rounding, which `proved_along` deducts; what is missing elsewhere is said in
        `kernels/field.py`.
        """
        return rooted(self._squares_along(_lines(heads, tails))).reshape(heads.shape[:-1])

    def proved_along(self, heads: Floats, tails: Floats) -> Floats:
        """The same, less what rounding can do.

        A computed square is off by a share of itself and of the square of the size of all that it is made of: s, the
        widths of the grid and the places seen from its corner. The interpolation of four squares of at most 2 (d^2 +
        s^2) is about 20 sums and products deep, and so are its slopes times the errors 2 u s of a place in a cell; a
        line doubles that, its square length being 8 s^2 at most. Nodes are off by u times their coordinates, which
        moves what is occupied by as much.
        """
        lines = _lines(heads, tails)
        found = self._squares_along(lines)
        size = self.spacing * max(self.squares.shape) + np.abs(lines - np.tile(self.corner, 2)).max(axis=1)
        roots = rooted(found - 1024.0 * ROUNDING * (np.abs(found) + size**2))
        proved: Floats = roots - 16.0 * ROUNDING * np.abs(self.corner).max()
        return proved.reshape(heads.shape[:-1])

    def _squares_along(self, lines: Floats) -> Floats:
        from gpsynth.kernels.field import squares_along

        found = np.empty(len(lines))
        squares_along(self.squares, self.grid, lines, found)
        return found

    def joined(self, squares: Floats) -> "DistanceField":
        """The field of what is occupied here and what another field on the same nodes has the squares of."""
        return DistanceField(np.minimum(self.squares, squares), self.corner, self.spacing)


def _lines(heads: Floats, tails: Floats) -> Floats:
    """Straight lines (n, 4) between points (..., 2), read-only."""
    lines = np.ascontiguousarray(np.concatenate([heads, tails], axis=-1).reshape(-1, 4))
    lines.setflags(write=False)
    return lines


def rooted(squares: Floats) -> Floats:
    """Distances of squared distances, the sign kept."""
    roots: Floats = np.copysign(np.sqrt(np.abs(squares)), squares)
    return roots


def field_of_cells(
    occupied: Cells, corner: npt.ArrayLike, spacing: float, *, parts: int = 1
) -> DistanceField:
    """The field of occupied cells (r, c) of a width of `spacing` (m) from `corner` on, row 0 at the least y.

    With `parts` each cell is cut into so many by so many first.
    """
    cells = np.repeat(np.repeat(occupied, parts, axis=0), parts, axis=1)
    width = spacing / parts
    outside, inside = _squares_from(_corners(cells)), _squares_from(_corners(~np.pad(cells, 1))[1:-1, 1:-1])
    squares = np.where(np.isinf(outside), FAR**2, width**2 * (outside - inside))
    return DistanceField(squares, np.asarray(corner, dtype=np.float64), width)


def squares_of_shapes(nodes_of: DistanceField, segments: Floats, polygons: Sequence[Floats]) -> Floats:
    """Squared distances (r, c) of a field's nodes from segments (s, 4) and polygons (n, 2), negative inside of these.

    Filled is what has an odd number of edges of a polygon to its right.
    """
    from gpsynth.kernels.field import squares_to_edges

    around = [np.hstack([corners, np.roll(corners, -1, axis=0)]) for corners in polygons]
    numbers = [np.full(len(edges), number) for number, edges in enumerate(around)]
    edges = frozen(np.vstack([segments, *around]))
    owners = frozen(np.concatenate([np.full(len(segments), -1), *numbers]).astype(np.int32))
    squares = np.empty_like(nodes_of.squares)
    squares_to_edges(edges, owners, nodes_of.grid, squares)
    return squares


def _corners(cells: Cells) -> Cells:
    """The nodes (r + 1, c + 1) that are a corner of one of the cells (r, c)."""
    padded = np.pad(cells, 1)
    return padded[:-1, :-1] | padded[:-1, 1:] | padded[1:, :-1] | padded[1:, 1:]


def _squares_from(nodes: Cells) -> Floats:
    """Squared distances to the nearest of the nodes in spacings, whole numbers; infinity if there is none."""
    if not nodes.any():
        return np.full(nodes.shape, np.inf)
    squares: Floats = np.rint(distance_transform_edt(~nodes) ** 2)
    return squares
