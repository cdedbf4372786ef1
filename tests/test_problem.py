"""Problems: the programs that follow from them, and what is refused with a sentence."""

import pickle
from dataclasses import replace

import numpy as np
import pytest

from gpsynth.errors import ProblemError, TracingError
from gpsynth.obstacles import Obstacles
from gpsynth.plant import Plant
from gpsynth.problem import Problem
from gpsynth.seeds import stream

STARTS = [[1.0, 2.0, 0.0], [-1.0, 0.5, 3.0]]


def unicycle(x, u):
    return u.v * np.cos(x.theta), u.v * np.sin(x.theta), u.omega


PLANT = Plant(
    unicycle,
    states={"x": "m", "y": "m", "theta": "rad"},
    controls={"v": ("m/s", -0.5, 0.5), "omega": ("rad/s", -1.0, 2.0)},
    angles=("theta",),
    name="unicycle",
)


def problem(starts=STARTS, goal=(0.0, 0.0, 0.0), tolerance=(0.05, 0.1, 0.2), **settings):
    return Problem(PLANT, starts, goal, tolerance=tolerance, **settings)


def wrapped(angle):
    return np.arctan2(np.sin(angle), np.cos(angle))


def test_default_features_are_the_errors_with_angles_wrapped():
    program = problem().features
    assert program.inputs == ("x", "y", "theta", "x_target", "y_target", "theta_target")
    assert program.names == ("error_x", "error_y", "error_theta")
    rows = stream(31).uniform(-6.0, 6.0, (100, 6))
    error = rows[:, 3:] - rows[:, :3]
    error[:, 2] = wrapped(error[:, 2])
    np.testing.assert_allclose(program(rows), error, atol=1e-14)


def test_default_arrival_is_the_largest_error_in_tolerances():
    program = problem().arrival
    assert program.inputs == ("x", "y", "theta", "x_goal", "y_goal", "theta_goal")
    assert program.names == ("measure",)
    rows = stream(32).uniform(-6.0, 6.0, (100, 6))
    error = rows[:, 3:] - rows[:, :3]
    error[:, 2] = wrapped(error[:, 2])
    expected = np.max(np.abs(error) / [0.05, 0.1, 0.2], axis=1) - 1.0
    np.testing.assert_allclose(program(rows)[:, 0], expected, rtol=1e-13)


def test_arrival_is_exactly_at_the_tolerance():
    rows = np.array([[0.05, 0.0, 0.0, 0.0, 0.0, 0.0], [np.nextafter(0.05, 1.0), 0.0, 0.0, 0.0, 0.0, 0.0]])
    measure = problem().arrival(rows)[:, 0]
    assert measure[0] == 0.0
    assert measure[1] > 0.0


def test_default_rates_are_the_derivatives_and_time():
    program = problem().rates
    assert program.inputs == ("x", "y", "theta", "v", "omega", "x_goal", "y_goal", "theta_goal", "t")
    assert program.names == ("x", "y", "theta", "running")
    rows = stream(33).normal(size=(20, 9))
    dynamics = PLANT.dynamics(rows[:, [0, 1, 2, 3, 4, 8]])
    assert np.array_equal(program(rows), np.column_stack([dynamics, np.ones(20)]))


def test_running_cost_sees_state_control_goal_and_time():
    rows = stream(34).normal(size=(20, 9))
    timed = problem(running=lambda x, u, goal, t: (x.x - goal.x) * u.omega + t)
    np.testing.assert_allclose(
        timed.rates(rows)[:, 3], (rows[:, 0] - rows[:, 5]) * rows[:, 4] + rows[:, 8], rtol=1e-13
    )
    untimed = problem(running=lambda x, u, goal: goal @ goal)
    np.testing.assert_allclose(untimed.rates(rows)[:, 3], np.sum(rows[:, 5:8] ** 2, axis=1), rtol=1e-14)


def test_terminal_costs_follow_the_measure():
    rows = stream(35).normal(size=(20, 6))
    program = problem(terminal=lambda x, goal: (np.hypot(*(x - goal)[:2]), x.theta)).arrival
    assert program.names == ("measure", "terminal_0", "terminal_1")
    np.testing.assert_allclose(program(rows)[:, 1], np.hypot(*(rows[:, :2] - rows[:, 3:5]).T), rtol=1e-14)
    assert np.array_equal(program(rows)[:, 2], rows[:, 2])


