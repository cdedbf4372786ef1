"""Whether a goal in a room can be reached, for gaps a little wider and a little narrower than the robot."""

import numpy as np
import pytest

from applications.rosbot.reachability import reachability
from applications.rosbot.room import Room
from applications.rosbot.scenario import Scenario

BOX = [[-1.0, -1.0, 4.0, -1.0], [4.0, -1.0, 4.0, 1.0], [4.0, 1.0, -1.0, 1.0], [-1.0, 1.0, -1.0, -1.0]]


def scene(gap: float, **changes) -> Scenario:
    """A box in two halves, joined by a gap of some width (m)."""
    walls = [[1.5, -1.0, 1.5, -0.5 * gap], [1.5, 0.5 * gap, 1.5, 1.0]]
    given = {"start": [0.0, 0.0, 0.0], "goal": [3.0, 0.3, 0.0], "room": Room(segments=np.array(BOX + walls))}
    return Scenario(**given | changes)


@pytest.mark.parametrize(("gap", "status"), [(0.4, "reachable"), (0.31, "undecided"), (0.24, "unreachable")])
def test_a_gap_is_wide_enough_or_not(gap, status):
    assert reachability(scene(gap)).status == status


def test_the_reason_says_how_wide_the_widest_way_is_at_most():
    reason = reachability(scene(0.2)).reason
    assert "no route leads through the room to the goal: the widest one is" in reason
    assert 0.2 <= float(reason.split("widest one is ")[1].split(" m")[0]) < 0.3
    assert "the robot needs 0.3 m" in reason


def test_a_goal_in_a_wall_is_told_from_one_that_is_shut_off():
    assert "the goal is in collision" in reachability(scene(0.4, goal=[1.5, 0.6, 0.0])).reason


def test_circles_at_rest_shut_a_way_and_moving_ones_do_not():
    plug = [[1.5, 0.0, 0.0, 0.0, 0.2]]
    moving = [[1.5, 0.0, 0.0, 0.3, 0.2]]
    assert reachability(scene(0.6, circles=plug)).status == "unreachable"
    assert reachability(scene(0.6, circles=moving)).status == "undecided"


def test_outside_of_the_room_a_way_leads_around_unless_the_bounds_forbid_it():
    wall = Room(segments=np.array([[1.5, -2.0, 1.5, 2.0]]))
    assert reachability(scene(0.4, room=wall)).status == "reachable"
    assert reachability(scene(0.4, room=wall, bounds=[-1.0, 4.0, -1.5, 1.5])).status == "unreachable"


def test_only_what_is_sure_is_said_of_other_bodies():
    long = np.array([[-0.3, 0.0, 0.15], [0.0, 0.0, 0.15], [0.3, 0.0, 0.15]])
    assert reachability(scene(1.2, footprint=long)).status == "undecided"
    assert reachability(scene(0.0, footprint=long)).status == "unreachable"
