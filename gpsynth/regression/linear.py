"""From chosen columns to formulas of y: sums for a target, quotients of sums, products of powers."""

import math
from collections.abc import Iterator, Sequence

import numpy as np

from gpsynth.arrays import Floats
from gpsynth.regression.algebra import simplify, total
from gpsynth.regression.expressions import Expression, number
from gpsynth.regression.polish import nearest_plain
from gpsynth.regression.targets import Target


def coefficients(terms: Floats, target: Floats) -> tuple[Floats, float]:
    """Least-squares coefficients of terms (k, n) and the constant, for a target (n,)."""
    matrix = np.column_stack((terms.T, np.ones(len(target))))
    scale = np.sqrt(np.einsum("ij,ij->j", matrix, matrix))
    scale[scale == 0.0] = 1.0
    solution = np.linalg.lstsq(matrix / scale, target, rcond=1e-13)[0] / scale
    return solution[:-1], float(solution[-1])


def sum_of(expressions: Sequence[Expression], terms: Floats, target: Target) -> Expression:
    """The formula of y whose target is the best sum of these expressions, with values terms (k, n)."""
    factors, constant = coefficients(terms, target.values)
    size = float(np.abs(target.values).max())
    if abs(constant) < 1e-9 * size:
        constant = 0.0
    kept = [
        (_settled(float(c)), e)
        for c, e, values in zip(factors, expressions, terms, strict=True)
        if abs(c) * float(np.abs(values).max()) > 1e-10 * size
    ]
    return simplify(target.inverse(total(kept, _settled(constant))))


def quotient_of(
    above: Sequence[Expression], below: Sequence[Expression], terms: Floats, target: Target
) -> Expression:
    """The formula with target (c0 + sum c_i above_i) / (1 + sum d_k below_k); terms are above, then target * below."""
    factors, constant = coefficients(terms, target.values)
    split = len(above)
    numerator = total(
        [(_settled(float(c)), e) for c, e in zip(factors[:split], above, strict=True)], constant
    )
    denominator = total([(_settled(-float(c)), e) for c, e in zip(factors[split:], below, strict=True)], 1.0)
    return simplify(target.inverse(("div", numerator, denominator)))


def power_product(bases: Sequence[Expression], exponents: Sequence[float]) -> Expression | None:
    """The product of bases to powers that are multiples of 1/2; None if one is not."""
    above: Expression | None = None
    below: Expression | None = None
    roots_above: Expression | None = None
    roots_below: Expression | None = None
    for base, exponent in zip(bases, exponents, strict=True):
        doubled = round(2.0 * exponent)
        if doubled == 0 or abs(doubled) > 12 or abs(2.0 * exponent - doubled) > 1e-4:
            return None
        whole, rooted = divmod(abs(doubled), 2)
        for _ in range(whole):
            if exponent > 0:
                above = base if above is None else ("mul", above, base)
            else:
                below = base if below is None else ("mul", below, base)
        if rooted and exponent > 0:
            roots_above = base if roots_above is None else ("mul", roots_above, base)
        elif rooted:
            roots_below = base if roots_below is None else ("mul", roots_below, base)
    root = _quotient(roots_above, roots_below)
    if root is not None:
        rooted_part: Expression = ("sqrt", root)
        above = rooted_part if above is None else ("mul", above, rooted_part)
    return simplify(_quotient(above, below) or number(1.0))


def _settled(value: float) -> float:
    return nearest_plain(value, 1e-9) if abs(value) > 1e-9 else value


def _quotient(above: Expression | None, below: Expression | None) -> Expression | None:
    if below is None:
        return above
    return ("div", above if above is not None else number(1.0), below)


def monomials(columns: Floats, degree: int, most: int) -> Iterator[tuple[Expression | None, Floats]]:
    """Products of the columns (n, m) up to a total degree, while there are at most `most`; None stands for 1."""
    from itertools import combinations_with_replacement

    m = columns.shape[1]
    count = 0
    for total_degree in range(degree + 1):
        if math.comb(m + total_degree, total_degree) > most:
            return
        for factors in combinations_with_replacement(range(m), total_degree):
            expression: Expression | None = None
            for j in factors:
                expression = ("variable", j) if expression is None else ("mul", expression, ("variable", j))
            count += 1
            yield expression, np.prod(columns[:, list(factors)], axis=1)
