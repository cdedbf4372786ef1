"""How near relative motions that are sums of arcs and a straight line come to the origin: lower bounds that are proved.

An arc is nowhere farther than |v omega| h^2 / 8 from the uniform motion between its ends (`Arcs.bend`), so the sum is
nowhere farther than the sum of those from a straight line, whose least distance is a closed form. Parts that may be
nearest are halved until that costs less than TIGHT.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from applications.rosbot.arcs import ROUNDING, advance, from_origin
from gpsynth.arrays import Floats

Indices = npt.NDArray[np.intp]

TIGHT = 1e-7  # m; what a bound may lose


@dataclass(frozen=True, eq=False)
class Parts:
    """Parts (r,) of the motions of some pairs, sums of a arcs each; what is to be taken off is driven backwards."""

    pair: Indices  # (r,) which motion each is of
    times: Floats  # (r,) s, when each begins
    place: Floats  # (r, 2) m, where
    headings: Floats  # (a, r) rad, there
    v: Floats  # (a, r) m/s
    omega: Floats  # (a, r) rad/s
    drift: Floats  # (r, 2) m/s, of the straight line
    steps: Floats  # (r,) s, how long each lasts

    @property
    def bend(self) -> Floats:
        """How far (m, (r,)) the motion can be from its chord."""
        bends: Floats = (0.125 + ROUNDING) * np.abs(self.v * self.omega).sum(axis=0) * self.steps**2
        return bends

    def moved(self, steps: Floats) -> Floats:
        """The motion (r, 2) in so many seconds."""
        motion = self.drift * steps[:, np.newaxis]
        for heading, v, omega in zip(self.headings, self.v, self.omega, strict=True):
            motion = motion + advance(heading, v, omega, steps)
        return motion

    def halved(self, which: npt.NDArray[np.bool_]) -> "Parts":
        """Both halves of some of them."""
        half = 0.5 * self.steps
        times = np.stack([self.times, self.times + half])
        place = np.stack([self.place, self.place + self.moved(half)])
        headings = np.stack([self.headings, self.headings + self.omega * half], axis=1)
        return Parts(
            np.tile(self.pair[which], 2),
            times[:, which].ravel(),
            place[:, which].reshape(-1, 2),
            headings[:, :, which].reshape(len(headings), -1),
            np.tile(self.v[:, which], 2),
            np.tile(self.omega[:, which], 2),
            np.tile(self.drift[which], (2, 1)),
            np.tile(half[which], 2),
        )


def least_gap(parts: Parts, sizes: Floats, lost: Floats) -> tuple[float, int, float]:
    """A lower bound (m) on the distance from the origin less the size of a pair, which pair's it is, and when (s).

    sizes, lost (p,): of each pair, m; the second is what rounding can do. Besides that the bound is no more than TIGHT
    below the least gap. Infinity, pair -1 and 0 without parts.
    """
    best, pair, when, most = np.inf, -1, 0.0, np.inf
    while len(parts.steps):
        bend = parts.bend
        gap = from_origin(parts.place, parts.moved(parts.steps)) - sizes[parts.pair]
        lower, most = gap - bend - lost[parts.pair], min(most, float((gap + bend).min()))
        halved = (lower < most) & (bend > 0.5 * TIGHT)
        settled = np.where(halved, np.inf, lower)
        row = int(np.argmin(settled))
        if settled[row] < best:
            best, pair, when = float(settled[row]), int(parts.pair[row]), float(parts.times[row])
        parts = parts.halved(halved)
    return best, pair, when
