"""What plans are asked for beside little time, and what they cost then."""

from dataclasses import replace

import numpy as np
import pytest

from applications.rosbot.model import unicycle
from applications.rosbot.planner import Effort, plan_scenario
from applications.rosbot.polar_law import SATURATING, Gains, polar_law
from applications.rosbot.scenario import Scenario
from gpsynth.errors import ProblemError
from gpsynth.law import Law
from gpsynth.obstacles import Obstacles
from gpsynth.planning import PlanSettings, Weights, plan
from gpsynth.planning.weights import weighted
from gpsynth.plant import Plant
from gpsynth.problem import Problem
from gpsynth.tracing import trace

SMALL = PlanSettings(points=3, particles=32, iterations=10, rounds=5)
CIRCLES = np.array([[1.5, -0.5, 0.0, 0.0, 0.2], [2.0, 2.0, 0.0, -0.1, 0.1]])


GENTLE = Gains(0.3, 1.0, 0.6, 0.06, 1.0, 0.24)  # a law that saturates drives at full speed or not at all


def robot(gains=SATURATING, goal=(3.0, 0.0, 0.0), **changes) -> tuple[Problem, Law]:
    law = polar_law(unicycle(), gains)
    obstacles = Obstacles(circles=CIRCLES, radius=0.1)
    given = {
        "tolerance": [0.05, 0.05, 0.1],
        "horizon": 20.0,
        "features": law.features,
        "obstacles": obstacles,
    }
    return Problem(law.plant, [0.0, 0.0, 0.5], goal, **given | changes), law


def seconds(found, weights: Weights) -> float:
    """The integral that the weights define, over the trajectory in 100 parts a period."""
    total, path, parts = 0.0, found.trajectory, 100
    for k, (v, omega) in enumerate(path.u):
        x, y, theta = path.x[k]
        for part in range(parts):
            h = 0.05 / parts
            turn, t = theta + omega * h * (part + 0.5), path.t[k] + h * (part + 0.5)
            x, y = x + 0.5 * h * v * np.cos(turn), y + 0.5 * h * v * np.sin(turn)
            gaps = np.hypot(*(CIRCLES[:, :2] + t * CIRCLES[:, 2:4] - [x, y]).T) - CIRCLES[:, 4] - 0.1
            rate = (
                1.0
                + weights.energy * 0.5 * ((v / 0.5) ** 2 + (omega / 0.5) ** 2)
                + weights.smoothness * omega**2
            )
            rate += weights.clearance * max(0.0, 1.0 - gaps.min() / weights.comfort) ** 2
            total += h * (rate + weights.heading * 0.5 * (1.0 - np.cos(turn)))
            x, y = x + 0.5 * h * v * np.cos(turn), y + 0.5 * h * v * np.sin(turn)
    return total * found.arrival_time / path.t[-1]


@pytest.mark.parametrize(
    ("name", "setting"),
    [
        ("energy", {"gains": GENTLE}),
        ("smoothness", {"goal": [2.0, 1.5, 0.0]}),
        ("clearance", {}),
        ("heading", {"goal": [2.0, 1.5, 0.0]}),
    ],
)
def test_a_weight_buys_what_it_is_for_with_time(name, setting):
    problem, law = robot(**setting)
    only, weights = Weights(**{name: 1.0}), Weights(**{name: 20.0})
    fast = plan(problem, law, SMALL, seed=1)
    other = plan(problem, law, replace(SMALL, weights=weights), seed=1, initial=[fast.schedule])
    extra = [seconds(each, only) - each.arrival_time for each in (fast, other)]
    assert other.is_free
    assert extra[1] < 0.6 * extra[0]
    assert other.value == pytest.approx(
        seconds(other, weights), rel=2e-3
    )  # the last period, taken in its mean
    assert fast.arrival_time == fast.value <= other.arrival_time + 0.02


def test_no_weights_change_no_problem():
    problem, _ = robot()
    assert weighted(problem, Weights(comfort=1.0)) is problem


