"""Plans for scenarios, judged by the replay that shares nothing with the planner."""

import json
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from applications.rosbot import planner
from applications.rosbot.bounds import lower_bound
from applications.rosbot.following import nearest_time
from applications.rosbot.guides import direct_guides, guides_along
from applications.rosbot.model import unicycle, wheel_coupled
from applications.rosbot.plan_file import plan_document, write_plan
from applications.rosbot.planner import Effort, plan_scenario
from applications.rosbot.polar_law import HOT, SATURATING, polar_law
from applications.rosbot.problems import PERIOD, problem_of
from applications.rosbot.replay import replay
from applications.rosbot.routes import routes
from applications.rosbot.scenario import Scenario
from applications.rosbot.seeds import along, nearby, repeated, schedules_along
from gpsynth.errors import ScenarioError
from gpsynth.evaluate import Evaluator
from gpsynth.planning import PlanSettings
from gpsynth.seeds import stream

QUICK = Effort(
    points=5,
    scouts=PlanSettings(particles=16, iterations=8, rounds=2),
    chasers=PlanSettings(particles=24, iterations=10, rounds=2),
    refiners=PlanSettings(particles=24, iterations=10, rounds=2),
    chased=2,
    refined=1,
)


def law():
    return polar_law(unicycle(), SATURATING)


def scene(**changes) -> Scenario:
    """A disc in the straight way to a goal 3 m ahead."""
    return Scenario(
        **{"start": [0.0, 0.0, 0.0], "goal": [3.0, 0.0, 0.0], "circles": [[1.5, 0.05, 0.0, 0.0, 0.3]]}
        | changes
    )


def hurried() -> Scenario:
    """The scene with less time than the control period lets a plan have, though the bound does not forbid it."""
    return scene(time_limit=lower_bound(scene()) + 0.01)


@pytest.fixture(name="report", scope="module")
def _report():
    return plan_scenario(scene(), [law()], seed=1, effort=QUICK)


def test_a_plan_is_confirmed_by_the_independent_replay(report):
    check = replay(scene(), report.plan.trajectory.u, PERIOD)
    assert report.status == "planned"
    assert check.solves
    assert check.arrival_time == report.replay.arrival_time
    assert check.clearance >= 0.003  # the margin is 4 mm, and a period moves the arcs by less than the rest
    assert 0.0 <= len(report.plan.trajectory.u) * PERIOD - check.arrival_time <= 2.0 * PERIOD


def test_a_plan_is_near_its_bound(report):
    assert 1.0 <= report.ratio < 1.1


def test_the_history_ends_at_the_plan(report):
    assert report.history[-1][1] == report.plan.arrival_time
    assert report.history[-1][0] <= report.evaluations
    seconds = [each[2] for each in report.history]
    assert 0.0 < seconds[0] <= seconds[-1] <= report.planning_time
    assert sorted(seconds) == seconds


def test_the_same_seed_gives_the_same_plan_for_any_number_of_threads(report):
    again = plan_scenario(scene(), [law()], seed=1, effort=QUICK, threads=2)
    assert np.array_equal(again.plan.trajectory.u, report.plan.trajectory.u)
    assert again.evaluations == report.evaluations


def test_a_plan_is_taken_up_on_the_way(report):
    driven = 6
    on_the_way = scene(start=report.plan.trajectory.x[driven])
    again = plan_scenario(on_the_way, [law()], seed=1, effort=QUICK, previous=report, elapsed=driven * PERIOD)
    assert again.replay.solves
    assert again.evaluations < report.evaluations / 3
    assert again.plan.arrival_time <= report.plan.arrival_time - driven * PERIOD + 1e-9


