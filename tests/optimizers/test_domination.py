import numpy as np
import pytest

from gpsynth.optimizers.domination import dominates, domination_ranks, nearest_to_utopia

INF = np.inf


@pytest.mark.parametrize(
    ("a", "b", "expected"),
    [
        ((1, 2), (1, 3), True),
        ((1, 2), (2, 3), True),
        ((1, 2), (1, 2), False),
        ((1, 3), (2, 2), False),
        ((1, 2), (INF, INF), True),
        ((INF, INF), (INF, INF), False),
    ],
)
def test_domination_is_nowhere_worse_and_somewhere_better(a, b, expected):
    assert dominates(np.array(a), np.array(b)) == expected


def test_ranks_count_who_dominates():
    costs = np.array([(1, 1), (2, 2), (3, 0), (3, 3), (1, 1), (INF, INF)], dtype=float)
    slow = [
        sum(all(p <= q for p, q in zip(b, a, strict=True)) and tuple(b) != tuple(a) for b in costs)
        for a in costs
    ]
    assert domination_ranks(costs).tolist() == slow == [0, 2, 0, 4, 0, 5]


def test_utopia_weighs_all_costs_alike():
    costs = np.array([(0.0, 1000.0), (0.4, 400.0), (1.0, 0.0), (INF, INF)])
    assert nearest_to_utopia(costs) == 1
    assert nearest_to_utopia(costs[:, ::-1]) == 1  # and not the least of the second cost


@pytest.mark.parametrize("costs", [[(1.0, 2.0)], [(1.0, 2.0), (2.0, 2.0)], [(1.0, 2.0), (INF, INF)]])
def test_without_spread_nothing_is_nearest(costs):
    assert nearest_to_utopia(np.array(costs)) is None
