"""Whether a goal can be reached in a mapped room: floods over the nodes of its distance field.

The nearest nodes of a path's points are neighbors, diagonals included, and nearer to the obstacles by half a diagonal
at most. So a robot whose flood over all nodes with that much less distance does not touch the goal cannot get there. Of
a path along the sides of the grid no point is nearer to the obstacles than a node by half a side.
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt
from scipy.ndimage import label

from applications.rosbot.scenario import Scenario
from gpsynth.arrays import Floats
from gpsynth.distance_field import DistanceField, rooted

SLACK = 1e-6  # m, what rounding may make of a distance
TURNS = np.ones((3, 3), dtype=np.int64)  # neighbors, diagonals included
HALVINGS = 8  # of the interval in which the width of the widest way is looked for

Verdict = tuple[Literal["reachable", "unreachable", "undecided"], str]
Flags = npt.NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class _Flood:
    """Distances (r, c) of nodes from what is at rest; the outermost nodes stand for all that is outside of the grid."""

    nodes: Floats  # (r, c, 2)
    distances: Floats
    within: Flags  # the bounds, or nearer to them than half a diagonal
    start: tuple[int, int]
    goals: Flags  # (r, c) whose surroundings meet the goal's tolerance
    half: float  # m, of a diagonal

    def joins(self, clearance: float) -> bool:
        """Whether some path that keeps a clearance (m) may lead from the start to the goal."""
        free = (self.distances >= clearance - self.half - SLACK) & self.within
        pieces, _ = label(free, structure=TURNS)
        return bool(pieces[self.start] and np.any(pieces[self.goals] == pieces[self.start]))


def flooded(scenario: Scenario, field: DistanceField) -> Verdict:
    """The verdict on a scenario with a room, and the reason for it."""
    flood, radius = _flood(scenario, field), scenario.radius
    free = flood.distances >= radius - flood.half - SLACK
    if not np.any(free & flood.within & flood.goals):
        return "unreachable", (
            f"the goal is in collision: with the robot's radius of {radius:g} m no point within "
            f"{scenario.position_tolerance:g} m of it is free"
        )
    if not flood.joins(radius):
        return "unreachable", _narrow(flood, radius)
    return _proved(scenario, flood, field)


def _flood(scenario: Scenario, field: DistanceField) -> _Flood:
    rows, columns = field.squares.shape
    x = field.corner[0] + field.spacing * np.arange(-1, columns + 1)
    y = field.corner[1] + field.spacing * np.arange(-1, rows + 1)
    nodes = np.stack(np.meshgrid(x, y), axis=-1)
    distances = np.pad(rooted(field.squares), 1, constant_values=np.inf)
    for cx, cy, vx, vy, radius in scenario.circles:
        if vx == vy == 0.0:
            distances = np.minimum(distances, np.hypot(nodes[..., 0] - cx, nodes[..., 1] - cy) - radius)
    half = field.spacing / np.sqrt(2.0) + SLACK
    low, high = scenario.bounds.reshape(2, 2).T
    place = np.clip(scenario.goal[:2], nodes[0, 0], nodes[-1, -1])
    return _Flood(
        nodes=nodes,
        distances=distances,
        within=np.all((nodes >= low - half) & (nodes <= high + half), axis=-1),
        start=_nearest(nodes, field.spacing, scenario.start[:2]),
        goals=np.hypot(*(nodes - place).transpose(2, 0, 1)) <= scenario.position_tolerance + half,
        half=half,
    )


def _nearest(nodes: Floats, spacing: float, point: Floats) -> tuple[int, int]:
    column, row = np.rint((point - nodes[0, 0]) / spacing).clip(0, np.array(nodes.shape[1::-1]) - 1)
    return int(row), int(column)


def _narrow(flood: _Flood, radius: float) -> str:
    """Why there is no route: how wide the widest way is at most."""
    low, high = 0.0, radius
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if flood.joins(middle) else (low, middle)
    return (
        f"no route leads through the room to the goal: the widest one is {2.0 * high:.3g} m wide at most, "
        f"the robot needs {2.0 * radius:g} m"
    )


def _proved(scenario: Scenario, flood: _Flood, field: DistanceField) -> Verdict:
    standing = scenario.speed_limits[0] <= 0.0 <= scenario.speed_limits[1]
    turning = scenario.turn_limits[0] <= 0.0 <= scenario.turn_limits[1]
    nimble = scenario.model == "unicycle" and standing and turning
    if not (scenario.is_static and scenario.is_round and nimble):
        return (
            "undecided",
            "a route may be free for a round robot that stands and turns among what is at rest",
        )
    need, bounds = scenario.radius + SLACK, scenario.bounds.reshape(2, 2).T
    inside = np.all((flood.nodes >= bounds[0]) & (flood.nodes <= bounds[1]), axis=-1)
    free = (flood.distances >= need + 0.5 * field.spacing) & inside
    free[[0, -1]] = free[:, [0, -1]] = False  # nothing is proved outside of the grid
    pieces, _ = label(free)
    node = flood.nodes[flood.start]
    joined = bool(pieces[flood.start]) and float(field.along(scenario.start[:2], node)) >= need
    aims = np.hypot(*(flood.nodes - scenario.goal[:2]).transpose(2, 0, 1)) <= scenario.position_tolerance
    if joined and np.any(pieces[aims] == pieces[flood.start]):
        return "reachable", "a route is free"
    return "undecided", "no route is proved to be wide enough, and none is proved to be shut"
