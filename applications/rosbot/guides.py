"""Guides: drivable lines from start to goal, with cusps, that schedules are first laid along.

A route is a taut string that knows nothing of headings. A guide leaves the start and enters the goal on Reeds-Shepp
curves that join the route some way on, forwards or backwards, and so brings in the maneuvers that a string lacks.
"""

from dataclasses import dataclass

import numpy as np

from applications.rosbot.reeds_shepp import ReedsSheppPath, paths, shortest_path
from applications.rosbot.routes import Route
from applications.rosbot.scenario import Scenario
from gpsynth.arrays import Floats

_Piece = tuple[Floats, Floats]  # poses (N, 3) and the sense of travel up to each, (N,)

SPACING = 0.05  # m, between the poses of a guide
JOINS = (0.3, 0.6, 1.0, 1.5)  # m along the route where the curves from the start and to the goal may join it
BLOCKED = 40.0  # s of detour that a meter in collision counts for, times its depth and 0.1 m in m


@dataclass(frozen=True, eq=False)
class Guide:
    """Poses along a drivable line."""

    poses: Floats  # (N, 3) m, m, rad: the robot's heading, also where it drives backwards
    times: Floats  # (N,) s, at top speed
    senses: Floats  # (N,) +1 driven forwards, -1 backwards, up to here
    score: float  # s, the duration and what the way through obstacles counts for

    @property
    def duration(self) -> float:
        """How long driving along takes at top speed, in s."""
        return float(self.times[-1])

    @property
    def cusps(self) -> Floats:
        """Times (c,) at which the direction of travel changes."""
        turned = self.senses[1:] != self.senses[:-1]
        cusps: Floats = self.times[:-1][turned & (self.times[:-1] > 0.0)]
        return cusps


def top_speed(scenario: Scenario) -> float:
    """The greatest speed (m/s) in either direction."""
    return max(map(abs, scenario.speed_limits))


def direct_guides(scenario: Scenario) -> list[Guide]:
    """Reeds-Shepp curves from start to goal, the best first."""
    curves = paths(scenario.start, scenario.goal, _radius(scenario))
    return _ranked(scenario, [[_sampled(curve)] for curve in curves[:16]])


def guides_along(scenario: Scenario, route: Route) -> list[Guide]:
    """Guides that follow a route forwards or backwards, the best first."""
    radius = _radius(scenario)
    ways = np.array([join for join in JOINS if join < 0.6 * route.length])
    found = []
    for sense in (1.0, -1.0):
        first, last = _turned(route.poses(ways), sense), _turned(route.poses(route.length - ways), sense)
        heads = [_sampled(shortest_path(scenario.start, pose, radius)) for pose in first]
        tails = [_sampled(shortest_path(pose, scenario.goal, radius)) for pose in last]
        for begin, head in zip(ways, heads, strict=True):
            for end, tail in zip(route.length - ways, tails, strict=True):
                if begin < end:
                    found.append([head, _followed(route, begin, end, sense), tail])
    return _ranked(scenario, found)


def _radius(scenario: Scenario) -> float:
    """The radius (m) of a turn at top speed that is possible to both sides, if there is one."""
    right, left = map(abs, scenario.turn_limits)
    return top_speed(scenario) / (min(right, left) or max(right, left))


def _ranked(scenario: Scenario, lines: list[list[_Piece]]) -> list[Guide]:
    """Guides along the lines that the limits on speed allow, short and free ones first."""
    speeds = {sense: sense * limit for sense, limit in zip((-1.0, 1.0), scenario.speed_limits, strict=True)}
    guides = []
    for line in lines:
        poses, senses = (np.concatenate(parts) for parts in zip(*line, strict=True))
        speed = np.where(senses > 0.0, speeds[1.0], speeds[-1.0])
        if np.all(speed > 0.0):
            steps = np.hypot(*np.diff(poses[:, :2], axis=0).T) / speed[1:]
            times = np.concatenate([[0.0], np.cumsum(steps)])
            score = float(times[-1]) + BLOCKED * _blockage(scenario, poses[:, :2])
            guides.append(Guide(poses, times, senses, score))
    return sorted(guides, key=lambda guide: guide.score)


def _blockage(scenario: Scenario, places: Floats) -> float:
    """Integral along places (N, 2) of the depth in obstacles or out of bounds and 0.1 m, where there is any (m^2)."""
    low, high = scenario.bounds.reshape(2, 2).T
    room = np.minimum(places - low, high - places).min(axis=1)
    discs = scenario.discs
    gaps = np.hypot(*(places[:, None] - discs[:, :2]).transpose(2, 0, 1)) - discs[:, 2]
    depth = -np.minimum(room, gaps.min(axis=1, initial=np.inf))
    return float(SPACING * np.sum((0.1 + depth)[depth > 0.0]))


def _turned(poses: Floats, sense: float) -> Floats:
    turned = poses.copy()
    turned[:, 2] += 0.0 if sense > 0.0 else np.pi
    return turned


def _sampled(curve: ReedsSheppPath) -> _Piece:
    """Poses (N, 3) and senses (N,) along a curve, its corners among them."""
    ends = np.concatenate([[0.0], np.cumsum(np.abs(curve.lengths))])
    ways = np.union1d(np.arange(0.0, curve.length, SPACING), ends)
    segment = np.clip(np.searchsorted(ends, ways, side="left") - 1, 0, len(curve.lengths) - 1)
    return curve.poses(ways), np.sign(curve.lengths)[segment]


def _followed(route: Route, begin: float, end: float, sense: float) -> _Piece:
    ways = np.append(np.arange(begin, end, SPACING), end)
    return _turned(route.poses(ways), sense), np.full(len(ways), sense)
