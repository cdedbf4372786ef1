"""Rewriting keeps the function; sizes, programs and enumerated formulas mean what they say."""

import numpy as np
import pytest

from gpsynth.regression.algebra import simplify
from gpsynth.regression.expressions import Expression, evaluate, number, program_of, size, variable
from gpsynth.regression.factoring import compact
from gpsynth.regression.library import enumerate_formulas, wrapped
from tests.regression.helpers import random_expression

NAMES = ("add", "sub", "mul", "div", "square", "exp", "log", "sqrt", "sin")
X, Y = variable(0), variable(1)


@pytest.mark.parametrize("rewriting", [simplify, compact])
def test_rewriting_keeps_the_function_and_never_grows_it(rewriting) -> None:
    rng = np.random.default_rng(6)
    rows = rng.uniform(0.5, 2.0, (50, 3))
    for _ in range(400):
        tree = random_expression(rng, int(rng.integers(2, 25)), 3, NAMES)
        before, after = evaluate([tree, rewriting(tree)], rows)
        largest = np.abs(before).max()
        if np.all(np.isfinite(before)) and largest < 1e6:
            assert after == pytest.approx(before, rel=1e-6, abs=1e-6 * largest)


def test_horners_scheme_is_found() -> None:
    power, total = X, X
    for _ in range(5):
        power = ("mul", power, X)
        total = ("add", total, power)
    assert size(total) == 41
    assert size(compact(total)) == 21


def test_a_common_factor_is_taken_out() -> None:
    tree: Expression = number(5.0)
    for j in range(3):
        tree = ("add", tree, ("mul", number(0.1), ("square", variable(j))))
        tree = ("sub", tree, ("mul", number(0.6), variable(j)))
    assert size(compact(("div", number(1.0), tree))) == 21  # 10 / (x (x - 6) + y (y - 6) + z (z - 6) + 50)


def test_logarithms_leave_an_exponential() -> None:
    tree = ("exp", ("add", ("log", ("sin", X)), ("log", ("cos", Y))))
    assert simplify(tree) == ("mul", ("sin", X), ("cos", Y))


def test_a_square_counts_as_the_product_it_stands_for() -> None:
    assert size(("square", ("add", X, Y))) == size(("mul", ("add", X, Y), ("add", X, Y))) == 7


def test_a_program_computes_the_expression() -> None:
    rows = np.random.default_rng(7).uniform(0.5, 2.0, (9, 2))
    tree = ("div", ("sin", ("mul", X, Y)), ("add", number(2.0), X))
    assert np.array_equal(program_of([tree], ("x", "y"), ("z",))(rows)[:, 0], evaluate([tree], rows)[0])


def test_enumerated_formulas_have_the_values_of_their_trees_and_none_is_there_twice() -> None:
    rows = np.random.default_rng(8).uniform(0.5, 2.0, (30, 2))
    library = enumerate_formulas(rows, frozenset(("add", "sub", "mul", "div", "sin", "exp", "log")), 2000)
    library = wrapped(library, frozenset(("sin", "exp")), 200)
    values = evaluate([library.expression(k) for k in range(len(library.ops))], rows)
    assert np.allclose(values, library.values, rtol=1e-10, atol=0.0)
    scaled = library.values / np.abs(library.values).max(axis=1, keepdims=True)
    distances = np.abs(scaled[:300, None] - scaled[None, :300]).max(axis=2) + np.eye(300)
    sizes = np.abs(library.values[:300]).max(axis=1)
    alike = (distances < 1e-10) & (np.abs(sizes[:, None] / sizes[None, :] - 1.0) < 1e-10)
    assert not alike.any()
