"""Numbers are tuned on a sample of the starts, and then on what the law misses."""

import numpy as np

import gpsynth as gs
from gpsynth.batch_cost import BatchCost
from gpsynth.builder import Builder
from gpsynth.objective import PROBLEMS_OWN
from gpsynth.structure_search import Candidate, Individual
from gpsynth.tuning import Tuner

CART = gs.Plant(
    lambda x, u: {"place": u.speed},
    states={"place": "m"},
    controls={"speed": ("m/s", -1.0, 1.0)},
    name="cart",
)
SPACE = gs.ParameterSpace(1, 0.0, 4.0)


def _law():
    """error (p1 - |error|): it runs away from starts beyond p1, of which those near the goal know nothing."""
    builder = Builder(("error_place",), ("p1",))
    error, bound = builder.inputs[0], builder.parameters[0]
    pull = builder.apply("sub", bound, builder.apply("abs", error))
    return builder.build([builder.apply("mul", error, pull)], ("speed",))


LAW = _law()


def _problem(starts):
    return gs.Problem(
        CART,
        np.reshape(starts, (-1, 1)),
        [0.0],
        tolerance=0.1,
        horizon=20.0,
        stop=False,
        running=lambda x, u, goal: x.place**2 + u.speed**2,
    )


def _individual(problem, value):
    values = np.array([value])
    cases = BatchCost(problem)([Candidate(None, LAW, values)])[0]
    return Individual(None, LAW, values, cases, 0)


def _tuned(problem, sample, budget=100):
    law = _individual(problem, 1.0)
    return Tuner(problem, PROBLEMS_OWN, SPACE, sample, 1, budget)(law, 0)[0]


def test_a_law_is_tuned_on_the_starts_of_its_sample_and_then_on_those_it_misses() -> None:
    near, far = [0.1, 0.2] * 8, [1.2, 1.3] * 8
    few = _problem(near)
    many = _problem([*near, *far])
    assert _tuned(few, None) < 1.3  # it runs away from starts beyond
    value = _tuned(many, len(near))
    assert value > 1.3
    assert not BatchCost(many).missed([_individual(many, value).candidate]).any()
