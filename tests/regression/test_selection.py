"""Selection of columns against brute force with numpy's least squares."""

import itertools

import numpy as np

from gpsynth.arrays import Floats
from gpsynth.regression.selection import best_products, columns_of, pairs, products_of, select


def rest(columns: Floats, target: Floats) -> float:
    """What columns (k, r) and a constant leave of a target, as a share of its deviation."""
    matrix = np.column_stack((columns.T, np.ones(len(target))))
    left = target - matrix @ np.linalg.lstsq(matrix, target, rcond=None)[0]
    return float(left @ left / np.sum((target - target.mean()) ** 2))


def test_the_best_pair_is_that_of_all_pairs() -> None:
    rng = np.random.default_rng(1)
    values, target = rng.normal(size=(40, 25)), rng.normal(size=25)
    columns = columns_of(values)
    found = pairs(columns, target, np.empty((0, 25)), 3)
    everything = sorted(
        (rest(values[list(pair)], target), pair) for pair in itertools.combinations(range(40), 2)
    )
    assert [(i, j) for i, j, _ in found] == [pair for _, pair in everything[:3]]
    assert np.allclose([r for _, _, r in found], [r for r, _ in everything[:3]], rtol=1e-9)


def test_the_best_pair_beside_given_columns() -> None:
    rng = np.random.default_rng(2)
    values, target = rng.normal(size=(20, 25)), rng.normal(size=25)
    given = values[[4]]
    i, j, _ = pairs(columns_of(values), target, given, 1)[0]
    others = [k for k in range(20) if k != 4]
    best = min(itertools.combinations(others, 2), key=lambda pair: rest(values[[4, *pair]], target))
    assert (i, j) == best


def test_the_best_product_is_that_of_all_products() -> None:
    rng = np.random.default_rng(3)
    few, many, target = rng.normal(size=(8, 30)), rng.normal(size=(300, 30)), rng.normal(size=30)
    residual = target - target.mean()
    found = best_products(products_of(few, many), residual / np.linalg.norm(residual), 5)
    everything = sorted((rest(few[[i]] * many[[j]], target), i, j) for i in range(8) for j in range(300))
    assert found[:3] == [(i, j) for _, i, j in everything[:3]]


def test_selected_subsets_leave_what_least_squares_leaves() -> None:
    rng = np.random.default_rng(4)
    values = rng.normal(size=(60, 40))
    target = values[7] - 2.0 * values[31] + 0.5 * values[50] + 3.0
    columns = columns_of(values)
    subsets = select(columns, target, terms=4, width=5)
    assert {*min(subsets, key=lambda subset: subset.rest).columns} >= {7, 31, 50}
    for subset in subsets:
        assert abs(subset.rest - rest(values[list(columns.formula[list(subset.columns)])], target)) < 1e-10


def test_fewer_columns_than_terms_are_all_selected() -> None:
    rng = np.random.default_rng(6)
    columns, target = columns_of(rng.normal(size=(2, 25))), rng.normal(size=25)
    sizes = [len(subset.columns) for subset in select(columns, target, terms=6, width=5)]
    assert sizes == [1, 1, 2]


def test_columns_that_differ_by_shift_and_scale_are_one() -> None:
    values = np.random.default_rng(5).normal(size=(3, 20))
    more = np.concatenate((values, 2.0 - 3.0 * values, np.ones((1, 20))))
    assert columns_of(more).formula.tolist() == [0, 1, 2]
