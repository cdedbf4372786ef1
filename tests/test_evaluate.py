"""Many candidates at once: each result in its place, whatever the number of threads."""

import re
from dataclasses import replace

import numpy as np
import pytest

from gpsynth.arrays import Floats
from gpsynth.errors import ProblemError
from gpsynth.evaluate import Evaluator
from gpsynth.law import Law
from gpsynth.obstacles import Obstacles
from gpsynth.plant import Plant
from gpsynth.problem import Problem
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
        assert all(
            values.tobytes() == getattr(other, name).tobytes()
            for name, values in vars(first).items()
            if name != "paths"
        )


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


@pytest.mark.parametrize("parameters", [np.zeros((2, 2, 2)), [["a", "b"]], np.zeros((2, 0))])
def test_parameters_that_are_no_vectors_are_refused(parameters: Floats) -> None:
    problem = _problem()
    with pytest.raises(ProblemError, match="parameters"):
        Evaluator(problem).of_program(_parametrized(problem), parameters)


def test_no_candidates_give_no_rollouts() -> None:
    problem = _problem()
    evaluator = Evaluator(problem, threads=2)
    law = _laws(problem, np.array([[0.7, 0.4]]))[0]
    constant = trace(lambda e: (0.0, 0.25), [("e", problem.features.names)], problem.plant.control_names)
    for rolled in (
        evaluator.of_program(law.program, np.empty((0, 2))),
        evaluator.of_program(constant, np.empty((0, 0))),
        evaluator.of_schedules(law, np.empty((0, 3, 3)), np.empty((0, 3))),
    ):
        assert rolled.cost.shape == (0, 5)
        assert rolled.final.shape == (0, 5, 3)


@pytest.mark.parametrize(
    ("points", "dwell", "sentence"),
    [
        (np.zeros((2, 4, 2)), np.ones((2, 4)), "shapes (2, 4, 2) and (2, 4); expected (N, k, 3) and (N, k)"),
        (np.zeros((4, 3)), np.ones((4,)), "shapes (4, 3) and (4,)"),
        (np.zeros((2, 4, 3)), np.ones((1, 4)), "shapes (2, 4, 3) and (1, 4)"),
        (np.zeros((2, 4, 3)), np.ones((2, 3)), "shapes (2, 4, 3) and (2, 3)"),
        (np.full((2, 4, 3), np.nan), np.ones((2, 4)), "the points hold NaN or infinity"),
        (np.zeros((2, 4, 3)), np.full((2, 4), np.nan), "the dwell times hold NaN"),
        (np.zeros((2, 4, 3)), np.full((2, 4), -0.1), "the dwell times hold"),
        ([[["here"]]], np.ones((1, 1)), "points must hold numbers"),
    ],
)
def test_schedules_that_do_not_fit_are_refused(points: Floats, dwell: Floats, sentence: str) -> None:
    problem = _problem()
    law = _laws(problem, np.array([[0.7, 0.4]]))[0]
    with pytest.raises(ProblemError, match=re.escape(sentence)):
        Evaluator(problem).of_schedules(law, points, dwell)


@pytest.mark.parametrize(
    ("settings", "sentence"),
    [
        ({"block": 0}, "block must be an integer of at least 1, not 0"),
        ({"block": 8.0}, "block must be an integer"),
        ({"threads": 0}, "threads must be an integer of at least 1, not 0"),
        ({"margin": np.nan}, "the margin must be finite and at least 0 m, got nan"),
        ({"margin": -0.1}, "the margin must be"),
    ],
)
def test_settings_that_make_no_sense_are_refused(settings: dict[str, float], sentence: str) -> None:
    with pytest.raises(ProblemError, match=sentence):
        Evaluator(_problem(), **settings)  # type: ignore[arg-type]


@pytest.mark.parametrize("horizon", [np.nan, -1.0, np.inf, 1e9])
def test_a_horizon_that_makes_no_sense_is_refused(horizon: float) -> None:
    problem = _problem()
    law = _laws(problem, np.array([[0.7, 0.4]]))[0]
    with pytest.raises(
        ProblemError, match=r"the horizon is .* expected at least 0 and at most 10000000 periods"
    ):
        Evaluator(problem).of_schedules(law, np.zeros((1, 1, 3)), np.ones((1, 1)), horizon)


