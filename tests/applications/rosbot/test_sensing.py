"""What is known of a scenario on the way, against where circles are by hand."""

import numpy as np
import pytest

from applications.rosbot.room import Room
from applications.rosbot.scenario import Scenario
from applications.rosbot.sensing import Sensor, scene_ahead
from gpsynth.errors import ScenarioError

RESTING, NEAR, FAR = [9.0, 0.0, 0.0, 0.0, 0.2], [2.0, 0.0, 0.1, 0.0, 0.2], [9.0, 1.0, -0.4, 0.0, 0.2]


def room(**changes):
    return Scenario(
        **{"start": [0.0, 0.0, 0.0], "goal": [6.0, 0.0, 0.0], "circles": [RESTING, NEAR, FAR]} | changes
    )


def test_what_rests_is_known_and_what_moves_is_seen_when_near():
    assert Sensor().seen(room(), np.zeros(2), 0.0).tolist() == [RESTING, NEAR]
    later = Sensor().seen(room(), np.array([3.0, 0.0]), 10.0)
    assert later.tolist() == [RESTING, [3.0, 0.0, 0.1, 0.0, 0.2], [5.0, 1.0, -0.4, 0.0, 0.2]]


def test_more_movers_than_a_sensor_can_tell_apart():
    with pytest.raises(ScenarioError, match="2 circles move; the sensor can tell 1 apart"):
        Sensor(most=1).check(room())


def at(x: float, y: float = 0.0, heading: float = 0.0) -> np.ndarray:
    """The state of a robot there."""
    return np.array([x, y, heading, 0.0, 0.0])


@pytest.mark.parametrize("reach", [0.0, -1.0, np.nan])
def test_a_sensor_reaches_somewhere(reach):
    with pytest.raises(ScenarioError, match="the sensor's reach is"):
        Sensor(reach)


def test_the_scene_ahead_has_the_circles_where_they_will_be():
    scene = scene_ahead(room(), np.array([NEAR]), at(0.5, heading=7.0), 2.0)
    assert scene.circles.tolist() == [[2.2, 0.0, 0.1, 0.0, 0.2]]
    assert np.allclose(scene.start, [0.5, 0.0, 7.0 - 2.0 * np.pi])


def test_a_circle_that_the_robot_overlaps_is_shrunk_and_one_around_its_center_left_out():
    scene = scene_ahead(room(), np.array([NEAR, [1.8, 0.0, 0.0, 0.0, 0.3]]), at(1.75), 0.0)
    assert len(scene.circles) == 1
    assert scene.circles[0, 4] == pytest.approx(0.1)


def test_a_pose_out_of_bounds_is_moved_inside():
    scene = scene_ahead(room(bounds=[-1.0, 7.0, -1.0, 1.0]), np.empty((0, 5)), at(0.0, 1.1), 0.1)
    assert scene.start.tolist() == [0.0, 1.0, 0.0]


def test_what_the_body_overlaps_counts_not_its_inner_disc():
    body = np.array([[0.3, 0.0, 0.1], [0.0, 0.0, 0.1]])
    scene = scene_ahead(room(footprint=body), np.array([NEAR]), at(1.55), 0.0)
    assert scene.circles[0, 4] == pytest.approx(0.05, abs=1e-8)


@pytest.mark.parametrize(("x", "radius"), [(0.8, 0.15), (0.9, 0.1), (0.99, 0.01)])
def test_a_robot_in_a_wall_is_made_thinner(x, radius):
    wall = Room(segments=np.array([[1.0, -1.0, 1.0, 1.0]]))
    scene = scene_ahead(room(room=wall), np.empty((0, 5)), at(x), 0.1)
    assert scene.radius == pytest.approx(radius, abs=1e-8)
    assert scene.room is wall


def test_nothing_is_left_of_a_room_whose_wall_is_at_the_robot_s_center():
    block = Room(polygons=(np.array([[0.0, -1.0], [2.0, -1.0], [2.0, 1.0], [0.0, 1.0]]),))
    scene = scene_ahead(room(room=block, start=[-1.0, 0.0, 0.0]), np.empty((0, 5)), at(1.0), 0.1)
    assert (scene.room, scene.radius) == (None, 0.15)


def test_a_circle_flies_off_no_farther_than_a_scenario_reaches():
    scene = scene_ahead(room(), np.array([[9999.0, 2.0, 3.0, 0.5, 0.2]]), at(0.0), 2.0)
    assert scene.circles.tolist() == [[1e4, 3.0, 3.0, 0.5, 0.2]]


def test_a_robot_with_lags_keeps_its_speeds():
    state = np.array([0.5, 0.0, 0.0, 0.4, -0.2])
    scene = scene_ahead(room(model="dynamic_unicycle"), np.empty((0, 5)), state, 0.1)
    assert scene.speeds == (0.4, -0.2)
