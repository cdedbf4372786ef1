"""The loop: judged by the replay of the speeds that the simulated robot really had."""

import numpy as np
import pytest

from applications.rosbot.crossings import crossing
from applications.rosbot.loop import CYCLE, drive_scenario
from applications.rosbot.model import unicycle
from applications.rosbot.polar_law import polar_law
from applications.rosbot.problems import PERIOD, problem_of
from applications.rosbot.replanning import Replanning
from applications.rosbot.replay import replay
from applications.rosbot.room import Room
from applications.rosbot.scenario import Scenario
from applications.rosbot.sensing import Sensor
from applications.rosbot.simulated_robot import UNCERTAIN
from applications.rosbot.stabilizer import default_law
from gpsynth.errors import ScenarioError
from gpsynth.schedule import Schedule
from gpsynth.simulation import simulate

LAW = default_law()


def scene(**changes):
    """A disc in the straight way to a goal 3 m ahead."""
    return Scenario(
        **{"start": [0.0, 0.0, 0.0], "goal": [3.0, 0.0, 0.0], "circles": [[1.5, 0.05, 0.0, 0.0, 0.3]]}
        | changes
    )


@pytest.fixture(name="run", scope="module")
def _run():
    return drive_scenario(crossing(5), LAW, seed=3)


def test_a_crossing_is_driven_without_a_collision(run):
    check = replay(crossing(5), run.applied, PERIOD)
    assert (run.arrives, run.is_safe) == (True, True)
    assert check.clearance == run.replay.clearance >= 0.0
    assert check.arrival_time == run.replay.arrival_time < 25.0
    assert len(run.courses) == len(run.cycles) == len(run.applied) // 2


def test_the_same_crossing_is_a_collision_for_who_goes_straight_to_the_goal():
    straight = Schedule([crossing(5).goal], [0.0])
    assert not drive_scenario(crossing(5), LAW, schedule=straight, settings=None).is_safe


def test_the_same_seed_gives_the_same_run():
    first, again, other = (
        drive_scenario(scene(time_limit=2.0), LAW, flaws=UNCERTAIN, seed=seed) for seed in (1, 1, 2)
    )
    assert np.array_equal(first.applied, again.applied)
    assert not np.array_equal(first.applied, other.applied)


def test_the_plan_of_one_cycle_takes_effect_in_the_next(run):
    assert np.all(run.courses[0].schedule.points == crossing(5).start)
    assert np.array_equal(run.applied[:2], np.zeros((2, 2)))
    assert np.any(run.applied[2:4])


def test_a_mover_that_comes_at_the_robot_is_evaded():
    coming = scene(goal=[0.0, 1.5, 0.0], circles=[[-2.5, 0.0, 0.4, 0.0, 0.3]], time_limit=20.0)
    stays = drive_scenario(coming, LAW, schedule=Schedule([[0.0, 0.0, 0.0]], [20.0]), settings=None)
    evades = drive_scenario(coming, LAW)
    assert stays.replay.clearance < 0.0
    assert (evades.arrives, evades.is_safe) == (True, True)


def test_an_occupied_goal_is_waited_for():
    parked = scene(
        circles=[[3.6, 0.0, -0.05, 0.0, 0.3]], time_limit=60.0
    )  # over the goal from 3 s to 21 s on
    run = drive_scenario(parked, LAW)
    assert (run.arrives, run.is_safe) == (True, True)


def test_a_robot_with_flaws_keeps_clear_of_a_wall_with_a_gap():
    walls = [[1.5, y, 0.0, 0.0, 0.3] for y in (-1.1, -0.55, 0.55, 1.1)]
    gap = scene(circles=walls, bounds=[-1.0, 4.0, -1.0, 1.0])
    runs = [drive_scenario(gap, LAW, flaws=UNCERTAIN, seed=seed) for seed in range(2)]
    assert all(run.arrives and run.is_safe for run in runs)


