"""Formulas that are products of powers: log |y| is a sum of logarithms of enumerated formulas."""

import numpy as np

from gpsynth.regression import linear
from gpsynth.regression.expressions import Expression, evaluate
from gpsynth.regression.selection import Columns, Subset, columns_of, pairs, select
from gpsynth.regression.state import TERMS, WIDTH, Shelf, State, promising
from gpsynth.regression.targets import Target

PAIRED = 4000


def powers(state: State, shelf: Shelf, target: Target) -> None:
    """The best products of powers that are multiples of 1/2; the sign comes from the factors."""
    values = target.values[state.rows]
    if np.any(target.values == 0.0):
        return
    with np.errstate(all="ignore"):
        logs = np.log(np.abs(shelf.library.values))
    usable = np.flatnonzero(np.all(np.isfinite(logs), axis=1))
    columns = columns_of(logs[usable])
    goal = np.log(np.abs(values))
    subsets = select(columns, goal, terms=TERMS, width=WIDTH)
    few = Columns(columns.unit[:PAIRED], columns.formula[:PAIRED])
    subsets += [Subset((i, j), rest) for i, j, rest in pairs(few, goal, np.empty((0, len(goal))), 4)]
    for single in select(few, goal, terms=1, width=6):
        if state.late:
            break
        given = few.unit[list(single.columns)]
        some = Columns(few.unit[: PAIRED // 3], few.formula[: PAIRED // 3])
        subsets += [
            Subset((*single.columns, i, j), r * single.rest) for i, j, r in pairs(some, goal, given, 1)
        ]
    state.evaluations += len(few.unit) ** 2 // 2
    found: list[Expression] = []
    for subset in promising(subsets, each=4):
        chosen = usable[columns.formula[list(subset.columns)]]
        exponents, _ = linear.coefficients(logs[chosen], goal)
        product = linear.power_product([shelf.library.expression(int(k)) for k in chosen], exponents.tolist())
        if product is None:
            continue
        value = evaluate([product], state.data.inputs)
        if np.all(np.isfinite(value)):
            found.append(linear.sum_of([product], value, target))
    state.consider(found, f"powers of {shelf.name} of {target.name}")
