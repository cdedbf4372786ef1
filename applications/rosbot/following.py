"""Replanning on the way: what is left of the previous plan is where the next search begins."""

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

from applications.rosbot.seeds import nearby
from applications.rosbot.swarms import Found
from applications.rosbot.vehicles import pose_plans
from gpsynth.arrays import Floats
from gpsynth.law import Law
from gpsynth.planning import Plan, PlanSettings
from gpsynth.problem import Problem
from gpsynth.schedule import Schedule, Schedules
from gpsynth.seeds import stream
from gpsynth.simulation import Trajectory

FOLLOW = 4  # stage of the random streams
BEYOND = 1.0  # m, how far from the schedule equilibrium points may lie
ASTRAY = 0.5  # s, that a robot may be behind its plan or ahead of it
HEADING = 0.3  # m/rad: what a heading error counts for beside one of position
NEARNESS = 0.3  # noise of the first schedules, as a share of that along guides


def follow(
    problem: Problem,
    law: Law,
    previous: Plan,
    elapsed: float,
    settings: PlanSettings,
    seed: int,
    *,
    stop: Callable[[], bool] | None = None,
) -> Iterator[Found]:
    """The best schedule near what is left of a plan (with points) that has been driven for `elapsed` seconds.

    The problem is the one that is left: it starts where the robot now is, among obstacles where they now are. A robot
    that is behind its plan, or ahead of it, goes on from where it should have been then. Once `stop` says so, what has
    been found so far is it.
    """
    count = len(previous.schedule.dwell)
    order = np.argsort(previous.particles.costs, kind="stable")[: settings.particles // 4]
    known = [previous.schedule, *(previous.particles.schedules[int(number)] for number in order)]
    there = nearest_time(previous.trajectory, problem.starts[0], elapsed)
    left = [each.after(there).split(count) for each in known]
    left.append(previous.schedule.after(elapsed).split(count))
    others = nearby(left[0], settings.particles, NEARNESS, stream(seed, FOLLOW, 0))
    initial = Schedules.joined([Schedules.of(left), others.take(np.arange(len(left), settings.particles))])
    remaining = max(previous.arrival_time - there, problem.period)
    *_, plan = pose_plans(
        problem,
        law,
        replace(settings, points=count),
        seed=seed,
        initial=initial,
        region=_region(problem, left[0]),
        budget=min(remaining, problem.horizon),
        path=(FOLLOW, 1),
        stop=stop,
    )
    yield Found(plan, law, plan.evaluations)


def nearest_time(trajectory: Trajectory, pose: Floats, expected: float) -> float:
    """When (s) a trajectory comes nearest to a pose (3,), within ASTRAY of the expected time."""
    near = np.flatnonzero(np.abs(trajectory.t - expected) <= ASTRAY)
    if len(near) < 2:
        return expected
    times, poses = trajectory.t[near], trajectory.x[near] - pose
    poses[:, 2] = HEADING * (np.remainder(poses[:, 2] + np.pi, 2.0 * np.pi) - np.pi)
    steps = np.diff(poses, axis=0)
    square = np.sum(steps * steps, axis=1)
    share = np.clip(-np.sum(poses[:-1] * steps, axis=1) / np.where(square > 0.0, square, 1.0), 0.0, 1.0)
    gaps = np.linalg.norm(poses[:-1] + share[:, None] * steps, axis=1)
    best = int(np.argmin(gaps))
    return float(times[best] + share[best] * (times[best + 1] - times[best]))


def _region(problem: Problem, schedule: Schedule) -> tuple[Floats, Floats]:
    """Bounds (3,) of the equilibrium points: all that the plan leads to and some more, and two turns."""
    places = np.vstack([problem.starts[:, :2], problem.goal[:2], schedule.points[:, :2]])
    turns = 2.0 * np.pi
    return np.append(places.min(axis=0) - BEYOND, -turns), np.append(places.max(axis=0) + BEYOND, turns)
