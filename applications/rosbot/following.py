"""Replanning on the way: what is left of the previous plan is where the next search begins."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from applications.rosbot.seeds import nearby
from applications.rosbot.swarms import Found
from gpsynth.arrays import Floats
from gpsynth.law import Law
from gpsynth.planning import Plan, PlanSettings, plans
from gpsynth.problem import Problem
from gpsynth.schedule import Schedule, Schedules
from gpsynth.seeds import stream

FOLLOW = 4  # stage of the random streams
BEYOND = 1.0  # m, how far from the schedule equilibrium points may lie
NEARNESS = 0.3  # noise of the first schedules, as a share of that along guides


def follow(
    problem: Problem, law: Law, previous: Plan, elapsed: float, settings: PlanSettings, seed: int
) -> Iterator[Found]:
    """The best schedule near what is left of a plan (with points) that has been driven for `elapsed` seconds.

    The problem is the one that is left: it starts where the robot now is, among obstacles where they now are.
    """
    count = len(previous.schedule.dwell)
    order = np.argsort(previous.particles.costs, kind="stable")[: settings.particles // 4]
    known = [previous.schedule, *(previous.particles.schedules[int(number)] for number in order)]
    left = [each.after(elapsed).split(count) for each in known]
    others = nearby(left[0], settings.particles, NEARNESS, stream(seed, FOLLOW, 0))
    initial = Schedules.joined([Schedules.of(left), others.take(np.arange(len(left), settings.particles))])
    remaining = max(previous.arrival_time - elapsed, problem.period)
    for plan in plans(
        problem,
        law,
        replace(settings, points=count),
        seed=seed,
        initial=initial,
        region=_region(problem, left[0]),
        budget=min(remaining, problem.horizon),
        path=(FOLLOW, 1),
    ):
        yield Found(plan, law, plan.evaluations)


def _region(problem: Problem, schedule: Schedule) -> tuple[Floats, Floats]:
    """Bounds (3,) of the equilibrium points: all that the plan leads to and some more, and two turns."""
    places = np.vstack([problem.starts, problem.goal, schedule.points])[:, :2]
    turns = 2.0 * np.pi
    return np.append(places.min(axis=0) - BEYOND, -turns), np.append(places.max(axis=0) + BEYOND, turns)
