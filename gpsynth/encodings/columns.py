"""The variational Cartesian form: a row of calls, each a column of a function and what it is applied to (Diveev).

A column is [function, operand, operand, ...]; operands count inputs, then parameters, then the calls to the left. The
outputs are the last calls.
"""

from dataclasses import dataclass, replace

import numpy as np

from gpsynth.arrays import Ints, frozen
from gpsynth.builder import Builder, Reference
from gpsynth.encodings.checks import checked_at_least
from gpsynth.encodings.parameters import ParameterSpace
from gpsynth.encodings.solution import Functions, Variation
from gpsynth.encodings.symbols import ADD, IDENTITY, MULTIPLY, NONE, applied, function_of, functions_by_arity
from gpsynth.errors import EncodingError
from gpsynth.operations import OPERATIONS, operation
from gpsynth.program import Program

MOST_CALLS = 5_000


@dataclass(frozen=True, eq=False)
class Columns:
    """A `Solution`: calls from left to right; raises EncodingError if one is not valid."""

    entries: Ints  # (calls, 1 + operands): a symbol of `gpsynth.encodings.symbols`, then operands
    n_inputs: int
    n_parameters: int
    n_outputs: int

    def __post_init__(self) -> None:
        object.__setattr__(self, "entries", frozen(np.array(self.entries, dtype=np.int32)))
        if self.entries.ndim != 2 or not 2 <= self.entries.shape[1] <= 4:
            raise EncodingError(f"columns have 2 to 4 rows each, not the shape {self.entries.shape}")
        if not self.n_outputs <= len(self.entries) <= MOST_CALLS:
            raise EncodingError(
                f"{len(self.entries)} calls; expected {self.n_outputs} outputs to {MOST_CALLS} in all"
            )
        for call, (symbol, *operands) in enumerate(self.entries.tolist()):
            name = function_of(symbol)
            if name is None or operation(name).arity > len(operands):
                raise EncodingError(f"call {call} has symbol {symbol}; no function of its operands has that")
            for operand in operands:
                if not 0 <= operand < self._first + call:
                    raise EncodingError(
                        f"call {call} has operand {operand}; it must lie in [0, {self._first + call})"
                    )

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Columns) and self._content() == other._content()

    def __hash__(self) -> int:
        return hash(self._content())

    @property
    def counts(self) -> tuple[int, int, int]:
        """How many inputs, parameters and outputs the formula has."""
        return self.n_inputs, self.n_parameters, self.n_outputs

    @property
    def identity(self) -> Variation:
        """(0, 0, 0): no function has symbol 0."""
        return 0, 0, NONE

    def functions(self, operations: tuple[str, ...]) -> Functions:
        """The symbols by number of operands; raises EncodingError for one of more operands than columns have."""
        widest = self.entries.shape[1] - 1
        for name in operations:
            if operation(name).arity > widest:
                raise EncodingError(
                    f"{name} takes {operation(name).arity} operands; the columns have room for {widest}"
                )
        return functions_by_arity(operations)

    def draw(self, entries: Ints, functions: Functions, rng: np.random.Generator) -> Variation:
        """Any call, any row of it: another function, or another operand."""
        call, row = int(rng.integers(len(entries))), int(rng.integers(entries.shape[1]))
        if row > 0:
            return call, row, int(rng.integers(self._first + call))
        symbols = [symbol for group in functions for symbol in group]
        return call, row, symbols[int(rng.integers(len(symbols)))]

    def varied(self, entries: Ints, variations: tuple[Variation, ...]) -> Ints:
        """A copy of the entries with these numbers replaced."""
        changed = entries.copy()
        for variation in variations:
            if variation != self.identity:
                call, row, value = variation
                changed[call, row] = value
        return changed

    def contains(self, variation: Variation, functions: Functions) -> bool:
        """Whether `draw` could have given this variation, or it is the identity."""
        if len(variation) != 3 or not all(type(entry) is int for entry in variation):
            return False
        call, row, value = variation
        if variation == self.identity:
            return True
        if not (0 <= call < len(self.entries) and 0 <= row < self.entries.shape[1]):
            return False
        if row > 0:
            return 0 <= value < self._first + call
        return any(value in group for group in functions)

    def with_entries(self, entries: Ints) -> "Columns":
        """As many outputs of other calls; raises EncodingError if one is not valid."""
        return replace(self, entries=entries)

    def program(self, entries: Ints, inputs: tuple[str, ...], outputs: tuple[str, ...]) -> Program:
        """The formula of the last calls and of those they need."""
        builder = Builder(inputs, ParameterSpace.names(self.n_parameters))
        columns, first = entries.tolist(), self._first
        values: dict[int, Reference] = dict(enumerate([*builder.inputs, *builder.parameters]))
        results = range(len(columns) - self.n_outputs, len(columns))
        for call in self._needed(columns):
            symbol, *operands = columns[call]
            arity = OPERATIONS[symbol - 1].arity
            values[first + call] = applied(builder, symbol, [values[operand] for operand in operands[:arity]])
        return builder.build([values[first + call] for call in results], outputs)

    @property
    def _first(self) -> int:
        """The operand number of call 0."""
        return self.n_inputs + self.n_parameters

    def _needed(self, columns: list[list[int]]) -> list[int]:
        """The calls that an output needs, left to right."""
        needed = set(range(len(columns) - self.n_outputs, len(columns)))
        for call in range(len(columns) - 1, -1, -1):
            if call in needed:
                symbol, *operands = columns[call]
                arity = OPERATIONS[symbol - 1].arity
                needed.update(operand - self._first for operand in operands[:arity] if operand >= self._first)
        return sorted(needed)

    def _content(self) -> tuple[object, ...]:
        return self.entries.shape, self.entries.tobytes(), self.counts


def basic_columns(
    n_inputs: int, n_parameters: int, n_outputs: int, n_calls: int | None = None, operands: int = 2
) -> Columns:
    """The usual start: every output is q0 x0 + q1 x1 + ...; calls that pass the sum on are left for variations.

    A call takes up to `operands` operands. Twelve calls more than the sum needs, unless `n_calls` is given.
    """
    checked_at_least("n_inputs", n_inputs, 1)
    checked_at_least("n_parameters", n_parameters, 0)
    checked_at_least("n_outputs", n_outputs, 1)
    checked_at_least("operands", operands, 2)
    least = min(n_inputs, n_parameters) + n_inputs - 1 + n_outputs
    size = least + 12 if n_calls is None else n_calls
    checked_at_least("n_calls", size, least)
    first = n_inputs + n_parameters
    calls = [(MULTIPLY, k, n_inputs + k) for k in range(min(n_inputs, n_parameters))]
    terms = [first + k if k < n_parameters else k for k in range(n_inputs)]
    total = terms[0]
    for term in terms[1:]:
        calls.append((ADD, total, term))
        total = first + len(calls) - 1
    while len(calls) < size - n_outputs:
        calls.append((IDENTITY, total, total))
        total = first + len(calls) - 1
    calls += [(IDENTITY, total, total)] * n_outputs
    padded = [(symbol, a, b, *[b] * (operands - 2)) for symbol, a, b in calls]
    return Columns(np.array(padded, dtype=np.int32), n_inputs, n_parameters, n_outputs)
