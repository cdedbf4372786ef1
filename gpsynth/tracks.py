"""Tracks: discs whose places are known in advance, say other robots that drive plans of their own."""

from dataclasses import dataclass

import numpy as np

from gpsynth.arrays import Floats, shaped
from gpsynth.errors import ProblemError


@dataclass(frozen=True, eq=False)
class Tracks:
    """Discs that go straight and evenly from place to place, and stand at their last one.

    Raises ProblemError if the numbers are not finite, a radius is negative or there is no place.
    """

    places: Floats  # (r, K, 2) x, y (m) at the times 0, period, 2 period, ...
    radii: Floats  # (r,) m
    period: float  # s; a multiple of the control period of the problem they are in

    def __post_init__(self) -> None:
        object.__setattr__(self, "places", shaped("places of tracks", self.places, (-1, -1, 2)))
        object.__setattr__(self, "radii", shaped("radii of tracks", self.radii, (len(self.places),)))
        object.__setattr__(self, "period", float(shaped("the period of tracks", self.period, ())))
        if not self.period > 0.0:
            raise ProblemError(f"the period of tracks must be positive, got {self.period}")
        if len(self.places) and not self.places.shape[1]:
            raise ProblemError("tracks need at least one place each, got none")
        if np.any(self.radii < 0.0):
            raise ProblemError(f"radii of tracks must be at least 0, got {self.radii.tolist()}")

    def at(self, times: Floats) -> Floats:
        """The centers (r, N, 2) at times (N,) in s."""
        ticks = self.period * np.arange(self.places.shape[1])
        centers = [[np.interp(times, ticks, axis) for axis in track.T] for track in self.places]
        return np.array(centers).reshape(len(self.places), 2, len(times)).transpose(0, 2, 1)


NOBODY = Tracks(np.empty((0, 0, 2)), np.empty(0), 1.0)
