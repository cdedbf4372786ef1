import numpy as np
import pytest

from gpsynth.errors import ProblemError
from gpsynth.evaluate import Evaluator
from gpsynth.objective import Objective, as_objective, costs_of, score
from gpsynth.problem import Problem
from gpsynth.simulation import simulate
from gpsynth.synthesis import synthesize
from gpsynth.tracing import trace
from tests.test_refitting import law_of
from tests.test_synthesis import PLANT, STARTS, encoding, quadratic

PROBLEM = quadratic()
LINEAR = trace(lambda f: f.error_place + 1.5 * f.error_speed, [("f", PROBLEM.features.names)], ("force",))


def largest_force(rollouts):
    return np.nanmax(np.abs(rollouts.paths.u[..., 0]), axis=-1)


def test_paths_are_the_trajectories():
    rollouts = Evaluator(PROBLEM).of_program(LINEAR, np.empty((1, 0)), paths=True)
    for start, point in enumerate(STARTS):
        path = simulate(PROBLEM, law_of(PROBLEM, 1.0, 1.5), point)
        assert np.array_equal(rollouts.paths.t[: len(path.t)], path.t)
        assert np.array_equal(rollouts.paths.x[0, start], path.x)
        assert np.array_equal(rollouts.paths.u[0, start, :-1], path.u)
        assert np.array_equal(rollouts.paths.target[0, start], path.target)


def test_paths_are_nan_after_the_end():
    problem = Problem(PLANT, STARTS, (0.0, 0.0), tolerance=0.3, horizon=10.0)
    rollouts = Evaluator(problem).of_program(LINEAR, np.empty((1, 0)), paths=True)
    ended = rollouts.paths.t > rollouts.end[0][:, np.newaxis] + 1e-9
    assert ended.any()
    assert np.array_equal(np.isnan(rollouts.paths.x[0]).all(axis=-1), ended)
    assert Evaluator(problem).of_program(LINEAR, np.empty((1, 0))).paths is None


def test_the_search_minimizes_the_objective():
    final_speed_and_force = Objective(lambda r: largest_force(r) + 10.0 * np.abs(r.final[..., 0]), paths=True)
    result = synthesize(
        PROBLEM, encoding(PROBLEM), seed=1, budget=2_000, tuning=100, objective=final_speed_and_force
    )
    law, plain = result.law, law_of(PROBLEM, 1.0, np.sqrt(2.0))
    scores = [
        score(Evaluator(PROBLEM), each.program, each.parameters[np.newaxis], final_speed_and_force).mean()
        for each in (law, plain)
    ]
    assert scores[0] == result.best.cost
    assert scores[0] < 0.9 * scores[1]


def test_what_the_problem_says_is_the_default_objective():
    own = synthesize(PROBLEM, encoding(PROBLEM), seed=1, budget=600, tuning=20)
    same = synthesize(PROBLEM, encoding(PROBLEM), seed=1, budget=600, tuning=20, objective=costs_of)
    assert own.law == same.law


def test_nan_and_divergence_cost_infinity():
    unstable = trace(lambda f: -5.0 * f.error_place, [("f", PROBLEM.features.names)], ("force",))
    problem = Problem(PLANT.with_limits([-1e9], [1e9]), STARTS, (0.0, 0.0), tolerance=0.01, horizon=30.0)
    costs = score(Evaluator(problem), unstable, np.empty((1, 0)), Objective(lambda r: np.zeros_like(r.cost)))
    assert np.all(np.isinf(costs))
    costs = score(Evaluator(PROBLEM), LINEAR, np.empty((1, 0)), Objective(lambda r: r.end * np.nan))
    assert np.all(costs == np.inf)


@pytest.mark.parametrize(
    ("function", "sentence"),
    [
        (lambda r: r.cost.mean(axis=1), r"returns shape \(1,\); expected \(1, 4\), laws by starts"),
        (lambda r: "much", "the objective fails on rollouts"),
    ],
)
def test_a_wrong_objective_is_one_sentence(function, sentence):
    with pytest.raises(ProblemError, match=sentence):
        score(Evaluator(PROBLEM), LINEAR, np.empty((1, 0)), Objective(function))


def test_what_is_no_function_is_refused():
    with pytest.raises(ProblemError, match="an objective must be a function, got 3"):
        as_objective(3)
