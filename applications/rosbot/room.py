"""A mapped room: occupied cells, polygons and segments, with their exact distances and a field of them."""

from dataclasses import dataclass, field
from functools import cached_property, lru_cache

import numpy as np
import numpy.typing as npt
from scipy.spatial import cKDTree

from gpsynth.arrays import Floats, frozen, shaped
from gpsynth.checks import check_kind
from gpsynth.distance_field import Cells, DistanceField, field_of_cells, squares_of_shapes
from gpsynth.errors import ScenarioError

MOST_NODES = 4_000_000  # of a field
AROUND = 0.5  # m around everything, where the field is still a grid
SAMPLES = 8  # of an edge of a cell, a power of two


@dataclass(frozen=True, eq=False)
class Room:
    """What stands around besides circles. Raises ScenarioError if it is nothing, or more than a field can hold."""

    cells: Cells = field(default_factory=lambda: np.zeros((0, 0), dtype=np.bool_))  # row 0 at the least y
    corner: tuple[float, float] = (0.0, 0.0)  # m, of the first cell
    width: float = 0.05  # m, of a cell; without cells the most that nodes of the field are apart
    polygons: tuple[
        Floats, ...
    ] = ()  # (n, 2) corners in m, filled where a ray crosses an odd number of edges
    segments: Floats = field(default_factory=lambda: np.zeros((0, 4)))  # (s, 4) m, x and y of both ends

    def __post_init__(self) -> None:
        object.__setattr__(self, "cells", frozen(np.asarray(self.cells, dtype=np.bool_)))
        check_kind("polygons", self.polygons, list, tuple, error=ScenarioError)
        polygons = tuple(shaped("a polygon", each, (-1, 2)) for each in self.polygons)
        if any(len(corners) < 3 for corners in polygons):
            raise ScenarioError(f"a polygon has {min(map(len, polygons))} corners; expected at least 3")
        object.__setattr__(self, "polygons", polygons)
        object.__setattr__(self, "segments", shaped("segments", self.segments, (-1, 4)))
        if not (self.cells.any() or self.polygons or len(self.segments)):
            raise ScenarioError(
                "the room is empty: its map has no occupied cell, and there is nothing else in it"
            )
        _check_size(self.box, self.width)

    @cached_property
    def edges(self) -> Floats:
        """The segments and the edges of the polygons (e, 4)."""
        around = [np.hstack([corners, np.roll(corners, -1, axis=0)]) for corners in self.polygons]
        return np.vstack([self.segments, *around])

    @cached_property
    def box(self) -> Floats:
        """The least and the greatest x and y (2, 2) of all there is."""
        corner, (rows, columns) = np.asarray(self.corner), self.cells.shape
        ends = [self.edges.reshape(-1, 2)]
        if self.cells.size:
            ends.append(np.array([corner, corner + self.width * np.array([columns, rows])]))
        points = np.concatenate(ends)
        return np.stack([points.min(axis=0), points.max(axis=0)])

    @property
    def roughness(self) -> float:
        """How much `gaps` may be less than the distance to the nearest sample of the cells' boundary, m."""
        return 0.5 * self.width / SAMPLES if self.cells.any() else 0.0

    def gaps(self, points: Floats) -> Floats:
        """The distances (N,) of points (N, 2), negative inside a polygon, 0 inside a cell.

        They are exact for polygons and segments. The boundary of the cells is sampled, corners included; where a sample
        is nearest at a distance d, the boundary is no nearer than the root of d^2 less the square of half the spacing,
        and that is given.
        """
        gaps = np.full(len(points), np.inf)
        for edge in self.edges:
            gaps = np.minimum(gaps, _distances(points, edge))
        inside = np.zeros(len(points), dtype=np.bool_)
        for corners in self.polygons:
            inside |= _inside(points, corners)
        gaps = np.where(inside, -gaps, gaps)
        if not self.cells.any():
            return gaps
        nearest = self._boundary.query(points)[0]
        beside = np.sqrt(np.maximum(nearest**2 - self.roughness**2, 0.0))
        least: Floats = np.minimum(gaps, np.where(self._covers(points), 0.0, beside))
        return least

    def field(self, spacing: float, places: Floats | None = None) -> DistanceField:
        """The distance field, its nodes at most `spacing` (m) apart, or as far as MOST_NODES allow.

        It reaches AROUND (m) beyond all there is and beyond the places (n, 2), these taken to whole meters, so that
        scenes of one room share a field.
        """
        low, high = self.box
        if places is not None:
            low = np.minimum(low, np.floor(places.min(axis=0)))
            high = np.maximum(high, np.ceil(places.max(axis=0)))
        return _field(self, spacing, tuple((low - AROUND).tolist()), tuple((high + AROUND).tolist()))

    def grid(self, spacing: float, low: Floats, high: Floats) -> DistanceField:
        """The distance field from one corner (2,) to another."""
        _check_size(np.stack([low, high]), self.width)
        least = float(np.sqrt(np.prod(high - low + self.width) / MOST_NODES))
        parts = max(1, int(np.ceil(self.width / max(spacing, least) - 1e-9)))
        corner = np.asarray(self.corner) if self.cells.size else low
        (left, below), (columns, rows) = self._cells_from(low, corner), self._cells_from(corner, high)
        cells = np.zeros((below + max(rows, 1), left + max(columns, 1)), dtype=np.bool_)
        cells[below : below + len(self.cells), left : left + self.cells.shape[1]] = self.cells
        corner = corner - self.width * np.array([left, below])
        found = field_of_cells(cells, corner, self.width, parts=parts)
        if len(self.edges):
            found = found.joined(squares_of_shapes(found, self.segments, self.polygons))
        return found

    def _cells_from(self, low: Floats, high: Floats) -> tuple[int, int]:
        """How many cells it takes from one point to another, along x and y."""
        columns, rows = np.ceil((high - low) / self.width - 1e-9).astype(int).tolist()
        return columns, rows

    def _covers(self, points: Floats) -> npt.NDArray[np.bool_]:
        """Which points (N, 2) are in an occupied cell."""
        index = np.floor((points - self.corner) / self.width).astype(int)[:, ::-1]
        within = np.all((index >= 0) & (index < self.cells.shape), axis=1)
        row, column = np.where(within[:, np.newaxis], index, 0).T
        covers: Cells = within & self.cells[row, column]
        return covers

    @cached_property
    def _boundary(self) -> cKDTree:
        """Points on the edges between occupied cells and others, SAMPLES for each and the corners."""
        padded = np.pad(self.cells, 1)
        upright = np.argwhere(padded[1:-1, 1:] != padded[1:-1, :-1])[:, ::-1]  # column, row of the lower end
        level = np.argwhere(padded[1:, 1:-1] != padded[:-1, 1:-1])[:, ::-1]
        shares = np.arange(SAMPLES + 1)[:, np.newaxis, np.newaxis] / SAMPLES
        along = [upright + shares * [0.0, 1.0], level + shares * [1.0, 0.0]]
        samples = np.unique(np.concatenate([part.reshape(-1, 2) for part in along]), axis=0)
        return cKDTree(np.asarray(self.corner) + self.width * samples)


