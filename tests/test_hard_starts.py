"""The starts that laws miss are found, and a search goes on from them."""

from dataclasses import replace

import numpy as np

import gpsynth as gs
from gpsynth.batch_cost import BatchCost
from gpsynth.hard_starts import covering, harder
from gpsynth.structure_search import Candidate, Individual, SearchState

MISSED = np.array([[1, 1, 0, 0], [1, 0, 0, 0], [0, 0, 0, 1]], dtype=bool)
PUSHED = gs.Plant(
    lambda x, u: {"place": u.speed},
    states={"place": "m"},
    controls={"speed": ("m/s", -1.0, 1.0)},
    name="cart",
)
PROBLEM = gs.Problem(
    PUSHED,
    [[-2.0], [-1.0], [1.0], [2.0]],
    [0.0],
    tolerance=0.1,
    horizon=5.0,
    stop=False,
    running=lambda x, u, goal: x.place**2,
)


def _individual(problem, formula):
    """A law given as a function of the error, as a search keeps it."""
    program = gs.trace(formula, [("x", PROBLEM.features.names)])
    cases = BatchCost(problem)([Candidate(None, program, np.empty(0))])[0]
    return Individual(None, program, np.empty(0), cases, 0)


def one_sided(x):
    """Comes from the left alone: the error is positive there."""
    return {"speed": np.maximum(x.error_place, 0.0)}


def two_sided(x):
    """Comes from either side."""
    return {"speed": 2.0 * x.error_place}


def test_every_law_that_misses_something_misses_a_chosen_start() -> None:
    assert covering(MISSED, 4)[:2] == (0, 3)
    assert sorted(covering(MISSED, 4)) == [0, 1, 3]
    assert covering(MISSED, 1) == (0,)
    assert covering(np.zeros((3, 4), dtype=bool), 2) == ()


def test_a_law_misses_the_starts_it_does_not_come_from() -> None:
    laws = [_individual(PROBLEM, each).candidate for each in (one_sided, two_sided)]
    assert BatchCost(PROBLEM).missed(laws).tolist() == [[False, False, True, True], [False] * 4]


def test_what_is_missed_comes_in_and_what_came_first_stays() -> None:
    many = replace(PROBLEM, starts=np.linspace(-2.0, 2.0, 40)[:, np.newaxis])
    seen = tuple(range(16))
    starts = harder(BatchCost(many), [_individual(PROBLEM, one_sided).candidate], seen)
    assert len(starts) == len(seen)
    assert all(many.starts[start] > 0.1 for start in starts[:2])
    assert starts[2:] == seen[:14]
    assert harder(BatchCost(many), [_individual(PROBLEM, two_sided).candidate], seen) == seen


def test_what_a_search_remembers_is_scored_anew() -> None:
    left = PROBLEM.of([0, 1])
    laws = [_individual(left, one_sided), _individual(left, two_sided)]
    search = gs.StructureSearch(
        gs.TreeEncoding(("error_place",), ("speed",), ("add",), gs.ParameterSpace(0, -1.0, 1.0))
    )
    before = SearchState(tuple(laws), (laws[0],))
    after = search.rescored(before, BatchCost(PROBLEM))
    assert after.population[0].program == laws[1].program
    for each in after.population:
        assert np.array_equal(each.cases, BatchCost(PROBLEM)([each.candidate])[0])