@pytest.mark.parametrize("share", [0.3, 1.0])
def test_the_time_of_a_robot_beside_its_plan_is_that_of_the_nearest_pose(report, share):
    t, x = report.plan.trajectory.t, report.plan.trajectory.x
    here = x[20] + share * (x[21] - x[20])
    aside = here + np.array([-0.01 * np.sin(here[2]), 0.01 * np.cos(here[2]), 2.0 * np.pi])
    assert nearest_time(report.plan.trajectory, aside, t[24]) == pytest.approx(
        t[20] + share * PERIOD, abs=2e-3
    )
    assert nearest_time(report.plan.trajectory, x[0], 100.0) == 100.0  # nothing is near that time


def test_what_shuts_the_way_of_a_previous_plan_is_driven_around(report):
    wall = [[1.5, y, 0.0, 0.0, 0.3] for y in np.arange(-0.4, 3.0, 0.5)]
    wall += [[1.5, y, 0.0, 0.0, 0.3] for y in np.arange(-3.0, -1.2, 0.5)]
    blocked = scene(start=report.plan.trajectory.x[6], circles=wall)
    assert not replay(blocked, report.plan.trajectory.u[6:], PERIOD).solves
    again = plan_scenario(blocked, [law()], effort=QUICK, previous=report, elapsed=6 * PERIOD)
    assert again.replay.solves


def test_every_report_on_the_way_is_replayed_and_no_worse_than_the_one_before():
    seen = []
    last = plan_scenario(scene(), [law()], seed=1, effort=QUICK, callback=seen.append)
    found = [each for each in seen if each.status == "planned"]
    assert len(found) > 3
    assert all(replay(scene(), each.plan.trajectory.u, PERIOD).solves for each in found)
    times = [each.plan.arrival_time for each in found]
    assert times == sorted(times, reverse=True)
    assert last.plan.arrival_time == times[-1]
    assert last.ended == "complete"


def test_the_callback_ends_the_search_with_the_plan_it_was_shown(report):
    first = plan_scenario(
        scene(), [law()], seed=1, effort=QUICK, callback=lambda each: each.status == "planned"
    )
    assert (first.status, first.ended) == ("planned", "callback")
    assert first.replay.solves
    assert first.evaluations < report.evaluations / 3


def test_a_number_of_rollouts_or_a_deadline_ends_the_search(report):
    few = plan_scenario(scene(), [law()], seed=1, effort=replace(QUICK, rollouts=300))
    assert (few.status, few.ended) == ("planned", "rollouts")
    assert 300 <= few.evaluations < report.evaluations
    now = plan_scenario(scene(), [law()], seed=1, effort=replace(QUICK, deadline=1e-9))
    assert now.ended == "deadline"
    assert now.evaluations < 300


def test_a_deadline_breaks_a_round_off(monkeypatch, report):
    """By a clock that rollouts alone move on, 1 ms each: a generation of scouts takes 0.2 s, a slice 0.128 s."""
    now, roll = [0.0], Evaluator.of_schedules

    def timed(evaluator, law, points, *rest, **options):
        now[0] += 1e-3 * len(points)
        return roll(evaluator, law, points, *rest, **options)

    monkeypatch.setattr(Evaluator, "of_schedules", timed)
    monkeypatch.setattr(planner, "time", SimpleNamespace(perf_counter=lambda: now[0]))
    for deadline in np.arange(1.3, 3.5, 0.3):
        ended = plan_scenario(scene(), [law()], seed=1, effort=replace(QUICK, deadline=deadline))
        assert (ended.status, ended.ended) == ("planned", "deadline")
        assert ended.replay.solves
        assert abs(ended.planning_time - deadline) <= 0.14  # a slice, and a rollout of what is best
        assert ended.evaluations <= 1e3 * ended.planning_time
    late = plan_scenario(scene(), [law()], seed=1, effort=replace(QUICK, deadline=1e6))
    assert np.array_equal(late.plan.schedule.points, report.plan.schedule.points)


@pytest.mark.parametrize("wrong", [{"deadline": np.nan}, {"deadline": 0.0}, {"rollouts": -1}])
def test_an_effort_allows_something(wrong):
    with pytest.raises(ScenarioError, match="expected more than 0"):
        Effort(**wrong)


