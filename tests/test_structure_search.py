"""The structure search: what it keeps, and that it finds formulas whose form is known."""

import numpy as np
import pytest

from gpsynth.encodings.parameters import ParameterSpace
from gpsynth.encodings.tree import TreeEncoding
from gpsynth.errors import OptimizerError
from gpsynth.optimizers import minimize
from gpsynth.seeds import stream
from gpsynth.structure_search import Candidate, StructureSearch

ENCODING = TreeEncoding(("a", "b"), ("y",), ("add", "mul", "sin"), ParameterSpace(2, -5.0, 5.0), max_size=15)
ROWS = np.random.default_rng(5).uniform(-2.0, 2.0, (24, 2))


def errors(target):
    """Costs (batch, rows) of candidates as formulas for target(a, b)."""

    def cost(batch: tuple[Candidate, ...]) -> np.ndarray:
        wanted = target(ROWS[:, 0], ROWS[:, 1])
        values = [candidate.program(ROWS, candidate.values)[:, 0] for candidate in batch]
        return (np.array(values) - wanted) ** 2

    return cost


@pytest.mark.parametrize("seed", [1, 2])
def test_finds_structure_and_numbers(seed: int) -> None:
    search = StructureSearch(ENCODING, population=60, offspring=30)
    cost = errors(lambda a, b: 1.7 * a * b + np.sin(b))
    result = minimize(cost, search, seed=seed, budget=12_000, target=1e-10)
    assert result.cost < 1e-8
    assert cost((Candidate(result.x.genome, result.x.program, result.x.values),)).mean() == result.cost


def test_front_falls_with_complexity() -> None:
    search = StructureSearch(ENCODING, population=40, offspring=20)
    result = minimize(errors(lambda a, b: a * a * b + 0.3), search, seed=3, budget=4_000)
    complexity = [individual.complexity for individual in result.state.front]
    cost = [individual.cost for individual in result.state.front]
    assert complexity == sorted(set(complexity))
    assert cost == sorted(cost, reverse=True)
    assert cost[-1] == result.cost


def test_values_of_an_individual_give_its_cases() -> None:
    search = StructureSearch(ENCODING, population=20, offspring=10)
    cost = errors(lambda a, b: a + 2.5 * b)
    result = minimize(cost, search, seed=4, budget=2_000)
    for individual in result.state.population:
        again = cost((Candidate(individual.genome, individual.program, individual.values),))[0]
        assert np.array_equal(again, individual.cases)


def test_not_finite_never_survives() -> None:
    def broken(batch: tuple[Candidate, ...]) -> np.ndarray:
        costs = errors(lambda a, b: a)(batch)
        costs[::2] = np.nan
        costs[1::4, 0] = np.inf
        return costs

    search = StructureSearch(ENCODING, population=20, offspring=10)
    result = minimize(broken, search, seed=5, budget=1_000)
    assert result.nonfinite > 0
    assert all(np.isfinite(individual.cases).all() for individual in result.state.population)


def test_begins_with_given_formulas() -> None:
    given = ENCODING.random(stream(9))
    search = StructureSearch(ENCODING, population=10, offspring=5, seeds=(given,))
    batch, _ = search.ask(search.init(stream(1)), stream(2))
    assert ENCODING.decode(given) in {candidate.program for candidate in batch}


def test_same_seed_same_search() -> None:
    search = StructureSearch(ENCODING, population=20, offspring=10)
    cost = errors(lambda a, b: a * b)
    first, second = (minimize(cost, search, seed=6, budget=1_500) for _ in range(2))
    assert first.history == second.history
    assert first.x.program == second.x.program


def test_a_grammar_without_further_formulas_ends_the_search() -> None:
    encoding = TreeEncoding(("a", "b"), ("y",), ("neg",), ParameterSpace(0, -1.0, 1.0), max_size=2)
    result = minimize(errors(lambda a, b: a - 3.0), StructureSearch(encoding), seed=1, budget=10_000)
    assert result.reason == "nothing new to try"
    assert result.evaluations == 4  # a, b, -a, -b
    assert len(result.x.program.code) == 0


def test_one_offspring_a_generation_is_new_as_long_as_there_are_new_ones() -> None:
    search = StructureSearch(ENCODING, population=4, offspring=1, tuned=0)
    assert minimize(errors(lambda a, b: a * b), search, seed=2, budget=300).evaluations == 300


def test_settings_below_one_are_an_error() -> None:
    with pytest.raises(OptimizerError, match="offspring must be an integer of at least 1, not 0"):
        StructureSearch(ENCODING, offspring=0)
