"""Guides: drivable lines from start to goal, with cusps, that schedules are first laid along.

A route is a taut string that knows nothing of headings. A guide leaves the start and enters the goal on Reeds-Shepp
curves that join the route some way on, forwards or backwards, and so brings in the maneuvers that a string lacks.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from applications.rosbot.curves import Curves, Samples
from applications.rosbot.reeds_shepp import paths
from applications.rosbot.routes import Route
from applications.rosbot.scenario import Scenario
from gpsynth.arrays import Floats

_Piece = tuple[Floats, Floats]  # poses (N, 3) and the sense of travel up to each, (N,)

SENSES = (1.0, -1.0)  # forwards, backwards
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


def direct_guides(scenario: Scenario, count: int = 16) -> list[Guide]:
    """Reeds-Shepp curves from start to goal, the best first."""
    curves = Curves.of(paths(scenario.start, scenario.goal, _radius(scenario))[:16])
    samples = curves.sampled(SPACING)
    scores = _durations(scenario, curves) + BLOCKED * _blockages(scenario, samples)
    best = [int(row) for row in np.argsort(scores, kind="stable") if np.isfinite(scores[row])]
    return [_guide(scenario, [samples.piece(row)], float(scores[row])) for row in best[:count]]


def guides_along(scenario: Scenario, routes: Sequence[Route], count: int = 32) -> list[list[Guide]]:
    """For each route guides that follow it forwards or backwards, the best first."""
    joins = [np.array([join for join in JOINS if join < 0.6 * route.length]) for route in routes]
    entries, exits = (
        [],
        [],
    )  # poses (j, 3) of each route and sense: where the curves join it, and where they leave
    for route, ways in zip(routes, joins, strict=True):
        for sense in SENSES:
            entries.append(_turned(route.poses(ways), sense))
            exits.append(_turned(route.poses(route.length - ways), sense))
    firsts, lasts = np.concatenate([np.empty((0, 3)), *entries]), np.concatenate([np.empty((0, 3)), *exits])
    if not len(firsts):
        return [[] for _ in routes]
    begins, ends = (np.broadcast_to(pose, firsts.shape) for pose in (scenario.start, scenario.goal))
    curves = Curves.shortest(
        np.concatenate([begins, lasts]), np.concatenate([firsts, ends]), _radius(scenario)
    )
    samples = curves.sampled(SPACING)
    scores = _durations(scenario, curves) + BLOCKED * _blockages(scenario, samples)
    places = np.cumsum([0, *(len(each) for each in entries)])
    found = []
    for number, (route, ways) in enumerate(zip(routes, joins, strict=True)):
        combined = []
        for index, sense in enumerate(SENSES):
            first = int(places[2 * number + index])
            combined += _combined(scenario, route, ways, sense, scores, (first, first + len(firsts)))
        best = sorted(combined, key=lambda each: each[0])[:count]
        found.append(
            [
                _guide(
                    scenario,
                    [samples.piece(head), _followed(route, begin, end, sense), samples.piece(tail)],
                    score,
                )
                for score, head, tail, begin, end, sense in best
            ]
        )
    return found


def _combined(
    scenario: Scenario,
    route: Route,
    ways: Floats,
    sense: float,
    scores: Floats,
    places: tuple[int, int],
) -> list[tuple[float, int, int, float, float, float]]:
    """Score, curves and joints of every way along a route; the route itself is free, so only the curves are tested.

    The curves to and from the route stand from the `places` on.
    """
    pace, (heads, tails), found = _pace(scenario, sense), places, []
    for i, begin in enumerate(ways):
        for j, end in enumerate(route.length - ways):
            score = float(scores[heads + i] + scores[tails + j] + pace * (end - begin))
            if begin < end and np.isfinite(score):
                found.append((score, heads + i, tails + j, float(begin), float(end), sense))
    return found


def _radius(scenario: Scenario) -> float:
    """The radius (m) of a turn at top speed that is possible to both sides, if there is one."""
    right, left = map(abs, scenario.turn_limits)
    return max(top_speed(scenario) / (min(right, left) or max(right, left)), scenario.turning_radius)


def _pace(scenario: Scenario, sense: float) -> float:
    """Seconds a meter takes at top speed, forwards or backwards; infinity where the limits forbid it."""
    limit = scenario.speed_limits[1] if sense > 0.0 else -scenario.speed_limits[0]
    return 1.0 / limit if limit > 0.0 else np.inf


def _durations(scenario: Scenario, curves: Curves) -> Floats:
    """How long driving along takes at top speed (N,), in s."""
    seconds = np.zeros(len(curves.lengths))
    for sense in SENSES:
        driven = np.sum(np.maximum(sense * curves.lengths, 0.0), axis=1)
        seconds[driven > 0.0] += _pace(scenario, sense) * driven[driven > 0.0]
    return seconds


def _blockages(scenario: Scenario, samples: Samples) -> Floats:
    """Integral (N,) along curves of the depth in obstacles or out of bounds and 0.1 m, where there is any (m^2)."""
    places = samples.poses[:, :2]
    low, high = scenario.bounds.reshape(2, 2).T
    room = np.minimum(places - low, high - places).min(axis=1)
    discs = scenario.discs
    gaps = np.hypot(*(places[:, None] - discs[:, :2]).transpose(2, 0, 1)) - discs[:, 2]
    room = np.minimum(room, gaps.min(axis=1, initial=np.inf))
    if scenario.field is not None:
        room = np.minimum(room, scenario.field.at(places) - scenario.radius)
    depth = -room
    counted = np.concatenate([[0.0], np.cumsum(np.where(depth > 0.0, 0.1 + depth, 0.0))])
    blocked: Floats = SPACING * np.diff(counted[samples.bounds])
    return blocked


def _guide(scenario: Scenario, line: Sequence[_Piece], score: float) -> Guide:
    """The pieces of a line, one after the other."""
    poses, senses = (np.concatenate(parts) for parts in zip(*line, strict=True))
    pace = np.where(senses > 0.0, _pace(scenario, 1.0), _pace(scenario, -1.0))
    steps = np.hypot(*np.diff(poses[:, :2], axis=0).T)
    times = np.cumsum(steps * np.where(steps > 0.0, pace[1:], 0.0))
    return Guide(poses, np.concatenate([[0.0], times]), senses, score)


def _turned(poses: Floats, sense: float) -> Floats:
    turned = poses.copy()
    turned[:, 2] += 0.0 if sense > 0.0 else np.pi
    return turned


def _followed(route: Route, begin: float, end: float, sense: float) -> _Piece:
    ways = np.append(np.arange(begin, end, SPACING), end)
    return _turned(route.poses(ways), sense), np.full(len(ways), sense)
