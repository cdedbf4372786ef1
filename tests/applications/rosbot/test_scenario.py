from dataclasses import replace

import numpy as np
import pytest

from applications.rosbot.scenario import Scenario
from gpsynth.errors import ScenarioError

START, GOAL = [0.0, 0.0, 0.0], [2.0, 2.0, 0.0]
BOUNDS = [-3.0, 3.0, -3.0, 3.0]


def test_arrays_are_frozen_and_discs_include_the_robot():
    scenario = Scenario(START, GOAL, circles=[[1.0, 1.0, 0.0, 0.0, 0.5]], radius=0.2)
    assert np.array_equal(scenario.discs, [[1.0, 1.0, 0.7]])
    with pytest.raises(ValueError, match="read-only"):
        scenario.start[0] = 1.0


def test_limits_may_differ_forwards_and_backwards():
    scenario = Scenario(START, GOAL, speed_limits=(-0.1, 0.7), turn_limits=(-2.0, 1.0))
    assert (scenario.speed_limits, scenario.turn_limits) == ((-0.1, 0.7), (-2.0, 1.0))


def test_an_obstacle_with_a_velocity_moves():
    still, moving = [[1.0, 1.0, 0.0, 0.0, 0.1]], [[1.0, 1.0, 0.0, -0.2, 0.1]]
    assert Scenario(START, GOAL, circles=still).is_static
    assert not Scenario(START, GOAL, circles=moving).is_static


def test_a_start_that_touches_an_obstacle_is_free():
    assert Scenario(START, GOAL, circles=[[1.0, 0.0, 0.0, 0.0, 0.75]], radius=0.25).radius == 0.25


@pytest.mark.parametrize(
    ("wrong", "sentence"),
    [
        ({"speed_limits": (np.nan, 0.5)}, r"speed_limits is \[nan, 0.5\]"),
        ({"turn_limits": (0.5, -0.5)}, r"limits of omega are \[0.5, -0.5\]"),
        ({"speed_limits": (0.5,)}, r"speed_limits has shape \(1,\); expected \(2,\)"),
        ({"bounds": [3.0, -3.0, -3.0, 3.0]}, r"bounds of x are \[3, -3\]"),
        ({"bounds": [-3.0, 3.0, np.nan, 3.0]}, r"bounds of y are \[nan, 3\]"),
        ({"radius": -0.1}, "the robot's radius is -0.1"),
        ({"circles": [[1.0, 1.0, 0.0, 0.0, -0.1]]}, r"obstacles\[0\] has radius -0.1"),
        ({"circles": [[1.0, np.inf, 0.0, 0.0, 0.1]]}, r"obstacles\[0\] is \[1.0, inf"),
        ({"circles": [[1.0, 1.0, 0.1]]}, r"circles has shape \(1, 3\)"),
        ({"circles": [[0.1, 0.0, 0.0, 0.0, 0.3]]}, r"start \(0, 0\) overlaps obstacles\[0\] by 0.35 m"),
        ({"goal": [4.0, 0.0, 0.0]}, r"goal \(4, 0\) lies outside the bounds"),
        ({"start": [0.0, -4.0, 0.0]}, r"start \(0, -4\) lies outside the bounds"),
        ({"goal": [1.0, 1.0]}, r"goal has shape \(2,\); expected \(3,\)"),
        ({"goal": [1.0, 1.0, np.inf]}, r"goal is \[1.0, 1.0, inf\]"),
        ({"time_limit": 0.0}, "time_limit is 0.0"),
        ({"position_tolerance": -0.05}, "position_tolerance is -0.05"),
        ({"heading_tolerance": np.nan}, "heading_tolerance is nan"),
    ],
)
def test_what_is_wrong_is_named_with_its_value(wrong, sentence):
    with pytest.raises(ScenarioError, match=sentence):
        Scenario(**{"start": START, "goal": GOAL, "bounds": BOUNDS} | wrong)


def test_a_changed_robot_is_the_changed_one():
    disc = Scenario([0.0, 0.0, 0.0], [1.0, 0.0, 0.0], radius=0.0)
    assert replace(disc, start=[0.1, 0.0, 0.0]).body.tolist() == [[0.0, 0.0, 0.0]]
    assert replace(disc, radius=0.2).body.tolist() == [[0.0, 0.0, 0.2]]
    assert replace(disc, footprint=[[0.1, 0.0, 0.3]]).radius == pytest.approx(0.2)


@pytest.mark.parametrize(("name", "what"), [("speed_limits", "v"), ("turn_limits", "omega")])
def test_a_robot_that_hardly_moves_is_refused(name, what):
    with pytest.raises(
        ScenarioError, match=f"limits of {what} are .*; expected one of at least 1e-06 in size"
    ):
        Scenario(START, GOAL, **{name: (-1e-310, 1e-310)})
    Scenario(START, GOAL, **{name: (-1e-6, 1e-310)})
