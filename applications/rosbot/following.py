"""Replanning on the way: what is left of the previous plan is where the next search begins."""

from dataclasses import replace

import numpy as np

from applications.rosbot.seeds import nearby
from gpsynth.arrays import Floats
from gpsynth.law import Law
from gpsynth.planning import Plan, PlanSettings, plan
from gpsynth.problem import Problem
from gpsynth.schedule import Schedule
from gpsynth.seeds import stream

FOLLOW = 4  # stage of the random streams
BEYOND = 1.0  # m, how far from the schedule equilibrium points may lie
NEARNESS = 0.3  # noise of the first schedules, as a share of that along guides


def follow(
    problem: Problem, law: Law, previous: Plan, elapsed: float, settings: PlanSettings, seed: int
) -> Plan:
    """The best schedule near what is left of a plan (with points) that has been driven for `elapsed` seconds.

    The problem is the one that is left: it starts where the robot now is, among obstacles where they now are.
    """
    count = len(previous.schedule.dwell)
    left = [each.after(elapsed).split(count) for each in (previous.schedule, *previous.swarm)]
    others = nearby(left[0], settings.particles, NEARNESS, stream(seed, FOLLOW, 0))[1:]
    remaining = previous.arrival_time - elapsed
    return plan(
        problem,
        law,
        replace(settings, points=count),
        seed=seed,
        initial=[left[0], *left[1 : settings.particles // 2], *others][: settings.particles],
        region=_region(problem, left[0]),
        budget=min(max(remaining, problem.period), problem.horizon),
        path=(FOLLOW, 1),
    )


def _region(problem: Problem, schedule: Schedule) -> tuple[Floats, Floats]:
    """Bounds (3,) of the equilibrium points: all that the plan leads to and some more, and two turns."""
    places = np.vstack([problem.starts, problem.goal, schedule.points])[:, :2]
    turns = 2.0 * np.pi
    return np.append(places.min(axis=0) - BEYOND, -turns), np.append(places.max(axis=0) + BEYOND, turns)
