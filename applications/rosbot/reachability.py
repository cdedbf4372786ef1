"""Whether a round robot that can turn in place can get to its goal at all: exact, in two dimensions, without a grid.

The robot's center must stay outside discs, the obstacles grown by its radius. Two points are cut off from each other
exactly if a ring of overlapping discs, closed perhaps through the outside of the bounds, passes between them: if it
crosses the straight line from one to the other an odd number of times. Such rings are paths from (disc, even) to
(disc, odd) in the graph whose edges join overlapping discs and change the parity when they cross the line.
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import connected_components, dijkstra
from scipy.spatial import cKDTree

from applications.rosbot.discs import grown
from applications.rosbot.floods import flooded
from applications.rosbot.scenario import Scenario
from gpsynth.arrays import Floats

SLACK = 1e-6  # m; a passage that is wider or narrower than its need by less than this is left undecided
Pairs = npt.NDArray[np.int64]


@dataclass(frozen=True)
class Reachability:
    """A verdict, its reason in one sentence, and the obstacles that shut the way, as a closed chain."""

    status: Literal["reachable", "unreachable", "undecided"]
    reason: str
    barrier: tuple[int, ...] = ()


@dataclass(frozen=True, eq=False)
class _Barriers:
    """Discs (n, 3), pairs of them that overlap (e, 2); the disc after the last is all that lies out of bounds."""

    discs: Floats
    centers: Floats  # (e, 2, 2) ends of a line inside the two discs of a pair
    pairs: Pairs


def reachability(scenario: Scenario) -> Reachability:
    """Whether some way leads from the start into the goal's tolerance, the time limit aside.

    "unreachable" is proved for any robot no larger than this one's body, whatever its limits. "reachable" is proved for
    obstacles at rest and a round unicycle whose limits let it stand, drive and turn by themselves; otherwise it is
    "undecided". In a room it is a matter of floods (`floods.py`).
    """
    if not scenario.covers_origin:
        return Reachability(
            "undecided", "the robot's origin is outside of its body, and may be in an obstacle"
        )
    if scenario.field is not None:
        return Reachability(*flooded(scenario, scenario.field))
    fixed = scenario.discs[~np.any(scenario.circles[:, 2:4], axis=1)]
    indices = np.flatnonzero(~np.any(scenario.circles[:, 2:4], axis=1))
    smaller = grown(fixed, -SLACK)
    goals = _arrivals(scenario, smaller, scenario.position_tolerance + SLACK)
    if not len(goals):
        return _blocked_goal(scenario, fixed, indices)
    barriers = _barriers(scenario, smaller)
    rings = [_ring(barriers, scenario.start[:2], goal) for goal in goals]
    if all(rings):
        ring = min((ring for ring in rings if ring), key=len)
        return _no_route(scenario, fixed, indices, ring)
    return _route(scenario, grown(fixed, SLACK))


def _route(scenario: Scenario, larger: Floats) -> Reachability:
    if not scenario.is_static:
        return Reachability(
            "undecided", "the obstacles at rest leave a route; what the moving ones leave is not tested"
        )
    if not scenario.is_round:
        return Reachability(
            "undecided", "a route is free for a disc within the body; the rest of it is not tested"
        )
    if scenario.model != "unicycle":
        return Reachability(
            "undecided", "a route is free for a robot that stands and turns in place; this one does not"
        )
    standing = scenario.speed_limits[0] <= 0.0 <= scenario.speed_limits[1]
    if not standing or not scenario.turn_limits[0] <= 0.0 <= scenario.turn_limits[1]:
        return Reachability(
            "undecided", "a route is free, but the limits do not let the robot stand and turn in place"
        )
    barriers = _barriers(scenario, larger)
    goals = _arrivals(scenario, larger, scenario.position_tolerance)
    if any(_ring(barriers, scenario.start[:2], goal) is None for goal in goals):
        return Reachability("reachable", "a route is free")
    return Reachability("undecided", f"the only way is closer to the obstacles than {2.0 * SLACK:g} m")


def _blocked_goal(scenario: Scenario, discs: Floats, indices: Pairs) -> Reachability:
    distance = np.hypot(*(discs[:, :2] - scenario.goal[:2]).T) - discs[:, 2]
    covering = np.flatnonzero(distance < scenario.position_tolerance)
    barrier = tuple(int(index) for index in indices[covering])
    return Reachability(
        "unreachable",
        f"the goal is in collision: with the robot's radius of {scenario.radius:g} m, {_listed(barrier)} "
        f"cover{'s' if len(barrier) == 1 else ''} every point within {scenario.position_tolerance:g} m of it",
        barrier,
    )


def _no_route(scenario: Scenario, discs: Floats, indices: Pairs, ring: list[int]) -> Reachability:
    """The ring as the witness, with its widest gap."""
    inside = [node for node in ring if node < len(discs)]
    barrier = tuple(int(indices[node]) for node in inside)
    joined = [
        pair
        for pair in zip(ring, ring[1:] + ring[:1], strict=True)
        if max(pair) < len(discs) and len(ring) > 1
    ]
    gaps = [np.hypot(*(discs[i, :2] - discs[j, :2])) - discs[i, 2] - discs[j, 2] for i, j in joined]
    gap = max(gaps, default=-2.0 * scenario.radius) + 2.0 * scenario.radius
    width = f"the widest gap between them is {max(gap, 0.0):.3g} m" if gaps else "it reaches across"
    walls = " and the bounds" if len(inside) < len(ring) else ""
    return Reachability(
        "unreachable",
        f"no route: {_listed(barrier)}{walls} shut the goal off from the start; {width}, "
        f"the robot needs {2.0 * scenario.radius:g} m",
        barrier,
    )


def _listed(barrier: tuple[int, ...]) -> str:
    shown = ", ".join(map(str, barrier[:12])) + (", ..." if len(barrier) > 12 else "")
    return f"obstacle{'s' if len(barrier) > 1 else ''} {shown}"


def _barriers(scenario: Scenario, discs: Floats) -> _Barriers:
    """Which discs overlap, and which reach out of the bounds."""
    centers, radii = discs[:, :2], discs[:, 2]
    near = cKDTree(centers).query_pairs(2.0 * radii.max(initial=0.0), output_type="ndarray").reshape(-1, 2)
    gap = np.hypot(*(centers[near[:, 0]] - centers[near[:, 1]]).T) - radii[near].sum(axis=1)
    pairs = [near[gap < 0.0]]
    lines = [centers[pairs[0]]]
    for axis, (low, high) in enumerate(scenario.bounds.reshape(2, 2)):
        for bound, sign in ((low, -1.0), (high, 1.0)):
            reaching = np.flatnonzero(sign * (bound - centers[:, axis]) < radii)
            beyond = centers[reaching].copy()
            beyond[:, axis] += sign * radii[reaching]
            lines.append(np.stack([centers[reaching], beyond], axis=1))
            pairs.append(np.column_stack([reaching, np.full(len(reaching), len(discs))]))
    return _Barriers(discs, np.concatenate(lines), np.concatenate(pairs).astype(np.int64))


def _ring(barriers: _Barriers, start: Floats, goal: Floats) -> list[int] | None:
    """A closed chain of overlapping discs between two points, as few as possible; None if there is none."""
    size = len(barriers.discs) + 1
    odd = _crosses(barriers.centers, start, goal).astype(np.int64)
    first, second = barriers.pairs.T
    heads = np.concatenate([first, first + size])
    tails = np.concatenate([second + size * odd, second + size * (1 - odd)])
    graph = csr_array(coo_array((np.ones(len(heads)), (heads, tails)), shape=(2 * size, 2 * size)))
    graph.data[:] = 1.0  # two lines may join the same pair
    _, part = connected_components(graph, directed=False)
    nodes = np.flatnonzero(part[:size] == part[size:])
    if not len(nodes):
        return None
    steps, before = dijkstra(graph, directed=False, indices=nodes, unweighted=True, return_predecessors=True)
    best = int(np.argmin(steps[np.arange(len(nodes)), nodes + size]))
    chain, node = [], int(nodes[best] + size)
    while node != nodes[best]:
        chain.append(node % size)
        node = int(before[best, node])
    return chain


def _crosses(lines: Floats, start: Floats, goal: Floats) -> npt.NDArray[np.bool_]:
    """Which lines (e, 2, 2) cross the one from start to goal; an end on its extension counts as left of it."""
    along = goal - start
    side = along[0] * (lines[..., 1] - start[1]) - along[1] * (lines[..., 0] - start[0])
    left = side >= 0.0
    crossed: npt.NDArray[np.bool_] = left[:, 0] != left[:, 1]
    share = side[:, 0] / np.where(crossed, side[:, 0] - side[:, 1], 1.0)
    place = (lines[:, 0] + share[:, None] * (lines[:, 1] - lines[:, 0]) - start) @ along
    crossed &= (place > 0.0) & (place < along @ along)
    return crossed


def _arrivals(scenario: Scenario, discs: Floats, tolerance: float) -> Floats:
    """Free points (k, 2) within the tolerance of the goal, at least one in each piece that the discs leave of it.

    A piece has a corner where two of its edges meet, or a whole circle for an edge: the goal's own or a disc's.
    """
    goal = scenario.goal[:2]
    touching = discs[np.hypot(*(discs[:, :2] - goal).T) - discs[:, 2] <= tolerance]
    if not len(touching):
        return goal[None]
    circles = np.vstack([[*goal, tolerance], touching])
    points = [goal[None], circles[:, :2] + circles[:, 2:] * [1.0, 0.0]]
    with np.errstate(
        divide="ignore", invalid="ignore"
    ):  # what does not meet becomes NaN and is dropped below
        points.append(_intersections(circles))
        points += [_on_bounds(circles, side // 2, bound) for side, bound in enumerate(scenario.bounds)]
    points.append(np.array([[x, y] for x in scenario.bounds[:2] for y in scenario.bounds[2:]]))
    candidates = np.concatenate(points)
    candidates = candidates[np.all(np.isfinite(candidates), axis=1)]
    rounding = 1e-3 * SLACK
    low, high = scenario.bounds.reshape(2, 2).T
    inside = np.all((candidates >= low - rounding) & (candidates <= high + rounding), axis=1)
    inside &= np.hypot(*(candidates - goal).T) <= tolerance + rounding
    gaps = np.hypot(*(candidates[:, None] - touching[:, :2]).transpose(2, 0, 1)) - touching[:, 2]
    free: Floats = candidates[inside & np.all(gaps >= -rounding, axis=1)]
    return free


def _intersections(circles: Floats) -> Floats:
    first, second = np.triu_indices(len(circles), k=1)
    a, b = circles[first], circles[second]
    between = b[:, :2] - a[:, :2]
    square = np.sum(between**2, axis=1)
    along = 0.5 * (1.0 + (a[:, 2] ** 2 - b[:, 2] ** 2) / square)
    across = np.sqrt(a[:, 2] ** 2 / square - along**2)
    normal = np.column_stack([-between[:, 1], between[:, 0]])
    foot = a[:, :2] + along[:, None] * between
    return np.concatenate([foot + across[:, None] * normal, foot - across[:, None] * normal])


def _on_bounds(circles: Floats, axis: int, bound: float) -> Floats:
    offset = bound - circles[:, axis]
    half = np.sqrt(circles[:, 2] ** 2 - offset**2)
    points = np.empty((2, len(circles), 2))
    points[:, :, axis] = bound
    points[:, :, 1 - axis] = circles[:, 1 - axis] + np.array([[1.0], [-1.0]]) * half
    return points.reshape(-1, 2)
