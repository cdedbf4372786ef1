import numpy as np
import pytest
from scipy.integrate import solve_ivp

from applications.rosbot.replay import replay
from applications.rosbot.scenario import Scenario
from gpsynth.errors import ScenarioError


def scene(**changes) -> Scenario:
    return Scenario(**{"start": [0.0, 0.0, 0.0], "goal": [1.0, 0.0, 0.0], "radius": 0.1} | changes)


def test_reference_controls_arrive_at_their_time_without_collision(public, reference):
    controls = np.array(reference["controls"])
    result = replay(public, controls[:, :2], controls[:, 2])
    assert result.solves
    assert result.arrival_time == pytest.approx(
        reference["T_ref"], abs=1.5e-3
    )  # one step, and T_ref's last digit
    assert result.clearance >= -1e-6


def test_poses_equal_an_adaptive_integrator():
    rng = np.random.default_rng(5)
    controls = rng.uniform(-0.5, 0.5, (12, 2))
    trajectory = replay(scene(goal=[50.0, 0.0, 0.0]), controls, 0.1234).trajectory
    pose = np.zeros(3)
    for v, omega in controls:
        rates = lambda _, q, v=v, omega=omega: [v * np.cos(q[2]), v * np.sin(q[2]), omega]  # noqa: E731
        pose = solve_ivp(rates, (0.0, 0.1234), pose, method="DOP853", rtol=1e-12, atol=1e-12).y[:, -1]
    assert trajectory[-1, 0] == pytest.approx(12 * 0.1234, abs=1e-12)
    assert trajectory[-1, 1:] == pytest.approx(pose, abs=1e-10)
    assert np.max(np.diff(trajectory[:, 0])) <= 1e-3 + 1e-12


def test_it_stops_at_the_first_entry_into_the_tolerance():
    result = replay(scene(), np.array([[0.5, 0.0]] * 100), 0.05)
    assert result.arrival_time == pytest.approx(1.9, abs=1e-3)
    assert result.trajectory[-1, 1] == pytest.approx(0.95, abs=1e-3)


def test_position_without_heading_is_no_arrival():
    result = replay(scene(goal=[1.0, 0.0, 0.5]), np.array([[0.5, 0.0]]), 2.5)
    assert result.arrival_time == np.inf
    assert not result.solves


def test_clearance_is_the_gap_to_the_body():
    circles = [[0.5, 0.6, 0.0, 0.0, 0.3]]
    assert replay(scene(circles=circles), np.array([[0.5, 0.0]]), 2.0).clearance == pytest.approx(
        0.2, abs=1e-6
    )
    assert replay(scene(), np.array([[0.5, 0.0]]), 2.0).clearance == np.inf


def test_a_moving_obstacle_is_met_where_it_then_is():
    crossing = [[0.5, 1.0, 0.0, -1.0, 0.1]]  # at (0.5, 0) after 1 s, as the robot is
    behind = [[0.5, 2.0, 0.0, -1.0, 0.1]]
    controls = np.array([[0.5, 0.0]])
    assert replay(scene(circles=crossing), controls, 2.0).clearance == pytest.approx(-0.2, abs=1e-6)
    assert replay(scene(circles=behind), controls, 2.0).clearance > 0.1


def test_what_happens_after_the_arrival_does_not_count():
    wall = [[1.4, 0.0, 0.0, 0.0, 0.2]]
    assert replay(scene(circles=wall), np.array([[0.5, 0.0]]), 4.0).solves


def test_limits_bounds_and_time_are_checked():
    forward = np.array([[0.5, 0.0]])
    assert replay(scene(), forward, 2.0).solves
    assert not replay(scene(speed_limits=(-0.5, 0.4)), forward, 2.0).in_limits
    assert not replay(scene(turn_limits=(-0.5, -0.1)), forward, 2.0).in_limits
    assert not replay(scene(bounds=[0.1 - 1.0, 1.0, -1.0, 1.0]), -forward, 2.0).in_bounds
    assert not replay(scene(time_limit=1.8), forward, 2.0).in_time


@pytest.mark.parametrize(
    ("controls", "period", "sentence"),
    [
        (np.zeros((3, 3)), 0.1, "expected"),
        (np.full((3, 2), np.nan), 0.1, "finite"),
        (np.zeros((3, 2)), -0.1, "at least 0"),
    ],
)
def test_controls_that_are_none_are_refused(controls, period, sentence):
    with pytest.raises(ScenarioError, match=sentence):
        replay(scene(), controls, period)
