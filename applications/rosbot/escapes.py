"""Escapes: out of a place so cramped that no curve leaves it freely, by a turn in place and a straight line."""

from dataclasses import dataclass

import numpy as np

from applications.rosbot.scenario import Scenario
from gpsynth.arrays import Floats

DIRECTIONS = 24  # that are tried
LENGTHS = (0.1, 0.25, 0.5)  # m, of the straight lines
SPACING = 0.05  # m, between the poses of a line


@dataclass(frozen=True, eq=False)
class Escape:
    """Poses (n, 3) from a place on; the sense of travel up to each, 0 being a turn in place; how long it takes."""

    poses: Floats
    senses: Floats  # (n,)
    seconds: float

    @classmethod
    def nowhere(cls, pose: Floats) -> "Escape":
        """To stay at a pose."""
        return cls(pose[np.newaxis], np.zeros(1), 0.0)

    def back(self) -> "Escape":
        """The same way driven back to the place; the time is that of the limits it was found under."""
        return Escape(self.poses[::-1], np.append(-self.senses[:0:-1], 0.0), self.seconds)


def can_turn_in_place(scenario: Scenario) -> bool:
    """Whether the robot can stand while it turns."""
    low, high = scenario.speed_limits
    return scenario.model != "car" and low <= 0.0 <= high


def escapes(scenario: Scenario, pose: Floats, *, count: int = 12, arrives: bool = False) -> list[Escape]:
    """Up to `count` free ways to leave a pose (3,), or to arrive at it, the quickest first."""
    if not can_turn_in_place(scenario):
        return []
    found = []
    for direction in np.linspace(-np.pi, np.pi, DIRECTIONS, endpoint=False):
        for length in LENGTHS:
            ways = np.append(np.arange(0.0, length, SPACING), length)
            line = pose[:2] + ways[:, np.newaxis] * [np.cos(direction), np.sin(direction)]
            if np.min(room_at(scenario, line)) >= -1e-9:
                both = [_escape(scenario, pose, line, direction, sense, arrives) for sense in (1.0, -1.0)]
                found.append(min(both, key=_seconds))
    found = sorted((each for each in found if np.isfinite(each.seconds)), key=_seconds)[:count]
    return [each.back() for each in found] if arrives else found


def turning_time(scenario: Scenario, angle: float) -> float:
    """How long (s) a turn in place by an angle (rad) takes, either way round."""
    right, left = scenario.turn_limits
    rest = float(np.remainder(angle, 2.0 * np.pi))
    times = [rest / left] if left > 0.0 else []
    times += [(2.0 * np.pi - rest) / -right] if right < 0.0 and rest > 0.0 else []
    return min(times, default=np.inf) if rest > 0.0 else 0.0


def room_at(scenario: Scenario, places: Floats) -> Floats:
    """How far (N,) places (N, 2) are within the bounds and from what the robot's center must stay out of, in m."""
    low, high = scenario.bounds.reshape(2, 2).T
    room: Floats = np.minimum(places - low, high - places).min(axis=1)
    discs = scenario.discs
    gaps = np.hypot(*(places[:, None] - discs[:, :2]).transpose(2, 0, 1)) - discs[:, 2]
    room = np.minimum(room, gaps.min(axis=1, initial=np.inf))
    if scenario.field is not None:
        room = np.minimum(room, scenario.field.at(places) - scenario.radius)
    return room


def _escape(
    scenario: Scenario, pose: Floats, line: Floats, direction: float, sense: float, arrives: bool
) -> Escape:
    heading = direction if sense > 0.0 else direction + np.pi
    low, high = scenario.speed_limits
    speed = high if (sense > 0.0) != arrives else -low
    length = float(np.hypot(*(line[-1] - line[0])))
    turn = heading - pose[2]
    seconds = turning_time(scenario, -turn if arrives else turn) + (length / speed if speed > 0.0 else np.inf)
    poses = np.vstack([pose, np.column_stack([line, np.full(len(line), heading)])])
    return Escape(poses, np.append([0.0, 0.0], np.full(len(line) - 1, sense)), seconds)


def _seconds(escape: Escape) -> float:
    return escape.seconds
