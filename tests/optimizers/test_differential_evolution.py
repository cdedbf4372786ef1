"""The parts of SHADE that a solved test function would not show to be wrong."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from gpsynth.errors import OptimizerError
from gpsynth.optimizers import DifferentialEvolution, minimize
from gpsynth.optimizers.differential_evolution import _donors, _positive_cauchy
from gpsynth.seeds import stream
from tests.optimizers.helpers import SPHERE

BOX = (SPHERE.lower, SPHERE.upper)


def test_donors_differ_and_every_pair_is_equally_likely():
    n, pool = 5, 8
    counts = np.zeros((n, n, pool))
    for g in range(8_000):
        r1, r2 = _donors(n, pool, stream(1, g))
        assert ((r1 != np.arange(n)) & (r2 != r1) & (r2 != np.arange(n))).all()
        np.add.at(counts, (np.arange(n), r1, r2), 1)
    seen = counts[counts > 0]
    assert len(seen) == n * (n - 1) * (pool - 2)
    assert stats.chisquare(seen).pvalue > 1e-3


@pytest.mark.parametrize("location", [0.05, 0.5, 0.9])
def test_scales_follow_the_cauchy_law_given_that_they_are_positive(location):
    drawn = _positive_cauchy(stream(4), np.full(20_000, location), 0.1)
    below = stats.cauchy.cdf(0.0, location, 0.1)

    def cdf(x):
        return (stats.cauchy.cdf(x, location, 0.1) - below) / (1 - below)

    assert drawn.min() > 0
    assert stats.kstest(drawn, cdf).pvalue > 1e-3


def test_a_generation_keeps_the_better_and_remembers_what_paid():
    optimizer = DifferentialEvolution(*BOX, size=8, memory=3)
    state = minimize(SPHERE.cost, optimizer, seed=1, budget=80).state
    x, waiting = optimizer.ask(state, stream(2))
    costs = SPHERE.cost(x)
    after = optimizer.tell(waiting, x, costs)
    gain = state.costs - costs
    won = [i for i in range(8) if gain[i] > 0]
    assert 0 < len(won) < 8
    for i in range(8):
        assert np.array_equal(after.x[i], x[i] if i in won else state.x[i])
    total = sum(gain[i] for i in won)
    rate = sum(gain[i] / total * waiting.rate[i] for i in won)
    scale = sum(gain[i] * waiting.scale[i] ** 2 for i in won) / sum(gain[i] * waiting.scale[i] for i in won)
    assert after.memory_rate[state.slot] == pytest.approx(rate, rel=1e-12)
    assert after.memory_scale[state.slot] == pytest.approx(scale, rel=1e-12)
    assert after.slot == (state.slot + 1) % 3
    assert np.array_equal(after.archive[-len(won) :], state.x[won])


def test_the_archive_stays_as_small_as_the_population():
    optimizer = DifferentialEvolution(*BOX, size=10)
    state = minimize(SPHERE.cost, optimizer, seed=1, budget=3_000).state
    assert len(optimizer.ask(state, stream(1))[1].archive) == 10


def test_a_coordinate_beyond_the_wall_comes_half_way_to_it():
    optimizer = DifferentialEvolution(np.zeros(1), np.ones(1), size=50)
    state = minimize(lambda x: x[:, 0], optimizer, seed=1, budget=50).state
    mutants = optimizer._mutant(state, np.full((50, 1), 1.0), stream(3))
    half_way = {float(value) for value in np.concatenate([state.x / 2, (1 + state.x) / 2]).ravel()}
    assert half_way & {float(value) for value in mutants.ravel()}
    assert ((mutants >= 0) & (mutants <= 1)).all()


def test_a_collapsed_population_ends_the_run():
    optimizer = DifferentialEvolution(*BOX, size=10)
    state = optimizer.init(stream(1))
    assert optimizer.stop(state) == ""
    assert optimizer.stop(replace(state, x=np.zeros((10, 5)))) == "the population has collapsed"


@pytest.mark.parametrize(
    ("settings", "sentence"),
    [
        ({"size": 3}, "size must be an integer of at least 4, not 3"),
        ({"memory": 0}, "memory must be an integer of at least 1, not 0"),
        ({"greed": 1.5}, "greed must lie in"),
        ({"x0": np.zeros(4)}, "x0 must have 5 columns"),
    ],
)
def test_settings_that_contradict_themselves_are_refused(settings, sentence):
    with pytest.raises(OptimizerError, match=sentence):
        DifferentialEvolution(*BOX, **settings)