def test_features_and_reached_may_be_the_users():
    made = problem(
        features=lambda x, target: {"range": np.hypot(target.x - x.x, target.y - x.y)},
        reached=lambda x, goal: np.abs(goal.x - x.x) - 0.5,
    )
    assert made.features.names == ("range",)
    row = np.array([[1.0, 2.0, 0.0, 4.0, 6.0, 0.0]])
    assert made.features(row).item() == 5.0
    assert made.arrival(row).item() == 2.5


def test_defaults():
    made = problem()
    assert (made.horizon, made.period, made.step, made.method) == (30.0, 0.05, 0.05, "rk4")
    assert (made.hold, made.stop, made.obstacles) == (True, True, None)


def test_one_start_and_one_tolerance_stand_for_all():
    made = problem(starts=[1.0, 2.0, 3.0], tolerance=0.25)
    assert made.starts.tolist() == [[1.0, 2.0, 3.0]]
    assert made.tolerance.tolist() == [0.25, 0.25, 0.25]


def test_derived_programs_are_made_once():
    made = problem()
    assert made.rates is made.rates
    assert made.arrival is made.arrival


def test_replace_keeps_what_is_not_replaced():
    made = problem(running=lambda x, u, goal: x.x, terminal=lambda x, goal: x.y, hold=False)
    changed = replace(made, starts=[[0.0, 0.0, 0.0]], period=0.1, step=0.05)
    assert changed.rates == made.rates
    assert changed.arrival == made.arrival
    assert changed.hold is False
    assert changed.starts.shape == (1, 3)


def test_replacing_the_tolerance_moves_the_default_arrival():
    row = np.array([[0.1, 0.0, 0.0, 0.0, 0.0, 0.0]])
    assert problem().arrival(row).item() == 1.0
    assert replace(problem(), tolerance=(0.2, 0.1, 0.2)).arrival(row).item() == -0.5


def test_replacing_the_limits_keeps_the_programs():
    slow = replace(problem(), plant=PLANT.with_limits([-0.1, -0.1], [0.1, 0.1]))
    assert slow.rates == problem().rates
    assert slow.plant.upper.tolist() == [0.1, 0.1]


def test_pickled_problem_computes_the_same():
    made = pickle.loads(pickle.dumps(problem(obstacles=Obstacles([[5.0, 5.0, 0.0, 0.0, 1.0]], radius=0.2))))
    assert made.rates == problem().rates
    assert made.starts.tolist() == STARTS
    assert made.obstacles.circles.tolist() == [[5.0, 5.0, 0.0, 0.0, 1.0]]


def test_arrays_are_read_only_copies():
    starts = np.array(STARTS)
    made = problem(starts=starts)
    starts[0] = 9.0
    assert made.starts.tolist() == STARTS
    for array in (made.starts, made.goal, made.tolerance, Obstacles().circles, Obstacles().bounds):
        assert not array.flags.writeable


