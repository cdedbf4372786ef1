"""Lower bounds for pieces of a path that are no arcs to an obstacle: of a body that turns, or beside a distance field.

Each circle of the body is taken along the chord of its motion in a piece, and what it bends away from that is deducted:
its acceleration is at most |v omega| + |o| omega^2 for an offset o, and h^2 / 8 of it is the farthest that a path gets
from its chord. Rounding is deducted as in `arcs`.
"""

from dataclasses import dataclass

import numpy as np

from applications.rosbot.arcs import ROUNDING, Arcs
from applications.rosbot.footprint import placed
from applications.rosbot.scenario import Scenario
from gpsynth.arrays import Floats


@dataclass(frozen=True, eq=False)
class Chords:
    """The motions of f circles in p pieces; a path that stands has one piece of no length."""

    heads: Floats  # (p, f, 2) m, where they begin
    tails: Floats  # (p, f, 2)
    lost: Floats  # (p, f) m, how far the circle may be from its chord
    radii: Floats  # (f,)
    times: Floats  # (p + 1,) s


def chords_of(path: Arcs, body: Floats) -> Chords:
    """The chords of the circles (f, 3) of a body along a path."""
    centers, offsets = placed(body, path.poses), np.hypot(body[:, 0], body[:, 1])
    turn = (np.abs(path.omega) * path.steps)[:, np.newaxis]
    bend = path.bend[:, np.newaxis] + 0.125 * (1.0 + 16.0 * ROUNDING) * offsets * turn**2
    lost = bend + path.error + offsets * (path.turn_error + 16.0 * ROUNDING)
    times = path.times
    if not len(path.steps):
        centers, times = np.repeat(centers, 2, axis=0), np.repeat(times, 2)
        lost = np.full((1, len(body)), path.error) + 16.0 * ROUNDING * offsets
    return Chords(centers[:-1], centers[1:], lost, body[:, 2], times)


def gaps_of_circles(chords: Chords, circles: Floats) -> Floats:
    """Lower bounds (p, c) on the distance from circles (c, 5), which may move."""
    gaps = np.full((len(chords.times) - 1, len(circles)), np.inf)
    begins, ends = chords.times[:-1, np.newaxis, np.newaxis], chords.times[1:, np.newaxis, np.newaxis]
    for index, (x, y, vx, vy, radius) in enumerate(circles):
        wind = np.array([vx, vy])
        place = chords.heads - [x, y] - wind * begins
        motion = chords.tails - chords.heads - wind * (ends - begins)
        square = np.sum(motion * motion, axis=-1)
        share = -np.sum(place * motion, axis=-1) / np.where(square > 0.0, square, 1.0)
        nearest = place + np.clip(share, 0.0, 1.0)[..., np.newaxis] * motion
        size = (
            np.abs(chords.heads).sum(axis=-1) + abs(x) + abs(y) + np.hypot(vx, vy) * chords.times[-1] + radius
        )
        lost = chords.lost + 64.0 * ROUNDING * size
        gap = np.hypot(nearest[..., 0], nearest[..., 1]) - radius - chords.radii - lost
        gaps[:, index] = gap.min(axis=1)
    return gaps


def gaps_of_room(chords: Chords, scenario: Scenario) -> Floats:
    """Lower bounds (p,) on the distance from the room's distance field; infinity without a room."""
    if scenario.field is None:
        return np.full(len(chords.times) - 1, np.inf)
    distances = scenario.field.proved_along(chords.heads, chords.tails)
    gaps: Floats = np.min(distances - chords.radii - chords.lost, axis=1)
    return gaps