def test_an_interrupted_search_gives_the_best_plan_so_far():
    def interrupt(report):
        if report.status == wanted:
            raise KeyboardInterrupt

    wanted = "planned"
    stopped = plan_scenario(scene(), [law()], seed=1, effort=QUICK, callback=interrupt)
    assert (stopped.status, stopped.ended) == ("planned", "interrupted")
    assert stopped.replay.solves
    wanted = "not_found"
    with pytest.raises(KeyboardInterrupt):
        plan_scenario(hurried(), [law()], effort=QUICK, callback=interrupt)


def test_without_a_plan_the_reason_says_what_has_ended_the_search():
    for ended, words, options in (
        ("complete", "rollouts; ", {"effort": replace(QUICK, attempts=1)}),
        ("rollouts", "rollouts, all that were allowed; ", {"effort": replace(QUICK, rollouts=100)}),
        ("deadline", "rollouts, when the deadline came; ", {"effort": replace(QUICK, deadline=1e-9)}),
        (
            "callback",
            "rollouts, when the search was ended; ",
            {"effort": QUICK, "callback": lambda report: True},
        ),
    ):
        report = plan_scenario(hurried(), [law()], **options)
        assert (report.status, report.ended) == ("not_found", ended)
        assert f"no collision-free plan within {hurried().time_limit:g} s was found in" in report.reason
        assert f"{report.evaluations} {words}the goal may still be reachable" in report.reason


def test_public_scenarios_are_solved_or_unreachable(public):
    report = plan_scenario(public, [law()], seed=0, effort=QUICK)
    assert report.status == ("planned" if public.expect_feasible else "unreachable")
    if report.replay is not None:
        assert report.replay.solves
        _proves(report)
    else:
        assert report.certificate is None
        assert "shut the goal off" in report.reason


def _proves(report):
    """The certificate clears the plan, and is within what the replay's samples may miss."""
    proof, seen = report.certificate, report.replay.clearance
    assert proof.is_clear
    assert proof.clearance <= seen
    assert seen == np.inf or seen - proof.clearance <= 2.5e-4  # half of 1 ms at 0.5 m/s
    assert plan_document(report)["certificate"]["room"] == proof.room


@pytest.mark.parametrize("direction", [1.0, -1.0])
@pytest.mark.parametrize("speed_limits", [(-0.1, 0.5), (0.0, 0.5), (-0.5, 0.2)])
def test_unequal_limits_are_kept(speed_limits, direction):
    scenario = scene(goal=[3.0 * direction, 1.0, 0.5], speed_limits=speed_limits, turn_limits=(-1.0, 0.8))
    report = plan_scenario(scenario, [law()], seed=0, effort=QUICK)
    assert report.replay.solves
    v, omega = report.plan.trajectory.u.T
    assert speed_limits[0] <= v.min() <= v.max() <= speed_limits[1]
    assert -1.0 <= omega.min() <= omega.max() <= 0.8


def test_a_moving_obstacle_is_met_where_it_then_is():
    crossing = scene(circles=[[1.5, -1.5, 0.0, 0.5, 0.3]])  # in the way when the robot would be there
    report = plan_scenario(crossing, [law()], seed=0, effort=QUICK)
    assert report.replay.solves
    assert report.replay.clearance < 1.0


def test_an_unreachable_goal_is_told_from_one_that_was_not_found():
    ring = [[3.0 + 0.6 * np.cos(a), 0.6 * np.sin(a), 0.0, 0.0, 0.2] for a in np.linspace(0.0, 6.2, 12)]
    unreachable = plan_scenario(scene(circles=ring), [law()], effort=QUICK)
    too_late = plan_scenario(scene(time_limit=3.0), [law()], effort=QUICK)
    not_found = plan_scenario(hurried(), [law()], effort=replace(QUICK, attempts=1))
    assert (unreachable.status, unreachable.evaluations) == ("unreachable", 0)
    assert (too_late.status, too_late.evaluations) == ("unreachable", 0)
    assert "too late: no plan arrives before 5.9 s, and the time limit is 3 s" in too_late.reason
    assert (not_found.status, not_found.evaluations > 0) == ("not_found", True)


