"""Ways on in a room, judged by strings around a wall's end whose lengths are known."""

import numpy as np
import pytest

from applications.rosbot.room import Room
from applications.rosbot.scenario import Scenario
from applications.rosbot.wayfinder import AHEAD, PASSING, Wayfinder, wayfinder

MARGIN = 0.05
NEED = Scenario.radius + MARGIN  # m, from the wall to the robot's center
WALL = np.array([[0.0, -6.0, 0.0, 6.0]])


def hall(y: float = 0.0, **changes) -> Scenario:
    """A wall between start and goal; the bounds leave a way over its upper end alone."""
    given = {"bounds": np.array([-4.0, 4.0, -6.1, 9.0]), "room": Room(segments=WALL)} | changes
    return Scenario([-1.0, y, 0.0], [1.0, 0.0, 0.0], **given)


def string(*places: tuple[float, float]) -> float:
    """The length (m) of the taut string around the wall's upper end that joins places beside it."""
    length = 0.0
    for x, y in places:
        far = np.hypot(x, 6.0 - y)
        turn = np.arctan2(6.0 - y, abs(x)) + np.arcsin(NEED / far)
        length += np.sqrt(far**2 - NEED**2) + NEED * turn
    return float(length)


def found(scenario: Scenario, *clearances: float) -> Wayfinder:
    finder = wayfinder(scenario, clearances or (MARGIN,))
    assert finder is not None
    return finder


@pytest.mark.parametrize("y", [3.0, 0.0, -5.5])  # to the last the lower end is nearer, but out of bounds
def test_a_way_within_reach_is_as_long_as_a_taut_string_and_leads_to_the_goal(y):
    scene = hall(y, speed_limits=(-2.0, 2.0))
    near, part = found(hall()).look(scene)
    taut = string((-1.0, y), (1.0, 0.0))
    assert near is scene
    assert taut - 1e-3 <= part.way.length <= 1.04 * taut
    assert np.array_equal(part.way.points[[0, -1]], [scene.start[:2], scene.goal[:2]])


def test_a_far_goal_gives_way_to_a_place_on_the_way_to_it():
    scene = hall(speed_limits=(-0.3, 0.3))
    near, part = found(scene).look(scene)
    place, ahead = near.goal[:2], AHEAD * 0.3
    assert place[0] < 0.0
    assert np.isfinite(part.field.at(place))
    assert ahead + string(place, (1.0, 0.0)) <= 1.02 * string((-1.0, 0.0), (1.0, 0.0))
    assert near.position_tolerance == PASSING
    assert near.heading_tolerance > np.pi
    assert near.goal[2] == pytest.approx(np.pi / 2 - np.arctan2(1.0 - NEED, 6.0), abs=0.2)  # along the string


def test_other_ways_are_those_around_what_moves_where_it_is_now():
    scene = hall(circles=[[-0.7, 2.5, 0.0, -0.1, 0.3]])
    near, part = found(scene).look(scene)
    routes = part.routes(near, 3, MARGIN)
    beside = [np.interp(2.5, route.points[:, 1], route.points[:, 0]) + 0.7 for route in routes]
    assert min(beside) <= -0.3 - NEED + 1e-3
    for route in routes:
        assert np.hypot(*(route.points - [-0.7, 2.5]).T).min() >= 0.3 + NEED - 1e-3
        assert np.array_equal(route.points[-1], near.goal[:2])


def test_what_rests_is_gone_around_and_what_moves_is_not():
    resting, moving = (
        found(hall(circles=[[-1.0, 3.0, 0.0, vy, 1.0]])).look(hall(speed_limits=(-2.0, 2.0)))[1].way.points
        for vy in (0.0, 0.1)
    )
    assert np.hypot(*(resting - [-1.0, 3.0]).T).min() >= 1.0 + NEED - 1e-3
    assert np.hypot(*(moving - [-1.0, 3.0]).T).min() < 1.0


def test_ways_keep_the_first_clearance_at_which_there_is_one():
    gap = hall(room=Room(segments=np.array([[0.0, -6.0, 0.0, 1.0], [0.0, 1.35, 0.0, 9.0]])))
    assert found(gap, MARGIN, 0.01, 0.0).clearance == pytest.approx(Scenario.radius + 0.01)


def test_there_is_no_way_without_a_room_and_through_a_wall():
    assert wayfinder(hall(room=None), (MARGIN,)) is None
    assert wayfinder(hall(bounds=np.array([-4.0, 4.0, -6.1, 6.1])), (MARGIN, 0.0)) is None
