"""The complete binary tree: levels of binary and unary functions in turn, one symbol a place (Diveev's binary GP).

From the root down stand 1 binary function, 2 unary, 2 binary, 4 unary ones, and so on, 2^depth leaves in the end:
2^(depth + 2) - 3 symbols, any of which can be replaced by any other of its level.
"""

from dataclasses import dataclass, replace
from functools import cached_property
from itertools import chain

import numpy as np

from gpsynth.arrays import Ints, frozen
from gpsynth.builder import Builder, Reference
from gpsynth.encodings.checks import checked_at_least
from gpsynth.encodings.parameters import ParameterSpace
from gpsynth.encodings.solution import Functions, Variation
from gpsynth.encodings.symbols import ADD, IDENTITY, MULTIPLY, NONE, applied, function_of, functions_by_arity
from gpsynth.errors import EncodingError
from gpsynth.operations import operation
from gpsynth.program import Program

DEEPEST = 12
_UNARY, _BINARY, _LEAF = range(3)


@dataclass(frozen=True, eq=False)
class CompleteTree:
    """A `Solution`: symbols of a complete tree, level by level; several outputs are several places of it.

    A function's symbol is that of `gpsynth.encodings.symbols`; a leaf's counts inputs, then parameters, then units.
    Raises EncodingError if a symbol is not one of its level.
    """

    entries: Ints  # (2^(depth + 2) - 3,)
    n_inputs: int
    n_parameters: int
    outputs: tuple[int, ...] = (0,)  # places
    units: tuple[float, ...] = (
        0.0,
        1.0,
    )  # constants that a leaf can be: unit elements of the binary functions

    def __post_init__(self) -> None:
        object.__setattr__(self, "entries", frozen(np.array(self.entries, dtype=np.int32)))
        size = len(self.entries)
        if self.entries.ndim != 1 or size < 5 or 2 ** (self.depth + 2) - 3 != size or self.depth > DEEPEST:
            raise EncodingError(
                f"a complete tree has 2^(depth + 2) - 3 symbols, depth 1 to {DEEPEST}, not {self.entries.shape}"
            )
        for place in self.outputs:
            if not 0 <= place < size:
                raise EncodingError(
                    f"output place {place} does not exist; the tree has places 0 to {size - 1}"
                )
        for place, symbol in enumerate(self.entries.tolist()):
            if not self._fits(place, symbol):
                raise EncodingError(f"place {place} has symbol {symbol}, which is none of its level")

    def __eq__(self, other: object) -> bool:
        return isinstance(other, CompleteTree) and self._content() == other._content()

    def __hash__(self) -> int:
        return hash(self._content())

    @property
    def depth(self) -> int:
        """Binary functions on the way from the root to a leaf."""
        return max((len(self.entries) + 3).bit_length() - 3, 0)

    @property
    def counts(self) -> tuple[int, int, int]:
        """How many inputs, parameters and outputs the formula has."""
        return self.n_inputs, self.n_parameters, len(self.outputs)

    @property
    def identity(self) -> Variation:
        """(0, 0): no function has symbol 0, and the root is no leaf."""
        return 0, NONE

    def functions(self, operations: tuple[str, ...]) -> Functions:
        """Symbols of the unary and of the binary functions; raises EncodingError for one of three operands."""
        unary, binary, ternary = functions_by_arity(operations)
        if ternary:
            raise EncodingError(
                f"{function_of(ternary[0])} takes three operands; a complete tree has none such"
            )
        return unary or (IDENTITY,), binary or (ADD,)

    def draw(self, entries: Ints, functions: Functions, rng: np.random.Generator) -> Variation:
        """Any place, any symbol of its level."""
        place = int(rng.integers(len(entries)))
        kind = self._kinds[place]
        choices = range(self._n_leaves) if kind == _LEAF else functions[kind]
        return place, choices[int(rng.integers(len(choices)))]

    def varied(self, entries: Ints, variations: tuple[Variation, ...]) -> Ints:
        """A copy of the entries with these symbols replaced."""
        changed = entries.copy()
        for variation in variations:
            if variation != self.identity:
                changed[variation[0]] = variation[1]
        return changed

    def contains(self, variation: Variation, functions: Functions) -> bool:
        """Whether `draw` could have given this variation, or it is the identity."""
        if len(variation) != 2 or not all(type(entry) is int for entry in variation):
            return False
        place, symbol = variation
        if variation == self.identity or not 0 <= place < len(self.entries):
            return variation == self.identity
        kind = self._kinds[place]
        return 0 <= symbol < self._n_leaves if kind == _LEAF else symbol in functions[kind]

    def with_entries(self, entries: Ints) -> "CompleteTree":
        """The same tree of other symbols; raises EncodingError if one is not of its level."""
        return replace(self, entries=entries)

    def program(self, entries: Ints, inputs: tuple[str, ...], outputs: tuple[str, ...]) -> Program:
        """The formula of valid entries; an operand that is the unit of its function is left out."""
        builder = Builder(inputs, ParameterSpace.names(self.n_parameters))
        leaves = [*builder.inputs, *builder.parameters, *map(builder.constant, self.units)]
        symbols = entries.tolist()
        values: dict[int, Reference] = {}
        for place, children in self._order:
            operands = [values[child] for child in children]
            values[place] = applied(builder, symbols[place], operands) if operands else leaves[symbols[place]]
        return builder.build([values[place] for place in self.outputs], outputs)

    @property
    def _n_leaves(self) -> int:
        return self.n_inputs + self.n_parameters + len(self.units)

    @cached_property
    def _kinds(self) -> tuple[int, ...]:
        functions = ([_BINARY] * 2**k + [_UNARY] * 2 ** (k + 1) for k in range(self.depth))
        return (*chain.from_iterable(functions), *[_LEAF] * 2**self.depth)

    def _fits(self, place: int, symbol: int) -> bool:
        kind = self._kinds[place]
        if kind == _LEAF:
            return 0 <= symbol < self._n_leaves
        name = function_of(symbol)
        return name is not None and operation(name).arity == (1 if kind == _UNARY else 2)

    def _children(self, place: int) -> tuple[int, ...]:
        level = ((place + 3) // 3).bit_length() - 1  # binary functions above this one, or above its parent
        first = 3 * 2**level - 3  # place of the first binary function there
        if level == self.depth:
            return ()
        if place < first + 2**level:
            child = first + 2**level + 2 * (place - first)
            return child, child + 1
        return (place + 2 ** (level + 1),)

    @cached_property
    def _order(self) -> tuple[tuple[int, tuple[int, ...]], ...]:
        """The places that outputs need and their children, children first."""
        waiting, found = list(self.outputs), dict[int, tuple[int, ...]]()
        while waiting:
            place = waiting.pop()
            if place not in found:
                found[place] = self._children(place)
                waiting.extend(found[place])
        return tuple(sorted(found.items(), reverse=True))

    def _content(self) -> tuple[object, ...]:
        return self.entries.tobytes(), self.n_inputs, self.n_parameters, self.outputs, self.units


def basic_tree(
    n_inputs: int,
    n_parameters: int,
    n_outputs: int,
    operations: tuple[str, ...] = ("add", "mul"),
    depth: int | None = None,
) -> CompleteTree:
    """The usual start: every output is q0 x0 + q1 x1 + ... + 0; the zeros are left for variations.

    Outputs are neighbors on one level and share nothing. Leaves can be the units of the `operations` too. One level
    more than the sums need, unless a `depth` is given.
    """
    for name, value, least in (
        ("n_inputs", n_inputs, 1),
        ("n_parameters", n_parameters, 0),
        ("n_outputs", n_outputs, 1),
    ):
        checked_at_least(name, value, least)
    above, below = (n_outputs - 1).bit_length(), (n_inputs - 1).bit_length() + 1
    levels = above + below + 1 if depth is None else depth
    checked_at_least("depth", levels, above + below)
    given = (operation(name).unit for name in operations)
    units = (0.0, 1.0, *sorted({unit for unit in given if unit is not None} - {0.0, 1.0}))
    n_leaves = n_inputs + n_parameters
    zero, one = n_leaves, n_leaves + 1
    functions = [[ADD] * 2**k + [IDENTITY] * 2 ** (k + 1) for k in range(levels - 1)]
    spare = 2 ** (levels - 1 - above) - n_inputs  # pairs of leaves under an output that no product takes
    lowest = ([MULTIPLY] * n_inputs + [ADD] * spare) * 2**above + [IDENTITY] * 2**levels
    pairs = [(k, n_inputs + k if k < n_parameters else one) for k in range(n_inputs)]
    leaves = [*pairs, *[(zero, zero)] * spare] * 2**above
    symbols = [*chain.from_iterable(functions), *lowest, *chain.from_iterable(leaves)]
    first = 3 * 2**above - 3
    outputs = tuple(range(first, first + n_outputs))
    return CompleteTree(np.array(symbols, dtype=np.int32), n_inputs, n_parameters, outputs, units)