def test_a_start_at_the_goal_has_arrived():
    for goal in ([0.0, 0.0, 0.0], [0.04, -0.02, 0.09]):
        report = plan_scenario(scene(goal=goal), [law()], effort=QUICK)
        document = plan_document(report)
        assert (report.status, report.evaluations, report.lower_bound, report.ratio) == (
            "planned",
            0,
            0.0,
            1.0,
        )
        assert (document["arrival_time"], document["controls"]) == (0.0, [])
        assert document["trajectory"] == [[0.0, 0.0, 0.0, 0.0]]
        assert document["schedule"] == {"points": [], "dwell": []}
        assert document["clearance"] == pytest.approx(np.hypot(1.5, 0.05) - 0.45)


def test_nothing_that_the_replay_rejects_is_called_planned(monkeypatch):
    monkeypatch.setattr(planner, "replay", lambda *given: replace(replay(*given), in_bounds=False))
    rejected = plan_scenario(scene(), [law()], seed=1, effort=replace(QUICK, attempts=1))
    assert rejected.status == "not_found"
    assert rejected.evaluations > 0
    assert (rejected.plan, rejected.replay, plan_document(rejected)["controls"]) == (None, None, [])


def test_the_ratio_shows_when_a_bound_is_beaten(report, monkeypatch):
    monkeypatch.setattr(planner, "lower_bound", lambda scenario: 2.0 * report.replay.arrival_time)
    assert replace(report).ratio == 0.5


def test_the_better_of_two_laws_is_taken():
    laws = [law(), polar_law(unicycle(), HOT)]
    both = plan_scenario(scene(), laws, seed=1, effort=QUICK)
    assert both.law.program in {each.program for each in laws}
    assert both.replay.solves


def test_a_law_must_steer_the_robot():
    with pytest.raises(ScenarioError, match="the law steers u1, u2; a scenario needs v, omega"):
        plan_scenario(scene(), [polar_law(wheel_coupled())], effort=QUICK)
    with pytest.raises(ScenarioError, match="a plan needs at least one law"):
        plan_scenario(scene(), [], effort=QUICK)


def test_the_goal_is_aimed_at_a_little_within_its_tolerance():
    problem = problem_of(scene(), law())
    edge = np.array([[3.0 - 0.0495, 0.0, 0.0, *scene().goal], [3.0 - 0.0485, 0.0, 0.0, *scene().goal]])
    assert np.array_equal(problem.reached(edge)[:, 0] <= 0.0, [False, True])


def test_a_plan_file_holds_what_a_replay_needs(report, tmp_path):
    write_plan(report, tmp_path / "plan.json")
    document = json.loads((tmp_path / "plan.json").read_text())
    check = replay(scene(), np.array(document["controls"]), document["control_period"])
    assert document["status"] == "planned"
    assert check.arrival_time == document["arrival_time"] == document["trajectory"][-1][0]
    assert check.clearance == document["clearance"]
    assert document["trajectory"][0] == [0.0, 0.0, 0.0, 0.0]
    assert len(document["trajectory"]) in (len(document["controls"]), len(document["controls"]) + 1)
    assert np.shape(document["schedule"]["points"]) == (len(document["schedule"]["dwell"]), 3)


def test_a_plan_file_without_a_plan_gives_the_reason():
    unreachable = plan_scenario(scene(circles=[[3.0, 0.0, 0.0, 0.0, 0.3]]), [law()], effort=QUICK)
    document = plan_document(unreachable)
    assert document["status"] == "unreachable"
    assert "the goal is in collision" in document["reason"]
    assert (document["arrival_time"], document["controls"], document["schedule"]) == (None, [], None)


