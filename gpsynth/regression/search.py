"""The search: enumerated formulas as columns of least-squares problems, for y and for invertible functions of it."""

import time
from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from gpsynth.arrays import Floats
from gpsynth.regression import linear
from gpsynth.regression.expressions import Expression, evaluate
from gpsynth.regression.front import EXACT, Front
from gpsynth.regression.library import Library, enumerate_formulas
from gpsynth.regression.polish import Candidate, Data, polish
from gpsynth.regression.selection import Columns, Subset, centered, columns_of, products, select
from gpsynth.regression.targets import Target, derived, plain

ROWS = 100  # that columns are chosen on; the winners are fitted on all
ARITHMETIC = frozenset(("add", "sub", "mul", "div"))
TERMS = 5
WIDTH = 12


class Setting(NamedTuple):
    """What a search works on."""

    data: Data
    functions: frozenset[str]
    rng: np.random.Generator


class Shelf(NamedTuple):
    """A library with its columns."""

    library: Library
    columns: Columns


class Search:
    """A search that can go on; `front` is what it has found."""

    def __init__(self, setting: Setting) -> None:
        self.data, self.functions, self.rng = setting
        self.front = Front()
        self.evaluations = 0
        n = len(self.data.inputs)
        self.rows = np.sort(self.rng.permutation(n)[:ROWS])
        self.y = self.data.y[:n]
        self.targets = [plain(self.y)]
        self.log: list[str] = []

    def consider(self, expressions: list[Expression], source: str = "") -> list[Candidate]:
        """Polish formulas of y and put them into the front."""
        before = self.front.error
        candidates = polish(expressions, self.data)
        self.front.add(candidates)
        self.evaluations += len(expressions)
        if self.front.error < 0.1 * before:
            self.log.append(f"{time.process_time():.2f} {source}: {before:.2e} -> {self.front.error:.2e}")
        return candidates

    @property
    def done(self) -> bool:
        return self.front.error < EXACT

    def steps(self) -> Iterator[None]:
        """The search, one small step after the other."""
        inputs = self.data.inputs[self.rows]
        levels = [plain(self.y)]
        levels = levels + [t for t in derived(levels[0], self.data.inputs, self.functions)]
        yield from self._dense(levels)
        full = enumerate_formulas(inputs, self.functions, 20_000)
        arithmetic = enumerate_formulas(inputs, self.functions & ARITHMETIC, 5_000)
        shelves = [
            shelf
            for limit in (300, 3000, 20_000)
            for shelf in (_shelf(full, limit), *((_shelf(arithmetic, limit),) if limit == 3000 else ()))
        ]
        yield
        for shelf in shelves:
            for target in levels:
                self._sums(shelf, target)
                yield
        for shelf in shelves[1:]:
            self._powers(shelf)
            yield
        for target in levels:
            self._products(shelves[1], target)
            yield
        for shelf in shelves[:3]:
            for target in levels:
                self._quotients(shelf, target)
                yield
        second = [t for level in levels[1:] for t in derived(level, self.data.inputs, self.functions)]
        for shelf in shelves:
            for target in second:
                self._sums(shelf, target)
                yield
        for target in second:
            self._products(shelves[1], target)
            yield

    def _sums(self, shelf: Shelf, target: Target, extra: list[tuple[int, int]] | None = None) -> None:
        subsets = select(shelf.columns, target.values[self.rows], terms=TERMS, width=WIDTH)
        self.evaluations += len(shelf.columns.unit)
        self._consider_subsets(subsets, lambda k: shelf.library.expression(int(shelf.columns.index[k])), target, "sum")

    def _consider_subsets(
        self, subsets: list[Subset], expression: Callable[[int], Expression], target: Target, source: str
    ) -> None:
        found = []
        for subset in _promising(subsets):
            expressions = [expression(k) for k in subset.columns]
            terms = evaluate(expressions, self.data.inputs)
            if np.all(np.isfinite(terms)):
                found.append(linear.sum_of(expressions, terms, target))
        self.consider(found, f"{source} {target.name}")

    def _products(self, shelf: Shelf, target: Target, rounds: int = 3) -> None:
        values = target.values[self.rows]
        some = np.flatnonzero(shelf.library.costs > 0)[:2500]
        base = shelf.library.values[some]
        residual = values - values.mean()
        pairs: list[tuple[int, int]] = []
        for _ in range(rounds):
            norm = np.sqrt(residual @ residual)
            if norm == 0.0:
                return
            pairs += products(base, residual / norm, 200)
            pairs = list(dict.fromkeys(pairs))
            made = np.array([base[i] * base[j] for i, j in pairs])
            unit, varies = centered(made)
            kept = [k for k, ok in enumerate(varies) if ok]
            together = Columns(
                np.concatenate((shelf.columns.unit, unit[kept])),
                np.concatenate((shelf.columns.index, -1 - np.array(kept))),
            )
            subsets = select(together, values, terms=TERMS, width=WIDTH)
            self.evaluations += len(some) ** 2 // 2

            def expression(k: int, together: Columns = together, pairs: list[tuple[int, int]] = pairs) -> Expression:
                index = int(together.index[k])
                if index >= 0:
                    return shelf.library.expression(index)
                i, j = pairs[-1 - index]
                return ("mul", shelf.library.expression(int(some[i])), shelf.library.expression(int(some[j])))

            self._consider_subsets(subsets, expression, target, "products")
            if self.done or not subsets:
                return
            few = min((s for s in subsets if len(s.columns) <= 2), key=lambda s: s.rest)
            columns = together.unit[list(few.columns)]
            solution = np.linalg.lstsq(columns.T, residual, rcond=None)[0]
            residual = values - values.mean() - solution @ columns

    def _powers(self, shelf: Shelf) -> None:
        """y as a product of powers: log |y| as a sum of log |formula|."""
        if np.any(self.y == 0.0):
            return
        with np.errstate(all="ignore"):
            logs = np.log(np.abs(shelf.library.values))
        usable = np.flatnonzero(np.all(np.isfinite(logs), axis=1))
        columns = columns_of(logs[usable])
        target = np.log(np.abs(self.y[self.rows]))
        subsets = select(columns, target, terms=TERMS, width=WIDTH)
        self.evaluations += len(columns.unit)
        found: list[Expression] = []
        for subset in _promising(subsets):
            chosen = usable[columns.index[list(subset.columns)]]
            exponents, _ = linear.coefficients(logs[chosen], target)
            product = linear.power_product([shelf.library.expression(int(k)) for k in chosen], exponents.tolist())
            if product is None:
                continue
            value = evaluate([product], self.data.inputs)
            if np.all(np.isfinite(value)):
                found.append(linear.sum_of([product], value, plain(self.y)))
        self.consider(found, "powers")

    def _quotients(self, shelf: Shelf, target: Target) -> None:
        values = target.values[self.rows]
        times = values * shelf.library.values[shelf.columns.index]
        unit, varies = centered(times)
        kept = np.flatnonzero(varies)
        count = len(shelf.columns.unit)
        together = Columns(np.concatenate((shelf.columns.unit, unit[kept])), np.arange(count + len(kept)))
        subsets = select(together, values, terms=TERMS, width=WIDTH)
        self.evaluations += len(together.unit)
        found = []
        for subset in _promising(subsets):
            above = [self._column(shelf, k) for k in subset.columns if k < count]
            below = [self._column(shelf, int(kept[k - count])) for k in subset.columns if k >= count]
            if not below:
                continue
            terms = evaluate([*above, *below], self.data.inputs)
            terms[len(above) :] *= target.values
            if np.all(np.isfinite(terms)):
                found.append(linear.quotient_of(above, below, terms, target))
        self.consider(found, f"quotient {target.name}")

    def _column(self, shelf: Shelf, k: int) -> Expression:
        return shelf.library.expression(int(shelf.columns.index[k]))

    def _dense(self, targets: list[Target]) -> Iterator[None]:
        """Polynomials and rational functions by least squares over all monomials, small terms dropped."""
        n = len(self.y)
        basis = list(linear.monomials(self.data.inputs, 8, min(n // 2, 130)))[1:]
        if not basis:
            return
        terms = np.array([values for _, values in basis])
        expressions = [e for e, _ in basis if e is not None]
        for target in targets:
            for count in _counts(len(basis), self.data.inputs.shape[1]):
                factors, constant = linear.coefficients(terms[:count], target.values)
                rest = target.values - factors @ terms[:count] - constant
                spread = target.values - target.values.mean()
                if rest @ rest < 1e-18 * (spread @ spread):
                    sizes = np.abs(factors) * np.abs(terms[:count]).max(axis=1)
                    kept = np.flatnonzero(sizes > 1e-7 * np.abs(target.values).max())
                    self.consider(
                        [linear.sum_of([expressions[k] for k in kept], terms[kept], target)], f"dense {target.name}"
                    )
                    break
            self.evaluations += len(basis)
            yield
            if self.done:
                return


def _counts(count: int, m: int) -> list[int]:
    from math import comb

    return [c for degree in range(1, 9) if (c := comb(m + degree, degree) - 1) <= count]


def _shelf(library: Library, limit: int) -> Shelf:
    part = Library(*(field[:limit] for field in library))
    return Shelf(part, columns_of(part.values))


def _promising(subsets: list[Subset]) -> list[Subset]:
    """The two best of each size."""
    chosen = []
    for terms in range(1, TERMS + 1):
        of_size = sorted((s for s in subsets if len(s.columns) == terms), key=lambda s: s.rest)
        chosen += of_size[:2]
    return chosen