NAN, INF = float("nan"), float("inf")
WRONG = {
    "starts_shape": ({"starts": [[0.0, 0.0]]}, r"starts has shape \(1, 2\); expected \(any number, 3\)"),
    "starts_deep": ({"starts": np.zeros((1, 2, 3))}, r"starts has shape \(1, 2, 3\)"),
    "starts_nan": ({"starts": [[0.0, NAN, 0.0]]}, "starts holds NaN or infinity"),
    "starts_infinite": ({"starts": [[0.0, INF, 0.0]]}, "starts holds NaN or infinity"),
    "starts_empty": ({"starts": np.empty((0, 3))}, "starts is empty"),
    "starts_ragged": (
        {"starts": [[0.0, 1.0, 2.0], [0.0]]},
        "starts must hold numbers in rows of equal length",
    ),
    "starts_text": ({"starts": "here"}, "starts must hold numbers"),
    "goal_shape": ({"goal": [0.0, 0.0]}, r"goal has shape \(2,\); expected \(3,\)"),
    "goal_nan": ({"goal": [0.0, NAN, 0.0]}, "goal holds NaN"),
    "tolerance_shape": ({"tolerance": [0.1, 0.1]}, "tolerance has shape"),
    "tolerance_zero": ({"tolerance": [0.1, 0.0, 0.1]}, r"tolerance must be positive, got \[0.1, 0.0, 0.1\]"),
    "tolerance_negative": ({"tolerance": -0.1}, "tolerance must be positive"),
    "tolerance_nan": ({"tolerance": NAN}, "tolerance holds NaN"),
    "horizon_zero": ({"horizon": 0.0}, "horizon must be positive, got 0.0"),
    "horizon_infinite": ({"horizon": INF}, "horizon holds NaN or infinity"),
    "horizon_short": ({"horizon": 0.01}, "horizon, 0.01 s, is shorter than the period, 0.05 s"),
    "period_negative": ({"period": -0.05}, "period must be positive, got -0.05"),
    "period_text": ({"period": "fast"}, "period must hold numbers"),
    "step_zero": ({"step": 0.0}, "step must be positive"),
    "step_long": ({"step": 0.1}, "period, 0.05 s, must be a multiple of the step, 0.1 s"),
    "step_no_divisor": ({"step": 0.02}, "period, 0.05 s, must be a multiple of the step, 0.02 s"),
    "method": ({"method": "rk5"}, "no method 'rk5'; expected one of euler, heun, rk4"),
    "features_number": ({"features": 5}, "features is a function or a Program, got 5"),
    "reached_two": ({"reached": lambda x, goal: (x.x, x.y)}, "reached returns 2 values; expected 1"),
    "running_two": ({"running": lambda x, u, goal: (x.x, x.y)}, "running returns 2 values; expected 1"),
    "running_program": (
        {"running": PLANT.dynamics},
        "running takes x, y, theta, v, omega, t; expected x, y, theta, v",
    ),
    "obstacles_list": ({"obstacles": [[0.0] * 5]}, "obstacles"),
}


@pytest.mark.parametrize(("change", "message"), WRONG.values(), ids=WRONG)
def test_a_wrong_problem_is_an_error(change, message):
    with pytest.raises(ProblemError, match=message) as caught:
        problem(**change)
    assert "\n" not in str(caught.value)


def test_what_is_no_plant_is_an_error():
    with pytest.raises(ProblemError, match="needs a Plant, got 'unicycle'"):
        Problem("unicycle", STARTS, [0, 0, 0], tolerance=0.1)


def test_a_function_that_cannot_be_traced_is_an_error_with_the_line():
    with pytest.raises(
        TracingError, match=r"test_problem.py, line \d+: goal has no 'z'; its names are x, y, theta"
    ):
        problem(terminal=lambda x, goal: goal.z)


def test_steps_may_divide_the_period_but_for_rounding():
    assert problem(period=0.3, step=0.1).step == 0.1  # 0.1 + 0.1 + 0.1 != 0.3


def test_a_start_inside_an_obstacle_names_both():
    circles = [[9.0, 9.0, 0.0, 0.0, 1.0], [-1.0, 1.0, 0.1, 0.0, 0.4]]
    with pytest.raises(
        ProblemError, match=r"start 1 at \(-1.0, 0.5\) is inside obstacle 1, .* radius 0.4 .*robot's 0.15"
    ):
        problem(obstacles=Obstacles(circles, radius=0.15))


def test_a_start_may_touch_an_obstacle():
    made = problem(obstacles=Obstacles([[2.0, 2.0, 0.0, 0.0, 0.75]], radius=0.25))
    assert made.obstacles.radius == 0.25


def test_a_start_outside_the_bounds_is_named():
    with pytest.raises(
        ProblemError, match=r"start 0 at \(1.0, 2.0\) is outside the bounds \[-3.0, 3.0, -1.5, 1.5\]"
    ):
        problem(obstacles=Obstacles(bounds=[-3.0, 3.0, -1.5, 1.5]))


def test_an_unknown_position_is_named():
    with pytest.raises(
        ProblemError, match="position 'z' is no state of the plant; its states are x, y, theta"
    ):
        problem(obstacles=Obstacles(position=("x", "z")))
