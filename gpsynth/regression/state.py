"""What a search knows: the data, the rows that columns are chosen on, and the front of what was found."""

import math
import time
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from gpsynth.arrays import Floats
from gpsynth.regression import linear
from gpsynth.regression.expressions import Expression, evaluate, number, size, variable
from gpsynth.regression.front import EXACT, Candidate, Front
from gpsynth.regression.library import Library
from gpsynth.regression.polish import HOPE, Data, fit_numbers, polish
from gpsynth.regression.selection import Columns, Subset, columns_of
from gpsynth.regression.targets import Target

ROWS = 128  # that columns are chosen on; the winners are fitted on all
TERMS = 6
WIDTH = 12


class Shelf(NamedTuple):
    """A library, the columns of least squares it gives, and its name in reports."""

    library: Library
    columns: Columns
    name: str

    def expression(self, column: int) -> Expression:
        """The formula of a column."""
        return self.library.expression(int(self.columns.formula[column]))


def shelf(library: Library, limit: int, name: str) -> Shelf:
    """The first `limit` formulas of a library."""
    part = library.first(limit)
    return Shelf(part, columns_of(part.values), f"{name} {limit}")


class State:
    """The state of a search; methods add to it."""

    def __init__(
        self,
        data: Data,
        functions: frozenset[str],
        rng: np.random.Generator,
        library: int = 20_000,
        front: Front | None = None,
    ) -> None:
        self.data, self.functions, self.rng = data, functions, rng
        count = len(data.inputs)
        self.rows = np.sort(rng.permutation(count)[:ROWS])
        self.y: Floats = data.y[:count]
        self.library = library
        self.front = front or Front()
        self.loosened: set[Expression] = set()
        self.evaluations = 0
        self.deadline = math.inf  # processor time
        self.found: list[tuple[int, str, float]] = []  # evaluations, what found it, error

    @property
    def done(self) -> bool:
        """Whether what is left is rounding."""
        return self.front.error < EXACT

    @property
    def late(self) -> bool:
        """Whether the time is up; what takes long looks at it on its way and stops with what it has."""
        return self.deadline < math.inf and time.process_time() >= self.deadline

    def members(self) -> list[Candidate]:
        """The front; where there was nothing to explain it is the mean."""
        return self.front.members() or [self._constant()]

    def _constant(self) -> Candidate:
        weights = self.data.weights[: len(self.y)]
        return Candidate(number(float(weights @ self.y / weights.sum())), 0.0, 1)

    def consider(
        self, expressions: Sequence[Expression], source: str, *, iterations: int = 12, hope: float = HOPE
    ) -> list[Candidate]:
        """Polish formulas of y and put them into the front."""
        before = self.front.error
        polished = polish(expressions, self.data, self.front, iterations=iterations, hope=hope)
        candidates = self._completed(polished, iterations)
        self.front.add(candidates)
        self.evaluations += len(expressions)
        if self.front.error < before:
            self.found.append((self.evaluations, source, self.front.error))
        return candidates

    def _completed(self, candidates: list[Candidate], iterations: int) -> list[Candidate]:
        """The candidates, with a multiple of each input added that they need and do not read."""
        missing = [(each.expression, self.front.missing(each.expression)) for each in candidates]
        if not any(inputs for _, inputs in missing):
            return candidates
        whole = [_with_inputs(expression, inputs) for expression, inputs in missing]
        return [Candidate(e, error, size(e)) for e, error in fit_numbers(whole, self.data, iterations)]

    def consider_sums(
        self, subsets: Sequence[Subset], expression: Callable[[int], Expression], target: Target, source: str
    ) -> None:
        """The sums of these subsets of columns, for the target."""
        found = []
        for subset in promising(subsets):
            expressions = [expression(column) for column in subset.columns]
            terms = evaluate(expressions, self.data.inputs)
            if np.all(np.isfinite(terms)):
                found.append(linear.sum_of(expressions, terms, target))
        self.consider(found, f"{source} of {target.name}")


def _with_inputs(expression: Expression, inputs: Sequence[int]) -> Expression:
    for column in inputs:
        expression = ("add", expression, ("mul", number(0.0), variable(column)))
    return expression


def promising(subsets: Sequence[Subset], each: int = 2) -> list[Subset]:
    """The best `each` of each size, while a larger one is clearly better than a smaller one."""
    chosen: list[Subset] = []
    least = np.inf
    for terms in sorted({len(subset.columns) for subset in subsets}):
        of_size = sorted((s for s in subsets if len(s.columns) == terms), key=lambda s: s.rest)
        if of_size[0].rest < 0.7 * least:
            chosen += [s for s in of_size[:each] if s.rest < 2.0 * of_size[0].rest or s.rest < 1e-13]
            least = of_size[0].rest
    return chosen
