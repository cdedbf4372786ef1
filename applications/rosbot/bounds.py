"""Times no plan can beat: what a plan's quality is measured by where the optimum is unknown."""

import numpy as np

from applications.rosbot.guides import top_speed
from applications.rosbot.model import FAMILY
from applications.rosbot.reeds_shepp import distance
from applications.rosbot.replay import SLACK
from applications.rosbot.routes import routes
from applications.rosbot.scenario import Scenario
from gpsynth.arrays import Floats

LEVELS = 11  # halvings of the cells, each of which halves what their size costs the bound
MOST_CELLS = 2_000
OCTANTS = np.stack(np.meshgrid([-1.0, 1.0], [-1.0, 1.0], [-1.0, 1.0]), axis=-1).reshape(-1, 3)


def lower_bound(scenario: Scenario, *, enough: float = np.inf) -> float:
    """The greatest of four lower bounds on the arrival time (s); 0 if the start is within the tolerance.

    The straight line, the turn, the shortest route around the obstacles where they rest and leave the whole tolerance
    free, and the Reeds-Shepp path to the nearest pose of the tolerance, all at top speed. Once a bound is above
    `enough` (s), those that take longer are not looked for.
    """
    position, heading = _tolerance(scenario)
    radius = _radius(scenario)
    dx, dy, turn = scenario.goal - scenario.start
    turn = abs(np.remainder(turn + np.pi, 2.0 * np.pi) - np.pi)
    least = max(np.hypot(dx, dy) - position, radius * (turn - heading))
    if least <= 0.0:
        return 0.0
    speed, longest = top_speed(scenario), least
    discs = scenario.discs
    gaps = np.hypot(*(discs[:, :2] - scenario.goal[:2]).T) - discs[:, 2]
    static = scenario.room is None and scenario.is_static and scenario.covers_origin
    if longest <= enough * speed and static and gaps.min(initial=np.inf) > position:
        longest = max([longest, *(route.length - position for route in routes(scenario, count=1))])
    if longest <= enough * speed:
        longest = max(longest, _reeds_shepp(scenario, least))
    return float(longest) / speed


def _reeds_shepp(scenario: Scenario, least: float) -> float:
    """A lower bound (m) on the way to every pose of the tolerance, at least the one given, by branch and bound.

    How fast the shortest way changes with its end is the costate of the maximum principle: at most the radius for the
    heading, and 1 for the position if the way has a straight piece. A way of arcs alone whose costate s is greater has
    at most four arcs of angle asin(1/s) each, so s <= 1 / sin(way / (4 radius)), and no way is shorter than `least`.
    """
    position, heading = _tolerance(scenario)
    radius, shortest = _radius(scenario), np.inf
    half = np.array([0.5 * position, np.pi, min(heading, np.pi)])
    cells = np.array([[0.5 * position, 0.0, 0.0]])  # distance from the goal, direction, turn
    for _ in range(LEVELS):
        half = 0.5 * half
        cells = (cells[:, np.newaxis] + OCTANTS * half).reshape(-1, 3)
        ways = distance(scenario.start, scenario.goal + _offsets(cells), radius)
        slope = 1.0 / np.sin(min(0.25 * least / radius, 0.5 * np.pi))
        lowest = ways - slope * (half[0] + (cells[:, 0] + half[0]) * half[1]) - radius * half[2]
        shortest, least = min(shortest, ways.min()), max(least, lowest.min())
        cells = cells[lowest <= shortest]
        if len(cells) > MOST_CELLS:
            break
    return least


def _offsets(cells: Floats) -> Floats:
    away, direction, turn = cells.T
    return np.column_stack([away * np.cos(direction), away * np.sin(direction), turn])


def _tolerance(scenario: Scenario) -> tuple[float, float]:
    """The tolerance (m, rad) as the replay reads it."""
    return scenario.position_tolerance + SLACK, scenario.heading_tolerance + SLACK


def _radius(scenario: Scenario) -> float:
    """A radius (m) that no robot turns more sharply than at top speed."""
    gain = FAMILY["k_omega"][3] if scenario.model == "dynamic_unicycle" else 1.0
    return max(top_speed(scenario) / (gain * max(map(abs, scenario.turn_limits))), scenario.turning_radius)
