"""What a robot on its way knows of the scenario: the map of what rests, and what moves within the sensor's reach."""

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from applications.rosbot.gaps import gaps_at, gaps_to_room
from applications.rosbot.scenario import MOST, Scenario
from gpsynth.arrays import Floats
from gpsynth.checks import check_number, check_whole
from gpsynth.errors import ScenarioError

TOUCHING = 1e-9  # m that what is shrunk keeps off, so that no rounding undoes it

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
    """The circles (c, 5) after a time (s); one that has left what a scenario may reach is at its edge for good."""
    later = circles.copy()
    later[:, :2] = np.clip(later[:, :2] + time * later[:, 2:4], -MOST, MOST)
    return later


def scene_ahead(scenario: Scenario, circles: Floats, state: Floats, delay: float) -> Scenario:
    """The scenario as it will be after a delay (s): from a state (5,) there, with the circles (c, 5) moved on.

    A circle that the robot would overlap is shrunk until it does not, a robot that would overlap the room is made
    thinner, and a pose out of bounds is moved inside: where it should not be it is all the same, and has to leave.
    """
    later = moved(circles, delay)
    low, high = scenario.bounds.reshape(2, 2).T
    pose, speeds = state[:3], state[3:]
    start = np.append(np.clip(pose[:2], low, high), np.remainder(pose[2] + np.pi, 2.0 * np.pi) - np.pi)
    slim = _thinned(scenario, start)
    fits = gaps_at(slim.body, later, start) + later[:, 4] - TOUCHING
    later[:, 4] = np.minimum(later[:, 4], fits)
    return replace(slim, start=start, speeds=(speeds[0], speeds[1]), circles=later[fits >= 0.0])


def _thinned(scenario: Scenario, pose: Floats) -> Scenario:
    """The scenario for a robot thin enough for a pose (3,) in the room; where no robot is, without the room."""
    if scenario.room is None:
        return scenario
    gap = float(gaps_to_room(scenario.body, scenario.room, pose[np.newaxis])[0])
    if gap >= 0.0:
        return scenario
    thin = scenario.body + np.array([0.0, 0.0, gap - TOUCHING])
    return replace(scenario, footprint=thin) if np.all(thin[:, 2] > 0.0) else replace(scenario, room=None)


def _moves(circles: Floats) -> Flags:
    moving: Flags = np.any(circles[:, 2:4] != 0.0, axis=1)
    return moving
