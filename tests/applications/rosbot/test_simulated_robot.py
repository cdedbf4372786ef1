"""The simulated robot: its flaws have the spread they are said to have."""

import numpy as np
import pytest

from applications.rosbot.simulated_robot import UNCERTAIN, Flaws, SimulatedRobot
from gpsynth.errors import ScenarioError
from gpsynth.seeds import stream

COMMAND = np.array([0.5, -0.4])


def test_without_flaws_it_does_what_it_is_told_and_knows_where_it_is():
    robot = SimulatedRobot.drawn(Flaws(), stream(1))
    assert np.array_equal(robot.applied(COMMAND), COMMAND)
    assert np.allclose(robot.located(np.zeros(3), np.array([1.0, 2.0, 3.0])), [1.0, 2.0, 3.0])


def test_gains_are_constant_and_slip_is_not():
    robots = [SimulatedRobot.drawn(UNCERTAIN, stream(2, number)) for number in range(400)]
    gains = np.array([robot.gains for robot in robots])
    assert np.allclose(gains.std(axis=0), UNCERTAIN.gain, rtol=0.15)  # 4 standard errors
    factors = np.array([robots[0].applied(COMMAND) for _ in range(400)]) / COMMAND / gains[0]
    assert np.allclose(factors.mean(axis=0), 1.0, atol=0.02)
    assert np.allclose(factors.std(axis=0), UNCERTAIN.slip, rtol=0.15)


def test_noise_of_the_pose_is_smoothed_and_headings_are_compared_round_the_circle():
    robot = SimulatedRobot.drawn(UNCERTAIN, stream(3))
    pose = np.array([1.0, 1.0, np.pi - 0.01])
    found = np.array([robot.located(pose - [0.0, 0.0, 2.0 * np.pi], pose) for _ in range(400)])
    errors = found - (pose - [0.0, 0.0, 2.0 * np.pi])
    assert np.all(np.abs(errors) < 0.02)
    assert np.all(errors.std(axis=0) < 0.5 * UNCERTAIN.position)


@pytest.mark.parametrize("name", ["gain", "slip", "position", "heading"])
def test_flaws_are_no_less_than_none(name):
    with pytest.raises(ScenarioError, match=f"the flaw {name} is -0.1; expected a finite number, at least 0"):
        Flaws(**{name: -0.1})