def test_weights_are_those_of_any_plant():
    plant = Plant(
        lambda x, u: (u.a, u.b),
        states={"x": "m", "y": "m"},
        controls={"a": ("m/s", -1, 1), "b": ("m/s", -2, 1)},
    )
    problem = Problem(plant, [0.0, 0.0], [3.0, 1.0], tolerance=0.05)
    law = Law(
        plant,
        problem.features,
        trace(lambda seen: (4.0 * seen[0], 4.0 * seen[1]), [("seen", problem.features.names)], ("a", "b")),
        np.empty(0),
    )
    found = plan(problem, law, replace(SMALL, weights=Weights(energy=2.0)), seed=1)
    u = found.trajectory.u / [1.0, 2.0]
    total = np.sum(0.05 * (1.0 + np.sum(u * u, axis=1)))  # twice the mean of two squares
    assert found.value == pytest.approx(total * found.arrival_time / found.trajectory.t[-1], rel=1e-9)


def test_a_scenario_is_planned_with_weights():
    small = PlanSettings(particles=16, iterations=8, rounds=2)
    effort = Effort(scouts=small, chasers=small, refiners=small, chased=1, refined=1)
    scenario = Scenario([0.0, 0.0, 0.0], [3.0, 0.0, 0.0], circles=[[1.5, 0.05, 0.0, 0.0, 0.3]])
    law = polar_law(unicycle(), SATURATING)
    fast = plan_scenario(scenario, [law], seed=1, effort=effort)
    wide = plan_scenario(scenario, [law], seed=1, effort=replace(effort, weights=Weights(clearance=20.0)))
    assert wide.certificate.clearance > fast.certificate.clearance + 0.02
    assert wide.replay.arrival_time >= fast.replay.arrival_time


@pytest.mark.parametrize(
    ("wrong", "sentence"),
    [
        ({"energy": -1.0}, "the weight energy must be finite and at least 0, not -1.0"),
        ({"heading": np.inf}, "the weight heading must be finite"),
        ({"clearance": "much"}, "the weight clearance must be a number, got 'much'"),
        ({"comfort": 0.0}, "comfort must be greater than 0 m"),
    ],
)
def test_weights_that_make_no_sense_are_one_sentence(wrong, sentence):
    with pytest.raises(ProblemError, match=sentence):
        Weights(**wrong)


def test_a_body_of_circles_keeps_all_of_them_clear():
    problem, _ = robot()
    parts = np.array([[0.2, 0.0, 0.1], [-0.1, 0.1, 0.15]])
    body = Obstacles(circles=CIRCLES, position=("x", "y", "theta"), footprint=parts)
    costs = weighted(replace(problem, obstacles=body), Weights(clearance=2.0, comfort=0.5)).running
    for pose in np.random.default_rng(2).uniform(0.0, 2.0, (50, 3)):
        turn = np.array([[np.cos(pose[2]), -np.sin(pose[2])], [np.sin(pose[2]), np.cos(pose[2])]])
        gaps = [
            np.hypot(*(pose[:2] + turn @ part[:2] - circle[:2] - 1.5 * circle[2:4])) - circle[4] - part[2]
            for part in parts
            for circle in CIRCLES
        ]
        inputs = np.hstack([pose, [0.1, 0.2], problem.goal, 1.5])
        expected = 1.0 + 2.0 * max(0.0, 1.0 - min(gaps) / 0.5) ** 2
        assert costs(inputs[np.newaxis])[0, 0] == pytest.approx(expected, rel=1e-12)


def test_what_the_problem_does_not_have_cannot_be_weighed():
    problem, law = robot(obstacles=None)
    with pytest.raises(ProblemError, match="clearance is a weight for problems with circles"):
        plan(problem, law, replace(SMALL, weights=Weights(clearance=1.0)))
    with pytest.raises(ProblemError, match="weights of a plan must be a Weights, got 3"):
        replace(SMALL, weights=3)
