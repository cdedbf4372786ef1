"""Certificates: a clearance that is proved for the continuous path of a plan, and not only for samples of it.

What is proved: a robot that obeys model (12) exactly, starts at the scenario's start and gets the controls for their
durations keeps at least this distance, up to the arrival. Everything that rounding can do is deducted (`arcs`).
Distances to circles at rest are those of arcs in closed form. A circle with a velocity sees arcs added to a straight
line, whose distance has no closed form (`approaches`).
"""

from dataclasses import dataclass

import numpy as np

from applications.rosbot.approaches import Indices, Parts, least_gap
from applications.rosbot.arcs import ROUNDING, STANDING, Arcs, arcs
from applications.rosbot.chords import Chords, chords_of, gaps_of_circles, gaps_of_room
from applications.rosbot.controls import held
from applications.rosbot.encounters import least_distance
from applications.rosbot.lag_errors import errors
from applications.rosbot.lags import lagging_path, nominal_speeds
from applications.rosbot.scenario import Scenario
from gpsynth.arrays import Floats

TOUCHING = 1e-9  # m; a path that touches an obstacle is clear, though rounding is deducted


@dataclass(frozen=True)
class Certificate:
    """What is proved about a path; the bounds hold whatever the samples of a simulator show."""

    clearance: float  # m, at least, between the body and every obstacle; infinity without obstacles
    room: float  # m, at least, between the robot's center and the bounds; infinity without bounds
    obstacle: int | None  # which circle is nearest; None if it is the room
    time: float | None  # s, when the piece begins that is nearest to it
    robot: int | None = None  # which other robot is nearest; None if it is none of them

    @property
    def is_clear(self) -> bool:
        """Whether the path is proved to be free of collisions and within the bounds."""
        return min(self.clearance, self.room) >= -TOUCHING


@dataclass(frozen=True, eq=False)
class _Nearest:
    """A lower bound on a distance, and where it is met."""

    gap: float = np.inf
    obstacle: int | None = None
    time: float | None = None
    robot: int | None = None


def certify(
    scenario: Scenario, controls: Floats, period: float | Floats, *, until: float = np.inf
) -> Certificate:
    """The certificate of (v, omega) pairs (n, 2), each held for `period` seconds (one number, or one per pair).

    `until` (s) is the arrival, after which the robot stands. Other robots are kept clear of even then, obstacles up to
    the arrival alone. Raises ScenarioError if these are no controls.
    """
    controls, durations = held(controls, period)
    begins = np.cumsum(durations) - durations
    kept = np.clip(until - begins, 0.0, durations)
    lags = scenario.model == "dynamic_unicycle"
    path = _lagging(scenario, controls, kept) if lags else arcs(scenario.start, controls, kept)
    moves = np.any(scenario.circles[:, 2:4] != 0.0, axis=1) & (len(path.steps) > 0)  # in no time nothing does
    by_arcs, found = scenario.is_round and not lags, list[_Nearest]()
    if by_arcs:
        found += [_at_rest(path, scenario, np.flatnonzero(~moves))]
        found += [_moving(path, scenario, np.flatnonzero(moves))]
        found += [_among(path, scenario)]
    if scenario.room is not None or not by_arcs:
        chords = chords_of(path, scenario.body)
        found.append(_in_room(chords, scenario))
        found += [] if by_arcs else [_turning(chords, scenario.circles)]
    nearest = min(found, key=lambda each: each.gap)
    return Certificate(
        nearest.gap, _room(path, scenario.bounds), nearest.obstacle, nearest.time, nearest.robot
    )


def _lagging(scenario: Scenario, controls: Floats, durations: Floats) -> Arcs:
    """The path of the nominal robot with lags, in pieces that are nearly arcs."""
    speeds = nominal_speeds(controls, durations, scenario.speeds)
    path = lagging_path(scenario.start, durations, *speeds)
    error, turn_error = errors(path, durations, *speeds)
    v, omega = (np.maximum(np.abs(each[:-1]), np.abs(each[1:])) for each in (path.v, path.omega))
    return Arcs(path.times, path.poses, v, omega, np.diff(path.times), error, turn_error)


def _in_room(chords: Chords, scenario: Scenario) -> _Nearest:
    """The least distance from the room."""
    gaps = gaps_of_room(chords, scenario)
    piece = int(np.argmin(gaps))
    return _Nearest(float(gaps[piece]), None, float(chords.times[piece]) if scenario.room else None)


def _turning(chords: Chords, circles: Floats) -> _Nearest:
    """The least distance of a body that turns from circles."""
    if not len(circles):
        return _Nearest()
    gaps = gaps_of_circles(chords, circles)
    piece, index = np.unravel_index(np.argmin(gaps), gaps.shape)
    return _Nearest(float(gaps[piece, index]), int(index), float(chords.times[piece]))


