"""Guides: drivable lines from start to goal, with cusps, that schedules are first laid along.

A route is a taut string that knows nothing of headings. A guide leaves the start and enters the goal on Reeds-Shepp
curves that join the route some way on, forwards or backwards, and so brings in the maneuvers that a string lacks.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from applications.rosbot.curves import Curves
from applications.rosbot.escapes import Escape, escapes, turning_time
from applications.rosbot.links import BLOCKED, SENSES, SPACING, Links, Piece, blockages, durations, pace
from applications.rosbot.reeds_shepp import paths
from applications.rosbot.routes import Route
from applications.rosbot.scenario import Scenario
from gpsynth.arrays import Floats

JOINS = (0.3, 0.6, 1.0, 1.5)  # m along the route where the curves from the start and to the goal may join it


@dataclass(frozen=True, eq=False)
class Guide:
    """Poses along a drivable line."""

    poses: Floats  # (N, 3) m, m, rad: the robot's heading, also where it drives backwards
    times: Floats  # (N,) s, at top speed
    senses: Floats  # (N,) +1 driven forwards, -1 backwards, 0 turned in place, up to here
    score: float  # s, the duration and what the way through obstacles counts for
    arrival: float  # s, when it comes into the goal's tolerance

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
    scores = durations(scenario, curves) + BLOCKED * blockages(scenario, samples)
    best = [int(row) for row in np.argsort(scores, kind="stable") if np.isfinite(scores[row])]
    return [_guide(scenario, [samples.piece(row)], float(scores[row])) for row in best[:count]]


def guides_along(scenario: Scenario, routes: Sequence[Route], count: int = 32) -> list[list[Guide]]:
    """For each route guides that follow it forwards or backwards, the best first.

    Where no curve leaves the start freely, or enters the goal, escapes (`escapes.py`) come before the curves, or after.
    """
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
    links = _links(scenario, firsts, lasts)
    places = np.cumsum([0, *(len(each) for each in entries)])
    found = []
    for number, (route, ways) in enumerate(zip(routes, joins, strict=True)):
        combined = []
        for index, sense in enumerate(SENSES):
            first = int(places[2 * number + index])
            combined += _combined(scenario, route, ways, sense, links, first)
        best = sorted(combined, key=lambda each: each[0])[:count]
        found.append(
            [
                _guide(
                    scenario,
                    [*links.head(head), _followed(route, begin, end, sense), *links.tail(tail)],
                    score,
                )
                for score, head, tail, begin, end, sense in best
            ]
        )
    return found


def _links(scenario: Scenario, firsts: Floats, lasts: Floats) -> Links:
    """What joins the start to poses (N, 3), and others to the goal."""
    leaves, arrives = [Escape.nowhere(scenario.start)], [Escape.nowhere(scenario.goal)]
    links = Links.of(scenario, firsts, lasts, _radius(scenario), leaves, arrives)
    if any(links.blocked):
        leaves += escapes(scenario, scenario.start) if links.blocked[0] else []
        arrives += escapes(scenario, scenario.goal, arrives=True) if links.blocked[1] else []
        links = Links.of(scenario, firsts, lasts, _radius(scenario), leaves, arrives)
    return links


def _combined(
    scenario: Scenario,
    route: Route,
    ways: Floats,
    sense: float,
    links: Links,
    place: int,
) -> list[tuple[float, int, int, float, float, float]]:
    """Score, links and joints of every way along a route; the route itself is free, so only the links are tested.

    The links to and from the route stand from `place` on.
    """
    seconds, (heads, tails), found = pace(scenario, sense), [each.min(axis=0) for each in links.scores], []
    for i, begin in enumerate(ways):
        for j, end in enumerate(route.length - ways):
            score = float(heads[place + i] + tails[place + j] + seconds * (end - begin))
            if begin < end and np.isfinite(score):
                found.append((score, place + i, place + j, float(begin), float(end), sense))
    return found


def _radius(scenario: Scenario) -> float:
    """The radius (m) of a turn at top speed that is possible to both sides, if there is one."""
    right, left = map(abs, scenario.turn_limits)
    return max(top_speed(scenario) / (min(right, left) or max(right, left)), scenario.turning_radius)


def _guide(scenario: Scenario, line: Sequence[Piece], score: float) -> Guide:
    """The pieces of a line, one after the other."""
    poses, senses = (np.concatenate(parts) for parts in zip(*line, strict=True))
    paces = np.where(senses > 0.0, pace(scenario, 1.0), pace(scenario, -1.0))
    steps = np.hypot(*np.diff(poses[:, :2], axis=0).T)
    times = steps * np.where(steps > 0.0, paces[1:], 0.0)
    for turn in 1 + np.flatnonzero(senses[1:] == 0.0):
        times[turn - 1] = turning_time(scenario, float(poses[turn, 2] - poses[turn - 1, 2]))
    times = np.cumsum(times)
    times = np.concatenate([[0.0], times])
    return Guide(poses, times, senses, score, float(times[np.argmax(_within(scenario, poses))]))


def _within(scenario: Scenario, poses: Floats) -> npt.NDArray[np.bool_]:
    """Which poses (N, 3) are within the goal's tolerance, for certain the last one."""
    error = poses - scenario.goal
    near = np.hypot(error[:, 0], error[:, 1]) <= scenario.position_tolerance
    near &= np.abs(np.remainder(error[:, 2] + np.pi, 2.0 * np.pi) - np.pi) <= scenario.heading_tolerance
    near[-1] = True
    return near


def _turned(poses: Floats, sense: float) -> Floats:
    turned = poses.copy()
    turned[:, 2] += 0.0 if sense > 0.0 else np.pi
    return turned


def _followed(route: Route, begin: float, end: float, sense: float) -> Piece:
    ways = np.append(np.arange(begin, end, SPACING), end)
    return _turned(route.poses(ways), sense), np.full(len(ways), sense)
