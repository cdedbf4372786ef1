"""What the path of a robot with lags is off by, against an adaptive integrator of its equations."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from applications.rosbot.lag_errors import errors
from applications.rosbot.lags import Speed, lagging_path, nominal_speeds, speed_under

REFERENCE = 2e-10  # m, rad; what the integrator may miss


def true_path(commands, durations, speeds: tuple[Speed, Speed], times) -> np.ndarray:
    """Poses (n, 3) at these times; begun anew at every corner, so that all it integrates is smooth."""
    begins = np.cumsum(durations) - durations
    corners = [speed.begins + np.minimum(speed.corners, durations) for speed in speeds]
    knots = np.unique(np.concatenate([begins, *corners, [durations.sum()]]))
    state, found = np.zeros(5), np.empty((len(times), 3))
    for low, high in pairwise(knots):
        u = commands[np.searchsorted(begins, 0.5 * (low + high)) - 1]

        def rates(_, x, u=u):
            pulls = [np.clip((u[k] - x[3 + k]) / s.lag, -s.most, s.most) for k, s in enumerate(speeds)]
            return [x[3] * np.cos(x[2]), x[3] * np.sin(x[2]), x[4], *pulls]

        asked = np.flatnonzero((times >= low) & (times <= high))
        at = np.unique(np.append(times[asked], high))
        solved = solve_ivp(rates, (low, high), state, method="DOP853", rtol=1e-12, atol=1e-13, t_eval=at)
        found[asked], state = solved.y[:3, np.searchsorted(at, times[asked])].T, solved.y[:, -1]
    return found


# how fast, how many commands of what duration (s), and lag (s) and acceleration, None: the nominal robot's
CASES = {
    "nominal": (0.5, 20, 0.1, None),
    "fast": (100.0, 4, 2.0, None),
    "strong": (50.0, 8, 0.1, (0.02, 1000.0)),
    "nearly at once": (50.0, 8, 0.05, (0.002, 1000.0)),
    "short lag": (1.0, 8, 0.05, (0.001, 30.0)),
}


@pytest.mark.parametrize("case", CASES.values(), ids=CASES)
def test_no_point_is_farther_from_its_chord_than_is_said(case):
    fastest, count, duration, family = case
    rng = np.random.default_rng(4)
    commands, durations = rng.uniform(-fastest, fastest, (count, 2)), np.full(count, duration)
    speeds = nominal_speeds(commands, durations)
    if family is not None:
        speeds = tuple(speed_under(each, durations, 1.0, *family) for each in commands.T)
    path = lagging_path(np.zeros(3), durations, *speeds)
    error, turn_error = errors(path, durations, *speeds)
    asked = np.sort(rng.choice(len(path.times) - 1, 60, replace=False))
    steps = np.diff(path.times)[asked]
    v, omega = (np.maximum(np.abs(each[:-1]), np.abs(each[1:]))[asked] for each in (path.v, path.omega))
    for share in (0.25, 0.5, 1.0):
        wanted = np.array([speed.wanted for speed in speeds]).T
        true = true_path(wanted, durations, speeds, path.times[asked] + share * steps)
        off = np.abs(true - path.poses[asked] - share * (path.poses[asked + 1] - path.poses[asked]))
        bend = 0.125 * v * omega * steps**2
        assert np.all(np.hypot(off[:, 0], off[:, 1]) <= error + bend + REFERENCE)
        assert np.all(off[:, 2] <= turn_error + REFERENCE)


def test_the_nominal_robot_s_path_is_known_to_less_than_a_micrometer():
    rng = np.random.default_rng(5)
    commands, durations = rng.uniform(-0.5, 0.5, (1000, 2)), np.full(1000, 0.05)
    speeds = nominal_speeds(commands, durations)
    error, turn_error = errors(lagging_path(np.zeros(3), durations, *speeds), durations, *speeds)
    assert error < 2e-7
    assert turn_error < 4e-7


def test_nothing_is_off_where_nothing_is_driven():
    nothing = np.empty(0)
    speeds = nominal_speeds(np.empty((0, 2)), nothing)
    assert max(errors(lagging_path(np.zeros(3), nothing, *speeds), nothing, *speeds)) < 1e-15
