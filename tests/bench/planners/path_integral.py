"""Model predictive path integral control (Williams et al. 2017): a sampling MPC that drives along a guide to the goal.

What a sample costs is its time: until it arrives, or the horizon and what is left of the guide from the nearest pose in
reach. Samples and horizon are those of Nav2 (1000 of 56 steps of 0.05 s); noise is held over four steps, as the fastest
controls switch rarely. Noise and temperature were tuned on p01, p03, p06, p08 and p10 over (0.4, 0.7) of the limits and
(0.02, 0.05, 0.1) s.
"""

import math
from collections.abc import Iterator

import numba
import numpy as np

from applications.rosbot.discs import grown
from applications.rosbot.scenario import Scenario
from gpsynth.arrays import Floats
from gpsynth.seeds import stream
from tests.bench.planners.attempt import MARGIN, Answer, Watch, guides_of

SAMPLES, STEPS, STEP = 1000, 56, 0.05  # s
HELD = 4  # steps with the same noise
NOISE = (0.7, 0.7)  # of the upper limits, standard deviation
TEMPERATURE = 0.05  # s
APART, TURNED = 2.0, 1.0  # s that a meter and a radian from the guide count for
CRASH = 1e3  # s
LONGEST = 40.0  # s of driving: nothing that takes longer is worth having here


def path_integral(scenario: Scenario, seed: int, watch: Watch) -> Iterator[Answer]:
    """Drive until the goal is reached; one answer, after all the computing that this takes."""
    guide = guides_of(scenario, count=5)[0]
    line = np.column_stack([guide.poses, guide.times])
    limits = np.array([scenario.speed_limits, scenario.turn_limits])
    discs, bounds = grown(scenario.discs, MARGIN), np.array(scenario.bounds)
    aim = np.array([*scenario.goal, 0.98 * scenario.position_tolerance, 0.98 * scenario.heading_tolerance])
    sigma, rng = np.array(NOISE) * limits[:, 1], stream(seed, 1)
    pose, nominal, driven, near = np.array(scenario.start), np.zeros((STEPS, 2)), [], 0
    while len(driven) * STEP < LONGEST and not arrived(pose, aim):
        noise = sigma * rng.normal(size=(SAMPLES, -(-STEPS // HELD), 2))
        noise[0] = 0.0
        near = nearest(line, pose, near, STEP)
        costs = np.empty(SAMPLES)
        sample(pose, nominal, noise, limits, discs, bounds, aim, line, near, costs)
        weights = np.exp(-(costs - costs.min()) / TEMPERATURE)
        change = np.tensordot(weights / weights.sum(), noise, 1)
        nominal = np.clip(nominal + np.repeat(change, HELD, axis=0)[:STEPS], *limits.T)
        driven.append(nominal[0])
        pose = np.array(moved(pose[0], pose[1], pose[2], nominal[0, 0], nominal[0, 1], STEP))
        nominal = np.vstack([nominal[1:], nominal[-1:]])
    if arrived(pose, aim):
        yield Answer(watch.spent, np.array(driven), np.full(len(driven), STEP))


@numba.njit
def moved(x: float, y: float, heading: float, v: float, omega: float, time: float):
    """The pose after driving an arc."""
    half = 0.5 * omega * time
    chord = v * time * (math.sin(half) / half if half != 0.0 else 1.0)
    return x + chord * math.cos(heading + half), y + chord * math.sin(heading + half), heading + 2.0 * half


@numba.njit
def turn(angle: float) -> float:
    """The size of an angle, wrapped."""
    return abs(angle - 2.0 * math.pi * math.floor(angle / (2.0 * math.pi) + 0.5))


@numba.njit
def arrived(pose: Floats, aim: Floats) -> bool:
    """Whether a pose is within the tolerance, aim (5,) being the goal and the two tolerances."""
    return math.hypot(pose[0] - aim[0], pose[1] - aim[1]) <= aim[3] and turn(pose[2] - aim[2]) <= aim[4]


@numba.njit
def left(line: Floats, x: float, y: float, heading: float, first: int, ahead: float) -> tuple[float, int]:
    """Time (s) along the line (m, 4) from the pose that is best to go on from, and its number.

    It is sought among those that can be reached within `ahead` seconds of pose `first`.
    """
    best, place = np.inf, first
    for k in range(first, len(line)):
        if line[k, 3] > line[first, 3] + ahead:
            break
        apart = math.hypot(x - line[k, 0], y - line[k, 1])
        cost = line[-1, 3] - line[k, 3] + APART * apart + TURNED * turn(heading - line[k, 2])
        if cost < best:
            best, place = cost, k
    return best, place


@numba.njit
def nearest(line: Floats, pose: Floats, first: int, ahead: float) -> int:
    """The pose of the line that the robot has come to, `first` or a later one."""
    best, place = np.inf, first
    for k in range(first, len(line)):
        if line[k, 3] > line[first, 3] + 10.0 * ahead:
            break
        apart = math.hypot(pose[0] - line[k, 0], pose[1] - line[k, 1]) + 0.3 * turn(pose[2] - line[k, 2])
        if apart < best:
            best, place = apart, k
    return place


@numba.njit
def sample(
    pose: Floats,
    nominal: Floats,  # (H, 2)
    noise: Floats,  # (N, H / HELD, 2)
    limits: Floats,  # (2, 2) of v and omega
    discs: Floats,  # (c, 3), grown
    bounds: Floats,
    aim: Floats,  # (5,)
    line: Floats,  # (m, 4) poses and times
    near: int,
    costs: Floats,
) -> None:
    """Roll every sample out; costs (N,) are seconds."""
    horizon = len(nominal) * STEP
    for n in range(len(noise)):
        x, y, heading = pose[0], pose[1], pose[2]
        cost = -1.0
        for step in range(len(nominal)):
            v = nominal[step, 0] + noise[n, step // HELD, 0]
            omega = nominal[step, 1] + noise[n, step // HELD, 1]
            v = min(max(v, limits[0, 0]), limits[0, 1])
            omega = min(max(omega, limits[1, 0]), limits[1, 1])
            x, y, heading = moved(x, y, heading, v, omega, STEP)
            free = bounds[0] <= x <= bounds[1] and bounds[2] <= y <= bounds[3]
            for k in range(len(discs)):
                dx, dy = x - discs[k, 0], y - discs[k, 1]
                free &= dx * dx + dy * dy >= discs[k, 2] * discs[k, 2]
            if not free:
                cost = CRASH - step * STEP
                break
            if math.hypot(x - aim[0], y - aim[1]) <= aim[3] and turn(heading - aim[2]) <= aim[4]:
                cost = (step + 1) * STEP
                break
        costs[n] = cost if cost >= 0.0 else horizon + left(line, x, y, heading, near, 1.2 * horizon)[0]
