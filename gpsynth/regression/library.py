"""A library of small formulas, enumerated from the cheapest on, each function once.

Two formulas with the same values on the rows at hand count as the same (semantic hashing); the cheaper one stays.
"""

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from gpsynth.arrays import Floats, Ints
from gpsynth.kernels.data_code import BINARY, CONSTANT, OPCODE, VARIABLE
from gpsynth.regression.expressions import Expression, number, variable

LEAF, STEP, SHIFT = (
    2,
    2,
    3,
)  # costs of a variable, of an operation, and of an operation with the number 1 or 2
LARGEST = 1e10
FARTHEST = 1e4  # arguments of sine and cosine beyond are noise
_UNARY = ("sqrt", "sin", "cos", "exp", "log", "tanh", "atan", "abs")
_VALUES = {
    "add": np.add,
    "sub": np.subtract,
    "mul": np.multiply,
    "div": np.divide,
    "square": np.square,
    "atan": np.arctan,
    "max": np.maximum,
    "min": np.minimum,
    **{name: getattr(np, name) for name in ("sqrt", "sin", "cos", "exp", "log", "tanh", "abs")},
}

Indices = npt.NDArray[np.int64]


class Library(NamedTuple):
    """Formulas that refer to each other: formula k is operation ops[k] of formulas a[k] and b[k]."""

    ops: Ints  # (N,)
    a: Ints  # (N,)
    b: Ints  # (N,)
    numbers: Floats  # (N,)
    costs: Ints  # (N,)
    values: Floats  # (N, r)

    def first(self, limit: int) -> "Library":
        """The cheapest formulas."""
        ops, a, b, numbers, costs, values = (field[:limit] for field in self)
        return Library(ops, a, b, numbers, costs, values)  # type: ignore[arg-type]

    def expression(self, index: int) -> Expression:
        """Formula `index` as a tree."""
        op = int(self.ops[index])
        if op == CONSTANT:
            return number(float(self.numbers[index]))
        if op <= VARIABLE:
            return variable(VARIABLE - op)
        name = _NAMES[op]
        operands = (self.a[index], self.b[index]) if name in BINARY else (self.a[index],)
        return (name, *(self.expression(int(operand)) for operand in operands))


def enumerate_formulas(
    rows: Floats, functions: frozenset[str], limit: int, late: Callable[[], bool] = lambda: False
) -> Library:
    """All formulas over the columns of rows (r, m) by rising cost until there are `limit` of them, or it is late."""
    growing = _Growing(rows)
    for cost in range(LEAF + STEP, 40):
        before = growing.count
        for name, a, b in _candidates(growing, functions, cost):
            if late():
                break
            growing.extend(name, a, b, cost, limit)
        growing.close(cost)
        if growing.count >= limit or late() or (growing.count == before and cost > 12):
            break
    return growing.library()


def wrapped(library: Library, functions: frozenset[str], limit: int) -> Library:
    """The functions of one operand of the first `limit` formulas of a library, behind that library."""
    growing = _Growing.of(library)
    below = np.flatnonzero(library.costs[:limit] > 0)
    for name in _UNARY:
        if name in functions:
            growing.extend(name, below, below, 0, 10 * limit)
    growing.close(0)
    whole = growing.library()
    costs = np.where(whole.costs == 0, whole.costs[whole.a] + STEP, whole.costs)
    costs[: len(library.ops)] = library.costs
    return whole._replace(costs=costs.astype(np.int32))


def _candidates(
    growing: "_Growing", functions: frozenset[str], cost: int
) -> Iterator[tuple[str, Indices, Indices]]:
    for name, a, b in (*_of_one(growing, cost), *_of_two(growing, cost)):
        if ("mul" if name == "square" else name) in functions:
            yield name, a, b


def _of_one(growing: "_Growing", cost: int) -> Iterator[tuple[str, Indices, Indices]]:
    """Functions of one formula; its reciprocal; the formula shifted by one, doubled, halved."""
    below, shifted = growing.of_cost(cost - STEP), growing.of_cost(cost - SHIFT)
    one, two = np.full_like(shifted, growing.one), np.full_like(shifted, growing.two)
    yield "square", below, below
    yield "div", np.full_like(below, growing.one), below
    for name in _UNARY:
        yield name, below, below
    yield "add", shifted, one
    yield "sub", shifted, one
    yield "sub", one, shifted
    yield "mul", two, shifted
    yield "div", shifted, two


