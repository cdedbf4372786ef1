"""How near two robots come to each other: a lower bound that is proved for both continuous paths.

On a common piece each robot drives an arc. It is nowhere farther than |v omega| h^2 / 8 from the uniform motion between
its ends (`Arcs.bend`), so seen from the other one it is nowhere farther than the sum of both from a straight line,
whose least distance is a closed form. Pieces that may be nearest are halved until that costs less than TIGHT. Rounding
is deducted as in `arcs`.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from applications.rosbot.arcs import ROUNDING, Arcs, advance, from_origin
from applications.rosbot.others import poses_at
from gpsynth.arrays import Floats

TIGHT = 1e-7  # m; what the bound may lose


@dataclass(frozen=True, eq=False)
class _Parts:
    """Common pieces (r,) of two paths."""

    times: Floats  # (r,) s, when each begins
    place: Floats  # (r, 2) m, of the first robot seen from the second
    headings: Floats  # (2, r) rad
    v: Floats  # (2, r)
    omega: Floats  # (2, r)
    steps: Floats  # (r,) s

    @property
    def bend(self) -> Floats:
        """How far (m, (r,)) the relative motion can be from its chord."""
        bends: Floats = (0.125 + ROUNDING) * np.abs(self.v * self.omega).sum(axis=0) * self.steps**2
        return bends

    def moved(self, steps: Floats) -> Floats:
        """The relative motion (r, 2) in so many seconds."""
        one, two = map(advance, self.headings, self.v, self.omega, (steps, steps))
        motion: Floats = one - two
        return motion

    def halved(self, which: npt.NDArray[np.bool_]) -> "_Parts":
        """Both halves of some of them."""
        half = 0.5 * self.steps
        times = np.stack([self.times, self.times + half])
        place = np.stack([self.place, self.place + self.moved(half)])
        headings = np.stack([self.headings, self.headings + self.omega * half], axis=1)
        return _Parts(
            times[:, which].ravel(),
            place[:, which].reshape(-1, 2),
            headings[:, :, which].reshape(2, -1),
            np.tile(self.v[:, which], 2),
            np.tile(self.omega[:, which], 2),
            np.tile(half[which], 2),
        )


def least_distance(first: Arcs, second: Arcs) -> tuple[float, float]:
    """A lower bound (m) on the distance of two robots' centers at any time, and when (s) they come that near.

    Whoever has ended stands where it is. The bound is no more than TIGHT and rounding below the least distance.
    """
    parts, lost = _common(first, second), _lost(first, second)
    best, when, most = np.inf, 0.0, np.inf
    while len(parts.steps):
        bend = parts.bend
        distance = from_origin(parts.place, parts.moved(parts.steps))
        lower, most = distance - bend, min(most, float((distance + bend).min()))
        halved = (lower < most) & (bend > 0.5 * TIGHT)
        settled = np.where(halved, np.inf, lower)
        row = int(np.argmin(settled))
        if settled[row] < best:
            best, when = float(settled[row]), float(parts.times[row])
        parts = parts.halved(halved)
    return best - lost, when


def _common(first: Arcs, second: Arcs) -> _Parts:
    """The paths cut where either changes its controls; a last piece of no length is where both stand."""
    times = np.union1d(first.times, second.times)
    one, two = poses_at(first, times), poses_at(second, times)
    v, omega = np.stack([_driven(first, times), _driven(second, times)], axis=1)
    headings = np.stack([one[:, 2], two[:, 2]])
    return _Parts(times, one[:, :2] - two[:, :2], headings, v, omega, np.append(np.diff(times), 0.0))


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
