"""Formulas whose target is a sum: of enumerated formulas, of pairs of them, of products of two."""

from typing import NamedTuple

import numpy as np

from gpsynth.arrays import Floats
from gpsynth.regression.expressions import Expression
from gpsynth.regression.selection import (
    Columns,
    Indices,
    Products,
    Subset,
    best_products,
    centered,
    pairs,
    products_of,
    select,
)
from gpsynth.regression.state import TERMS, WIDTH, Shelf, State
from gpsynth.regression.targets import Target

PAIRED = 5000  # columns of which all pairs are tried
MULTIPLIED = 300  # products that become columns at a time
EXACT = 1e-16


def greedy(state: State, shelf: Shelf, target: Target) -> None:
    """The best sums by forward selection."""
    subsets = select(shelf.columns, target.values[state.rows], terms=TERMS, width=WIDTH)
    state.evaluations += len(shelf.columns.unit)
    state.consider_sums(subsets, shelf.expression, target, f"sums of {shelf.name}")


def exhaustive(state: State, shelf: Shelf, target: Target, most: int = PAIRED) -> None:
    """The best sums of two, of all pairs there are; and of three beside each of the best single ones."""
    values = target.values[state.rows]
    columns = Columns(shelf.columns.unit[:most], shelf.columns.formula[:most])
    found = [Subset((i, j), rest) for i, j, rest in pairs(columns, values, np.empty((0, len(values))), 4)]
    few = Columns(columns.unit[: most // 3], columns.formula[: most // 3])
    for single in select(few, values, terms=1, width=6):
        if state.late:
            break
        given = few.unit[list(single.columns)]
        triples = pairs(few, values, given, 1)
        found += [Subset((*single.columns, i, j), rest * single.rest) for i, j, rest in triples]
    state.evaluations += len(columns.unit) ** 2 // 2
    state.consider_sums(found, shelf.expression, target, f"pairs of {shelf.name}")


class Multiples(NamedTuple):
    """Products of a formula of one shelf and one of another."""

    few: Shelf
    many: Shelf
    left: Indices  # formulas of `few`
    right: Indices
    products: Products


def multiples(few: Shelf, many: Shelf) -> Multiples:
    """All products of two formulas."""
    left, right = (np.flatnonzero(shelf.library.costs > 0) for shelf in (few, many))
    return Multiples(
        few, many, left, right, products_of(few.library.values[left], many.library.values[right])
    )


def multiplied(state: State, multiples: Multiples, target: Target) -> None:
    """Sums in which terms may be products of a formula of `few` and one of `many`, found on what is left each time."""
    values = target.values[state.rows]
    few, many, left, right, pairs_of_factors = multiples
    residual = values - values.mean()
    made: list[tuple[int, int]] = []
    subsets: list[Subset] = []
    together = few.columns
    least = 1.0
    for terms in range(1, TERMS):
        norm = float(np.sqrt(residual @ residual))
        if norm == 0.0:
            return
        if state.late:
            break
        made = list(dict.fromkeys(made + best_products(pairs_of_factors, residual / norm, MULTIPLIED)))
        state.evaluations += len(left) * len(right)
        if not made:
            break
        unit, varies = centered(_made(multiples, made))
        kept = np.flatnonzero(varies)
        together = Columns(
            np.concatenate((few.columns.unit, unit[kept])), np.concatenate((few.columns.formula, -1 - kept))
        )
        subsets = select(together, values, terms=TERMS, width=WIDTH)
        best = min((s for s in subsets if len(s.columns) <= terms), key=lambda s: s.rest, default=None)
        if best is None:
            break
        if min(s.rest for s in subsets) < EXACT or best.rest > 0.9 * least:
            break
        least = best.rest
        residual = _left_over(together.unit[list(best.columns)], values)

    def expression(column: int) -> Expression:
        index = int(together.formula[column])
        if index >= 0:
            return few.library.expression(index)
        i, j = made[-1 - index]
        return ("mul", few.library.expression(int(left[i])), many.library.expression(int(right[j])))

    state.consider_sums(subsets, expression, target, f"products of {few.name} and {many.name}")


def _made(multiples: Multiples, made: list[tuple[int, int]]) -> Floats:
    i, j = np.array(made).T
    few, many = multiples.few.library.values, multiples.many.library.values
    made_of: Floats = few[multiples.left[i]] * many[multiples.right[j]]
    return made_of


def _left_over(columns: Floats, values: Floats) -> Floats:
    residual = values - values.mean()
    solution = np.linalg.lstsq(columns.T, residual, rcond=None)[0]
    left: Floats = residual - solution @ columns
    return left
