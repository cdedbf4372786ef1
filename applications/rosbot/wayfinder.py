"""The way on in a room: lines of a lattice that lead to a far goal from anywhere, found once, and how far to look.

What the next seconds are best spent with hardly depends on how a far goal is entered. So a scene gets a goal no farther
than AHEAD, a place on the shortest way that is to be passed in any direction (receding horizon). Rollouts end there,
and other ways are looked for around there alone.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.ndimage import distance_transform_edt
from scipy.sparse.csgraph import dijkstra

from applications.rosbot.guides import top_speed
from applications.rosbot.lattice import Indices, Lattice, chain, lattices, taut
from applications.rosbot.routes import Route, routes_in_room, with_discs
from applications.rosbot.scenario import COARSE, Scenario
from gpsynth.arrays import Floats, frozen
from gpsynth.distance_field import DistanceField

AHEAD = 15.0  # s at top speed to the farthest place that is planned for
PASSING = 0.3  # m from that place, where it is passed
ANY_HEADING = 4.0  # rad, more than half a turn
FURTHER = 1.0  # m of the way beyond that place, so that drawing it taut does not depend on where it is cut
AROUND = 2.0  # m around the way, where other ways are looked for


@dataclass(frozen=True, eq=False)
class Part:
    """The part of a room that is planned in."""

    way: Route  # the shortest to the goal, whatever moves
    field: DistanceField  # around it

    def routes(self, scene: Scenario, count: int, margin: float) -> list[Route]:
        """Up to `count` routes to the scene's goal that keep `margin` (m), also from what moves, where it is now."""
        return routes_in_room(scene, self.field, count, scene.radius + margin)


@dataclass(frozen=True, eq=False)
class Wayfinder:
    """The shortest ways to a goal from all points of a lattice, as a tree."""

    field: DistanceField  # of all that rests
    clearance: float  # m, that the ways keep
    goal: Floats  # (2,)
    lattice: Lattice
    nearest: Indices  # (r, c) number of the free point that is nearest to each point of the lattice
    lengths: Floats  # (r c,) m to the goal; infinity without a way
    after: Indices  # (r c,) number of the next point on the way

    def look(self, scene: Scenario) -> tuple[Scenario, Part]:
        """The scene with a goal no farther than AHEAD, and the part of the room on the way there."""
        ahead = AHEAD * top_speed(scene)
        way = self._way(scene.start[:2], ahead + FURTHER)
        part = Part(way, _around(self.field, way.points))
        if way.length <= ahead:
            return scene, part
        place = way.poses(np.array([ahead]))[0]
        near = replace(scene, goal=place, position_tolerance=PASSING, heading_tolerance=ANY_HEADING)
        return near, part

    def _way(self, position: Floats, enough: float) -> Route:
        """The way from a position (2,) on, to the goal or until it is long `enough` (m), drawn taut."""
        numbers = np.array(chain(self.after, int(self.nearest[self.lattice.index(position)])))
        driven = self.lengths[numbers[0]] - self.lengths[numbers]
        last = int(np.searchsorted(driven, enough))
        points = self.lattice.points.reshape(-1, 2)[numbers[: last + 1]]
        ends = [self.goal] if last >= len(numbers) else []
        line = taut(np.vstack([position, points, *ends]), self.field, self.clearance, np.empty((0, 2)))
        return Route(line, float(np.hypot(*np.diff(line, axis=0).T).sum()))


def wayfinder(scenario: Scenario, clearances: tuple[float, ...]) -> Wayfinder | None:
    """The ways that keep the first of some clearances (m) at which one leads from the start; None without any.

    They are those of the robot's center, around all that rests in the scenario's room.
    """
    if scenario.field is None:
        return None
    resting = ~np.any(scenario.circles[:, 2:4], axis=1)
    field = with_discs(scenario.field, scenario.circles[resting][:, [0, 1, 4]])
    for clearance in clearances:
        for lattice in lattices(field, scenario.radius + clearance, scenario.bounds):
            found = _tree(lattice, field, scenario.radius + clearance, scenario.goal[:2])
            if np.isfinite(found.lengths[found.nearest[lattice.index(scenario.start[:2])]]):
                return found
    return None


def _tree(lattice: Lattice, field: DistanceField, clearance: float, goal: Floats) -> Wayfinder:
    row, column = distance_transform_edt(~lattice.free, return_distances=False, return_indices=True)
    nearest = np.ravel_multi_index((row, column), lattice.free.shape)
    root = int(nearest[lattice.index(goal)])
    lengths, after = dijkstra(lattice.graph, directed=False, indices=root, return_predecessors=True)
    return Wayfinder(field, clearance, frozen(goal), lattice, nearest, lengths, after)


def _around(field: DistanceField, points: Floats) -> DistanceField:
    """The part of a field around points (n, 2), its nodes up to COARSE apart."""
    shape, stride = np.array(field.squares.shape[::-1]), max(1, int(COARSE / field.spacing + 1e-9))
    low, high = (
        (end - field.corner) / field.spacing
        for end in (points.min(axis=0) - AROUND, points.max(axis=0) + AROUND)
    )
    left, below = np.clip(np.floor(low), 0, shape - 1 - stride).astype(int)
    right, above = np.clip(np.ceil(high) + 1, [left + stride + 1, below + stride + 1], shape).astype(int)
    corner = field.corner + field.spacing * np.array([left, below])
    return DistanceField(field.squares[below:above:stride, left:right:stride], corner, stride * field.spacing)
