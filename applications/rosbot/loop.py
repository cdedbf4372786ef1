"""The receding-horizon loop at 10 Hz: sense, plan on from where the robot will be, and drive on meanwhile.

A course that is planned in one cycle takes effect in the next. The law is the same at all times; what a new course
changes are the equilibrium points.
"""

import time
from dataclasses import dataclass, replace

import numpy as np

from applications.rosbot.courses import Course, standing
from applications.rosbot.lags import nominal_path
from applications.rosbot.problems import PERIOD
from applications.rosbot.reachability import reachability
from applications.rosbot.replanning import Replanning, replan
from applications.rosbot.replay import Replay, drive, replay, within
from applications.rosbot.scenario import Scenario
from applications.rosbot.sensing import Sensor, scene_ahead
from applications.rosbot.simulated_robot import Flaws, SimulatedRobot
from applications.rosbot.vehicles import law_for, plant_of
from applications.rosbot.wayfinder import wayfinder
from gpsynth.arrays import Floats
from gpsynth.checks import check_kind
from gpsynth.errors import ScenarioError
from gpsynth.law import Law
from gpsynth.schedule import Schedule
from gpsynth.seeds import stream

TICKS = 2  # control periods in a cycle
CYCLE = TICKS * PERIOD  # s
ROBOT, SEARCH = range(2)  # random streams


@dataclass(frozen=True, eq=False)
class Drive:
    """A run from the start to the goal, or to the time limit; none where what rests leaves no way to the goal."""

    applied: Floats  # (n, 2) speeds of the robot, or what they lag behind (m/s, rad/s), a row a period
    replay: Replay  # of these speeds
    cycles: Floats  # (c,) s of processor time that planning took
    courses: tuple[Course, ...]  # that were followed, one a cycle
    unreachable: str = ""  # why the goal is proved to be so

    @property
    def arrives(self) -> bool:
        """Whether the goal is reached in time."""
        return self.replay.in_time

    @property
    def is_safe(self) -> bool:
        """Whether nothing is hit on the way, and the bounds are kept."""
        return self.replay.clearance >= 0.0 and self.replay.in_bounds


@dataclass(frozen=True, eq=False)
class _Moment:
    """What is so at the beginning of a cycle; states are x, y, theta, and v and omega if these lag behind commands."""

    state: Floats  # (5,) of the robot
    estimate: Floats  # (5,) what it takes for its state
    course: Course
    age: float  # s since the course began
    arrived: bool = False


def drive_scenario(
    scenario: Scenario,
    law: Law,
    *,
    schedule: Schedule | None = None,
    flaws: Flaws = Flaws(),
    sensor: Sensor = Sensor(),
    settings: Replanning | None = Replanning(),
    seed: int = 0,
) -> Drive:
    """Drive a simulated robot to the goal and plan on in every cycle; the same seed gives the same run.

    The first course is the schedule, or to stand still; without `settings` nothing is planned and it is followed to
    its end. If what rests leaves no way to the goal, nothing is driven. Raises ScenarioError as `check_drivable`, and
    if an argument is of a wrong kind.
    """
    for name, value, kind in (
        ("scenario", scenario, Scenario),
        ("law", law, Law),
        ("flaws", flaws, Flaws),
        ("sensor", sensor, Sensor),
    ):
        check_kind(name, value, kind, error=ScenarioError)
    check_kind("schedule", schedule, Schedule, error=ScenarioError, optional=True)
    check_kind("settings", settings, Replanning, error=ScenarioError, optional=True)
    check_drivable(scenario, sensor)
    verdict = reachability(scenario)
    if verdict.status == "unreachable" and settings is not None:
        nothing = np.empty((0, 2))
        return Drive(nothing, replay(scenario, nothing, PERIOD), np.empty(0), (), verdict.reason)
    law = law.with_limits(*zip(scenario.speed_limits, scenario.turn_limits, strict=True))
    planning = law_for(law, plant_of(scenario))
    robot = SimulatedRobot.drawn(flaws, stream(seed, ROBOT))
    first = Course.of(schedule or standing(scenario.start), scenario.goal, settings.points if settings else 1)
    finder = wayfinder(scenario, (settings.margin, settings.least, 0.0)) if settings else None
    state = np.append(scenario.start, scenario.speeds)
    now = _Moment(state, state, first, 0.0)
    applied, cycles, courses = list[Floats](), list[float](), list[Course]()
    while len(courses) * CYCLE < scenario.time_limit and not now.arrived:
        course, age = now.course, now.age + CYCLE
        courses.append(course)
        if settings is not None:
            began = time.process_time()
            seen = sensor.seen(scenario, now.estimate[:2], len(cycles) * CYCLE)
            scene = scene_ahead(scenario, seen, _ahead(scenario, law, now), CYCLE)
            scene, part = finder.look(scene) if finder else (scene, None)
            path = (SEARCH, len(cycles))
            course = replan(scene, planning, course, age, settings, part=part, seed=seed, path=path)
            age = 0.0
            cycles.append(time.process_time() - began)
        now, speeds = _driven(scenario, law, robot, now)
        now = replace(now, course=course, age=age)
        applied.append(speeds)
    controls = np.concatenate(applied)
    return Drive(controls, replay(scenario, controls, PERIOD), np.array(cycles), tuple(courses))


def check_drivable(scenario: Scenario, sensor: Sensor) -> None:
    """Raise ScenarioError if more circles move than the sensor can tell apart, or the robot is a car."""
    sensor.check(scenario)
    if scenario.model == "car":
        raise ScenarioError("the robot is a car; the loop drives unicycles, with lags or without")


def _driven(scenario: Scenario, law: Law, robot: SimulatedRobot, now: _Moment) -> tuple[_Moment, Floats]:
    """A cycle along the course, and the speeds (TICKS, 2) of the robot in it."""
    state, estimate, arrived, applied = now.state, now.estimate, False, []
    for tick in range(TICKS):
        control = law(estimate[:3], now.course.target(now.age + tick * PERIOD))
        speeds = robot.applied(control)
        poses, state = _moved(scenario, state, speeds)
        arrived = arrived or bool(np.any(within(scenario, poses)))
        _, predicted = _moved(scenario, estimate, control)
        estimate = np.append(robot.located(predicted[:3], state[:3]), predicted[3:])
        applied.append(speeds)
    return replace(now, state=state, estimate=estimate, arrived=arrived), np.array(applied)


def _ahead(scenario: Scenario, law: Law, now: _Moment) -> Floats:
    """The state (5,) of a robot without flaws after a cycle."""
    estimate = now.estimate
    for tick in range(TICKS):
        control = law(estimate[:3], now.course.target(now.age + tick * PERIOD))
        _, estimate = _moved(scenario, estimate, control)
    return estimate


def _moved(scenario: Scenario, state: Floats, speeds: Floats) -> tuple[Floats, Floats]:
    """The poses (N, 3) during one period, and the state (5,) after it."""
    given, duration = speeds[np.newaxis], np.array([PERIOD])
    if scenario.model == "dynamic_unicycle":
        path = nominal_path(state[:3], given, duration, (state[3], state[4]))
        return path.poses, np.array([*path.poses[-1], path.v[-1], path.omega[-1]])
    poses = drive(state[:3], given, duration)[:, 1:]
    return poses, np.append(poses[-1], [0.0, 0.0])
