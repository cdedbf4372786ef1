"""How far a robot with lags may be from the chords between the poses of its computed path.

Simpson's rule over h is off by h^5 / 2880 times the most that a fourth derivative is, the quadratic through three
values by h^4 / 384 of a third when it is integrated up to the middle. An acceleration is at most a and its slope, where
it is not constant, a / lag, and so on, which bounds the derivatives of omega and of v e^(i theta). Between two poses a
path bends away from the chord by its acceleration times h^2 / 8. Rounding is bounded as in `arcs`; besides, the begins
of m commands are sums, late by up to u m times all of the time, and an error of a speed never grows, since a lag only
draws speeds together.
"""

import numpy as np

from applications.rosbot.arcs import ROUNDING
from applications.rosbot.lags import LaggingPath, Speed
from gpsynth.arrays import Floats


def errors(path: LaggingPath, durations: Floats, v: Speed, omega: Speed) -> tuple[float, float]:
    """(m, rad): no point is farther from its chord than the first and |v omega| h^2 / 8, no heading than the second."""
    steps, end, commands = np.diff(path.times), float(durations.sum()), len(durations) + 4
    fast, turning = (np.maximum(np.abs(each[:-1]), np.abs(each[1:])) for each in (path.v, path.omega))
    late = 2.0 * ROUNDING * commands * end
    wrong_v, wrong_omega = (_wrong(speed, commands, late) for speed in (v, omega))
    terms, length = ROUNDING * (len(steps) + 16), float(np.sum(steps * fast))
    summed = terms * (abs(path.poses[0, 2]) + float(np.sum(steps * turning)))
    turn_error = float(
        np.sum(steps**5) / 2880.0 * omega.most / omega.lag**3
        + end * wrong_omega
        + late * turning.max(initial=0.0)
        + summed
    )
    error = float(
        np.sum(steps**5 / 2880.0 * _fourth(fast, turning, v, omega))
        + np.sum(steps**5 * fast) / 384.0 * omega.most / omega.lag**2
        + end * wrong_v
        + late * fast.max(initial=0.0)
        + length * (64.0 * ROUNDING + 4.0 * turn_error)
        + terms * (np.abs(path.poses[0, :2]).sum() + 2.0 * length)
    )
    longest, most = float(steps.max(initial=0.0)), float(turning.max(initial=0.0))
    drawn = (
        0.125 * longest**2 * v.most * (1.0 + longest * most)
    )  # a v that changes its sign in a step included
    return error + drawn, turn_error + 0.125 * longest**2 * omega.most


def _wrong(speed: Speed, commands: int, late: float) -> float:
    """How far a computed speed may be off."""
    size = np.max(np.abs(speed.wanted) + np.abs(speed.first), initial=0.0)
    return float(speed.most * late + 32.0 * ROUNDING * commands * size)


def _fourth(fast: Floats, turning: Floats, v: Speed, omega: Speed) -> Floats:
    """The most (n,) that the fourth derivative of v e^(i theta) can be at these speeds."""
    a, b, lags = v.most, omega.most, (v.lag, omega.lag)
    first, second = turning, turning**2 + b
    third = turning**3 + 3.0 * turning * b + b / lags[1]
    fourth = turning**4 + 6.0 * turning**2 * b + 4.0 * turning * b / lags[1] + 3.0 * b**2 + b / lags[1] ** 2
    most: Floats = (
        fast * fourth
        + 4.0 * a * third
        + a / lags[0] * (6.0 * second + 4.0 * first / lags[0] + 1.0 / lags[0] ** 2)
    )
    return most
