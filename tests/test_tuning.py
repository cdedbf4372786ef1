"""The numbers of a law become those that cost least on the tuner's problem."""

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

import gpsynth as gs
from gpsynth.batch_cost import BatchCost
from gpsynth.builder import Builder
from gpsynth.evaluate import Evaluator
from gpsynth.law_cost import LawCost
from gpsynth.structure_search import Candidate, Individual
from gpsynth.tuning import Tuner

CART = gs.Plant(
    lambda x, u: {"place": u.speed},
    states={"place": "m"},
    controls={"speed": ("m/s", -1.0, 1.0)},
    name="cart",
)
PROBLEM = gs.Problem(
    CART,
    [[-0.5], [0.2]],
    [0.0],
    tolerance=0.1,
    horizon=10.0,
    running=lambda x, u, goal: x.place**2 + u.speed**2,
    stop=False,
)
SPACE = gs.ParameterSpace(1, 0.0, 4.0)


def _gain():
    """The law speed = p1 error."""
    builder = Builder(("error_place",), ("p1",))
    return builder.build([builder.apply("mul", builder.inputs[0], builder.parameters[0])], ("speed",))


def _individual(value):
    values = np.array([value])
    cases = BatchCost(PROBLEM)([Candidate(None, _gain(), values)])[0]
    return Individual(None, _gain(), values, cases, 0)


def test_the_gain_is_the_one_that_a_scalar_search_finds() -> None:
    tuned = Tuner(LawCost(Evaluator(PROBLEM)), SPACE, seed=1, budget=300)(_individual(3.0), 0)
    least = minimize_scalar(lambda gain: _individual(gain).cost, bounds=(0.0, 4.0), method="bounded")
    assert tuned[0] == pytest.approx(least.x, abs=1e-4)


def test_without_a_budget_the_numbers_stay() -> None:
    law = _individual(3.0)
    assert Tuner(LawCost(Evaluator(PROBLEM)), SPACE, seed=1, budget=0)(law, 0) is law.values
