"""The linear model, polynomials, and what a target makes of them, by least squares over all monomials of a degree."""

from math import comb

import numpy as np

from gpsynth.arrays import Floats
from gpsynth.regression import linear
from gpsynth.regression.expressions import Expression, evaluate, variable
from gpsynth.regression.state import State
from gpsynth.regression.targets import Target

DEGREE = 8
MOST = 130  # monomials
MOST_VARIABLES = 20  # of a linear model
ENOUGH = 4  # rows for each monomial; what is no polynomial on them is none on all
EXACT = 1e-18
SMALL = 1e-7  # terms that contribute less are rounding


def polynomials(state: State, targets: list[Target]) -> None:
    """The linear model of y, and the polynomial of least degree that a target is exactly, if there is one."""
    count, m = state.data.inputs.shape
    if m < min(count - 1, MOST_VARIABLES):
        columns = np.ascontiguousarray(state.data.inputs.T)
        state.consider([linear.sum_of([variable(j) for j in range(m)], columns, targets[0])], "linear model")
    basis = _monomials(state.data.inputs[:1], min(count // 2, MOST))[0]
    if not basis:
        return
    some = np.linspace(0, count - 1, min(count, ENOUGH * len(basis))).astype(int)
    terms = _monomials(state.data.inputs[some], min(count // 2, MOST))[1]
    for target in targets:
        if state.late:
            return
        state.evaluations += len(basis)
        for number in _counts(len(basis), m):
            exact = _rest(terms[:number], target.values[some]) < EXACT
            if exact and _is_polynomial(state, target, basis[:number]):
                break


def _monomials(inputs: Floats, most: int) -> tuple[list[Expression], Floats]:
    """Monomials beside the constant, and their values (k, n)."""
    whole = [(e, values) for e, values in linear.monomials(inputs, DEGREE, most) if e is not None]
    return [expression for expression, _ in whole], np.array([values for _, values in whole])


def _rest(terms: Floats, values: Floats) -> float:
    """What the best sum of the terms leaves of the squares of values (n,), as a share; 0 if all values are equal."""
    if not np.isfinite(terms).all():  # a high power of a large number
        return np.inf
    factors, constant = linear.coefficients(terms, values)
    rest, spread = values - factors @ terms - constant, values - values.mean()
    return float(rest @ rest) / (float(spread @ spread) or np.inf)


def _is_polynomial(state: State, target: Target, monomials: list[Expression]) -> bool:
    """Whether a target is a sum of the monomials on all rows; then the sum is considered."""
    terms = evaluate(monomials, state.data.inputs)
    if not _rest(terms, target.values) < EXACT:
        return False
    factors, _ = linear.coefficients(terms, target.values)
    sizes = np.abs(factors) * np.abs(terms).max(axis=1)
    kept = np.flatnonzero(sizes > SMALL * np.abs(target.values).max())
    sums = linear.sum_of([monomials[k] for k in kept], terms[kept], target)
    state.consider([sums], f"polynomial of {target.name}")
    return True


def _counts(count: int, m: int) -> list[int]:
    """How many monomials there are up to each degree, the constant not counted."""
    return [number for degree in range(1, DEGREE + 1) if (number := comb(m + degree, degree) - 1) <= count]
