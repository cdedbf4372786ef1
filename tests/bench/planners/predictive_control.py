"""Nonlinear model predictive control with CasADi and IPOPT: 20 steps of 0.1 s, following a guide to the goal.

The reference runs along the guide by the clock and waits a little for a robot that is behind; obstacles are soft
constraints on the nearest discs, as hard ones fail as soon as a step ends inside of the margin. Pace and waiting
were tuned by hand on the public scenarios.
"""

from collections.abc import Iterator
from typing import Any

import numpy as np

from applications.rosbot.scenario import Scenario
from gpsynth.arrays import Floats
from tests.bench.planners.attempt import Answer, Watch, guides_of
from tests.bench.planners.path_integral import LONGEST, arrived, moved

STEPS, STEP = 20, 0.1  # s
NEAREST = 6  # discs that count
KEPT = 0.01  # m, clearance beyond which they do not
PACE = 0.97  # of top speed, of the reference
BEHIND = 0.15  # m, of the robot, at which the reference waits
PATIENCE = 8  # steps that it waits at a time
TURNED, EFFORT, CRASH = 0.5, 1e-3, 50.0  # m^2 a rad^2, m^2 a change of controls, m a meter of depth
FAR = np.array([1e3, 1e3, 0.1])  # a disc that is in nobody's way


def predictive_control(scenario: Scenario, seed: int, watch: Watch) -> Iterator[Answer]:
    """Drive until the goal is reached; one answer, after all the computing that this takes."""
    guide = guides_of(scenario, count=5)[0]
    line = np.column_stack([guide.poses[:, :2], np.unwrap(guide.poses[:, 2]), guide.times])
    aim = np.array([*scenario.goal, 0.98 * scenario.position_tolerance, 0.98 * scenario.heading_tolerance])
    solver, low, high = _solver(scenario)
    pose, driven, first = np.array(scenario.start), [np.zeros(2)], np.zeros(2 * STEPS + 1)
    time, waited = 0.0, 0
    while len(driven) * STEP < LONGEST and not arrived(pose, aim):
        ahead = _ahead(line, time)
        told = np.concatenate([pose, driven[-1], ahead.ravel(), _close(scenario.discs, pose).ravel()])
        found = np.asarray(solver(x0=first, p=told, lbx=low, ubx=high, lbg=0.0, ubg=np.inf)["x"]).ravel()
        driven.append(np.clip(found[:2], low[:2], high[:2]))
        first = np.concatenate([found[2:-1], found[-3:]])
        pose = np.array(moved(*pose, *driven[-1], STEP))
        waited = waited + 1 if np.hypot(*(ahead[0] - pose)[:2]) > BEHIND and waited < PATIENCE else 0
        time += 0.0 if waited else PACE * STEP
    if arrived(pose, aim):
        yield Answer(watch.spent, np.array(driven[1:]), np.full(len(driven) - 1, STEP))


def _ahead(line: Floats, time: float) -> Floats:
    """The reference (STEPS, 3): poses along the line, the last one being the goal."""
    instants = time + PACE * STEP * np.arange(1, STEPS + 1)
    return np.column_stack([np.interp(instants, line[:, 3], values) for values in line[:, :3].T])


def _close(discs: Floats, pose: Floats) -> Floats:
    """The NEAREST discs (NEAREST, 3)."""
    gaps = np.hypot(discs[:, 0] - pose[0], discs[:, 1] - pose[1]) - discs[:, 2]
    chosen = discs[np.argsort(gaps)[:NEAREST]]
    return np.vstack([chosen, np.tile(FAR, (NEAREST - len(chosen), 1))])


def _solver(scenario: Scenario) -> tuple[Any, Floats, Floats]:
    """The program over the controls and one slack, with the bounds of these."""
    import casadi

    u, slack = casadi.SX.sym("u", 2, STEPS), casadi.SX.sym("slack")
    pose, latest = casadi.SX.sym("pose", 3), casadi.SX.sym("latest", 2)
    reference, discs = casadi.SX.sym("reference", 3, STEPS), casadi.SX.sym("discs", 3, NEAREST)
    x, before, cost, gaps = pose, latest, CRASH * slack, []
    for k in range(STEPS):
        middle = x[2] + 0.5 * STEP * u[1, k]
        x = x + STEP * casadi.vertcat(u[0, k] * casadi.cos(middle), u[0, k] * casadi.sin(middle), u[1, k])
        miss = x - reference[:, k]
        cost += casadi.sumsqr(miss[:2]) + TURNED * 2.0 * (1.0 - casadi.cos(miss[2]))
        cost += EFFORT * casadi.sumsqr(u[:, k] - before)
        before = u[:, k]
        for disc in range(NEAREST):
            kept = discs[2, disc] + KEPT
            apart = casadi.sumsqr(x[:2] - discs[:2, disc])
            gaps.append((apart - kept**2) / (2.0 * kept) + slack)
    program = {
        "x": casadi.vertcat(casadi.vec(u), slack),
        "f": cost,
        "g": casadi.vertcat(*gaps),
        "p": casadi.vertcat(pose, latest, casadi.vec(reference), casadi.vec(discs)),
    }
    settings = {"print_level": 0, "sb": "yes", "max_iter": 30, "tol": 1e-4, "mu_init": 1e-3}
    solver = casadi.nlpsol("controller", "ipopt", program, {"ipopt": settings, "print_time": False})
    low, high = np.array([scenario.speed_limits, scenario.turn_limits]).T
    return solver, np.append(np.tile(low, STEPS), 0.0), np.append(np.tile(high, STEPS), 1.0)
