"""NSGA-II: its order against brute force, its operators, and the fronts it reaches."""

import numpy as np
import pytest

from gpsynth.errors import OptimizerError
from gpsynth.optimizers import NSGA2, NSGA2State, minimize
from gpsynth.optimizers.nsga2 import _tournaments, crowded_order
from gpsynth.seeds import stream

UNIT = (np.zeros(10), np.ones(10))


def brute_ranks(costs):
    ranks, left, rank = np.full(len(costs), -1), set(range(len(costs))), 0
    while left:
        front = {
            i
            for i in left
            if not any((costs[j] <= costs[i]).all() and (costs[j] < costs[i]).any() for j in left)
        }
        ranks[list(front)] = rank
        left, rank = left - front, rank + 1
    return ranks


def brute_crowding(costs):
    """Deb's distance for a front without equal costs, as the mean over objectives."""
    distance = np.zeros(len(costs))
    for column in costs.T:
        order = np.argsort(column)
        distance[order[[0, -1]]] = np.inf
        for k in range(1, len(column) - 1):
            gap = column[order[k + 1]] - column[order[k - 1]]
            distance[order[k]] += gap / (column.max() - column.min()) / costs.shape[1]
    return distance


@pytest.mark.parametrize("objectives", [2, 3])
def test_ranks_equal_a_brute_force_sort(objectives):
    for case in range(150):
        rng = stream(1, objectives, case)
        n = int(rng.integers(1, 40))
        costs = rng.integers(0, 1 + rng.integers(1, 12), (n, objectives)).astype(float)  # many ties
        costs[rng.random(n) < 0.1] = np.inf
        order, ranks, _ = crowded_order(costs, n)
        assert sorted(order) == list(range(n))
        assert np.array_equal(ranks, brute_ranks(costs)[order])
        assert (np.diff(ranks) >= 0).all()


def test_crowding_equals_debs_formula_and_decides_within_a_front():
    f = np.sort(stream(2).random(30))
    costs = stream(3).permutation(np.stack([f, 1 - f**2], axis=1))
    order, ranks, crowding = crowded_order(costs, 12)
    expected = brute_crowding(costs)
    assert (ranks == 0).all()
    assert np.allclose(crowding, expected[order], rtol=1e-12)
    assert set(order) == set(np.argsort(-expected, kind="stable")[:12])


@pytest.mark.parametrize("objectives", [2, 3])
def test_selection_keeps_whole_fronts_before_it_cuts_one(objectives):
    costs = stream(4).random((60, objectives))
    order, _, _ = crowded_order(costs, 30)
    ranks = brute_ranks(costs)
    assert np.array_equal(np.sort(ranks[order]), np.sort(ranks)[:30])


def test_tournaments_prefer_the_lower_rank_and_then_the_less_crowded():
    rank, crowding = np.array([0, 0, 1, 1], np.int32), np.array([1.0, 9.0, 9.0, 1.0])
    state = NSGA2State(1, np.zeros((4, 2)), np.zeros((4, 2)), rank, crowding)
    wins = np.bincount(np.concatenate([_tournaments(state, stream(1, g)) for g in range(4_000)]), minlength=4)
    # member k beats all after it: of 16 equally likely pairs, with order 1, 0, 2, 3, it wins 7, 5, 3, 1
    assert np.allclose(wins / wins.sum(), np.array([5, 7, 3, 1]) / 16, atol=0.02)


def test_crossover_keeps_the_parents_mean_far_from_the_walls():
    optimizer = NSGA2(np.full(4, -1e6), np.full(4, 1e6), crossover=1.0)
    a, b = stream(5).uniform(-1, 1, (2, 500, 4))
    children = optimizer._crossed(a, b, stream(6))
    assert np.allclose(children[:500] + children[500:], a + b, atol=1e-9)
    assert 0.4 < (children[:500] == a).mean() < 0.6


def test_the_spread_of_crossover_follows_debs_law():
    optimizer = NSGA2(np.full(1, -1e9), np.full(1, 1e9), crossover=1.0, crossover_index=15.0)
    a, b = np.zeros((200_000, 1)), np.ones((200_000, 1))
    children = optimizer._crossed(a, b, stream(6))
    crossed = children[:200_000, 0] != 0.0
    beta = np.abs(children[:200_000, 0] - children[200_000:, 0])[crossed]
    beta = beta[beta != 1.0]
    # P(beta < t) = t**(eta + 1) / 2 for t < 1 and 1 - t**-(eta + 1) / 2 beyond (Deb & Agrawal 1995)
    for t in (0.9, 0.95, 1.0, 1.05, 1.1):
        expected = t**16 / 2 if t <= 1 else 1 - t**-16 / 2
        assert (beta < t).mean() == pytest.approx(expected, abs=0.01)


