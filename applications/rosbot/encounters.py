"""How near two robots come to each other: a lower bound that is proved for both continuous paths.

On a common piece each robot drives an arc, and the one seen from the other their difference (`approaches`). Rounding is
deducted as in `arcs`.
"""

import numpy as np

from applications.rosbot.approaches import Parts, least_gap
from applications.rosbot.arcs import ROUNDING, Arcs
from applications.rosbot.others import poses_at
from gpsynth.arrays import Floats


def least_distance(first: Arcs, second: Arcs) -> tuple[float, float]:
    """A lower bound (m) on the distance of two robots' centers at any time, and when (s) they come that near.

    Whoever has ended stands where it is. The bound is no more than TIGHT and rounding below the least distance.
    """
    distance, _, time = least_gap(_common(first, second), np.zeros(1), np.array([_lost(first, second)]))
    return distance, time


def _common(first: Arcs, second: Arcs) -> Parts:
    """The paths cut where either changes its controls; a last piece of no length is where both stand."""
    times = np.union1d(first.times, second.times)
    one, two = poses_at(first, times), poses_at(second, times)
    (v, w), omega = np.stack([_driven(first, times), _driven(second, times)], axis=1)
    return Parts(
        pair=np.zeros(len(times), dtype=np.intp),
        times=times,
        place=one[:, :2] - two[:, :2],
        headings=np.stack([one[:, 2], two[:, 2]]),
        v=np.stack([v, -w]),
        omega=omega,
        drift=np.zeros((len(times), 2)),
        steps=np.append(np.diff(times), 0.0),
    )


def _driven(path: Arcs, times: Floats) -> Floats:
    """v and omega (2, N) from each of the times on."""
    piece = np.searchsorted(path.times, times, side="right") - 1
    v, omega = np.append(path.v, 0.0), np.append(path.omega, 0.0)
    driven: Floats = np.stack([v[piece], omega[piece]])
    return driven


def _lost(first: Arcs, second: Arcs) -> float:
    """What rounding can do (m): of the paths, of the cuts' times, and of sums and differences of places."""
    lost = 0.0
    for path in (first, second):
        size = np.abs(path.poses).max() + float(np.sum(np.abs(path.v) * path.steps))
        lost += path.error + (ROUNDING * (256.0 + 4.0 * len(path.steps)) + path.turn_error) * size
    return float(lost)
