"""Ways out of cramped places: free, in order, and of the time that they say."""

from dataclasses import replace

import numpy as np
import pytest

from applications.rosbot.escapes import escapes, turning_time
from applications.rosbot.guides import guides_along
from applications.rosbot.replay import replay
from applications.rosbot.routes import routes
from applications.rosbot.scenario import Scenario

# between two discs that touch it, and facing one of them
WEDGED = Scenario(
    start=[0.0, 0.0, -1.2],
    goal=[2.5, -0.8, 2.8],
    bounds=[-1.5, 3.5, -2.0, 2.0],
    circles=[[-0.02, 0.551, 0.0, 0.0, 0.4], [0.1, -0.545, 0.0, 0.0, 0.4], [0.7, 0.0, 0.0, 0.0, 0.2]],
    speed_limits=(-0.25, 0.5),
    turn_limits=(-0.4, 0.5),
)


def test_escapes_are_driven_without_a_collision_in_their_time():
    found = escapes(WEDGED, WEDGED.start)
    assert found
    for each in found:
        turn = np.remainder(each.poses[1, 2] - each.poses[0, 2] + np.pi, 2.0 * np.pi) - np.pi
        length, sense = float(np.hypot(*(each.poses[-1] - each.poses[1])[:2])), each.senses[-1]
        v, omega = (0.5 if sense > 0.0 else -0.25), (0.5 if turn > 0.0 else -0.4)
        durations = np.array([turn / omega, length / abs(v)])
        check = replay(WEDGED, np.array([[0.0, omega], [v, 0.0]]), durations)
        assert check.clearance >= -1e-6
        assert check.trajectory[-1, 1:3] == pytest.approx(each.poses[-1, :2], abs=1e-9)
        assert each.seconds == pytest.approx(durations.sum())
    assert [each.seconds for each in found] == sorted(each.seconds for each in found)


def test_ways_to_arrive_end_at_the_pose():
    cramped = replace(WEDGED, start=WEDGED.goal, goal=WEDGED.start)
    for each in escapes(cramped, cramped.goal, arrives=True):
        assert each.poses[-1] == pytest.approx(cramped.goal)
        step = each.poses[1, :2] - each.poses[0, :2]
        heading = each.poses[0, 2]
        assert np.sign(step @ [np.cos(heading), np.sin(heading)]) == each.senses[1]


def test_a_turn_goes_the_quicker_way_round():
    assert turning_time(WEDGED, 1.0) == pytest.approx(2.0)
    assert turning_time(WEDGED, -1.0) == pytest.approx(2.5)
    assert turning_time(WEDGED, 3.2) == pytest.approx(6.4)  # 7.7 s to the right
    assert turning_time(replace(WEDGED, turn_limits=(0.0, 0.5)), -1.0) == pytest.approx(
        2.0 * (2.0 * np.pi - 1.0)
    )
    assert turning_time(WEDGED, 0.0) == 0.0


def test_a_robot_that_cannot_stand_has_none():
    assert escapes(replace(WEDGED, speed_limits=(0.1, 0.5)), WEDGED.start) == []


def test_a_guide_leaves_a_cramped_place_freely():
    best = min((way[0] for way in guides_along(WEDGED, routes(WEDGED)) if way), key=lambda each: each.score)
    begin = best.poses[best.times < 1.0]
    gaps = np.hypot(*(begin[:, None, :2] - WEDGED.discs[:, :2]).transpose(2, 0, 1)) - WEDGED.discs[:, 2]
    assert gaps.min() >= -1e-9
    assert best.senses[1] == 0.0  # a turn in place comes first
