"""One cycle of planning on: what is kept, what gives way, and what is done where nothing is clear to its end."""

import numpy as np
import pytest

from applications.rosbot.courses import Course
from applications.rosbot.problems import problem_of
from applications.rosbot.replanning import CRASH, SOON, Caution, Replanning, replan
from applications.rosbot.scenario import Scenario
from applications.rosbot.stabilizer import default_law
from gpsynth.evaluate import Evaluator
from gpsynth.planning import Objective, PlanSettings
from gpsynth.schedule import Schedule
from gpsynth.simulation import simulate

LAW = default_law()
GOAL = np.array([3.0, 0.0, 0.0])
STRAIGHT = Schedule([GOAL], [1.0])


def scene(*circles):
    return Scenario([0.0, 0.0, 0.0], GOAL, circles=np.reshape(circles, (-1, 5)))


def driven(scene, course, horizon=None):
    return simulate(problem_of(scene, LAW), LAW, schedule=course.schedule, horizon=horizon)


def test_a_course_that_cannot_be_beaten_by_much_is_kept():
    course = Course.of(STRAIGHT, GOAL, 5)
    later = replan(scene(), LAW, course, 0.0, Replanning(gain=1.0))
    assert np.array_equal(later.schedule.points, course.schedule.points)
    assert later.arrival_time == pytest.approx(
        driven(scene(), later).arrival, abs=0.05
    )  # between the periods


def test_a_faster_course_is_preferred():
    slow = Course.of(Schedule([[0.0, 0.0, 0.0]], [2.0]), GOAL, 5)
    waits = driven(scene(), slow).arrival
    assert replan(scene(), LAW, slow, 0.0).arrival_time < waits - 1.5


@pytest.mark.parametrize("circle", [[1.5, 0.1, 0.0, 0.0, 0.3], [1.5, -1.2, 0.0, 0.4, 0.3]])
def test_a_course_that_would_hit_something_gives_way(circle):
    here, course = scene(circle), Course.of(STRAIGHT, GOAL, 5)
    assert driven(here, course).clearance < 0.0
    later = replan(here, LAW, course, 0.0)
    assert driven(here, later).clearance >= Replanning().least
    assert np.isfinite(later.arrival_time)


def test_where_nothing_is_clear_to_its_end_the_next_moments_are():
    angles = np.linspace(0.0, 2.0 * np.pi, 16, endpoint=False)
    ring = [[2.5 * np.cos(a), 2.5 * np.sin(a), -0.4 * np.cos(a), -0.4 * np.sin(a), 0.5] for a in angles]
    closing = scene(*ring)
    course = replan(closing, LAW, Course.of(STRAIGHT, GOAL, 5), 0.0)
    assert course.clearance < 0.0
    assert driven(closing, course, SOON).clearance >= Replanning().least
    assert driven(closing, Course.of(STRAIGHT, GOAL, 5), SOON).clearance < 0.0


def test_no_delay_outweighs_a_crash():
    here = scene([1.5, 0.0, 0.0, 0.0, 0.3])
    settings = PlanSettings(points=1, margin=0.05)
    caution = Caution(Objective(Evaluator(problem_of(here, LAW), margin=0.05), LAW, settings, 60.0), 0.02)
    through, never = np.array([[3.0, 0.0, 0.0, 1.0], [-3.0, -3.0, 0.0, 200.0]])
    costs = caution(np.array([through, never]))
    assert costs[1] < CRASH < costs[0]


def test_the_swarm_goes_on_and_the_same_seed_gives_the_same_course():
    here, course = scene([1.5, 0.1, 0.0, 0.0, 0.3]), Course.of(STRAIGHT, GOAL, 5)
    first, again, other = (replan(here, LAW, course, 0.1, seed=seed) for seed in (1, 1, 2))
    assert np.array_equal(first.schedule.points, again.schedule.points)
    assert not np.array_equal(first.swarm.points, other.swarm.points)
    assert len(first.swarm) == Replanning().kept
    assert len(first.remainder(0.1)) == 1 + Replanning().kept
