"""Many candidates at once: each result in its place, whatever the number of threads."""

import numpy as np
import pytest

from gpsynth.arrays import Floats
from gpsynth.errors import ProblemError
from gpsynth.evaluate import Evaluator
from gpsynth.law import Law
from gpsynth.plant import Plant
from gpsynth.problem import Obstacles, Problem
from gpsynth.program import Program
from gpsynth.schedule import Schedule
from gpsynth.simulation import simulate
from gpsynth.tracing import trace


def _problem() -> Problem:
    plant = Plant(
        lambda x, u: (u.v * np.cos(x.theta), u.v * np.sin(x.theta), u.omega),
        states={"x": "m", "y": "m", "theta": "rad"},
        controls={"v": ("m/s", -0.5, 0.5), "omega": ("rad/s", -0.5, 0.5)},
        angles=("theta",),
        name="unicycle",
    )
    starts = np.random.default_rng(2).uniform(-2, 2, (5, 3))
    circles = np.array([[9.0, 9.0, -0.1, 0.0, 0.5]])
    return Problem(
        plant, starts, np.zeros(3), tolerance=0.1, horizon=8.0, obstacles=Obstacles(circles, radius=0.2)
    )


def _program(problem: Problem) -> Program:
    return trace(
        lambda e, k: (k.a * e.error_x, k.b * e.error_y + np.sin(e.error_theta)),
        [("e", problem.features.names), ("k", ("a", "b"))],
        problem.plant.control_names,
    )


def _parametrized(problem: Problem) -> Program:
    """The traced program with its last two inputs made parameters."""
    traced = _program(problem)
    return Program(
        traced.inputs[:-2], traced.inputs[-2:], traced.constants, traced.code, traced.outputs, traced.names
    )


def _laws(problem: Problem, gains: Floats) -> list[Law]:
    return [Law(problem.plant, problem.features, _parametrized(problem), gain) for gain in gains]


def test_results_stand_by_candidate_and_start() -> None:
    problem = _problem()
    gains = np.random.default_rng(4).normal(size=(7, 2))
    rolled = Evaluator(problem).of_program(_parametrized(problem), gains)
    assert rolled.cost.shape == (7, 5)
    assert rolled.final.shape == (7, 5, 3)
    assert rolled.terminal.shape == (7, 5, 0)
    for c, law in enumerate(_laws(problem, gains)):
        for s, start in enumerate(problem.starts):
            alone = simulate(problem, law, start)
            assert alone.x[-1].tobytes() == rolled.final[c, s].tobytes()
            assert (alone.cost, alone.clearance) == (rolled.cost[c, s], rolled.clearance[c, s])


def test_schedules_stand_by_schedule_and_start() -> None:
    problem = _problem()
    rng = np.random.default_rng(5)
    law = _laws(problem, np.array([[0.7, 0.4]]))[0]
    points, dwell = rng.uniform(-2, 2, (6, 3, 3)), rng.uniform(0, 2, (6, 3))
    rolled = Evaluator(problem, threads=2, block=8).of_schedules(law, points, dwell, horizon=5.0)
    for k in range(6):
        for s, start in enumerate(problem.starts):
            alone = simulate(problem, law, start, schedule=Schedule(points[k], dwell[k]), horizon=5.0)
            assert alone.x[-1].tobytes() == rolled.final[k, s].tobytes()


def test_no_points_lead_straight_to_the_goal() -> None:
    problem = _problem()
    law = _laws(problem, np.array([[0.7, 0.4]]))[0]
    rolled = Evaluator(problem).of_schedules(law, np.empty((1, 0, 3)), np.empty((1, 0)))
    direct = Evaluator(problem).of_program(law.program, law.parameters)
    assert rolled.final.tobytes() == direct.final.tobytes()


def test_threads_and_blocks_change_no_bit_of_schedules() -> None:
    problem = _problem()
    rng = np.random.default_rng(6)
    law = _laws(problem, np.array([[0.7, 0.4]]))[0]
    points, dwell = rng.uniform(-2, 2, (31, 3, 3)), rng.uniform(0, 2, (31, 3))
    first = Evaluator(problem).of_schedules(law, points, dwell)
    for block, threads in [(8, 3), (32, 2), (256, 1)]:
        other = Evaluator(problem, threads=threads, block=block).of_schedules(law, points, dwell)
        assert all(values.tobytes() == getattr(other, name).tobytes() for name, values in vars(first).items())


def test_a_law_without_instructions_is_evaluated() -> None:
    problem = _problem()
    program = trace(lambda e: (e.error_x, 0.25), [("e", problem.features.names)], problem.plant.control_names)
    assert np.all(np.isfinite(Evaluator(problem).of_program(program, np.empty((1, 0))).cost))


def test_limits_saturate_every_control() -> None:
    raw = np.array([[0.7, -0.7], [0.1, np.nan], [np.inf, -np.inf]])
    assert _problem().plant.saturation(raw).tolist() == [[0.5, -0.5], [0.1, 0.0], [0.5, -0.5]]


def test_parameters_of_the_wrong_width_are_named() -> None:
    problem = _problem()
    with pytest.raises(ProblemError, match=r"parameters have shape \(4, 3\); the law has 2 parameters"):
        Evaluator(problem).of_program(_parametrized(problem), np.zeros((4, 3)))
