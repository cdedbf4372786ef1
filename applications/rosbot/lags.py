"""The robot that follows its commands with lags and limited accelerations, in closed form between the commands.

x' = clip((gain u - x) / lag, -most, most) is a straight line until the error is most lag and an exponential after it.
Poses are integrated by Simpson's rule over at most STEP, never across a corner of a speed; `lag_errors` bounds what is
missing.
"""

from dataclasses import dataclass

import numpy as np

from applications.rosbot.model import FAMILY
from gpsynth.arrays import Floats

STEP = 1e-3  # s


@dataclass(frozen=True, eq=False)
class Speed:
    """A speed that follows m held commands."""

    begins: Floats  # (m,) s
    first: Floats  # (m,) the speed at each of them
    wanted: Floats  # (m,) where each would lead
    lag: float  # s
    most: float  # acceleration

    @property
    def corners(self) -> Floats:
        """When the straight lines end (m,), in s after the beginnings."""
        late: Floats = np.maximum(np.abs(self.wanted - self.first) / self.most - self.lag, 0.0)
        return late

    def at(self, times: Floats) -> Floats:
        """The speed at some times."""
        part = np.clip(np.searchsorted(self.begins, times, side="right") - 1, 0, None)
        return _after(self, part, times - self.begins[part])


@dataclass(frozen=True, eq=False)
class LaggingPath:
    """What commands lead to, at knots no more than STEP apart."""

    times: Floats  # (n,) s
    poses: Floats  # (n, 3)
    v: Floats  # (n,) m/s
    omega: Floats  # (n,) rad/s


def speed_under(
    commands: Floats, durations: Floats, gain: float, lag: float, most: float, *, at_first: float = 0.0
) -> Speed:
    """The speed under commands (m,), each held for its duration (m,), from what it is at first."""
    begins, wanted = np.cumsum(durations) - durations, gain * commands
    first = np.full(len(commands), at_first)
    for k in range(len(commands) - 1):
        here = Speed(begins[k : k + 1], first[k : k + 1], wanted[k : k + 1], lag, most)
        first[k + 1] = _after(here, np.zeros(1, dtype=np.intp), durations[k : k + 1])[0]
    return Speed(begins, first, wanted, lag, most)


def lagging_path(start: Floats, durations: Floats, v: Speed, omega: Speed) -> LaggingPath:
    """The path of these speeds from a pose (3,)."""
    end = float(durations.sum())
    corners = [speed.begins + np.minimum(speed.corners, durations) for speed in (v, omega)]
    times = np.unique(np.concatenate([np.arange(0.0, end, STEP), v.begins, *corners, [0.0, end]]))
    steps, middle = np.diff(times), 0.5 * (times[:-1] + times[1:])
    (v0, vm), (o0, om) = (
        (speed.at(times), speed.at(middle)) if len(durations) else (np.zeros(1), np.zeros(0))
        for speed in (v, omega)
    )
    turns = steps / 6.0 * (o0[:-1] + 4.0 * om + o0[1:])
    heading = start[2] + np.concatenate([[0.0], np.cumsum(turns)])
    halfway = heading[:-1] + steps / 24.0 * (5.0 * o0[:-1] + 8.0 * om - o0[1:])
    poses = np.empty((len(times), 3))
    poses[:, 2] = heading
    for axis, wave in enumerate((np.cos, np.sin)):
        moved = (
            steps
            / 6.0
            * (v0[:-1] * wave(heading[:-1]) + 4.0 * vm * wave(halfway) + v0[1:] * wave(heading[1:]))
        )
        poses[:, axis] = start[axis] + np.concatenate([[0.0], np.cumsum(moved)])
    return LaggingPath(times, poses, v0, o0)


def nominal_speeds(
    controls: Floats, durations: Floats, speeds: tuple[float, float] = (0.0, 0.0)
) -> tuple[Speed, Speed]:
    """v and omega of the nominal robot (`model.FAMILY`) under (v, omega) pairs (m, 2), by default from rest."""
    v, omega = (
        speed_under(
            commands,
            durations,
            *(FAMILY[f"{letter}_{name}"][3] for letter in ("k", "tau", "a")),
            at_first=at_first,
        )
        for commands, name, at_first in zip(controls.T, ("v", "omega"), speeds, strict=True)
    )
    return v, omega


def nominal_path(
    start: Floats, controls: Floats, durations: Floats, speeds: tuple[float, float] = (0.0, 0.0)
) -> LaggingPath:
    """The path of the nominal robot from a pose (3,) under (v, omega) pairs (m, 2), as long as they last."""
    return lagging_path(start, durations, *nominal_speeds(controls, durations, speeds))


def _after(speed: Speed, part: np.ndarray[tuple[int], np.dtype[np.intp]], elapsed: Floats) -> Floats:
    """The speed so long after the beginnings of some commands."""
    error = speed.wanted[part] - speed.first[part]
    corner = np.maximum(np.abs(error) / speed.most - speed.lag, 0.0)
    line = np.sign(error) * speed.most * np.minimum(elapsed, corner)
    left = (error - line) * np.exp(-np.maximum(elapsed - corner, 0.0) / speed.lag)
    return speed.wanted[part] - left
