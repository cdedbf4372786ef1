"""First schedules for the swarms: equilibrium points laid along guides, somewhat beyond where they lead."""

from collections.abc import Sequence

import numpy as np

from applications.rosbot.guides import Guide
from gpsynth.arrays import Floats
from gpsynth.schedule import Schedule, Schedules

POSITION_NOISE, HEADING_NOISE, DWELL_NOISE = 0.1, 0.3, 0.15  # m, rad, share
DWELL = (0.0, 4.0)  # s
BEYOND = 0.3  # m: a point ahead of where the next takes over keeps the controls saturated
LINGER = 1.0  # s, that the last point of a schedule through the goal holds on: robots are later than guides


def schedules_along(guides: Sequence[Guide], points: int, through: bool = False) -> Schedules:
    """A schedule along each of the guides, at least one; `through` the goal, if the last point lies beyond it."""
    return Schedules.of([along(guide, points, through) for guide in guides])


def repeated(exact: Schedules, count: int, rng: np.random.Generator) -> Schedules:
    """`count` schedules, the given ones in turn: once as they are, then with noise."""
    number = np.arange(count)
    return _disturbed(exact.take(number % len(exact)), np.where(number < len(exact), 0.0, 1.0), rng)


def along(guide: Guide, points: int, through: bool = False) -> Schedule:
    """Points at equal times along a guide, one for every cusp, each moved on in the direction of travel."""
    nodes = np.searchsorted(guide.times, _switches(guide, points, through) - 1e-9)
    poses, senses = guide.poses[nodes].copy(), guide.senses[nodes]
    heading = np.column_stack([np.cos(poses[:, 2]), np.sin(poses[:, 2])])
    poses[:, :2] += BEYOND * senses[:, np.newaxis] * heading
    dwell = np.diff(guide.times[nodes], prepend=0.0)
    dwell[-1] += LINGER if through else 0.0
    return Schedule(poses, dwell)


def _switches(guide: Guide, points: int, through: bool) -> Floats:
    """Times (k,) at which the target changes: evenly spread, the nearest one that is left moved to each cusp."""
    shares, end = np.arange(1, points + 1), guide.arrival if through else guide.duration
    times = end * shares / (points if through else points + 1)
    left = shares < points + (not through)
    for cusp in guide.cusps[guide.cusps < end][: left.sum()]:
        nearest = np.argmin(np.where(left, np.abs(times - cusp), np.inf))
        times[nearest], left[nearest] = cusp, False
    return np.sort(times)


def nearby(schedule: Schedule, count: int, scale: float, rng: np.random.Generator) -> Schedules:
    """A schedule and `count` - 1 others around it; `scale` is the noise as a share of that along guides."""
    number = np.arange(count)
    return _disturbed(Schedules.of([schedule]).take(0 * number), np.where(number == 0, 0.0, scale), rng)


def anywhere(region: tuple[Floats, Floats], points: int, count: int, rng: np.random.Generator) -> Schedules:
    """`count` schedules with points anywhere in a region, bounds (3,), and any dwell times."""
    return Schedules(rng.uniform(*region, (count, points, 3)), rng.uniform(*DWELL, (count, points)))


def _disturbed(schedules: Schedules, scales: Floats, rng: np.random.Generator) -> Schedules:
    """The schedules with noise, each at a scale (N,) of its own."""
    noise = rng.normal(size=schedules.points.shape) * [POSITION_NOISE, POSITION_NOISE, HEADING_NOISE]
    shares = DWELL_NOISE * rng.uniform(-1.0, 1.0, schedules.dwell.shape)
    return Schedules(
        schedules.points + scales[:, None, None] * noise, schedules.dwell * (1.0 + scales[:, None] * shares)
    )