@lru_cache(maxsize=2)  # a loop asks for the field of one room again and again
def _field(room: Room, spacing: float, low: tuple[float, ...], high: tuple[float, ...]) -> DistanceField:
    return room.grid(spacing, np.array(low), np.array(high))


def _check_size(box: Floats, width: float) -> None:
    size = np.ptp(box, axis=0)
    if np.prod(size / width + 1.0) > MOST_NODES:
        raise ScenarioError(
            f"the map, polygons and segments, with start, goal and circles, reach over {size[0]:g} m x {size[1]:g} m; "
            f"expected at most {MOST_NODES} cells of {width:g} m"
        )


def _distances(points: Floats, edge: Floats) -> Floats:
    """Distances (N,) of points (N, 2) from a segment (4,)."""
    start, along = edge[:2], edge[2:] - edge[:2]
    square = along @ along
    x, y = (points - start).T
    share = np.clip((x * along[0] + y * along[1]) / (square if square > 0.0 else 1.0), 0.0, 1.0)
    distances: Floats = np.hypot(x - share * along[0], y - share * along[1])
    return distances


def _inside(points: Floats, corners: Floats) -> npt.NDArray[np.bool_]:
    """Which points (N, 2) have an odd number of edges of a polygon to their right."""
    x, y = points.T
    inside = np.zeros(len(points), dtype=np.bool_)
    for (x0, y0), (x1, y1) in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        if y0 != y1:
            inside ^= ((y0 > y) != (y1 > y)) & (x < x0 + (y - y0) * (x1 - x0) / (y1 - y0))
    return inside