def test_whole_numbers_are_numbers() -> None:
    problem = _problem()
    law = _laws(problem, np.array([[0.7, 0.4]]))[0]
    points, dwell = np.ones((1, 1, 3)), np.ones((1, 1))
    whole, real = (
        Evaluator(problem, margin=kind(1)).of_schedules(law, points, dwell, reach=kind(1)).depth.tolist()
        for kind in (int, float)
    )
    assert whole == real
    unbounded = Evaluator(problem).of_program(law.program, law.parameters)
    bounded = Evaluator(problem).of_program(law.program, law.parameters, bound=np.float32(99.0))
    assert bounded.cost.tolist() == unbounded.cost.tolist()


@pytest.mark.parametrize("reach", [np.nan, -1.0])
def test_a_reach_that_makes_no_sense_is_refused(reach: float) -> None:
    problem = _problem()
    law = _laws(problem, np.array([[0.7, 0.4]]))[0]
    with pytest.raises(ProblemError, match="the reach must be at least 0"):
        Evaluator(problem).of_schedules(law, np.zeros((1, 1, 3)), np.ones((1, 1)), reach=reach)


def test_a_program_of_other_inputs_or_outputs_is_refused() -> None:
    problem = _problem()
    names, evaluator = problem.features.names, Evaluator(problem)
    swapped = trace(lambda e: (e[0], e[1]), [("e", names[::-1])])
    with pytest.raises(
        ProblemError,
        match=r"computes y_0, y_1 from error_theta, error_y, error_x; expected \w+, \w+ from the",
    ):
        evaluator.of_program(swapped, np.empty((1, 0)))
    single = trace(lambda e: e[0], [("e", names)])
    with pytest.raises(ProblemError, match=r"computes y from .*; expected \w+, \w+ from the features"):
        evaluator.of_program(single, np.empty((1, 0)))


def test_a_law_for_another_plant_or_other_features_is_refused() -> None:
    problem = _problem()
    law = _laws(problem, np.array([[0.7, 0.4]]))[0]
    points, dwell = np.zeros((1, 1, 3)), np.ones((1, 1))
    evaluator = Evaluator(problem)
    for _ in range(2):  # an error is not forgotten the second time
        with pytest.raises(ProblemError, match=r"adapt the law by law.with_limits"):
            evaluator.of_schedules(law.with_limits([-0.1, -0.1], [0.1, 0.1]), points, dwell)
    renamed = replace(law, plant=Plant.from_dict({**problem.plant.to_dict(), "name": "other"}))
    with pytest.raises(ProblemError, match="the plant 'other', which is not the problem's 'unicycle'"):
        evaluator.of_schedules(renamed, points, dwell)
    same_name = replace(law, plant=Plant.from_dict({**problem.plant.to_dict(), "angles": []}))
    with pytest.raises(
        ProblemError, match="the plant 'unicycle', which differs from the problem's of that name"
    ):
        evaluator.of_schedules(same_name, points, dwell)
    doubled = Problem(
        problem.plant,
        problem.starts,
        problem.goal,
        tolerance=0.1,
        features=lambda x, target: {
            f"error_{name}": 2.0 * (getattr(target, name) - getattr(x, name)) for name in ("x", "y", "theta")
        },
    )
    with pytest.raises(ProblemError, match=r"features=law.features"):
        Evaluator(doubled).of_schedules(law, points, dwell)


def test_a_law_read_from_a_document_fits_its_problem() -> None:
    problem = _problem()
    law = _laws(problem, np.array([[0.7, 0.4]]))[0]
    points, dwell = np.zeros((1, 1, 3)), np.ones((1, 1))
    again = Evaluator(problem).of_schedules(Law.from_dict(law.to_dict()), points, dwell)
    assert again.final.tobytes() == Evaluator(problem).of_schedules(law, points, dwell).final.tobytes()
