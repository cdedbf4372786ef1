import numpy as np
import pytest

from applications.rosbot.model import (
    FAMILY,
    STATES,
    dynamic_unicycle,
    features,
    reached,
    unicycle,
    wheel_coupled,
)
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


def test_the_dynamic_robot_follows_its_commands_within_its_accelerations():
    plant = dynamic_unicycle()
    assert plant.control_names == unicycle().control_names
    assert plant.state_names[:3] == unicycle().state_names
    # k_v, tau_v, a_v, k_omega, tau_omega, a_omega
    vector = [0.99, 0.1, 1.2, 0.8, 0.2, 3.0]
    near, far = [0.0, 0.0, 0.3, 0.4, -0.1, 0.45, -0.2, 0.0], [0.0, 0.0, 0.3, 0.4, -0.1, -0.5, 0.9, 0.0]
    rates = plant.dynamics(np.array([near, far]), vector)
    velocity = 0.4 * np.exp(0.3j)
    followed = [(0.99 * 0.45 - 0.4) / 0.1, (0.8 * -0.2 + 0.1) / 0.2]
    assert rates[0] == pytest.approx([velocity.real, velocity.imag, -0.1, *followed], abs=1e-15)
    assert rates[1, 3:].tolist() == [-1.2, 3.0]
    assert plant.parameters == dict(FAMILY)


def test_turning_gains_are_those_of_skid_steer():
    track, half_wheelbase = 0.192, 0.0525  # m, of Husarion's model
    for separation, gain in [(0.192, 0.77), (0.186 * 1.45, 1.08)]:
        theory = (separation / 2) * (track / 2) / ((track / 2) ** 2 + half_wheelbase**2)
        assert theory == pytest.approx(gain, abs=0.006)


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
