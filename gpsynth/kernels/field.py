"""Lower bounds from a distance field: squared distances d^2 at the nodes of a square grid, negative where occupied.

d^2 is the least of |p - q|^2 over the occupied points q, so d^2 - |p|^2 is the least of linear functions of p: it is
concave, and lies above its chords. Hence d^2 lies above the bilinear interpolation of its values at the corners of a
cell of width h, less s (1 - s) h^2 + t (1 - t) h^2 for s and t across the cell, and along a line of length L above the
linear interpolation between its ends, less s (1 - s) L^2. Neither bound knows of any constant of the obstacles. At most
h^2 / 2 + L^2 / 4 is missing of d^2 where one point of the obstacles is nearest all around, at nodes nothing; between
two obstacles, where d has a ridge, it is h / sqrt 2 + L / 2 of d besides. A negative value stands where d is 0, so the
bounds hold there too.
"""

import numba

from gpsynth.arrays import Floats, Ints
from gpsynth.kernels.compile import INTEGERS, MATRIX, OUT_MATRIX, OUT_VECTOR, VECTOR, kernel, part


@part
def square_at(squares: Floats, grid: Floats, x: float, y: float) -> float:
    """A lower bound on d^2 (m^2) at a point.

    Outside of the grid, which holds all obstacles, an obstacle is seen at an obtuse angle from the nearest point of the
    grid, so the squared distance to there adds to that from there.
    """
    spacing, rows, columns = grid[2], squares.shape[0], squares.shape[1]
    across, up = (x - grid[0]) / spacing, (y - grid[1]) / spacing
    u, v = (across if across > 0.0 else 0.0), (up if up > 0.0 else 0.0)  # NaN becomes 0
    u, v = (u if u < columns - 1.0 else columns - 1.0), (v if v < rows - 1.0 else rows - 1.0)
    j, i = min(int(u), columns - 2), min(int(v), rows - 2)
    s, t = u - j, v - i
    below = squares[i, j] + s * (squares[i, j + 1] - squares[i, j])
    above = squares[i + 1, j] + s * (squares[i + 1, j + 1] - squares[i + 1, j])
    beyond = (across - u) * (across - u) + (up - v) * (up - v) - s * (1.0 - s) - t * (1.0 - t)
    return float(below + t * (above - below) + spacing * spacing * beyond)


@part
def least_square(first: float, last: float, length: float) -> float:
    """A lower bound on d^2 along a straight line, given those at its ends and its squared length (m^2)."""
    difference = last - first
    s = 0.5 - 0.5 * difference / (length if length > 0.0 else 1.0)
    s = (s if s > 0.0 else 0.0) if length > 0.0 else 0.0
    s = s if s < 1.0 else 1.0
    least = first + s * (difference - (1.0 - s) * length)
    return min(first, last, least)


@kernel(numba.types.void(MATRIX, VECTOR, MATRIX, OUT_VECTOR))
def squares_along(squares: Floats, grid: Floats, lines: Floats, out: Floats) -> None:
    """Lower bounds on d^2 along straight lines (n, 4) of x, y and x, y, into out (n,)."""
    for k in range(len(lines)):
        x0, y0, x1, y1 = lines[k, 0], lines[k, 1], lines[k, 2], lines[k, 3]
        first, last = square_at(squares, grid, x0, y0), square_at(squares, grid, x1, y1)
        out[k] = least_square(first, last, (x1 - x0) * (x1 - x0) + (y1 - y0) * (y1 - y0))


@kernel(numba.types.void(MATRIX, INTEGERS, VECTOR, OUT_MATRIX))
def squares_to_edges(edges: Floats, polygons: Ints, grid: Floats, out: Floats) -> None:
    """d^2 of the nodes of a grid from straight lines (e, 4), into out (r, c), negative inside of polygons.

    polygons (e,): which one a line is an edge of, those of one in a row, or -1; what has an odd number of edges to its
    right is inside.
    """
    for i in range(out.shape[0]):
        y = grid[1] + grid[2] * i
        for j in range(out.shape[1]):
            x = grid[0] + grid[2] * j
            least, inside, odd = 1e300, False, False
            for k in range(len(edges)):
                x0, y0, dx, dy = (
                    edges[k, 0],
                    edges[k, 1],
                    edges[k, 2] - edges[k, 0],
                    edges[k, 3] - edges[k, 1],
                )
                odd = odd and k > 0 and polygons[k] == polygons[k - 1]
                if polygons[k] >= 0 and (y0 > y) != (edges[k, 3] > y) and x < x0 + (y - y0) * dx / dy:
                    odd = not odd
                inside = inside or (odd and (k + 1 == len(edges) or polygons[k + 1] != polygons[k]))
                square = dx * dx + dy * dy
                s = ((x - x0) * dx + (y - y0) * dy) / (square if square > 0.0 else 1.0)
                s = 0.0 if s < 0.0 else (1.0 if s > 1.0 else s)
                px, py = x - x0 - s * dx, y - y0 - s * dy
                least = min(least, px * px + py * py)
            out[i, j] = -least if inside else least
