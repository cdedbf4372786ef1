"""How programs are written down for people: which shared values get a name, and where parentheses stand.

One fold serves readable text, LaTeX and sympy. It never copies a shared value of more than trivial size, so what is
printed grows like the program and not like the tree it stands for.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from enum import IntEnum
from itertools import count
from typing import Generic, TypeVar

from gpsynth.operations import Operation
from gpsynth.program import Leaf, Program

Value = TypeVar("Value")


class Level(IntEnum):
    """How tightly a piece of text holds together."""

    SUM = 1
    SIGNED = 2  # a product behind a minus sign
    OPEN = 3  # a product that ends in a function and its argument without parentheses
    PRODUCT = 4
    FUNCTION = 5  # a function and its argument without parentheses
    POWER = 6
    ATOM = 7


@dataclass(frozen=True)
class Piece:
    """Text and how tightly it holds together."""

    text: str
    level: Level = Level.ATOM
    is_number: bool = False


@dataclass(frozen=True)
class Notation(Generic[Value]):
    """A way to write programs; `copies` is how often an operation's text repeats each of its operands."""

    leaf: Callable[[Leaf], Value]
    node: Callable[[Operation, tuple[Value, ...]], Value]
    symbol: Callable[[str], Value]
    copies: Callable[[Operation], tuple[int, ...]]


@dataclass(frozen=True)
class Brackets:
    """A pair of parentheses."""

    left: str
    right: str

    def around(self, piece: Piece, least: Level) -> str:
        """The text, in parentheses unless it holds together at least as tightly as `least`."""
        return piece.text if piece.level >= least else f"{self.left}{piece.text}{self.right}"

    def add(self, a: Piece, b: Piece) -> Piece:
        """a + b; a minus sign in front of b takes the place of the plus."""
        if b.text.startswith("-"):
            return Piece(f"{a.text} - {b.text[1:]}", Level.SUM)
        return Piece(f"{a.text} + {b.text}", Level.SUM)

    def subtract(self, a: Piece, b: Piece) -> Piece:
        """a - b; a minus sign in front of b turns it into a plus."""
        if b.level != Level.SUM and b.text.startswith("-"):
            return Piece(f"{a.text} + {b.text[1:]}", Level.SUM)
        return Piece(f"{a.text} - {self.around(b, Level.SIGNED)}", Level.SUM)

    def negate(self, a: Piece) -> Piece:
        """-a."""
        return Piece(f"-{self.around(a, Level.OPEN)}", Level.SIGNED)


def spell(
    program: Program,
    notation: Notation[Value],
    names: Iterator[str],
    *,
    trivial: int = 1,
    largest: int = 12,
) -> list[tuple[str, Value]]:
    """Named intermediates, then the outputs, as (name, value); every name is assigned before it is used.

    A value gets a name if it stands in several places and holds more than `trivial` operations, or if it holds more
    than `largest`; the names it already uses count as nothing. Names come from `names`.
    """
    rows = program.instructions
    first = len(program.leaves)
    places = _places(program, notation)
    values = [notation.leaf(leaf) for leaf in program.leaves]
    sizes = [0] * first
    lines: list[tuple[str, Value]] = []
    for index, (operation, operands) in enumerate(rows, start=first):
        value = notation.node(operation, tuple(values[operand] for operand in operands))
        copies = notation.copies(operation)
        size = 1 + sum(sizes[operand] * count for operand, count in zip(operands, copies, strict=True))
        is_last = index in program.outputs and places[index] == 1
        if (places[index] > 1 and size > trivial) or (places[index] and size > largest and not is_last):
            name = next(names)
            lines.append((name, value))
            value, size = notation.symbol(name), 0
        values.append(value)
        sizes.append(size)
    outputs = [values[output] for output in program.outputs.tolist()]
    return [*lines, *zip(program.names, outputs, strict=True)]


def fresh_names(prefix: str, *programs: Program) -> Iterator[str]:
    """prefix1, prefix2 and so on, without the names the programs use already."""
    taken = {name for program in programs for name in (*program.inputs, *program.parameters, *program.names)}
    return (name for number in count(1) if (name := f"{prefix}{number}") not in taken)


def number_text(value: float) -> str:
    """A number with six digits, as people read it."""
    return f"{value:.6g}"


def _places(program: Program, notation: Notation[Value]) -> list[int]:
    """In how many places each value would be written if each were written once; 0 for dead code."""
    first = len(program.leaves)
    places = [0] * (first + len(program.code))
    for output in program.outputs.tolist():
        places[output] += 1
    for index, (operation, operands) in reversed(list(enumerate(program.instructions, start=first))):
        if places[index]:
            for operand, copies in zip(operands, notation.copies(operation), strict=True):
                places[operand] += copies
    return places
