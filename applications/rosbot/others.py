"""Other robots of a fleet: discs that drive controls which are known, and then stand."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from applications.rosbot.arcs import Arcs, advance, arcs
from applications.rosbot.controls import held
from gpsynth.arrays import Floats, frozen, shaped
from gpsynth.checks import check_number
from gpsynth.errors import ScenarioError
from gpsynth.tracks import Tracks


@dataclass(frozen=True, eq=False)
class Other:
    """A round robot that obeys model (12)."""

    start: Floats  # (3,) x m, y m, theta rad
    controls: Floats  # (n, 2) v m/s, omega rad/s
    durations: Floats  # (n,) s
    radius: float  # m

    def __post_init__(self) -> None:
        controls, durations = held(self.controls, self.durations)
        object.__setattr__(self, "start", shaped("the start of another robot", self.start, (3,)))
        object.__setattr__(self, "controls", frozen(controls))
        object.__setattr__(self, "durations", frozen(durations))
        check_number("the radius of another robot", self.radius, ScenarioError)
        if not 0.0 <= self.radius < np.inf:
            raise ScenarioError(f"the radius of another robot is {self.radius} m; expected at least 0")

    @cached_property
    def path(self) -> Arcs:
        """What it drives."""
        return arcs(self.start, self.controls, self.durations)


def held_until(controls: Floats, period: float, end: float) -> tuple[Floats, Floats]:
    """The controls (m, 2) of a period each that begin before `end` (s), and how long (m,) each is held until then."""
    begins = period * np.arange(len(controls))
    kept = np.clip(end - begins, 0.0, period)
    return controls[kept > 0.0], kept[kept > 0.0]


def poses_at(path: Arcs, times: Floats) -> Floats:
    """The poses (N, 3) on a path at times (N,) in s; beyond its end it is where it ended."""
    if not len(path.steps):
        return np.repeat(path.poses[:1], len(times), axis=0)
    piece = np.clip(np.searchsorted(path.times, times, side="right") - 1, 0, len(path.steps) - 1)
    after = np.clip(times - path.times[piece], 0.0, path.steps[piece])
    heading, omega = path.poses[piece, 2], path.omega[piece]
    moved = advance(heading, path.v[piece], omega, after)
    return np.column_stack([path.poses[piece, :2] + moved, heading + omega * after])


def tracks_of(others: Sequence[Other], period: float) -> Tracks | None:
    """Their tracks, grown by what the arcs bend away from chords of a period; None if there are none."""
    if not others:
        return None
    ticks = max(int(np.ceil(other.path.times[-1] / period)) for other in others) + 1
    times = period * np.arange(ticks, dtype=np.float64)
    bends = [0.125 * period**2 * np.abs(each.path.v * each.path.omega).max(initial=0.0) for each in others]
    return Tracks(
        places=np.array([poses_at(other.path, times)[:, :2] for other in others]),
        radii=np.array([other.radius for other in others]) + bends,
        period=period,
    )