def _of_two(growing: "_Growing", cost: int) -> Iterator[tuple[str, Indices, Indices]]:
    for left in range(LEAF, cost - STEP - LEAF + 1):
        firsts, seconds = growing.of_cost(left), growing.of_cost(cost - STEP - left)
        a, b = (grid.ravel() for grid in np.meshgrid(firsts, seconds, indexing="ij"))
        yield "div", a, b
        ordered = a < b
        for name in ("mul", "add", "sub", "max", "min"):
            yield name, a[ordered], b[ordered]


class _Growing:
    """The library while it is being enumerated."""

    def __init__(self, rows: Floats) -> None:
        r, m = rows.shape
        self.one, self.two = m, m + 1
        self._parts: list[tuple[Ints, ...]] = []
        self._values = [np.ascontiguousarray(rows.T), np.ones((1, r)), np.full((1, r), 2.0)]
        ops = [*(VARIABLE - j for j in range(m)), CONSTANT, CONSTANT]
        self._ops, self._a, self._b = [np.array(ops)], [np.zeros(m + 2, int)], [np.zeros(m + 2, int)]
        self._costs = [np.array([LEAF] * m + [0, 0])]
        self._projections = np.random.default_rng(7).standard_normal((r, 2))
        self._keys = _keys(np.concatenate(self._values), self._projections)
        self._levels: dict[int, list[Indices]] = {LEAF: [np.arange(m)]}
        self._pending: list[Indices] = []
        self._all = np.concatenate(self._values)
        self.count = m + 2

    @classmethod
    def of(cls, library: Library) -> "_Growing":
        """To go on from a finished library."""
        variables = int(np.sum(library.ops <= VARIABLE))
        growing = cls(np.ascontiguousarray(library.values[:variables].T))
        growing._ops, growing._a, growing._b = [library.ops], [library.a], [library.b]
        growing._costs, growing._values, growing._all = [library.costs], [library.values], library.values
        growing._keys = _keys(library.values, growing._projections)
        growing.count = len(library.ops)
        return growing

    def of_cost(self, cost: int) -> Indices:
        """The formulas of this cost."""
        return np.concatenate([*self._levels.get(cost, []), np.empty(0, dtype=np.int64)])

    def extend(self, name: str, a: Indices, b: Indices, cost: int, limit: int) -> None:
        """Add `name` of formulas a and b, where that is new and finite."""
        for begin in range(0, len(a), 8192):
            if self.count >= limit:
                return
            first, second = a[begin : begin + 8192], b[begin : begin + 8192]
            self._add(name, first, second, cost)

    def _add(self, name: str, a: Indices, b: Indices, cost: int) -> None:
        with np.errstate(all="ignore"):
            operands = (self._all[a], self._all[b]) if name in BINARY else (self._all[a],)
            values = _VALUES[name](*operands)
            largest = np.abs(values).max(axis=1)
            spread = values.max(axis=1) - values.min(axis=1)
        useful = (largest < LARGEST) & (spread > 1e-7 * largest)
        if name in {"sin", "cos"}:
            useful &= np.abs(operands[0]).max(axis=1) < FARTHEST
        values, a, b = values[useful], a[useful], b[useful]
        keys = _keys(values, self._projections)
        _, first = np.unique(keys, return_index=True)
        new = np.sort(first[~np.isin(keys[first], self._keys)])
        if len(new) == 0:
            return
        self._keys = np.concatenate((self._keys, keys[new]))
        self._pending.append(np.arange(self.count, self.count + len(new)))
        self._ops.append(np.full(len(new), OPCODE[name]))
        self._a.append(a[new])
        self._b.append(b[new])
        self._costs.append(np.full(len(new), cost))
        self._values.append(values[new])
        self.count += len(new)

    def close(self, cost: int) -> None:
        """The level of this cost is complete."""
        self._levels[cost] = self._pending
        self._pending = []
        self._all = np.concatenate(self._values)
        self._values = [self._all]

    def library(self) -> Library:
        ops, a, b, costs = (
            np.concatenate(part).astype(np.int32) for part in (self._ops, self._a, self._b, self._costs)
        )
        numbers = np.zeros(len(ops))
        numbers[self.one], numbers[self.two] = 1.0, 2.0
        return Library(ops, a, b, numbers, costs, np.concatenate(self._values))


def _keys(values: Floats, projections: Floats) -> Indices:
    """One integer for each row; rows that agree to eight digits agree in it."""
    scale = np.abs(values).max(axis=1) + 1e-300
    first, second = np.round(values @ projections / scale[:, None] * 1e8).T
    keys: Indices = first.astype(np.int64) * 1_000_003 + second.astype(np.int64)
    return keys


_NAMES = {code: name for name, code in OPCODE.items()}
