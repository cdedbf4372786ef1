"""Scenarios of the public ones' kinds, generated: other sizes, poses and limits, tight gaps, starts that touch."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from applications.rosbot.reachability import reachability
from applications.rosbot.scenario import Scenario
from applications.rosbot.training import circles_in_a_row
from gpsynth.arrays import Floats
from gpsynth.errors import ScenarioError
from gpsynth.seeds import stream

ROBOT = 0.15  # m, radius
TWISTS = ("other", "turned", "limits", "tight", "touching")
LIMITS = (  # m/s and rad/s
    ((-0.5, 0.5), (-1.5, 1.5)),
    ((-1.0, 1.0), (-1.0, 1.0)),
    ((-0.1, 0.1), (-0.3, 0.3)),
    ((-0.2, 0.6), (-0.8, 0.8)),
    ((-0.5, 0.5), (-0.3, 0.6)),
    ((0.0, 0.5), (-0.5, 0.5)),
    ((-0.6, 0.6), (-0.4, 0.4)),
)
GAPS = (1e-6, 1e-4, 1e-3, 3e-3, 1e-2)  # m, between a touching robot and an obstacle or a bound
_STREAM = 107

Rng = np.random.Generator


class Drawn(NamedTuple):
    """A scene before it becomes a scenario."""

    start: Floats  # (3,)
    goal: Floats  # (3,)
    circles: Floats  # (c, 3) x, y, radius in m
    bounds: Floats  # (4,) m


def generated(seed: int = 0) -> list[Scenario]:
    """Every kind with every twist; the same seed gives the same ones. All but those of `enclosed` can be solved."""
    return [
        next(_scenarios(kind, twist, 100 * seed + 5 * number + column))
        for number, kind in enumerate(KINDS)
        for column, twist in enumerate(TWISTS)
    ]


def _scenarios(kind: str, twist: str, number: int) -> Iterator[Scenario]:
    """Scenarios of a kind that are in order and, but for those enclosed, can be solved."""
    rng = stream(number, _STREAM)
    while True:
        drawn = KINDS[kind](rng, twist == "tight")
        speed, turn = LIMITS[number % len(LIMITS)] if twist == "limits" else ((-0.5, 0.5), (-0.5, 0.5))
        if twist == "turned":
            drawn = _turned(drawn, rng)
        if twist == "touching":
            drawn = _touching(drawn, GAPS[number // 5 % len(GAPS)], rng)
        try:
            scenario = Scenario(
                start=drawn.start,
                goal=drawn.goal,
                speed_limits=speed,
                turn_limits=turn,
                bounds=drawn.bounds,
                circles=np.insert(drawn.circles, 2, np.zeros((2, 1)), axis=1),
                time_limit=300.0 if speed[1] < 0.3 else 60.0,
                name=f"{kind}-{twist}",
            )
        except ScenarioError:
            continue  # start or goal in an obstacle
        is_feasible = reachability(scenario).status == "reachable"
        if is_feasible or kind == "enclosed":
            yield replace(scenario, expect_feasible=is_feasible)


def _turned(drawn: Drawn, rng: Rng) -> Drawn:
    """Mirrored, x and y exchanged, or start and goal, each by chance."""
    start, goal, circles, bounds = drawn
    if rng.random() < 0.5:
        start, goal, circles = start * [1, -1, -1], goal * [1, -1, -1], circles * [1, -1, 1]
        bounds = np.array([*bounds[:2], -bounds[3], -bounds[2]])
    if rng.random() < 0.5:
        start, goal = ([y, x, 0.5 * np.pi - heading] for x, y, heading in (start, goal))
        circles, bounds = circles[:, [1, 0, 2]], bounds[[2, 3, 0, 1]]
    if rng.random() < 0.5:
        start, goal = np.add(goal, [0, 0, np.pi]), np.add(start, [0, 0, np.pi])
    return Drawn(np.asarray(start), np.asarray(goal), circles, bounds)


def _touching(drawn: Drawn, gap: float, rng: Rng) -> Drawn:
    """One or two more circles, or a bound, so near to start or goal."""
    near = drawn.start if rng.random() < 0.7 else drawn.goal
    if rng.random() < 0.25:
        bounds = drawn.bounds.copy()
        bounds[0] = min(near[0] - gap, drawn.start[0], drawn.goal[0])
        return drawn._replace(bounds=bounds)
    count = int(rng.integers(1, 3))
    radii, angles = rng.uniform(0.1, 0.35, count), rng.uniform(-np.pi, np.pi, count)
    away = radii + ROBOT + gap
    places = near[:2] + away[:, None] * np.column_stack([np.cos(angles), np.sin(angles)])
    return drawn._replace(circles=np.vstack([drawn.circles, np.column_stack([places, radii])]))


def _pose(rng: Rng, x: float, y: float, heading: float = 0.0, turn: float = 0.5) -> Floats:
    """A pose near another."""
    return np.array([x, y, heading]) + rng.uniform(-1.0, 1.0, 3) * [0.2, 0.2, turn]


def _seed(rng: Rng, tight: bool) -> Drawn:
    count = 9 if tight else 6
    goal = np.append(rng.uniform(1.5, 2.5, 2), rng.choice([0.0, 0.5, -0.5]) * np.pi)
    circles = np.column_stack([rng.uniform(-1.6, 2.6, (count, 2)), rng.uniform(0.25, 0.45, count)])
    circles[0, :2] = 0.45 * goal[:2] + rng.uniform(-0.2, 0.2, 2)
    return Drawn(
        np.array([0.0, 0.0, rng.uniform(-np.pi, np.pi)]), goal, circles, np.array([-2.0, 3.0, -2.0, 3.0])
    )


def _empty(rng: Rng, tight: bool) -> Drawn:
    reach = 0.6 if tight else 2.5
    goal = np.append(rng.uniform(-reach, reach, 2), rng.uniform(-np.pi, np.pi))
    room = 0.2 if tight else 2.0
    x, y = (np.array([min(0.0, each) - room, max(0.0, each) + room]) for each in goal[:2])
    return Drawn(np.array([0.0, 0.0, rng.uniform(-np.pi, np.pi)]), goal, np.empty((0, 3)), np.append(x, y))


def _narrow(rng: Rng, tight: bool) -> Drawn:
    gap = rng.uniform(0.302, 0.32) if tight else rng.uniform(0.34, 0.5)
    x, y, radius = rng.uniform(1.2, 1.8), rng.uniform(-0.9, 0.9), rng.uniform(0.12, 0.25)
    upper = np.arange(y + 0.5 * gap + radius, 2.5, 1.5 * radius)
    lower = np.arange(y - 0.5 * gap - radius, -2.5, -1.5 * radius)
    walls = np.array([[x, place, radius] for place in (*upper, *lower)])
    return Drawn(_pose(rng, 0.0, 0.0), _pose(rng, 3.0, 0.0), walls, np.array([-0.5, 3.5, -2.0, 2.0]))


def _wall(rng: Rng, tight: bool) -> Drawn:
    middle, half = rng.uniform(-0.4, 0.4), rng.uniform(0.7, 1.3)
    wall = circles_in_a_row([1.2, middle - half], [1.2, middle + half], rng.uniform(0.1, 0.2))
    low, high = (middle - half - 0.15 - wall[0, 2], middle + half + 0.15 + wall[0, 2])
    # tight: within the bounds only just past both ends
    room = rng.uniform(0.005, 0.03) if tight else rng.uniform(0.5, 1.2)
    return Drawn(
        _pose(rng, 0.0, 0.0), _pose(rng, 2.4, 0.2), wall, np.array([-1.0, 3.5, low - room, high + room])
    )


def _slalom(rng: Rng, tight: bool) -> Drawn:
    step, radius = rng.uniform(0.9, 1.2), rng.uniform(0.25, 0.33)
    aside = rng.uniform(0.14, 0.17) if tight else rng.uniform(0.08, 0.2)
    # the wall stands so that between it and a post is room for the robot, or only just
    room = rng.uniform(0.302, 0.32) if tight else rng.uniform(0.36, 0.45)
    posts = [[0.9 + step * k, aside * (-1) ** k, radius] for k in range(int(rng.integers(2, 5)))]
    end = 0.9 + step * len(posts)
    wall = radius - aside + room + 0.35
    walls = [[x, side * wall, 0.35] for x in np.arange(0.0, end + 0.3, 0.5) for side in (1.0, -1.0)]
    goal = np.array([end + 0.1, 0.0, rng.uniform(-0.3, 0.3)])
    return Drawn(np.zeros(3), goal, np.array(posts + walls), np.array([-0.6, end + 0.7, -1.0, 1.0]))


def _utrap(rng: Rng, tight: bool) -> Drawn:
    half, depth, radius = rng.uniform(0.6, 0.9), rng.uniform(0.8, 1.3), rng.uniform(0.1, 0.18)
    if tight:
        half, depth = radius + ROBOT + rng.uniform(0.02, 0.1), rng.uniform(0.8, 1.0)
    back = 1.5
    corners = [back, -half], [back, half]
    rows = [
        circles_in_a_row(*corners, radius),
        *(circles_in_a_row(corner, [back - depth, corner[1]], radius) for corner in corners),
    ]
    start = np.array(
        [back - depth + rng.uniform(-0.2, 0.4), rng.uniform(-0.05, 0.05), rng.uniform(-0.5, 0.5)]
    )
    return Drawn(start, _pose(rng, 2.5, 0.1), np.vstack(rows), np.array([-1.5, 3.5, -2.0, 2.0]))


def _forest(count: int, least: float, most: float) -> Callable[[Rng, bool], Drawn]:
    def drawn(rng: Rng, tight: bool) -> Drawn:
        trees = count * 4 // 3 if tight else count
        circles = np.column_stack([rng.uniform(0.0, 4.0, (trees, 2)), rng.uniform(least, most, trees)])
        goal = np.array([4.0, 4.0, rng.choice([0.0, 0.5, 1.0]) * np.pi])
        return Drawn(np.zeros(3), goal, circles, np.array([-0.5, 4.5, -0.5, 4.5]))

    return drawn


def _reversal(rng: Rng, tight: bool) -> Drawn:
    x = rng.uniform(-2.2, -1.2)
    circles = [[0.5 * x, rng.uniform(-0.15, 0.15), rng.uniform(0.15, 0.25)]]
    circles += [
        [0.5 * x + rng.uniform(-0.4, 0.4), side * rng.uniform(0.75, 1.0), 0.3] for side in (1.0, -1.0)
    ]
    if tight:
        circles += [[0.45, 0.0, 0.2], [x - 0.45, rng.uniform(-0.1, 0.1), 0.2]]
    goal = np.array([x, rng.uniform(-0.1, 0.1), rng.uniform(-0.2, 0.2)])
    return Drawn(np.zeros(3), goal, np.array(circles), np.array([-3.0, 2.0, -2.0, 2.0]))


def _parking(rng: Rng, tight: bool) -> Drawn:
    y, radius = rng.uniform(0.6, 1.1), rng.uniform(0.2, 0.3)
    aside = radius + ROBOT + (rng.uniform(0.01, 0.05) if tight else rng.uniform(0.2, 0.45))
    circles = [[-aside, y, radius], [aside, y, radius], [0.0, y + 0.2 + radius + ROBOT, radius]]
    circles += [[side * 0.5, y + 0.55, 0.2] for side in (1.0, -1.0)]
    circles += [[rng.uniform(-0.2, 0.2), -0.75, 0.3]]
    goal = np.array([0.0, y, rng.choice([0.0, 0.5, 1.0]) * np.pi])
    return Drawn(np.zeros(3), goal, np.array(circles), np.array([-2.0, 2.0, -1.2, 2.0]))


def _enclosed(rng: Rng, tight: bool) -> Drawn:
    """A ring around the goal, with one gap that is just wide enough or not."""
    radius, count = rng.uniform(0.6, 0.9), 12
    width = 0.3 + (1 if tight else -1) * rng.uniform(0.002, 0.02)
    size = 0.18
    step = 2.0 * np.arcsin((size + 0.5 * width) / radius)
    angles = rng.uniform(-np.pi, np.pi) + np.linspace(0.5 * step, 2.0 * np.pi - 0.5 * step, count)
    goal = np.array([2.0, 2.0, rng.uniform(-np.pi, np.pi)])
    ring = goal[:2] + radius * np.column_stack([np.cos(angles), np.sin(angles)])
    circles = np.column_stack([ring, np.full(count, size)])
    return Drawn(np.zeros(3), goal, np.vstack([circles, [1.0, 0.5, 0.2]]), np.array([-1.0, 4.0, -1.0, 4.0]))


KINDS: Mapping[str, Callable[[Rng, bool], Drawn]] = MappingProxyType(
    {
        "seed": _seed,
        "empty": _empty,
        "narrow": _narrow,
        "wall": _wall,
        "slalom": _slalom,
        "utrap": _utrap,
        "forest10": _forest(10, 0.2, 0.4),
        "forest20": _forest(20, 0.15, 0.3),
        "forest40": _forest(40, 0.1, 0.2),
        "reversal": _reversal,
        "parking": _parking,
        "enclosed": _enclosed,
    }
)
