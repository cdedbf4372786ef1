"""Plans that pass places on their way."""

from dataclasses import replace

import numpy as np
import pytest

from applications.rosbot.model import unicycle
from applications.rosbot.planner import Effort, plan_scenario
from applications.rosbot.polar_law import SATURATING, polar_law
from applications.rosbot.problems import PERIOD, problem_of
from applications.rosbot.replay import replay
from applications.rosbot.scenario import Scenario
from applications.rosbot.through import plan_through
from gpsynth.errors import ScenarioError
from gpsynth.evaluate import Evaluator
from gpsynth.planning import PlanSettings

SMALL = PlanSettings(particles=16, iterations=8, rounds=2)
QUICK = Effort(scouts=SMALL, chasers=SMALL, refiners=SMALL, chased=1, refined=1)
VIA = np.array([[1.0, 1.0, 0.1], [2.0, -0.5, 0.05]])


def scene(**changes) -> Scenario:
    circles = [[1.5, 0.3, 0.0, 0.0, 0.2], [2.5, -2.0, 0.0, 0.3, 0.1]]
    return Scenario(**{"start": [0.0, 0.0, 0.0], "goal": [3.0, 0.0, 0.0], "circles": circles} | changes)


def law():
    return polar_law(unicycle(), SATURATING)


@pytest.fixture(name="report", scope="module")
def _report():
    return plan_through(scene(), VIA, law(), seed=1, effort=QUICK)


def test_every_place_is_passed_in_its_order(report):
    assert report.status == "planned"
    path = report.replay.trajectory
    near = [np.hypot(path[:, 1] - x, path[:, 2] - y) <= tolerance + 1e-6 for x, y, tolerance in VIA]
    first = int(np.argmax(near[0]))
    assert np.any(near[0])
    assert np.any(near[1][first:])
    assert report.certificate.is_clear
    # straight lines at top speed, less the tolerances, are a bound
    places = np.vstack([[0.0, 0.0], VIA[:, :2], [3.0, 0.0]])
    straight = np.hypot(*np.diff(places, axis=0).T).sum() - 2.0 * VIA[:, 2].sum() - 0.05
    assert straight / 0.5 < report.replay.arrival_time < 1.6 * straight / 0.5


def test_the_schedule_is_what_the_law_follows(report):
    schedule = report.plan.schedule
    problem = problem_of(replace(scene(), goal=np.array([30.0, 0.0, 0.0])), report.law)  # no goal on the way
    found = Evaluator(problem).of_schedules(
        report.law, schedule.points[np.newaxis], schedule.dwell[np.newaxis], schedule.ends[-1]
    )
    tick = round(schedule.ends[-1] / PERIOD)
    assert found.final[0, 0] == pytest.approx(report.plan.trajectory.x[tick], abs=1e-9)


def test_a_goal_at_the_start_is_arrived_at_after_the_places():
    there = plan_through(scene(goal=[0.0, 0.0, 0.0]), VIA[:1], law(), seed=1, effort=QUICK)
    assert there.replay.arrival_time > 2.0 * (np.hypot(1.0, 1.0) - 0.1) / 0.5 - 0.2
    assert replay(scene(goal=[0.0, 0.0, 0.0]), there.plan.trajectory.u, PERIOD).arrival_time == 0.0


def test_a_place_that_cannot_be_reached_is_named():
    block = scene(circles=[[1.0, 1.0, 0.0, 0.0, 0.3]])
    report = plan_through(block, VIA, law(), effort=QUICK)
    assert (report.status, report.plan) == ("unreachable", None)
    assert report.reason.startswith("on the way to via-point 0: via-point 0 is in collision")


def test_a_car_passes_places_and_a_robot_with_lags_is_refused():
    car = scene(model="car", turning_radius=0.5, circles=[])
    report = plan_through(car, VIA[:1], law(), seed=1, effort=QUICK)
    assert replay(car, report.controls, PERIOD, via=VIA[:1]).solves
    with pytest.raises(ScenarioError, match="via-points are for robots without lags"):
        plan_through(scene(model="dynamic_unicycle"), VIA, law(), effort=QUICK)


@pytest.mark.parametrize(
    ("via", "sentence"),
    [
        ([[1.0, 1.0, 0.0]], "via-point 0 has tolerance 0 m; expected more than 0"),
        ([[2e4, 1.0, 0.1]], r"via-point 0 is \[20000.0, 1.0, 0.1\]; expected finite numbers within ±10000"),
        ([[1.0, 1.0, 0.1], [9.0, 0.0, 0.1]], r"via-point 1 \(9, 0\) lies outside the bounds"),
        ([[1.0, np.nan, 0.1]], "expected finite numbers within ±10000"),
        ([1.0, 1.0, 0.1], "via-points are rows of x, y and tolerance"),
    ],
)
def test_places_that_make_no_sense_are_one_sentence(via, sentence):
    with pytest.raises(ScenarioError, match=sentence):
        plan_through(scene(bounds=[-5.0, 5.0, -5.0, 5.0]), via, law(), effort=QUICK)


def test_what_is_allowed_is_for_all_legs():
    few = Effort(rollouts=3 * 288)
    report = plan_through(scene(), VIA, law(), seed=1, effort=few)
    alone = plan_scenario(scene(), [law()], seed=1, effort=few)
    assert report.ended == "rollouts"
    assert few.rollouts <= report.evaluations <= alone.evaluations  # a round is not broken off


def test_too_little_time_after_a_leg_proves_nothing():
    late = plan_through(scene(circles=[], time_limit=9.0), [[2.0, 1.5, 0.05]], law(), effort=QUICK)
    assert (late.status, late.plan) == ("not_found", None)
    assert late.reason.startswith("on the way to the goal: too late")
    shut = scene(circles=[[3.0, 0.0, 0.0, 0.0, 0.3]])
    assert plan_through(shut, [[1.0, 0.0, 0.1]], law(), effort=QUICK).status == "unreachable"


def test_a_circle_may_fly_off_on_the_way():
    far = scene(circles=[[9e3, 0.0, 1e3, 0.0, 0.2]])
    assert plan_through(far, [[1.0, 0.0, 0.1]], law(), effort=QUICK).status == "planned"
