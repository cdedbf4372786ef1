"""Formulas of several outputs as one: their fronts joined, what a formula shares with those before it counted once."""

import math
from collections.abc import Iterator, Sequence
from functools import cached_property

from gpsynth.regression.expressions import Expression, numbers, size, variable
from gpsynth.regression.front import EXACT, Candidate

NATS_A_NODE = 2.5  # ln 12: a node is one of about a dozen symbols
_KNOWN = variable(-1)  # in place of what a formula before computes


class Joint:
    """A formula for each output."""

    def __init__(self, parts: tuple[Candidate, ...]) -> None:
        self.parts = parts

    @cached_property
    def own(self) -> tuple[Expression, ...]:
        """The formulas, a leaf in place of each operation that a formula before has as well."""
        known: set[Expression] = set()
        found = []
        for part in self.parts:
            found.append(_cut(part.expression, known))
            known.update(operations(part.expression))
        return tuple(found)

    @cached_property
    def size(self) -> int:
        """Nodes of all formulas, shared operations being written once and then named."""
        return sum(map(size, self.own))

    @cached_property
    def loss(self) -> float:
        """The sum of ln(error) over the outputs; errors below EXACT count as equal."""
        return sum(math.log(max(part.error, EXACT)) for part in self.parts)


def joined(fronts: Sequence[Sequence[Candidate]]) -> list[Joint]:
    """One front of the fronts of all outputs: each smaller or of less loss than every other that was built.

    It grows by one output at a time, and what is dominated is dropped at once.
    """
    joint = [Joint(())]
    for front in fronts:
        pairs = [Joint((*before.parts, part)) for before in joint for part in front]
        joint = []
        for pair in sorted(pairs, key=lambda each: (each.size, each.loss)):
            if not joint or pair.loss < joint[-1].loss:
                joint.append(pair)
    return joint


def choose(front: Sequence[Joint], rows: int) -> Joint:
    """The shortest description of the data: n / 2 ln error, 2.5 for each node and ln(n) / 2 for each number."""
    return min(front, key=lambda joint: description_length(joint, rows))


def description_length(joint: Joint, rows: int) -> float:
    """In nats, up to a constant of the data (Rissanen 1978); every output has a noise of its own."""
    count = sum(1 for expression in joint.own for _ in numbers(expression))
    return 0.5 * rows * joint.loss + NATS_A_NODE * joint.size + 0.5 * math.log(rows) * count


def operations(expression: Expression) -> Iterator[Expression]:
    """The operations of a tree, itself included."""
    if expression[0] not in {"variable", "number"}:
        yield expression
        for operand in expression[1:]:
            yield from operations(operand)


def _cut(expression: Expression, known: set[Expression]) -> Expression:
    if expression[0] in {"variable", "number"}:
        return expression
    if expression in known:
        return _KNOWN
    return (expression[0], *(_cut(operand, known) for operand in expression[1:]))
