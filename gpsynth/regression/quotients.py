"""Formulas that are quotients: target (1 + sum d_k g_k) = c0 + sum c_i f_i is linear in the numbers."""

import numpy as np

from gpsynth.regression import linear
from gpsynth.regression.expressions import evaluate
from gpsynth.regression.selection import Columns, Subset, centered, pairs, select
from gpsynth.regression.state import TERMS, WIDTH, Shelf, State, promising
from gpsynth.regression.targets import Target

PAIRED = 2500


def quotients(state: State, shelf: Shelf, target: Target) -> None:
    """The best quotients of sums, by forward selection, and by all pairs beside the best single columns."""
    values = target.values[state.rows]
    unit, varies = centered(values * shelf.library.values[shelf.columns.formula])
    kept = np.flatnonzero(varies)
    count = len(shelf.columns.unit)
    origin = np.concatenate((np.arange(count), count + kept))
    together = Columns(np.concatenate((shelf.columns.unit, unit[kept])), origin)
    state.evaluations += len(origin)
    subsets = select(together, values, terms=TERMS, width=WIDTH)
    subsets += _pairs(together, values, min(count, PAIRED // 2), count)
    found = []
    for subset in promising(subsets):
        columns = [int(origin[k]) for k in subset.columns]
        above = [shelf.expression(k) for k in columns if k < count]
        below = [shelf.expression(k - count) for k in columns if k >= count]
        if not below:
            continue
        terms = evaluate([*above, *below], state.data.inputs)
        terms[len(above) :] *= target.values
        if np.all(np.isfinite(terms)):
            found.append(linear.quotient_of(above, below, terms, target))
    state.consider(found, f"quotients of {shelf.name} of {target.name}")


def _pairs(
    together: Columns, values: np.ndarray[tuple[int], np.dtype[np.float64]], few: int, count: int
) -> list[Subset]:
    """Pairs, and triples with one of the best single columns, among the first `few` above and below."""
    place = np.concatenate((np.arange(few), np.arange(count, min(count + few, len(together.unit)))))
    some = Columns(together.unit[place], place)
    found = [
        Subset((int(place[i]), int(place[j])), rest)
        for i, j, rest in pairs(some, values, np.empty((0, len(values))), 3)
    ]
    for single in select(some, values, terms=1, width=8):
        given = some.unit[list(single.columns)]
        found += [
            Subset(tuple(int(place[k]) for k in (*single.columns, i, j)), rest * single.rest)
            for i, j, rest in pairs(some, values, given, 1)
        ]
    return found
