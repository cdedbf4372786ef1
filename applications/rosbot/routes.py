"""The shortest routes of distinct homotopy classes around the obstacles: where a plan may look for its way."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import numpy.typing as npt
from scipy.sparse.csgraph import dijkstra

from applications.rosbot.discs import clear_of, grown, outermost
from applications.rosbot.lattice import ways
from applications.rosbot.scenario import Scenario
from applications.rosbot.tangents import TangentGraph, tangent_graph
from gpsynth.arrays import Floats, frozen
from gpsynth.distance_field import DistanceField

SPACING = np.deg2rad(7.5)  # between the vertices on an arc
FEW = 50  # discs that are all looked at
SAME = 1e-7  # m; lengths of routes that differ by less belong to one route


@dataclass(frozen=True, eq=False)
class Route:
    """A taut string from start to goal: a polyline with its vertices on straight lines and arcs around obstacles."""

    points: Floats  # (n, 2) m
    length: float  # m, of the lines and arcs; the polyline is shorter by its chords

    def poses(self, ways: Floats) -> Floats:
        """The points after so many meters, (N,), with the heading along the route, (N, 3)."""
        steps = np.diff(self.points, axis=0)
        ends = np.concatenate([[0.0], np.cumsum(np.hypot(*steps.T))])
        ways = np.clip(ways, 0.0, ends[-1])
        x, y = (np.interp(ways, ends, values) for values in self.points.T)
        piece = np.clip(np.searchsorted(ends, ways, side="right") - 1, 0, len(steps) - 1)
        return np.column_stack([x, y, np.arctan2(steps[piece, 1], steps[piece, 0])])


def routes(scenario: Scenario, *, count: int = 5, margin: float = 0.0) -> list[Route]:
    """Up to `count` routes of distinct homotopy class for the robot's center, the shortest first.

    They keep `margin` (m) besides the robot's radius where start and goal allow it. Obstacles count where they are at
    time 0. Classes that are longer than 1.8 times the shortest plus 1 m are left out. In a room the routes are those of
    a lattice (`lattice.py`).
    """
    if scenario.field is not None:
        return routes_in_room(scenario, scenario.field, count, scenario.radius + margin)
    start, goal = scenario.start[:2], scenario.goal[:2]
    discs = clear_of(clear_of(grown(scenario.discs, margin), start), goal)
    return shortest_routes(start, goal, discs, scenario.bounds, count=count)


def routes_in_room(scenario: Scenario, field: DistanceField, count: int, clearance: float) -> list[Route]:
    """Routes that keep `clearance` (m) from the scenario's circles and from what a field is of."""
    field = with_discs(field, scenario.circles[:, [0, 1, 4]])
    ends = scenario.start[:2], scenario.goal[:2]
    found = ways(*ends, field, clearance, bounds=scenario.bounds, count=count)
    return [Route(way, float(np.hypot(*np.diff(way, axis=0).T).sum())) for way in found]


def with_discs(field: DistanceField, discs: Floats) -> DistanceField:
    """The field of what it is of and of discs (c, 3) besides."""
    for x, y, radius in discs:
        gaps = np.hypot(*(field.nodes - [x, y]).transpose(2, 0, 1)) - radius
        field = field.joined(gaps * np.abs(gaps))
    return field


def shortest_routes(start: Floats, goal: Floats, discs: Floats, bounds: Floats, *, count: int) -> list[Route]:
    """The routes between two points (2,) outside of discs (c, 3), within bounds (4,).

    No way of some length touches a disc by which there is no way as short. So of many discs only those are looked at
    that the longest route may touch.
    """
    straight = float(np.hypot(*(goal - start)))
    if straight < SAME:
        return [Route(frozen(np.array([start, goal])), 0.0)]
    there, back = (np.hypot(*(discs[:, :2] - end).T) for end in (start, goal))
    ways = there + back - 2.0 * discs[:, 2]
    reach = _longest(1.25 * straight) if len(discs) > FEW else np.inf
    while True:
        near = ways <= reach
        found = _taut_routes(start, goal, discs[near], bounds, count)
        if not found or np.all(near) or _longest(found[0].length) <= reach:
            return found
        reach = _longest(found[0].length)


