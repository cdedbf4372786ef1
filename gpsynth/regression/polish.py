"""Numbers of finished structures: Levenberg-Marquardt on all rows, then plain numbers where they fit as well."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from gpsynth.arrays import Floats, Ints
from gpsynth.kernels import fitting
from gpsynth.kernels.data_code import CONSTANT, FILL
from gpsynth.kernels.layout import readonly
from gpsynth.kernels.vectors import WIDTH
from gpsynth.regression.algebra import simplify
from gpsynth.regression.expressions import Expression, Flat, flatten, numbers, size, with_numbers
from gpsynth.regression.factoring import compact
from gpsynth.regression.front import Candidate, Front

LONGEST = 120  # nodes
HOPE = 0.1  # a fit may bring the error down to this share
_DENOMINATORS = (1, 2, 3, 4, 5, 6, 8, 10, 12)
NEAR = (1e-2, 1e-4, 1e-6, 1e-9)  # how far a plain number may be, as a share


class Data(NamedTuple):
    """Rows to fit, padded to the machine's width with rows of weight zero."""

    inputs: Floats  # (n, m)
    columns: Floats  # (m, N)
    y: Floats  # (N,)
    weights: Floats  # (N,) mean 1 over the rows
    total: float  # weighted squared deviation of y from its mean


def data_of(inputs: Floats, y: Floats, weights: Floats) -> Data:
    """Rows for the kernels."""
    padding = -len(inputs) % WIDTH
    columns = np.pad(inputs, ((0, padding), (0, 0)), mode="edge").T
    scaled = weights * (len(weights) / weights.sum())
    total = float(scaled @ (y - (scaled @ y) / len(y)) ** 2)
    return Data(
        inputs,
        readonly(np.ascontiguousarray(columns)),
        readonly(np.pad(y, (0, padding), mode="edge")),
        readonly(np.pad(scaled, (0, padding))),
        total,
    )


def fit_numbers(
    expressions: Sequence[Expression], data: Data, iterations: int
) -> list[tuple[Expression, float]]:
    """Each expression with its numbers improved, and its error; no iterations only measures."""
    if not expressions:
        return []
    flat = flatten(expressions)
    values = flat.population.numbers.copy()
    spans = readonly(flat.firsts), readonly(flat.population.roots + np.int32(1))
    rows = data.columns, data.y, data.weights
    places, ends = readonly(flat.places), readonly(flat.ends)
    errors = fitting.fit(readonly(code_of(flat)), values, spans, places, ends, rows, iterations)
    fitted, begin = [], 0
    for expression, end, error in zip(expressions, flat.ends, errors, strict=True):
        found = iter(values[flat.places[begin:end]].tolist())
        fitted.append((with_numbers(expression, found), float(error) / data.total))
        begin = end
    return fitted


def polish(
    expressions: Sequence[Expression], data: Data, front: Front, *, iterations: int = 12, hope: float = HOPE
) -> list[Candidate]:
    """What is worth a place in the front: fitted, rounded to plain numbers where that costs nothing, simplified.

    A formula is fitted only if it would come in with its error times `hope`.
    """
    short = [e for e in dict.fromkeys(map(simplify, expressions)) if size(e) <= LONGEST]
    measured = fit_numbers(short, data, 0)
    hopeful = [e for e, error in measured if front.admits(size(e), hope * error)]
    fitted = [
        (e, error) for e, error in fit_numbers(hopeful, data, iterations) if front.admits(size(e), error)
    ]
    rounded = [simplify(_plain(e, near)) for e, _ in fitted for near in NEAR]
    plain = fit_numbers(rounded, data, 0)
    candidates = []
    for k, (expression, error) in enumerate(fitted):
        trials = plain[k * len(NEAR) : (k + 1) * len(NEAR)]
        best, value = next((t for t in trials if t[1] <= 1.01 * error + 1e-26), (expression, error))
        candidates.append(Candidate(best, value, size(best)))
    return [*candidates, *_compacted(candidates, data)]


def _compacted(candidates: Sequence[Candidate], data: Data) -> list[Candidate]:
    """Smaller forms of the candidates that are as good."""
    smaller = [(c, compact(c.expression)) for c in candidates]
    smaller = [(c, e) for c, e in smaller if size(e) < c.size]
    measured = fit_numbers([e for _, e in smaller], data, 0)
    return [
        Candidate(e, error, size(e))
        for (candidate, _), (e, error) in zip(smaller, measured, strict=True)
        if error <= 1.01 * candidate.error + 1e-26
    ]


def code_of(flat: Flat) -> Ints:
    """Instructions of the data machine for trees whose numbers change: each position has its own row."""
    whole = flat.population
    positions = np.arange(len(whole.ops), dtype=np.int32)
    ops = np.where(whole.ops == CONSTANT, FILL, whole.ops)
    return np.ascontiguousarray(np.stack((ops, positions, whole.a, whole.b), axis=1), dtype=np.int32)


def _plain(expression: Expression, near: float) -> Expression:
    return with_numbers(expression, iter([nearest_plain(value, near) for value in numbers(expression)]))


def nearest_plain(value: float, near: float) -> float:
    """An integer, a fraction with a small denominator or such a multiple of pi, if one is near; else the value."""
    if abs(value) <= 0.1 * near:
        return 0.0
    if not math.isfinite(value):
        return value
    for unit in (1.0, math.pi):
        ratio = value / unit
        for denominator in _DENOMINATORS if abs(ratio) < 1e6 else ():
            nearest = round(ratio * denominator)
            if nearest and abs(ratio * denominator - nearest) <= near * abs(ratio):
                return nearest / denominator * unit
    decimal = float(f"{value:.3g}")
    return decimal if abs(value - decimal) <= 0.01 * near * abs(value) else value
