"""Times no plan can beat: what a plan's quality is measured by where the optimum is unknown."""

import numpy as np

from applications.rosbot.guides import top_speed
from applications.rosbot.reeds_shepp import distance
from applications.rosbot.routes import routes
from applications.rosbot.scenario import Scenario
from gpsynth.arrays import Floats


def lower_bound(scenario: Scenario) -> float:
    """The greatest of three lower bounds on the arrival time (s).

    The straight line, the shortest route around the obstacles where they rest and leave the whole tolerance free, and
    the Reeds-Shepp path to the nearest pose of the tolerance (the least of samples of it), all at top speed.
    """
    lengths = [np.hypot(*(scenario.goal - scenario.start)[:2]) - scenario.position_tolerance]
    discs = scenario.discs
    gaps = np.hypot(*(discs[:, :2] - scenario.goal[:2]).T) - discs[:, 2]
    if scenario.is_static and gaps.min(initial=np.inf) > scenario.position_tolerance:
        lengths += [route.length - scenario.position_tolerance for route in routes(scenario, count=1)]
    radius = top_speed(scenario) / max(map(abs, scenario.turn_limits))
    lengths.append(distance(scenario.start, _tolerated(scenario), radius).min())
    return max(0.0, float(max(lengths)) / top_speed(scenario))


def _tolerated(scenario: Scenario) -> Floats:
    """Poses (N, 3) on the edge of the goal's tolerance, and around its middle."""
    angles = np.linspace(0.0, 2.0 * np.pi, 180, endpoint=False)
    turns = scenario.heading_tolerance * np.linspace(-1.0, 1.0, 9)
    radii = scenario.position_tolerance * np.array([0.5, 1.0])
    angle, turn, radius = (axis.ravel() for axis in np.meshgrid(angles, turns, radii))
    return scenario.goal + np.column_stack([radius * np.cos(angle), radius * np.sin(angle), turn])
