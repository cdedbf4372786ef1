"""Fleets: nobody touches anybody, checked by another simulator; and what cannot be planned is said in one sentence."""

from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest

from applications.rosbot import fleet_search
from applications.rosbot.certificate import certify
from applications.rosbot.fleet import FleetEffort, plan_fleet
from applications.rosbot.fleet_search import other_of
from applications.rosbot.others import Other
from applications.rosbot.planner import Effort, plan_scenario
from applications.rosbot.problems import PERIOD
from applications.rosbot.replay import drive, replay
from applications.rosbot.scenario import Scenario
from applications.rosbot.stabilizer import default_law
from gpsynth.errors import ProblemError, ScenarioError
from gpsynth.planning import PlanSettings

SMALL = PlanSettings(particles=24, iterations=10, rounds=3)
ROBOT = Effort(scouts=SMALL, chasers=SMALL, refiners=SMALL, followers=SMALL, chased=1, refined=1, attempts=1)
QUICK = FleetEffort(robot=ROBOT, orders=1, rounds=0)
HALL = np.array([-0.5, 3.5, -0.45, 0.45])


def robot(start, goal, **changes):
    return Scenario(**{"start": start, "goal": goal, "bounds": HALL} | changes)


EXCHANGE = (robot([0.0, 0.0, 0.0], [3.0, 0.0, 0.0]), robot([3.0, 0.0, np.pi], [0.0, 0.0, np.pi]))


def planned(scenarios, effort=QUICK, seed=1):
    return plan_fleet(scenarios, [default_law()], seed=seed, effort=effort)


@pytest.fixture(scope="module")
def exchange():
    return planned(EXCHANGE)


def gap(first, second):
    """The least distance of two robots at samples 1 ms apart, each standing once it has arrived."""
    paths = [drive(each.start, each.controls, each.durations) for each in map(other_of, (first, second))]
    times = np.union1d(paths[0][:, 0], paths[1][:, 0])
    x, y = (np.subtract(*(np.interp(times, path[:, 0], path[:, k]) for path in paths)) for k in (1, 2))
    return np.hypot(x, y).min() - first.scenario.radius - second.scenario.radius


def test_two_robots_change_places_clear_of_each_other(exchange):
    assert exchange.status == "planned"
    one, two = exchange.robots
    [encounter] = exchange.encounters
    assert (
        0.0 <= encounter.clearance <= gap(one, two) + 2e-7
    )  # which sees the arcs as chords of a millisecond
    assert encounter.clearance == exchange.clearance
    assert 2.0 < encounter.time < 5.0
    for report in exchange.robots:
        assert report.replay.solves
        assert report.certificate.is_clear
        assert report.certificate.robot == 0  # of the others
        assert report.certificate.clearance == pytest.approx(encounter.clearance, abs=1e-12)
    assert max(exchange.arrivals) <= 1.1 * max(each.replay.arrival_time for each in exchange.alone)


def test_the_same_seed_gives_the_same_plans(exchange):
    again = planned(EXCHANGE)
    for one, two in zip(exchange.robots, again.robots, strict=True):
        assert np.array_equal(one.controls, two.controls)
    assert exchange.encounters == again.encounters
    assert exchange.evaluations == again.evaluations


def test_who_is_clear_of_the_others_keeps_the_plan_made_alone():
    lanes = [robot([0.0, y, 0.0], [2.0, y, 0.0]) for y in (-0.4, 0.0, 0.4)]
    report = planned(lanes)
    for alone, together in zip(report.alone, report.robots, strict=True):
        assert np.array_equal(alone.controls, together.controls)
    assert len(report.encounters) == 3
    assert report.evaluations == sum(each.evaluations for each in report.alone)


def test_a_robot_that_has_arrived_stands_in_the_way():
    wall = robot([1.5, -0.4, np.pi / 2], [1.5, 0.0, np.pi / 2], bounds=[-0.5, 3.5, -0.6, 0.6])
    passing = robot([-0.4, 0.0, 0.0], [3.0, 0.0, 0.0], bounds=[-0.5, 3.5, -0.6, 0.6])
    report = planned([wall, passing])
    assert report.status == "planned"
    assert report.arrivals[0] < report.arrivals[1]
    assert report.encounters[0].time > report.arrivals[0]
    assert gap(*report.robots) >= report.clearance >= 0.0


