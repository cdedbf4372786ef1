"""Courses on their way: the same targets at the same times, and alternatives that begin where the robot is."""

import numpy as np
import pytest

from applications.rosbot.courses import Course, alternatives, anew, standing
from applications.rosbot.scenario import Scenario
from gpsynth.schedule import Schedule

GOAL = np.array([4.0, 0.0, 0.0])
POSE = np.array([1.0, 0.0, 0.5])
SCHEDULE = Schedule([[1.0, 0.5, 0.0], [2.0, -0.5, 0.1], [3.0, 0.0, 0.0]], [0.7, 1.1, 0.4])


def test_what_is_left_of_a_course_has_the_same_targets():
    course = Course.of(SCHEDULE, GOAL, 5)
    later = Course.of(course.remainder(0.9)[0], GOAL, 5)
    assert len(later.schedule.dwell) == 5
    for time in np.arange(0.0, 2.0, 0.05):
        assert np.allclose(later.target(time), course.target(time + 0.9))
    assert np.array_equal(later.target(1.4), GOAL)


def test_to_stand_still_is_a_course():
    assert np.array_equal(Course.of(standing(POSE), GOAL, 4).target(1.0), POSE)


def test_alternatives_wait_retreat_go_straight_and_pass_on_both_sides():
    others = alternatives(SCHEDULE, POSE, GOAL)
    first, dwell = others.points[:, 0], others.dwell
    assert np.any(np.all(first == GOAL, axis=1) & (dwell.sum(axis=1) == 0.0))
    assert np.any(np.all(first == POSE, axis=1) & (dwell[:, 0] == 1.0))
    ahead = (first[:, :2] - POSE[:2]) @ [np.cos(POSE[2]), np.sin(POSE[2])]
    assert ahead.min() == pytest.approx(-1.0)
    aside = others.points[:, :, 1].mean(axis=1)
    assert aside.min() < -0.9 < 0.9 < aside.max()


def test_new_courses_know_the_ways_around_what_is_there_now():
    scene = Scenario(POSE, GOAL, circles=[[2.5, 0.0, 0.0, 0.0, 0.5]])
    found = anew(scene, 5, 0.05)
    assert found.points.shape[1:] == (5, 3)
    beside = found.points[np.abs(found.points[..., 0] - 2.5) < 0.4][:, 1]
    assert beside.min() < -0.5 < 0.5 < beside.max()