def _longest(shortest: float) -> float:
    """How long (m) a route may be."""
    return 1.8 * shortest + 1.0


def _taut_routes(start: Floats, goal: Floats, discs: Floats, bounds: Floats, count: int) -> list[Route]:
    tangents = tangent_graph(start, goal, outermost(discs), bounds)
    # The shortest way through a touching point is taut there as well, hence a class of its own.
    there, before = dijkstra(tangents.graph, indices=0, return_predecessors=True)
    back, after = dijkstra(tangents.graph.T, indices=1, return_predecessors=True)
    lengths = there + back
    found: list[Route] = []
    for node in np.argsort(lengths, kind="stable"):
        longest = _longest(found[0].length) if found else np.inf
        if len(found) == count or not lengths[node] <= longest or np.isinf(lengths[node]):
            break
        if any(_passes(route, tangents.points[node], float(lengths[node])) for route in found):
            continue
        chain = _chain(before, int(node), 0)[::-1] + _chain(after, int(node), 1)[1:]
        points = _polyline(tangents, chain)
        if len(set(chain)) == len(chain) and not _crosses_itself(points):
            found.append(Route(frozen(points), float(lengths[node])))
    return found


def _chain(neighbor: npt.NDArray[np.int32], node: int, last: int) -> list[int]:
    chain = [node]
    while chain[-1] != last:
        chain.append(int(neighbor[chain[-1]]))
    return chain


def _passes(route: Route, point: Floats, length: float) -> bool:
    """Whether a way of some length through a point is this route."""
    if abs(route.length - length) > SAME:
        return False
    tail, step = route.points[:-1], np.diff(route.points, axis=0)
    share = np.clip(np.sum((point - tail) * step, axis=1) / np.sum(step * step, axis=1), 0.0, 1.0)
    return bool(np.min(np.hypot(*(tail + share[:, None] * step - point).T)) < 10.0 * SAME)


def _polyline(tangents: TangentGraph, chain: list[int]) -> Floats:
    """The touching points of a chain, with vertices on the arcs between them."""
    pieces = [tangents.points[chain[:1]]]
    for node, following in pairwise(chain):
        x, y, radius = tangents.circles[node]
        if np.array_equal(tangents.circles[node], tangents.circles[following]):
            (ax, ay), (bx, by) = tangents.points[[node, following]] - [x, y]
            sense = tangents.senses[node]
            span = sense * np.arctan2(ax * by - ay * bx, ax * bx + ay * by)
            span = max(
                np.remainder(span + SAME, 2.0 * np.pi) - SAME, 0.0
            )  # of two points in one place: 0, not 2 pi
            angles = (
                np.arctan2(ay, ax) + sense * np.linspace(0.0, span, 1 + int(np.ceil(span / SPACING)))[1:-1]
            )
            pieces.append(np.column_stack([x + radius * np.cos(angles), y + radius * np.sin(angles)]))
        pieces.append(tangents.points[[following]])
    points = np.concatenate(pieces)
    moved = np.hypot(*np.diff(points, axis=0).T) > SAME
    distinct: Floats = points[np.concatenate([[True], moved])]
    return distinct


def _crosses_itself(points: Floats) -> bool:
    """Whether two pieces of a polyline that are no neighbors meet."""
    tail, head = points[:-1], points[1:]
    step = head - tail

    def sides(of: Floats) -> Floats:
        """Of every point (column), to which side of every piece (row) it lies."""
        side: Floats = step[:, :1] * (of[:, 1] - tail[:, 1:]) - step[:, 1:] * (of[:, 0] - tail[:, :1])
        return side

    parted = sides(tail) * sides(head) < 0.0
    return bool(np.any(parted & parted.T))
