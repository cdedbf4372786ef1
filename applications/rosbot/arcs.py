"""Paths of model (12) under held controls as what they are: circular arcs, straight lines and turns in place.

Lengths are in m, angles in rad, times in s. All that is computed here differs from the motion in real numbers by
rounding alone, and by no more than `Arcs.error` and `Arcs.turn_error`: a sum of n terms is off by at most n u times
the sum of their magnitudes (Higham 2002, section 4.2; u = 2^-53), a sine, cosine or hypot of numpy by 4 units in the
last place, and a heading that is off by e moves what is driven with it by e times its length.
"""

from dataclasses import dataclass

import numpy as np

from gpsynth.arrays import Floats

ROUNDING = 2.0**-53  # u
LONGEST_TURN = (
    1.0  # rad; longer ones are cut, so that the foot of a perpendicular is told by the sides of two lines
)
STANDING = 1e-12  # m; a piece that goes no farther is taken as a turn in place, and its length is deducted


@dataclass(frozen=True, eq=False)
class Arcs:
    """n pieces of constant v and omega, and the poses between them."""

    times: Floats  # (n + 1,)
    poses: Floats  # (n + 1, 3) x, y, theta
    v: Floats  # (n,)
    omega: Floats  # (n,)
    steps: Floats  # (n,) s
    error: float  # m; no point of the path is farther from its computed place
    turn_error: float  # rad; the same of the headings

    @property
    def curvature(self) -> Floats:
        """1/m, (n,); 0 where the robot stands."""
        moving = np.abs(self.v) * self.steps > STANDING
        return np.where(moving, self.omega / np.where(moving, self.v, 1.0), 0.0)

    @property
    def bend(self) -> Floats:
        """No point of a piece is farther than this (m, (n,)) from the uniform motion between its ends.

        The acceleration of the unicycle is |v omega| and a function is within h^2 / 8 of its second derivative's
        bound of its linear interpolant.
        """
        return (1.0 + 8.0 * ROUNDING) * 0.125 * np.abs(self.v * self.omega) * self.steps**2


def arcs(start: Floats, controls: Floats, durations: Floats) -> Arcs:
    """The path from a pose (3,) under (v, omega) pairs (m, 2), each for its duration (m,)."""
    counts = np.maximum(np.ceil(np.abs(controls[:, 1]) * durations / LONGEST_TURN), 1.0).astype(np.intp)
    steps = np.repeat(durations / counts, counts)
    v, omega = np.repeat(controls, counts, axis=0).T
    turns, lengths, count = steps * omega, steps * np.abs(v), len(steps) + 4
    poses = np.empty((len(steps) + 1, 3))
    poses[:, 2] = np.cumsum(np.concatenate([start[2:], turns]))
    poses[:, :2] = np.cumsum(np.vstack([start[:2], advance(poses[:-1, 2], v, omega, steps)]), axis=0)
    turn_error = count * ROUNDING * (abs(start[2]) + np.sum(np.abs(turns)))
    far = np.sum(np.abs(start[:2])) + 2.0 * lengths.sum()
    return Arcs(
        times=np.cumsum(np.concatenate([[0.0], steps])),
        poses=poses,
        v=v,
        omega=omega,
        steps=steps,
        error=float(lengths.sum() * (64.0 * ROUNDING + 4.0 * turn_error) + count * ROUNDING * far),
        turn_error=float(turn_error),
    )


def advance(heading: Floats, v: Floats, omega: Floats, steps: Floats) -> Floats:
    """How far (n, 2) a robot gets: along the chord, whose direction is the heading halfway."""
    half = 0.5 * omega * steps
    chord = v * steps * np.where(half == 0.0, 1.0, np.sin(half) / np.where(half == 0.0, 1.0, half))
    moved: Floats = chord[:, np.newaxis] * np.column_stack([np.cos(heading + half), np.sin(heading + half)])
    return moved


def from_origin(places: Floats, motions: Floats) -> Floats:
    """The distance (r,) of the origin from the segments that begin at `places` (r, 2)."""
    square = np.sum(motions * motions, axis=1)
    share = -np.sum(places * motions, axis=1) / np.where(square > 0.0, square, 1.0)
    nearest = places + np.clip(share, 0.0, 1.0)[:, np.newaxis] * motions
    distance: Floats = np.hypot(nearest[:, 0], nearest[:, 1])
    return distance
