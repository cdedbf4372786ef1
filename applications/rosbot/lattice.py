"""Routes through a mapped room: shortest paths on a lattice, one for each way around what stands free, drawn taut.

Every lattice point of both trees of shortest paths, from the start and to the goal, stands for the way through it. How
far a way turns around a point inside an island of obstacles differs between two ways by whole turns, and by none for
all islands exactly if one can be drawn into the other.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.ndimage import label
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import dijkstra

from gpsynth.arrays import Floats, frozen
from gpsynth.distance_field import DistanceField

SPACINGS = (
    0.1,
    0.05,
    0.025,
)  # m, between the points of a lattice: the next where the one before finds no way
MOST_POINTS = 500_000
MOST_ISLANDS = 60  # the largest of them count
LONGER = (1.8, 1.0)  # ways that are so many times longer than the shortest, and so many meters, are left out
STEP = 0.05  # m, of a way while it is drawn taut
STEPS = ((0, 1), (1, 0), (1, 1), (1, -1))  # rows and columns from a point to its neighbors; and back
EVERYWHERE = frozen(np.array([-np.inf, np.inf] * 2))  # bounds of x and y

Indices = npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Lattice:
    """Points in rows, which of them are free, and the straight lines between neighbors that are."""

    points: Floats  # (r, c, 2)
    free: npt.NDArray[np.bool_]  # (r, c)
    graph: csr_array  # (r c, r c) lengths in m

    def index(self, place: Floats) -> tuple[int, int]:
        """Row and column of the point that is nearest to a place (2,)."""
        first, beyond = self.points[0, 0], self.points[-1, -1]
        spread = np.array(self.free.shape[::-1]) - 1
        column, row = np.rint(spread * np.clip((place - first) / np.maximum(beyond - first, 1e-9), 0.0, 1.0))
        return int(row), int(column)


def ways(
    start: Floats,
    goal: Floats,
    field: DistanceField,
    clearance: float,
    *,
    count: int,
    bounds: Floats = EVERYWHERE,
) -> list[Floats]:
    """Up to `count` polylines (n, 2) that keep `clearance` (m) from what a field is of, the shortest first.

    They stay within bounds (4,) of x and y. Start and goal (2,) are joined to the nearest free points of the lattice,
    whatever is between.
    """
    for lattice in lattices(field, clearance, bounds):
        found = _ways(lattice, start, goal, count)
        if found:
            islands = _islands(lattice)
            return [taut(way, field, clearance, islands) for way in found]
    return []


def lattices(field: DistanceField, clearance: float, bounds: Floats) -> Iterator[Lattice]:
    """Lattices over a field, each finer than the one before, that have free points."""
    for spacing in SPACINGS:
        lattice = lattice_of(field, clearance, max(spacing, _least_spacing(field)), bounds)
        if lattice.free.any():
            yield lattice


def _least_spacing(field: DistanceField) -> float:
    rows, columns = field.squares.shape
    return field.spacing * float(np.sqrt(rows * columns / MOST_POINTS))


def lattice_of(field: DistanceField, clearance: float, spacing: float, bounds: Floats) -> Lattice:
    """The lattice over a field, within bounds (4,) of x and y, its lines proved to keep `clearance` (m)."""
    rows, columns = field.squares.shape
    x, y = (np.arange(0.0, field.spacing * (n - 1), spacing) for n in (columns, rows))
    points = np.stack(np.meshgrid(field.corner[0] + x, field.corner[1] + y), axis=-1)
    low, high = bounds.reshape(2, 2).T
    free = (field.at(points) >= clearance) & np.all((low <= points) & (points <= high), axis=-1)
    number = np.arange(free.size).reshape(free.shape)
    heads, tails = [], []
    for down, right in STEPS:
        one = np.s_[: len(y) - down, max(-right, 0) : len(x) - max(right, 0)]
        other = np.s_[down:, max(right, 0) : len(x) + min(right, 0)]
        both = free[one] & free[other]
        heads.append(number[one][both])
        tails.append(number[other][both])
    head, tail = np.concatenate(heads), np.concatenate(tails)
    places = points.reshape(-1, 2)
    clear = field.along(places[head], places[tail]) >= clearance
    head, tail = head[clear], tail[clear]
    lengths = np.hypot(*(places[tail] - places[head]).T)
    graph = csr_array(coo_array((lengths, (head, tail)), shape=(free.size, free.size)))
    return Lattice(points, free, graph)


def _ways(lattice: Lattice, start: Floats, goal: Floats, count: int) -> list[Floats]:
    """The shortest way of each class that a point of the lattice stands for."""
    places = lattice.points.reshape(-1, 2)
    ends = [_nearest(lattice, point) for point in (start, goal)]
    lengths, before = dijkstra(lattice.graph, directed=False, indices=ends, return_predecessors=True)
    total = lengths.sum(axis=0)
    shortest = total.min()
    if not np.isfinite(shortest):
        return []
    kept = np.flatnonzero(total <= LONGER[0] * shortest + LONGER[1])  # with the ways to both ends
    islands = _islands(lattice)
    turns = np.subtract(*(_turned(places, parents, kept, islands) for parents in before))
    ranks = np.argsort(total[kept], kind="stable")
    whole = np.rint((turns[ranks] - turns[ranks[0]]) / (2.0 * np.pi)).astype(np.int64)
    found = []
    for node in kept[ranks[_distinct(whole)[:count]]].tolist():
        there, back = (chain(parents, node) for parents in before)
        found.append(np.vstack([start, places[there[::-1] + back[1:]], goal]))
    return found


def _nearest(lattice: Lattice, point: Floats) -> int:
    apart = np.hypot(*(lattice.points - point).transpose(2, 0, 1))
    return int(np.argmin(np.where(lattice.free, apart, np.inf)))


def chain(before: Indices, node: int) -> list[int]:
    """The points from one to the root of a tree."""
    found = [node]
    while before[found[-1]] >= 0:
        found.append(int(before[found[-1]]))
    return found


def _islands(lattice: Lattice) -> Floats:
    """A point (i, 2) in each of the largest pieces of what is not free, but for those at the rim."""
    pieces, count = label(~lattice.free, structure=np.ones((3, 3)))
    rim = np.unique(np.concatenate([pieces[0], pieces[-1], pieces[:, 0], pieces[:, -1]]))
    sizes = np.bincount(pieces.ravel(), minlength=count + 1)
    sizes[rim] = 0
    sizes[0] = 0
    largest = np.argsort(-sizes, kind="stable")[:MOST_ISLANDS]
    first = [int(np.argmax(pieces.ravel() == piece)) for piece in largest if sizes[piece] > 0]
    # beside the point itself, so that no line of the lattice runs through it
    return lattice.points.reshape(-1, 2)[first] + 1e-3


def _turned(places: Floats, before: Indices, kept: Indices, islands: Floats) -> Floats:
    """How far (k, i) the ways from the root of a tree to some of its points turn around the islands, in rad.

    All points on these ways must be among them. Each knows the turn of its last line; doubling how far back a point
    looks sums up all lines of its way.
    """
    own = np.arange(len(kept))
    rank = np.zeros(len(before), dtype=np.int64)
    rank[kept] = own
    parent = np.where(before[kept] < 0, own, rank[before[kept].clip(0)])
    angles = _bearings(places[kept], islands)
    turned = _wrapped(angles - angles[parent])
    while np.any(parent != parent[parent]):
        turned = turned + turned[parent]
        parent = parent[parent]
    return turned


def _distinct(rows: Indices) -> list[int]:
    """The numbers of the rows (n, i) that are like none before them."""
    firsts: dict[bytes, int] = {}
    for number, row in enumerate(np.ascontiguousarray(rows, dtype=np.int16)):
        firsts.setdefault(row.tobytes(), number)
    return list(firsts.values())


def _bearings(places: Floats, islands: Floats) -> Floats:
    """The directions (n, i) of places seen from the islands, in rad."""
    apart = places[:, np.newaxis] - islands
    bearings: Floats = np.arctan2(apart[..., 1], apart[..., 0])
    return bearings


def _wrapped(angles: Floats) -> Floats:
    wrapped: Floats = np.remainder(angles + np.pi, 2.0 * np.pi) - np.pi
    return wrapped


def taut(way: Floats, field: DistanceField, clearance: float, islands: Floats) -> Floats:
    """A way (n, 2) cut short as far as `clearance` (m) allows without passing an island on its other side."""
    for _ in range(3):
        way = _shortened(_divided(way), field, clearance, islands)
    return way


def _divided(way: Floats) -> Floats:
    ends = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(way, axis=0).T))])
    at = np.union1d(ends, np.arange(0.0, ends[-1], STEP))
    return np.column_stack([np.interp(at, ends, values) for values in way.T])


def _shortened(way: Floats, field: DistanceField, clearance: float, islands: Floats) -> Floats:
    """From each point that is kept straight on to the last one in sight."""
    bearings = _bearings(way, islands)
    turned = np.cumsum(_wrapped(np.diff(bearings, axis=0, prepend=bearings[:1])), axis=0)
    kept, last = [0], len(way) - 1
    while kept[-1] < last:
        here = kept[-1]
        ahead = way[here + 1 :]
        seen = (
            here
            + 1
            + np.flatnonzero(field.along(np.broadcast_to(way[here], ahead.shape), ahead) >= clearance)
        )
        straight = _wrapped(bearings[seen] - bearings[here])
        same = np.all(np.abs(turned[seen] - turned[here] - straight) < np.pi, axis=1)
        kept.append(int(np.max(seen[same], initial=here + 1)))
    return frozen(way[kept])
