from dataclasses import replace

import numpy as np
import pytest

from gpsynth.builder import Builder
from gpsynth.errors import ProblemError
from gpsynth.evaluate import Evaluator
from gpsynth.law import Law
from gpsynth.objective import costs_of
from gpsynth.planning import PlanCost, Task
from gpsynth.problem import Problem
from gpsynth.program import Program
from gpsynth.refitting import refit, without_constants
from gpsynth.schedule import Schedule
from gpsynth.tracing import trace
from tests.test_synthesis import PLANT, STARTS, quadratic

PROBLEM = quadratic()
OPTIMUM = np.array([1.0, np.sqrt(2.0)])  # gains of the linear-quadratic regulator


def law_of(problem: Problem, *gains: float) -> Law:
    builder = Builder(problem.features.names, ("k1", "k2"))
    terms = [builder.apply("mul", *pair) for pair in zip(builder.parameters, builder.inputs, strict=True)]
    return Law(PLANT, problem.features, builder.build([builder.apply("add", *terms)], ("force",)), gains)


def cost(law: Law) -> float:
    return costs_of(Evaluator(PROBLEM).of_program(law.program, law.parameters[np.newaxis])).mean()


@pytest.mark.parametrize("gains", [(3.0, 0.4), (0.05, 0.05), (20.0, 9.0)])
def test_finds_the_regulator_from_other_gains(gains):
    law = law_of(PROBLEM, *gains)
    found = refit(PROBLEM, law, seed=1, budget=600)
    assert found.program == law.program
    assert found.parameters == pytest.approx(
        OPTIMUM, rel=0.1
    )  # the hold of 0.05 s moves the optimum a little
    assert cost(found) < cost(law)


def test_a_law_that_cannot_be_improved_comes_back():
    best = refit(PROBLEM, law_of(PROBLEM, *OPTIMUM), seed=1, budget=1_000)
    again = refit(PROBLEM, best, seed=2, budget=30)
    assert cost(again) <= cost(best)
    no_numbers = Law(
        PLANT,
        PROBLEM.features,
        trace(lambda f: f.error_place, [("f", PROBLEM.features.names)], ("force",)),
        (),
    )
    assert refit(PROBLEM, no_numbers) is no_numbers


def test_numbers_of_the_formula_are_tuned_on_request():
    program = trace(
        lambda f: 3.0 * f.error_place + 0.4 * f.error_speed, [("f", PROBLEM.features.names)], ("force",)
    )
    law = Law(PLANT, PROBLEM.features, program, ())
    assert refit(PROBLEM, law) is law
    found = refit(PROBLEM, law, seed=1, budget=600, constants=True)
    assert np.array_equal(found.program.code, program.code)
    assert sorted(found.parameters) == pytest.approx(sorted(OPTIMUM), rel=0.1)


def test_constants_as_parameters_change_no_bit():
    program = trace(lambda f: np.tanh(2.5 * f.x) + f.y / 3.0 - 0.1, [("f", ("x", "y"))])
    rows = np.random.default_rng(1).normal(size=(20, 2))
    lifted = without_constants(program)
    assert len(lifted.constants) == 0
    assert np.array_equal(lifted(rows, program.constants), program(rows))


def test_another_objective_finds_other_numbers():
    gentle = refit(
        PROBLEM,
        law_of(PROBLEM, *OPTIMUM),
        seed=1,
        budget=300,
        objective=lambda r: r.cost + 5.0 * r.final[..., 0] ** 2,
    )
    assert not np.array_equal(gentle.parameters, OPTIMUM)


def test_a_law_of_another_problem_is_refused():
    other = Problem(
        PLANT, STARTS, (0.0, 0.0), tolerance=0.1, features=lambda x, target: {"e": target.place - x.place}
    )
    with pytest.raises(ProblemError, match="the law sees other features than the problem"):
        refit(other, law_of(PROBLEM, 1.0, 1.0))


def test_plans_weigh_in_when_numbers_are_tuned():
    """Settling alone is content with gentle gains; the plan wants to be there soon."""
    eager = Task(
        replace(PROBLEM, starts=[[2.0, 0.0]], tolerance=[0.1, 10.0], running=_second(), stop=True),
        1.0,
        [Schedule([[0.0, 0.0]], [1.0])],
    )
    gentle = refit(PROBLEM, law_of(PROBLEM, 0.5, 0.5), seed=1, budget=600)
    both = refit(
        PROBLEM, law_of(PROBLEM, 0.5, 0.5), seed=1, budget=600, plans=PlanCost((eager,), weight=100.0)
    )
    assert _arrival(both, eager.problem) < 0.7 * _arrival(gentle, eager.problem)
    assert cost(gentle) < cost(both)


def _second() -> Program:
    """A running cost of 1."""
    return Problem(PLANT, STARTS, goal=(0.0, 0.0), tolerance=0.1).running


def _arrival(law: Law, problem: Problem) -> float:
    return Evaluator(problem).of_program(law.program, law.parameters[np.newaxis]).arrival[0, 0]