def _at_rest(path: Arcs, scenario: Scenario, which: Indices) -> _Nearest:
    """The least distance of arcs to circles that do not move.

    In the frame of a piece's first pose a center lies at (a, b), and its distance to the whole circle of curvature k
    that the robot drives on is |k (a^2 + b^2) - 2 b| / (1 + |(k a, 1 - k b)|), which does not cancel however straight
    the way. It counts where the center is ahead of the piece's beginning, behind its end and on the same side of the
    turning point as the piece; elsewhere an end is nearest. A distance that is counted in doubt is no larger than that
    of the piece.
    """
    if not len(which):
        return _Nearest()
    centers, radii = scenario.circles[which, :2], scenario.circles[which, 4] + scenario.radius
    to_center = centers - path.poses[:, np.newaxis, :2]  # (n + 1, c, 2)
    distance = np.hypot(to_center[..., 0], to_center[..., 1])
    slack = path.error + (128.0 * ROUNDING + path.turn_error) * (distance + radii)
    near = distance - slack
    if len(path.steps):
        cos, sin = np.cos(path.poses[:, 2:]), np.sin(path.poses[:, 2:])
        ahead = to_center[..., 0] * cos + to_center[..., 1] * sin
        left = to_center[..., 1] * cos - to_center[..., 0] * sin
        a, b, d = ahead[:-1], left[:-1], distance[:-1]
        k, sense = path.curvature[:, np.newaxis], np.sign(path.v)[:, np.newaxis]
        moving = (np.abs(path.v) * path.steps > STANDING)[:, np.newaxis]
        side = 1.0 - k * b
        passed = (sense * a >= -slack[:-1]) & (sense * ahead[1:] <= slack[1:])
        passed &= moving & (side >= -64.0 * ROUNDING * (1.0 + np.abs(k) * d))
        whole = np.abs(k * d * d - 2.0 * b) / (1.0 + np.hypot(k * a, side))
        ends = np.minimum(near[:-1], near[1:]) - np.where(moving, 0.0, STANDING)
        near = np.where(passed, np.minimum(ends, whole - np.maximum(slack[:-1], slack[1:])), ends)
    piece, index = np.unravel_index(np.argmin(near - radii), near.shape)
    return _Nearest(float(near[piece, index] - radii[index]), int(which[index]), float(path.times[piece]))


def _moving(path: Arcs, scenario: Scenario, which: Indices) -> _Nearest:
    """A lower bound on the distance of arcs to circles that move, no lower than TIGHT below it."""
    circles, end = scenario.circles[which], path.times[-1]
    piece, number = (grid.ravel() for grid in np.indices((len(path.steps), len(which))))
    speed = np.hypot(circles[:, 2], circles[:, 3])
    size = np.abs(path.poses).max() + np.abs(circles[:, :2]).sum(axis=1) + speed * end + scenario.radius
    lost = path.error + (ROUNDING * (256.0 + len(path.steps)) + path.turn_error) * (size + circles[:, 4])
    times = path.times[:-1, np.newaxis]
    place = path.poses[:-1, np.newaxis, :2] - circles[:, :2] - circles[:, 2:4] * times[..., np.newaxis]
    parts = Parts(
        pair=number,
        times=path.times[piece],
        place=place.reshape(-1, 2),
        headings=path.poses[np.newaxis, piece, 2],
        v=path.v[np.newaxis, piece],
        omega=path.omega[np.newaxis, piece],
        drift=-circles[number, 2:4],
        steps=path.steps[piece],
    )
    gap, nearest, time = least_gap(parts, circles[:, 4] + scenario.radius, lost)
    return _Nearest(gap, int(which[nearest]), time) if len(which) else _Nearest()


def _among(path: Arcs, scenario: Scenario) -> _Nearest:
    """The least distance from other robots, up to when all of them stand."""
    nearest = _Nearest()
    for number, other in enumerate(scenario.others):
        distance, time = least_distance(path, other.path)
        gap = distance - scenario.radius - other.radius
        nearest = min(nearest, _Nearest(gap, None, time, number), key=lambda each: each.gap)
    return nearest


def _room(path: Arcs, bounds: Floats) -> float:
    """A lower bound (m) on the distance of the path from the bounds; where it is outside, negative.

    Where x or y is monotone over a piece its ends decide, elsewhere the bend of the arc is deducted.
    """
    heading = path.poses[:, 2]
    room = np.inf
    for axis, slopes in enumerate((np.cos(heading), np.sin(heading))):
        values = path.poses[:, axis]
        turned = slopes[:-1] * slopes[1:] <= 4.0 * (4.0 * ROUNDING + path.turn_error)
        bulge = np.where(turned, path.bend, 0.0)
        low = np.min(np.minimum(values[:-1], values[1:]) - bulge, initial=values[0])
        high = np.max(np.maximum(values[:-1], values[1:]) + bulge, initial=values[0])
        room = min(room, low - bounds[2 * axis], bounds[2 * axis + 1] - high)
    return float(room - path.error - 4.0 * ROUNDING * (np.abs(path.poses[:, :2]).max() + _finite(bounds)))


def _finite(bounds: Floats) -> float:
    return float(np.abs(bounds[np.isfinite(bounds)]).max(initial=0.0))