def test_a_schedule_is_followed_as_the_planner_predicts():
    schedule = Schedule([[1.0, 0.6, 0.5], [2.0, 0.7, -0.3]], [1.3, 2.2])
    expected = simulate(problem_of(scene(circles=[]), LAW), LAW, schedule=schedule)
    run = drive_scenario(scene(circles=[]), LAW, schedule=schedule, settings=None)
    count = min(len(run.applied), len(expected.u))
    assert abs(len(run.applied) - len(expected.u)) <= 2
    assert np.allclose(run.applied[:count], expected.u[:count], atol=1e-6)  # RK4 against Simpson


def test_limits_of_the_scenario_hold():
    slow = scene(speed_limits=(-0.1, 0.3), turn_limits=(-0.8, 0.6))
    speeds = drive_scenario(slow, polar_law(unicycle())).applied
    assert np.all((speeds >= [-0.1, -0.8]) & (speeds <= [0.3, 0.6]))


def test_a_robot_with_lags_plans_on_from_the_speeds_it_has():
    """Were it to plan from rest, all courses would promise to be late by what it takes to come to full speed."""
    lags = scene(model="dynamic_unicycle", goal=[5.0, 0.5, 0.0])
    run = drive_scenario(lags, LAW)
    assert (run.arrives, run.is_safe) == (True, True)
    promised = [number * CYCLE + course.arrival_time for number, course in enumerate(run.courses)]
    assert promised[len(promised) // 2] == pytest.approx(run.replay.arrival_time, abs=0.1)


def test_a_goal_that_is_shut_off_by_what_rests_is_not_set_off_for():
    walls = Room(segments=np.array([[1.5, -9.0, 1.5, 9.0]]))
    shut = scene(room=walls, circles=[[0.0, 1.0, 0.1, 0.0, 0.2]], bounds=[-1.0, 4.0, -2.0, 2.0])
    run = drive_scenario(shut, LAW)
    assert "no route leads through the room" in run.unreachable
    assert (len(run.applied), run.courses, run.arrives) == (0, (), False)
    assert drive_scenario(shut, LAW, schedule=Schedule([shut.goal], [1.0]), settings=None).unreachable == ""


def test_a_far_goal_in_a_room_is_driven_to_along_the_way_there():
    """Around a wall, with a mover on the way; the courses lead to places before the goal until it is near."""
    walls = Room(segments=np.array([[0.0, -4.0, 0.0, 4.2]]))
    hall = {"bounds": [-4.0, 4.0, -4.0, 6.0], "room": walls, "circles": [[-2.5, 3.0, 0.2, 0.0, 0.25]]}
    run = drive_scenario(scene(start=[-1.0, 0.0, 1.5], goal=[1.0, 0.0, -1.5], **hall), LAW)
    assert (run.arrives, run.is_safe) == (True, True)
    assert run.replay.arrival_time < 25.0  # the taut string takes 17.4 s, and the mover is on it for some
    goals = np.array([course.goal for course in run.courses[1:]])
    assert np.array_equal(goals[-1], [1.0, 0.0, -1.5])
    assert goals[0, 1] > 1.5 > goals[20, 1] > 0.0


def test_a_late_robot_is_told():
    run = drive_scenario(scene(time_limit=1.0), LAW)
    assert (run.arrives, run.is_safe) == (False, True)
    assert len(run.applied) * PERIOD == pytest.approx(1.0)
    assert pytest.approx(0.1) == CYCLE


def test_mistakes_are_told():
    with pytest.raises(ScenarioError, match="10 circles move; the sensor can tell 3 apart"):
        drive_scenario(crossing(0), LAW, sensor=Sensor(most=3))
    with pytest.raises(ScenarioError, match="the robot is a car"):
        drive_scenario(scene(model="car", turning_radius=0.5), LAW)
    with pytest.raises(ScenarioError, match="begins at the speeds"):
        scene(speeds=(0.1, 0.0))
    with pytest.raises(ScenarioError, match="expected 0 <= least <= margin"):
        Replanning(margin=0.01)
    with pytest.raises(ScenarioError, match=r"the margin is -0\.1 m"):
        Replanning.keeping(-0.1)
