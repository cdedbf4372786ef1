import numpy as np
import pytest

from applications.rosbot.model import STATES, features, reached, unicycle, wheel_coupled
from gpsynth.tracing import trace

POSES = [("x", tuple(STATES)), ("target", {name: f"{name}_target" for name in STATES})]


def seen(pose, target):
    program = trace(features, POSES)
    return dict(zip(program.names, program(np.array([[*pose, *target]]))[0], strict=True))


def moved(pose, shift, turn):
    position = (pose[0] + 1j * pose[1]) * np.exp(1j * turn) + shift
    return [position.real, position.imag, pose[2] + turn]


def test_the_unicycle_drives_where_it_looks():
    plant = unicycle((-0.1, 0.7), (-2.0, 1.0))
    rates = plant.dynamics(np.array([[5.0, 6.0, 0.3, 0.4, -0.2, 0.0]]))[0]
    velocity = 0.4 * np.exp(0.3j)
    assert rates == pytest.approx([velocity.real, velocity.imag, -0.2], abs=1e-15)
    assert np.array_equal(plant.lower, [-0.1, -2.0])
    assert np.array_equal(plant.upper, [0.7, 1.0])


def test_coupled_wheels_leave_no_turning_at_full_speed():
    plant = wheel_coupled(10.0)
    rates = plant.dynamics(np.array([[0.0, 0.0, 0.0, 10.0, 10.0, 0.0], [0.0, 0.0, 0.0, 10.0, -10.0, 0.0]]))
    assert rates == pytest.approx(np.array([[10.0, 0.0, 0.0], [0.0, 0.0, 10.0]]))


def test_features_equal_complex_arithmetic():
    rng = np.random.default_rng(3)
    for pose, target in rng.uniform(-3.0, 3.0, (50, 2, 3)):
        line = complex(*(target - pose)[:2])
        ahead = line * np.exp(-1j * pose[2])
        bearing = np.angle((ahead if ahead.real >= 0.0 else -ahead) + 0.05)
        turn = np.angle(np.exp(1j * (target[2] - pose[2])))
        expected = {
            "error_x": (line * np.exp(-1j * pose[2])).real,
            "error_y": (line * np.exp(-1j * pose[2])).imag,
            "error_theta": np.angle(np.exp(1j * (target[2] - pose[2]))),
            "distance": abs(line),
            "bearing": bearing,
            "approach": np.angle(np.exp(1j * (bearing - turn))),
            "heading": turn / (1.0 + abs(line) ** 2 / 0.05**2),
        }
        assert seen(pose, target) == pytest.approx(expected, abs=1e-12)


def test_features_do_not_change_when_pose_and_target_move_together():
    pose, target = [0.3, -0.2, 2.0], [1.5, 0.4, -1.0]
    expected = seen(pose, target)
    assert seen(moved(pose, 2 - 1j, 0.7), moved(target, 2 - 1j, 0.7)) == pytest.approx(expected, abs=1e-12)


def test_all_features_are_zero_at_the_target():
    assert set(seen([1.0, 2.0, 3.0], [1.0, 2.0, 3.0]).values()) == {0.0}


@pytest.mark.parametrize(
    ("pose", "arrived"),
    [
        ([0.029, 0.04, 0.0], True),
        ([0.031, 0.04, 0.0], False),
        ([0.0, 0.0, 0.099], True),
        ([0.0, 0.0, -0.101], False),
        ([0.0, 0.0, 2.0 * np.pi], True),
    ],
)
def test_arrival_needs_position_and_heading(pose, arrived):
    measure = trace(reached(0.05, 0.1), POSES)(np.array([[*pose, 0.0, 0.0, 0.0]]))[0, 0]
    assert (measure <= 0.0) == arrived
