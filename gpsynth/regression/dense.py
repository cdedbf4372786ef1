"""The linear model, polynomials, and what a target makes of them, by least squares over all monomials of a degree."""

from math import comb

import numpy as np

from gpsynth.regression import linear
from gpsynth.regression.expressions import Expression, variable
from gpsynth.regression.state import State
from gpsynth.regression.targets import Target

DEGREE = 8
MOST = 130  # monomials
MOST_VARIABLES = 20  # of a linear model
EXACT = 1e-18
SMALL = 1e-7  # terms that contribute less are rounding


def polynomials(state: State, targets: list[Target]) -> None:
    """The linear model of y, and the polynomial of least degree that a target is exactly, if there is one."""
    count, m = state.data.inputs.shape
    if m < min(count - 1, MOST_VARIABLES):
        columns = np.ascontiguousarray(state.data.inputs.T)
        state.consider([linear.sum_of([variable(j) for j in range(m)], columns, targets[0])], "linear model")
    basis = list(linear.monomials(state.data.inputs, DEGREE, min(count // 2, MOST)))[1:]
    if not basis:
        return
    terms = np.array([values for _, values in basis])
    expressions: list[Expression] = [expression for expression, _ in basis if expression is not None]
    for target in targets:
        state.evaluations += len(basis)
        spread = target.values - target.values.mean()
        for some in _counts(len(basis), m):
            factors, constant = linear.coefficients(terms[:some], target.values)
            rest = target.values - factors @ terms[:some] - constant
            if rest @ rest < EXACT * (spread @ spread):
                sizes = np.abs(factors) * np.abs(terms[:some]).max(axis=1)
                kept = np.flatnonzero(sizes > SMALL * np.abs(target.values).max())
                sums = linear.sum_of([expressions[k] for k in kept], terms[kept], target)
                state.consider([sums], f"polynomial of {target.name}")
                break


def _counts(count: int, m: int) -> list[int]:
    """How many monomials there are up to each degree, the constant not counted."""
    return [number for degree in range(1, DEGREE + 1) if (number := comb(m + degree, degree) - 1) <= count]