def test_nobody_may_arrive_where_another_one_has_yet_to_pass():
    """The robot's own path is clear up to its arrival; the other one runs into it later."""
    late = Other([-3.0, 0.0, 0.0], [[0.5, 0.0]], [10.0], 0.15)
    scenario = Scenario([0.0, -1.0, np.pi / 2], [0.0, 0.0, np.pi / 2], others=(late,))
    controls = np.tile([0.5, 0.0], (40, 1))
    assert certify(scenario, controls, PERIOD, until=1.9).clearance <= -0.25
    assert replay(scenario, controls, PERIOD).clearance == pytest.approx(-0.25, abs=1e-9)
    soon = replace(scenario, others=(replace(late, durations=[3.0]),))
    assert certify(soon, controls, PERIOD, until=1.9).clearance > 0.3


def test_who_finds_no_way_goes_first(monkeypatch):
    tried = []

    def stuck(scenario, laws, **options):
        report = plan_scenario(scenario, laws, **options | {"previous": None})
        if not scenario.others:
            return report
        tried.append(float(scenario.start[0]))
        return replace(report, status="not_found", plan=None, replay=None)

    monkeypatch.setattr(fleet_search, "plan_scenario", stuck)
    report = planned(EXCHANGE, replace(QUICK, retries=5))
    assert report.status == "not_found"
    assert "in any order" in report.reason
    assert sorted(tried) == [0.0, 3.0]  # each was second once, and no order was tried twice


def test_a_robot_that_cannot_arrive_alone_is_named():
    shut = robot([0.0, 0.0, 0.0], [3.0, 0.0, 0.0], circles=[[3.0, 0.1, 0.0, 0.0, 0.2]])
    report = planned([EXCHANGE[1], shut])
    assert report.status == "unreachable"
    assert report.reason.startswith("robot 1, alone: ")
    assert report.robots == ()


@pytest.mark.parametrize(
    ("scenarios", "sentence"),
    [
        (EXCHANGE[:1], "at least two robots, got 1"),
        (
            (EXCHANGE[0], replace(EXCHANGE[1], start=[0.2, 0.0, 0.0])),
            "starts of robots 0 and 1 overlap by 0.1 m",
        ),
        (
            (EXCHANGE[0], replace(EXCHANGE[1], goal=[3.0, 0.1, 0.0])),
            "goals of robots 0 and 1 overlap by 0.2 m",
        ),
        ((EXCHANGE[0], replace(EXCHANGE[1], model="dynamic_unicycle")), "robot 1 is a dynamic_unicycle"),
        ((replace(EXCHANGE[0], footprint=[[0.1, 0.0, 0.2]]), EXCHANGE[1]), "robot 0 is not round"),
    ],
)
def test_what_is_no_fleet_is_refused(scenarios, sentence):
    with pytest.raises(ScenarioError, match=sentence):
        planned(scenarios)


def test_a_scenario_refuses_others_that_it_cannot_prove_to_be_clear_of():
    other = Other(np.zeros(3), np.empty((0, 2)), np.empty(0), 0.2)
    with pytest.raises(ScenarioError, match=r"start .* overlaps other robot 0 by 0.05 m"):
        Scenario([0.3, 0.0, 0.0], [3.0, 0.0, 0.0], others=(other,))
    with pytest.raises(ScenarioError, match="must be round"):
        Scenario([2.0, 0.0, 0.0], [3.0, 0.0, 0.0], others=(other,), model="dynamic_unicycle")


@pytest.mark.parametrize("change", [{"orders": 0}, {"retries": -1}, {"rounds": 0.5}, {"loss": "much"}])
def test_wrong_efforts_are_refused(change):
    with pytest.raises(ProblemError):
        FleetEffort(**change)


def test_every_pair_of_four_on_a_crossing_is_clear():
    ends = [(-1.5, 0.0, 0.0), (0.0, -1.5, np.pi / 2), (1.5, 0.0, np.pi), (0.0, 1.5, -np.pi / 2)]
    bounds = [-2.0, 2.0, -2.0, 2.0]
    four = [robot(list(end), [-end[0], -end[1], end[2]], bounds=bounds) for end in ends]
    report = planned(four)
    assert report.status == "planned"
    for encounter, (first, second) in zip(report.encounters, combinations(report.robots, 2), strict=True):
        assert 0.0 <= encounter.clearance <= gap(first, second) + 2e-7
