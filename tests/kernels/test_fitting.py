"""Derivatives against mpmath's, Levenberg-Marquardt against scipy's."""

import mpmath
import numpy as np
import pytest
from scipy.optimize import least_squares

from gpsynth.kernels.data_code import BINARY, NAMES
from gpsynth.regression.expressions import Expression, evaluate, numbers
from gpsynth.regression.polish import data_of, fit_numbers

MP = {
    "add": lambda a, b: a + b,
    "sub": lambda a, b: a - b,
    "mul": lambda a, b: a * b,
    "div": lambda a, b: a / b,
    "neg": lambda a: -a,
    "abs": abs,
    "half": lambda a: a / 2,
    "double": lambda a: 2 * a,
    "square": lambda a: a * a,
    "cube": lambda a: a**3,
    "max": max,
    "min": min,
    **{name: getattr(mpmath, name) for name in ("sqrt", "sin", "cos", "atan", "exp", "log", "tanh")},
}
X = ("variable", 0)


def derivative(expression: Expression, x: float) -> float:
    """By the only number of an expression, from one step of linearize: slope = residual * derivative."""
    from gpsynth.kernels import fitting
    from gpsynth.kernels.layout import readonly
    from gpsynth.regression.expressions import flatten
    from gpsynth.regression.polish import code_of

    flat = flatten([expression])
    data = data_of(np.array([[x]]), np.array([0.25]), np.ones(1))
    errors, slopes, normals = (
        np.zeros(1),
        np.zeros((1, fitting.MOST)),
        np.zeros((1, fitting.MOST, fitting.MOST)),
    )
    fitting.linearize(
        readonly(code_of(flat)),
        *(
            readonly(flat.population.numbers),
            readonly(flat.firsts),
            readonly(flat.population.roots + np.int32(1)),
        ),
        *(readonly(flat.places), readonly(flat.ends), data.columns, data.y, data.weights),
        *(np.ones(1, dtype=np.int32), True, errors, slopes, normals),
    )
    residual = evaluate([expression], np.array([[x]]))[0, 0] - 0.25
    return float(slopes[0, 0] / residual)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("c", [0.3, 1.7])
def test_derivatives_are_those_of_the_function(name: str, c: float) -> None:
    trees = (
        [(name, ("number", c), X), (name, X, ("number", c))] if name in BINARY else [(name, ("number", c))]
    )
    for tree in trees:
        outer = ("mul", ("sin", tree), ("variable", 0))

        def value(number: mpmath.mpf, tree: Expression = tree) -> mpmath.mpf:
            operands = [number if operand[0] == "number" else mpmath.mpf(0.9) for operand in tree[1:]]
            return mpmath.sin(MP[name](*operands)) * mpmath.mpf(0.9)

        assert derivative(outer, 0.9) == pytest.approx(
            float(mpmath.diff(value, mpmath.mpf(c))), rel=1e-12, abs=1e-14
        )


CASES = {
    "decay": (
        ("add", ("mul", ("number", 1.0), ("exp", ("mul", ("number", -0.5), X))), ("number", 0.0)),
        lambda p, x: p[0] * np.exp(p[1] * x) + p[2],
        (2.5, -1.3, 0.7),
    ),
    "wave": (
        ("mul", ("number", 1.0), ("sin", ("add", ("mul", ("number", 1.0), X), ("number", 0.1)))),
        lambda p, x: p[0] * np.sin(p[1] * x + p[2]),
        (3.0, 1.4, 0.6),
    ),
    "ratio": (
        ("div", ("number", 1.0), ("add", ("number", 1.0), ("mul", ("number", 0.5), ("square", X)))),
        lambda p, x: p[0] / (p[1] + p[2] * x * x),
        (2.0, 1.0, 0.8),
    ),
}


@pytest.mark.parametrize("case", CASES)
def test_fits_come_to_where_scipy_comes(case: str) -> None:
    tree, function, truth = CASES[case]
    rng = np.random.default_rng(5)
    x = np.linspace(0.0, 3.0, 60)
    y = function(truth, x) + 0.05 * rng.normal(size=60)
    weights = rng.uniform(0.5, 2.0, 60)
    weights /= weights.mean()
    found, error = fit_numbers([tree], data_of(x[:, None], y, weights), 200)[0]
    solution = least_squares(
        lambda p: np.sqrt(weights) * (function(p, x) - y),
        list(numbers(tree)),
        xtol=1e-15,
        ftol=1e-15,
        gtol=1e-15,
    )
    total = float(weights @ (y - weights @ y / 60) ** 2)
    assert error == pytest.approx(2.0 * solution.cost / total, rel=1e-9)
    values = evaluate([found], x[:, None])[0]
    assert values == pytest.approx(function(solution.x, x), abs=1e-6)


def test_many_expressions_are_fitted_as_each_alone() -> None:
    x = np.linspace(0.1, 3.0, 41)
    data = data_of(x[:, None], np.sqrt(x) + np.sin(2 * x), np.ones(41))
    trees = [tree for tree, _, _ in CASES.values()]
    assert fit_numbers(trees, data, 9) == [fit_numbers([tree], data, 9)[0] for tree in trees]


def test_an_expression_that_is_not_finite_keeps_its_numbers() -> None:
    tree = ("log", ("sub", ("number", -1.0), X))
    data = data_of(np.ones((9, 1)), np.arange(9.0), np.ones(9))
    assert fit_numbers([tree], data, 5) == [(tree, np.inf)]
