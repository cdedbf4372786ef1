from dataclasses import replace

import numpy as np
import pytest

from gpsynth.encodings.cartesian import CartesianEncoding
from gpsynth.encodings.columns import basic_columns
from gpsynth.encodings.parameters import ParameterSpace
from gpsynth.encodings.variational import VariationalEncoding
from gpsynth.epochs import Epochs
from gpsynth.errors import OptimizerError
from gpsynth.optimizers import minimize
from gpsynth.seeds import stream
from gpsynth.structure_search import StructureSearch

SPACE = ParameterSpace(2, -4.0, 4.0)
NETWORK = VariationalEncoding(("a", "b"), ("y",), ("add", "nop_mul", "sin"), SPACE, n_variations=3)
COLUMNS = VariationalEncoding(
    ("a", "b"), ("y",), ("add", "mul", "sin"), SPACE, basic_columns(2, 2, 1), n_variations=3
)
ROWS = np.random.default_rng(5).uniform(-2.0, 2.0, (12, 2))


def errors(batch):
    wanted = ROWS[:, 0] * ROWS[:, 1] + np.sin(ROWS[:, 1] + ROWS[:, 0] * np.sin(ROWS[:, 1]))
    values = np.array([each.program(ROWS, each.values)[:, 0] for each in batch])
    return (values - wanted) ** 2


def epochs(encoding, every=4):
    return Epochs(StructureSearch(encoding, population=20, offspring=10, tuned=1), every=every)


@pytest.mark.parametrize("encoding", [NETWORK, COLUMNS])
def test_the_basis_is_the_best_member_of_the_epoch_before(encoding):
    search = epochs(encoding)
    state = search.init(stream(1, 0))
    moves = 0
    for generation in range(1, 20):
        before = state
        batch, waiting = search.ask(state, stream(1, generation))
        state = search.tell(waiting, batch, errors(batch))
        if before.search.encoding is not state.search.encoding:
            moves += 1
            best, moved = before.inner.population[0], state.search.encoding
            assert moved.decode(moved.basic(best.values)) == best.program
            assert state.inner.population[0].cost <= best.cost  # it is in the first batch, with its numbers
            lists = {each.genome.variations for each in before.inner.population[1:]}
            assert len(lists & {each.genome.variations for each in batch}) > 5
        for member in state.inner.population:
            assert state.search.encoding.decode(member.genome) == member.program
    assert moves == 4


def test_nothing_that_was_found_is_lost():
    search = epochs(NETWORK)
    result = minimize(errors, search, seed=2, budget=700)
    best = [cost for _, cost in result.history]
    assert best == sorted(best, reverse=True)
    assert result.cost == result.state.front[-1].cost == errors([result.x]).mean()


def test_an_epoch_goes_where_no_list_of_variations_can():
    one = VariationalEncoding(("a", "b"), ("y",), NETWORK.operations, SPACE, n_variations=1)
    search = Epochs(StructureSearch(one, population=20, offspring=10, tuned=1), every=3)
    basis = minimize(errors, search, seed=3, budget=400).state.search.encoding.basis
    assert np.count_nonzero(basis.psi != one.basis.psi) > one.n_variations


def test_same_seed_same_search():
    first, second = (minimize(errors, epochs(NETWORK), seed=6, budget=400) for _ in range(2))
    assert first.history == second.history


def test_begins_with_given_formulas():
    given = NETWORK.random(stream(9))
    search = replace(epochs(NETWORK), seeds=(given,))
    batch, _ = search.ask(search.init(stream(1)), stream(2))
    assert given in {each.genome for each in batch}


def test_an_encoding_without_a_basis_is_refused():
    search = StructureSearch(CartesianEncoding(("a", "b"), ("y",), ("add",)))
    with pytest.raises(OptimizerError, match="CartesianEncoding has none"):
        Epochs(search)
    with pytest.raises(OptimizerError, match="every must be an integer of at least 1, not 0"):
        epochs(NETWORK, every=0)
