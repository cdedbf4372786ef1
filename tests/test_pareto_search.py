import numpy as np

from gpsynth.encodings.parameters import ParameterSpace
from gpsynth.encodings.tree import TreeEncoding
from gpsynth.pareto_search import ParetoSearch
from gpsynth.seeds import stream

SEARCH = ParetoSearch(
    TreeEncoding(("x", "y"), ("u",), ("add", "mul", "sin"), ParameterSpace(3)),
    population=20,
    size_counts=False,
)


def told(*costs):
    """The state after a first generation with these costs, as often as need be."""
    candidates, waiting = SEARCH.ask(SEARCH.init(stream(1)), stream(1, 1))
    rows = np.resize(np.array(costs, dtype=np.float64), (len(candidates), len(costs[0])))
    return SEARCH.tell(waiting, candidates, rows)


def test_costs_that_are_not_finite_never_enter():
    state = told((1.0, 2.0), (np.inf, 0.0), (0.0, np.nan))
    assert [member.costs.tolist() for member in state.population] == [[1.0, 2.0]]
    nothing = told((np.inf, 0.0))
    assert (nothing.population, nothing.front, SEARCH.best(nothing)) == ((), (), (None, np.inf))


def test_the_front_is_what_none_dominates_by_rising_first_cost():
    state = told((3.0, 1.0), (1.0, 3.0), (2.0, 2.0), (3.0, 2.0), (2.0, 3.0))
    assert [member.costs.tolist() for member in state.front] == [[1.0, 3.0], [2.0, 2.0], [3.0, 1.0]]
    assert len(state.population) == 5
    assert SEARCH.best(state)[1] == 1.0


def test_children_are_formulas_of_the_encoding_and_some_keep_their_structure():
    state = told((1.0, 3.0), (3.0, 1.0))
    children, _ = SEARCH.ask(state, stream(2))
    for child in children:
        SEARCH.encoding.check(child.genome)
        assert child.program == SEARCH.encoding.decode(child.genome)
    parents = {member.genome.trees for member in state.population}
    moved = [child for child in children if child.genome.trees in parents]
    assert 0 < len(moved) < len(children)
