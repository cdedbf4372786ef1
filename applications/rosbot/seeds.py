"""First schedules for the swarms: equilibrium points laid along guides, somewhat beyond where they lead."""

from collections.abc import Sequence

import numpy as np

from applications.rosbot.guides import Guide
from gpsynth.arrays import Floats
from gpsynth.schedule import Schedule

POSITION_NOISE, HEADING_NOISE, DWELL_NOISE = 0.1, 0.3, 0.15  # m, rad, share
BEYOND = 0.3  # m: a point ahead of where the next takes over keeps the controls saturated


def schedules_along(
    guides: Sequence[Guide], points: int, count: int, rng: np.random.Generator
) -> list[Schedule]:
    """`count` schedules, the guides in turn: once as they are, then with noise; none without guides."""
    found = []
    for number in range(count if guides else 0):
        exact = along(guides[number % len(guides)], points)
        found.append(exact if number < len(guides) else _disturbed(exact, rng))
    return found


def along(guide: Guide, points: int) -> Schedule:
    """Points at equal times along a guide, with one for every cusp, each moved on in the direction of travel."""
    nodes = np.searchsorted(guide.times, _switches(guide, points) - 1e-9)
    poses, senses = guide.poses[nodes].copy(), guide.senses[nodes]
    heading = np.column_stack([np.cos(poses[:, 2]), np.sin(poses[:, 2])])
    poses[:, :2] += BEYOND * senses[:, np.newaxis] * heading
    return Schedule(poses, np.diff(guide.times[nodes], prepend=0.0))


def _switches(guide: Guide, points: int) -> Floats:
    """Times (k,) at which the target changes: evenly spread, the nearest one moved to each cusp."""
    times = guide.duration * np.arange(1, points + 1) / (points + 1)
    for cusp in guide.cusps:
        times[np.argmin(np.abs(times - cusp))] = cusp
    return np.sort(times)


def nearby(schedule: Schedule, count: int, scale: float, rng: np.random.Generator) -> list[Schedule]:
    """A schedule and `count` - 1 others around it; `scale` is the noise as a share of that along guides."""
    return [schedule, *(_disturbed(schedule, rng, scale) for _ in range(count - 1))]


def _disturbed(schedule: Schedule, rng: np.random.Generator, scale: float = 1.0) -> Schedule:
    noise = scale * rng.normal(size=schedule.points.shape) * [POSITION_NOISE, POSITION_NOISE, HEADING_NOISE]
    share = 1.0 + scale * DWELL_NOISE * rng.uniform(-1.0, 1.0, len(schedule.dwell))
    return Schedule(schedule.points + noise, schedule.dwell * share)