def test_guides_lead_from_start_to_goal_and_bring_cusps():
    trap = scene(circles=[[0.8, y, 0.0, 0.0, 0.2] for y in (-0.6, -0.3, 0.0, 0.3, 0.6)])
    guides = guides_along(trap, routes(trap))[0] + direct_guides(trap)
    for guide in guides:
        assert np.allclose(guide.poses[[0, -1], :2], [[0.0, 0.0], [3.0, 0.0]], atol=1e-6)
    assert any(len(guide.cusps) for guide in guides)
    assert guides[0].duration >= 2.9 / 0.5


def test_guides_do_not_drive_where_the_limits_forbid():
    forwards = scene(speed_limits=(0.0, 0.5))
    assert all(np.all(guide.senses > 0.0) for guide in guides_along(forwards, routes(forwards))[0])


def test_a_schedule_along_a_guide_takes_its_time_and_points_at_its_cusps():
    parking = scene(goal=[0.0, 1.0, 0.0], circles=np.zeros((0, 5)))
    guide = direct_guides(parking)[0]
    schedule = along(guide, 6)
    assert set(np.round(guide.cusps, 9)) <= set(np.round(np.cumsum(schedule.dwell), 9))
    assert 0.6 * guide.duration < schedule.dwell.sum() < guide.duration


def test_a_schedule_through_the_goal_ends_beyond_where_its_guide_arrives():
    guide = direct_guides(scene(circles=np.zeros((0, 5))))[0]
    to, through = along(guide, 5), along(guide, 5, through=True)
    assert guide.arrival == pytest.approx(2.95 / 0.5)
    assert to.dwell.sum() < guide.arrival < through.dwell.sum()
    assert to.points[-1, 0] < 3.0 < through.points[-1, 0]


def test_cusps_that_are_near_each_other_have_a_point_each():
    short = scene(goal=[0.0, 0.1, 0.0], circles=np.zeros((0, 5)))
    guide = next(each for each in direct_guides(short) if len(each.cusps) > 1)
    assert set(np.round(guide.cusps, 9)) <= set(np.round(np.cumsum(along(guide, 3).dwell), 9))


TOUCHED = [-0.4, -0.1, 0.0, 0.0, np.hypot(0.4, 0.1) - 0.15]  # leaves the robot at the origin no room at all
WEDGING = [[-0.02, 0.551, 0.0, 0.0, 0.4], [0.1, -0.545, 0.0, 0.0, 0.4], [0.7, 0.0, 0.0, 0.0, 0.2]]


@pytest.mark.parametrize(
    "changes",
    [
        {"circles": [TOUCHED, [1.5, 0.05, 0.0, 0.0, 0.3]]},
        {"bounds": [0.0, 4.0, -2.0, 2.0]},
        {"start": [0.0, 0.0, -1.2], "goal": [2.5, -0.8, 2.8], "circles": WEDGING},
    ],
    ids=["circle", "bound", "wedged"],
)
def test_a_robot_with_hardly_any_room_finds_its_way(changes):
    """Touched from behind, at the edge, between circles on three sides."""
    cramped = scene(**changes)
    report = plan_scenario(cramped, [law()], seed=1, effort=QUICK)
    assert report.status == "planned"
    assert replay(cramped, report.controls, PERIOD).solves
    assert report.replay.arrival_time < 25.0


def test_schedules_repeat_the_guides_with_noise():
    guides = direct_guides(scene())[:2]
    schedules = repeated(schedules_along(guides, 4), 5, stream(1))
    assert len(schedules) == 5
    assert np.array_equal(schedules[1].points, along(guides[1], 4).points)
    assert not np.array_equal(schedules[2].points, schedules[0].points)
    assert np.array_equal(nearby(schedules[0], 3, 0.1, stream(2))[0].points, schedules[0].points)


@pytest.mark.parametrize("name", ["deadline", "rollouts"])
def test_an_effort_is_bounded_by_numbers(name):
    with pytest.raises(ScenarioError, match=f"{name} of an effort is nan; expected"):
        Effort(**{name: np.nan})
