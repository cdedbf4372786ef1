"""A simulator that shares no line with the planner's own: what plans are judged by."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from applications.rosbot.controls import held
from applications.rosbot.gaps import least_gap, least_gap_to_room
from applications.rosbot.lags import nominal_path
from applications.rosbot.others import Other
from applications.rosbot.scenario import Scenario
from gpsynth.arrays import Floats, frozen

STEP = 1e-3  # s; at 0.5 m/s the robot moves half a millimeter in it
SLACK = 1e-6  # m and rad; what rounding may cost a path that touches an obstacle or just arrives


@dataclass(frozen=True, eq=False)
class Replay:
    """What became of the controls, up to the arrival if there is one."""

    arrival_time: float  # s, first sample within the goal's tolerance; inf if none is
    clearance: float  # m, smallest gap between robot and obstacles at the samples; inf without obstacles
    in_limits: bool
    in_bounds: bool
    in_time: bool
    trajectory: Floats  # (N, 4) s, m, m, rad

    @property
    def solves(self) -> bool:
        """Whether the goal is reached in time, within the limits and bounds, and without a collision."""
        return self.in_time and self.in_limits and self.in_bounds and self.clearance >= -SLACK


def replay(
    scenario: Scenario, controls: Floats, period: float | Floats, *, via: Floats = np.empty((0, 3))
) -> Replay:
    """Drive (v, omega) pairs, (n, 2), for `period` seconds each (one number, or one per pair), in steps of 1 ms.

    The robot starts at the scenario's start and stops at the end of the controls. It has arrived in the goal's
    tolerance once it has been within the third number (m) of each place in `via` (m, 3), one after the other. Raises
    ScenarioError if these are no controls.
    """
    controls, durations = held(controls, period)
    trajectory = _driven(scenario, controls, durations)
    reached = within(scenario, trajectory[:, 1:])
    reached[: _passed(trajectory, via)] = False
    arrived = bool(np.any(reached))
    trajectory = trajectory[: int(np.argmax(reached)) + 1] if arrived else trajectory
    arrival_time = float(trajectory[-1, 0]) if arrived else np.inf
    return Replay(
        arrival_time=arrival_time,
        clearance=clearance(scenario, trajectory),
        in_limits=_in_limits(scenario, controls),
        in_bounds=_in_bounds(scenario, trajectory),
        in_time=arrival_time <= scenario.time_limit,
        trajectory=frozen(trajectory),
    )


def _driven(scenario: Scenario, controls: Floats, durations: Floats) -> Floats:
    if scenario.model != "dynamic_unicycle":
        return drive(scenario.start, controls, durations)
    path = nominal_path(scenario.start, controls, durations, scenario.speeds)
    return np.column_stack([path.times, path.poses])


def drive(start: Floats, controls: Floats, durations: Floats) -> Floats:
    """The poses (N, 4) at steps of at most 1 ms and at every change of the controls, by classical Runge-Kutta.

    The rates depend on the heading only and the heading is linear in time, so a Runge-Kutta step is Simpson's rule
    and all steps are taken at once.
    """
    counts = np.ceil(durations / STEP - 1e-9).astype(int)
    counts[durations > 0.0] = np.maximum(counts[durations > 0.0], 1)
    steps = np.repeat(durations / np.maximum(counts, 1), counts)
    v, omega = np.repeat(controls, counts, axis=0).T
    turns = steps * omega
    heading = start[2] + np.concatenate([[0.0], np.cumsum(turns)])
    before, middle, after = heading[:-1], heading[:-1] + 0.5 * turns, heading[1:]
    dx = steps * v / 6.0 * (np.cos(before) + 4.0 * np.cos(middle) + np.cos(after))
    dy = steps * v / 6.0 * (np.sin(before) + 4.0 * np.sin(middle) + np.sin(after))
    trajectory = np.empty((len(steps) + 1, 4))
    trajectory[0] = 0.0, *start
    trajectory[1:, 0] = np.cumsum(steps)
    trajectory[1:, 1] = start[0] + np.cumsum(dx)
    trajectory[1:, 2] = start[1] + np.cumsum(dy)
    trajectory[:, 3] = heading
    return trajectory


def within(scenario: Scenario, poses: Floats) -> npt.NDArray[np.bool_]:
    """Which of the poses (N, 3) lie within the goal's tolerance."""
    errors = poses - scenario.goal
    distance = np.hypot(errors[:, 0], errors[:, 1])
    turn = np.abs(np.remainder(errors[:, 2] + np.pi, 2.0 * np.pi) - np.pi)
    inside: npt.NDArray[np.bool_] = (distance <= scenario.position_tolerance + SLACK) & (
        turn <= scenario.heading_tolerance + SLACK
    )
    return inside


def clearance(scenario: Scenario, trajectory: Floats) -> float:
    """The smallest gap (m) between the robot and the obstacles, moving ones where they then are; inf without any."""
    t, poses = trajectory[:, 0], trajectory[:, 1:]
    gap = least_gap(scenario.body, scenario.circles, poses, t)
    if scenario.room is not None:
        gap = min(gap, least_gap_to_room(scenario.body, scenario.room, poses))
    return min(gap, *(_gap_to(other, scenario.radius, trajectory) for other in scenario.others), np.inf)


def _gap_to(other: Other, radius: float, trajectory: Floats) -> float:
    """The smallest gap (m) to another robot; whoever has ended stands where it is."""
    driven = drive(other.start, other.controls, other.durations)
    times = np.union1d(trajectory[:, 0], driven[:, 0])
    apart = [
        np.interp(times, trajectory[:, 0], trajectory[:, axis])
        - np.interp(times, driven[:, 0], driven[:, axis])
        for axis in (1, 2)
    ]
    return float(np.hypot(*apart).min()) - radius - other.radius


def _passed(trajectory: Floats, via: Floats) -> int:
    """The first sample at which all places have been passed in their order; the number of samples if none is."""
    first = 0
    for x, y, tolerance in via:
        near = np.hypot(trajectory[first:, 1] - x, trajectory[first:, 2] - y) <= tolerance + SLACK
        if not np.any(near):
            return len(trajectory)
        first += int(np.argmax(near))
    return first


def _in_limits(scenario: Scenario, controls: Floats) -> bool:
    low, high = np.array([scenario.speed_limits, scenario.turn_limits]).T
    if scenario.model == "car":
        sharpest = np.abs(controls[:, 0]) / scenario.turning_radius
        if np.any(np.abs(controls[:, 1]) > sharpest + SLACK):
            return False
    return bool(np.all((controls >= low - SLACK) & (controls <= high + SLACK)))


def _in_bounds(scenario: Scenario, trajectory: Floats) -> bool:
    position = trajectory[:, 1:3]
    low, high = scenario.bounds[[0, 2]], scenario.bounds[[1, 3]]
    return bool(np.all((position >= low - SLACK) & (position <= high + SLACK)))
