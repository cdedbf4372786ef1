"""Costs of a batch, from all starts or from some, and which starts a law misses."""

import numpy as np

import gpsynth as gs
from gpsynth.batch_cost import BatchCost
from gpsynth.structure_search import Candidate, Individual, SearchState

CART = gs.Plant(
    lambda x, u: {"place": u.speed},
    states={"place": "m"},
    controls={"speed": ("m/s", -1.0, 1.0)},
    name="cart",
)
PROBLEM = gs.Problem(
    CART,
    [[-2.0], [-1.0], [1.0], [2.0]],
    [0.0],
    tolerance=0.1,
    horizon=5.0,
    running=lambda x, u, goal: x.place**2,
    stop=False,
)


def one_sided(x):
    """Comes from the left alone: the error is positive there."""
    return {"speed": np.maximum(x.error_place, 0.0)}


def two_sided(x):
    """Comes from either side."""
    return {"speed": 2.0 * x.error_place}


def _candidate(formula):
    return Candidate(None, gs.trace(formula, [("x", PROBLEM.features.names)]), np.empty(0))


LAWS = [_candidate(one_sided), _candidate(two_sided)]


def test_the_cost_from_some_starts_is_that_part_of_the_whole() -> None:
    whole = BatchCost(PROBLEM)(LAWS)
    assert np.array_equal(BatchCost(PROBLEM).of([2, 0])(LAWS), whole[:, [2, 0]])


def test_a_law_misses_the_starts_it_does_not_come_from() -> None:
    assert BatchCost(PROBLEM).missed(LAWS).tolist() == [[False, False, True, True], [False] * 4]


def test_what_a_search_remembers_is_scored_anew() -> None:
    left = BatchCost(PROBLEM).of([0, 1])
    laws = [Individual(None, each.program, each.values, left([each])[0], 0) for each in LAWS]
    space = gs.ParameterSpace(0, -1.0, 1.0)
    search = gs.StructureSearch(gs.TreeEncoding(("error_place",), ("speed",), ("add",), space))
    after = search.rescored(SearchState(tuple(laws), (laws[0],)), BatchCost(PROBLEM))
    assert after.population[0].program == laws[1].program
    for each in after.population:
        assert np.array_equal(each.cases, BatchCost(PROBLEM)([each.candidate])[0])
