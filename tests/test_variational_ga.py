"""The authors' genetic algorithm: what it keeps, and that it finds a formula whose form is known."""

from dataclasses import replace

import numpy as np
import pytest

from gpsynth.encodings.parameters import ParameterSpace
from gpsynth.encodings.variational import VariationalEncoding
from gpsynth.errors import OptimizerError
from gpsynth.optimizers import minimize
from gpsynth.optimizers.domination import domination_ranks
from gpsynth.seeds import stream
from gpsynth.structure_search import Candidate
from gpsynth.variational_ga import VariationalGA, mean_and_worst

ENCODING = VariationalEncoding(("a", "b"), ("y",), ("add", "nop_mul", "sin"), ParameterSpace(2, -4.0, 4.0))
ROWS = np.random.default_rng(5).uniform(-2.0, 2.0, (12, 2))
SMALL = VariationalGA(ENCODING, population=40, couples=10, epoch=3, elite=5)


def errors(batch):
    wanted = ROWS[:, 0] * ROWS[:, 1] + np.sin(ROWS[:, 1])
    values = np.array([each.program(ROWS, each.values)[:, 0] for each in batch])
    return (values - wanted) ** 2


def states(search, generations, seed=1, cost=errors):
    """The state after every batch."""
    state = search.init(stream(seed, 0))
    for generation in range(1, generations + 1):
        batch, waiting = search.ask(state, stream(seed, generation))
        state = search.tell(waiting, batch, cost(batch))
        yield batch, state


def test_ranks_and_costs_are_those_of_the_members():
    for _, state in states(SMALL, 12):
        assert len(state.population) == 40
        assert np.array_equal(state.ranks, domination_ranks(state.functionals))
        again = errors(state.population)
        assert np.array_equal(again, [member.cases for member in state.population])
        assert np.array_equal(mean_and_worst(again), state.functionals)
        for member in state.population:
            assert state.encoding.decode(member.genome) == member.program


def test_the_first_member_is_the_basis():
    for _, state in states(SMALL, 12):
        first = state.population[0]
        assert first.genome == state.encoding.basic(first.values)


def test_turns_follow_each_other():
    turns = [state.turn for _, state in states(SMALL, 12)]
    epoch = ["couples", "couples", "population", "elite", "couples"]
    assert turns == ["couples", *epoch, *epoch, "couples"]


def test_a_member_near_utopia_becomes_the_basis():
    seen = [state for _, state in states(SMALL, 5)]
    before, after = seen[3], seen[4]
    rows = before.functionals
    spread = (rows - rows.min(axis=0)) / (rows.max(axis=0) - rows.min(axis=0))
    chosen = before.population[int(np.argmin(np.hypot(*spread.T)))]
    assert after.encoding.decode(after.encoding.basic()) == chosen.program
    assert np.array_equal(after.population[0].values, chosen.values)
    assert [each.genome for each in after.population[1:]] == [each.genome for each in before.population[1:]]


def test_without_spread_dominated_members_and_copies_are_drawn_anew():
    def flat(batch):
        return np.ones((len(batch), 3))

    seen = [state for _, state in states(SMALL, 5, cost=flat)]
    assert seen[4].encoding == ENCODING
    pairs = list(zip(seen[3].population, seen[4].population, strict=True))
    assert pairs[0][0].genome == pairs[0][1].genome
    assert not any(old.genome == new.genome for old, new in pairs[1:])


def test_elite_members_lose_the_variations_that_do_not_help():
    seen = [state for _, state in states(SMALL, 6)]
    before, after = seen[4], seen[5]
    changed = [k for k in range(40) if before.population[k].genome != after.population[k].genome]
    assert changed
    assert len(changed) <= SMALL.elite
    assert 0 not in changed
    for k in changed:
        old, new = before.population[k].genome, after.population[k].genome
        count = next(n for n in range(8) if new == after.encoding.trimmed(old, n))
        rows = [mean_and_worst(errors([trimmed(after.encoding, old, n)]))[0] for n in range(count, 9)]
        assert np.array_equal(rows[0], after.functionals[k])
        assert not any(np.all(row <= rows[0]) for row in rows[1:])


def trimmed(encoding, genome, count):
    shorter = encoding.trimmed(genome, count)
    return Candidate(shorter, encoding.decode(shorter), encoding.parameters(shorter))


def test_it_improves_on_its_first_population():
    result = minimize(errors, SMALL, seed=3, budget=2_000)
    first = min(np.mean(errors(batch), axis=1).min() for batch, _ in states(SMALL, 1, seed=3))
    assert result.cost < 0.2 * first
    assert errors([result.x]).mean() == result.cost


def test_the_front_spans_all_epochs():
    fronts = [state.front for _, state in states(SMALL, 12)]
    best = [front[-1].cost for front in fronts]
    assert best == sorted(best, reverse=True)
    for front in fronts:
        assert [each.complexity for each in front] == sorted({each.complexity for each in front})


def test_not_finite_is_never_best_and_loses_to_all():
    def broken(batch):
        costs = errors(batch)
        costs[::2] = np.nan
        return costs

    for _, state in states(SMALL, 8, cost=broken):
        assert np.isfinite(SMALL.best(state)[1])
        wrong = ~np.isfinite(state.functionals).all(axis=1)
        assert np.all(state.ranks[wrong] == (~wrong).sum())


def test_begins_with_the_basis_and_given_formulas():
    given = ENCODING.random(stream(9)), ENCODING.random(stream(10))
    search = replace(SMALL, seeds=given)
    batch, _ = search.ask(search.init(stream(1)), stream(2))
    assert tuple(each.genome for each in batch[:3]) == (ENCODING.basic(), *given)
    assert len(batch) == SMALL.population


def test_same_seed_same_search():
    first, second, other = (minimize(errors, SMALL, seed=seed, budget=900) for seed in (6, 6, 7))
    assert first.history == second.history
    assert first.x.program == second.x.program
    assert first.history != other.history


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"population": 1}, "population must be an integer of at least 2, not 1"),
        ({"couples": 0}, "couples must be an integer of at least 1"),
        ({"epoch": -1}, "epoch must be an integer of at least 0"),
        ({"attraction": 1.5}, r"attraction must lie in \[0, 1\]"),
        ({"mutation": float("nan")}, r"mutation must lie in \[0, 1\]"),
    ],
)
def test_wrong_settings_are_named(changes, sentence):
    with pytest.raises(OptimizerError, match=sentence):
        VariationalGA(ENCODING, **changes)