def test_mutation_changes_one_coordinate_in_d_on_average_and_by_debs_law():
    optimizer = NSGA2(np.full(10, -1.0), np.full(10, 1.0))
    x = np.zeros((20_000, 10))
    step = optimizer._mutated(x, stream(7))
    changed = step[step != 0.0]
    assert len(changed) / x.size == pytest.approx(0.1, abs=0.005)
    # in the middle of the box |step| / range = 1 - (2 u + (1 - 2 u) / 2**21)**(1/21), u uniform in (0, 1/2)
    u = (np.arange(100_000) + 0.5) / 200_000
    law = 2.0 * (1 - (2 * u + (1 - 2 * u) * 0.5**21) ** (1 / 21))
    assert np.abs(changed).mean() == pytest.approx(law.mean(), rel=0.03)
    assert np.quantile(np.abs(changed), 0.9) == pytest.approx(np.quantile(law, 0.9), rel=0.03)


def zdt1(x):
    g = 1 + 9 * x[:, 1:].mean(axis=1)
    return np.stack([x[:, 0], g * (1 - np.sqrt(x[:, 0] / g))], axis=1)


def zdt2(x):
    g = 1 + 9 * x[:, 1:].mean(axis=1)
    return np.stack([x[:, 0], g * (1 - (x[:, 0] / g) ** 2)], axis=1)


def hypervolume(front):
    """Area dominated within (1.1, 1.1) by points of rising first and falling second cost."""
    width = np.diff(np.append(front[:, 0], 1.1))
    return float((width * (1.1 - front[:, 1])).sum())


@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize(
    ("cost", "whole"),
    [(zdt1, 1.21 - 1 / 3), (zdt2, 1.21 - 2 / 3)],  # 1.21 minus the area under the true front
)
def test_fronts_of_zdt_are_reached(cost, whole, seed):
    optimizer = NSGA2(*UNIT)
    result = minimize(cost, optimizer, seed=seed, budget=15_000)
    x, front = optimizer.front(result.state)
    assert np.array_equal(front, cost(x))
    assert (brute_ranks(front) == 0).all()
    assert len(front) == 100
    assert 0.98 * whole < hypervolume(front) < whole


def test_the_best_is_the_front_member_with_the_least_first_cost():
    optimizer = NSGA2(*UNIT, size=20)
    result = minimize(zdt1, optimizer, seed=1, budget=400)
    x, front = optimizer.front(result.state)
    assert result.cost == front[0, 0] == front[:, 0].min()
    assert np.array_equal(result.x, x[0])


def test_a_row_with_one_bad_cost_never_enters_the_front():
    optimizer = NSGA2(*UNIT, size=20)

    def cost(x):
        costs = zdt1(x)
        costs[x[:, 0] < 0.3, 1] = np.nan
        return costs

    result = minimize(cost, optimizer, seed=1, budget=1_000)
    x, front = optimizer.front(result.state)
    assert len(front) > 0
    assert x[:, 0].min() >= 0.3
    assert np.isfinite(front).all()


def test_the_front_is_empty_while_no_cost_was_finite():
    optimizer = NSGA2(*UNIT, size=20)
    x, front = optimizer.front(optimizer.init(stream(1)))
    assert (x.shape, front.shape) == ((0, 10), (0, 2))


@pytest.mark.parametrize(
    ("settings", "sentence"),
    [
        ({"objectives": 1}, "objectives must be an integer of at least 2, not 1"),
        ({"size": 2}, "size must be an integer of at least 4, not 2"),
        ({"size": 21}, "size must be even, since children come in pairs, not 21"),
        ({"crossover": 2.0}, "crossover must lie in"),
        ({"mutation": -0.1}, "mutation must lie in"),
        ({"crossover_index": 0.0}, "crossover_index must be positive"),
        ({"mutation_index": np.nan}, "mutation_index must be positive"),
    ],
)
def test_settings_that_contradict_themselves_are_refused(settings, sentence):
    with pytest.raises(OptimizerError, match=sentence):
        NSGA2(*UNIT, **settings)
