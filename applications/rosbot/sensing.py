"""What a robot on its way knows of the scenario: the map of what rests, and what moves within the sensor's reach."""

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from applications.rosbot.scenario import Scenario
from gpsynth.arrays import Floats
from gpsynth.checks import check_number, check_whole
from gpsynth.errors import ScenarioError

Flags = npt.NDArray[np.bool_]


@dataclass(frozen=True)
class Sensor:
    """Positions and velocities of moving circles, exact within its reach and unknown beyond it."""

    reach: float = 3.0  # m, from the robot's center to the edge of a circle
    most: int = 32  # moving circles it can tell apart

    def __post_init__(self) -> None:
        check_number("the sensor's reach", self.reach)
        if not self.reach > 0.0:
            raise ScenarioError(f"the sensor's reach is {self.reach} m; expected more than 0")
        check_whole("the moving circles a sensor can tell apart", self.most, 1)

    def check(self, scenario: Scenario) -> None:
        """Raise ScenarioError if more circles move than can be told apart."""
        moving = int(np.sum(_moves(scenario.circles)))
        if moving > self.most:
            raise ScenarioError(f"{moving} circles move; the sensor can tell {self.most} apart")

    def knows(self, circles: Floats, position: Floats) -> Flags:
        """Which of the circles (c, 5) rest, or are near to a position (2,)."""
        near: Flags = np.hypot(*(circles[:, :2] - position).T) - circles[:, 4] <= self.reach
        return near | ~_moves(circles)

    def seen(self, scenario: Scenario, position: Floats, time: float) -> Floats:
        """The circles (s, 5) known at a position (2,), where they are at a time (s)."""
        circles = moved(scenario.circles, time)
        known: Floats = circles[self.knows(circles, position)]
        return known


def moved(circles: Floats, time: float) -> Floats:
    """The circles (c, 5) after a time (s)."""
    later = circles.copy()
    later[:, :2] += time * later[:, 2:4]
    return later


def scene_ahead(scenario: Scenario, circles: Floats, pose: Floats, delay: float) -> Scenario:
    """The scenario as it will be after a delay (s): from a pose (3,) there, with the circles (c, 5) moved on.

    A circle that the robot would overlap is shrunk until it does not, and a pose out of bounds is moved inside: where
    it should not be it is all the same, and has to leave.
    """
    later = moved(circles, delay)
    low, high = scenario.bounds.reshape(2, 2).T
    start = np.append(np.clip(pose[:2], low, high), np.remainder(pose[2] + np.pi, 2.0 * np.pi) - np.pi)
    gap = np.hypot(*(later[:, :2] - start[:2]).T) * (1.0 - 1e-9) - scenario.radius
    later[:, 4] = np.minimum(later[:, 4], gap)
    return replace(scenario, start=start, circles=later[gap >= 0.0])


def _moves(circles: Floats) -> Flags:
    moving: Flags = np.any(circles[:, 2:4] != 0.0, axis=1)
    return moving
