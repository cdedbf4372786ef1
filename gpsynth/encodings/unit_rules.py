"""Trees whose units fit: where they do not, a number is put in front, which may have any unit."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Generic, NamedTuple, TypeVar

from gpsynth.dimensions import NONE, Dimension, alike, dimension, powers, product, pure
from gpsynth.errors import EncodingError

Node = TypeVar("Node")


class _Part(NamedTuple, Generic[Node]):
    nodes: tuple[Node, ...]
    unit: Dimension | None  # None: a number takes part, so it may be any


@dataclass(frozen=True)
class UnitRules:
    """The units of a formula's inputs and outputs, in their order."""

    inputs: tuple[Dimension, ...]
    outputs: tuple[Dimension, ...]

    @classmethod
    def of(cls, units: Mapping[str, str], inputs: Sequence[str], outputs: Sequence[str]) -> "UnitRules":
        """Raises EncodingError unless each input and output, and nothing else, has a unit, UnitError if it is none."""
        if set(units) != {*inputs, *outputs}:
            odd = sorted(set(units) ^ {*inputs, *outputs})[0]
            raise EncodingError(
                f"units are given for inputs and outputs, {', '.join((*inputs, *outputs))}; "
                f"{odd!r} {'is none of them' if odd in units else 'has none'}"
            )
        return cls(*(tuple(dimension(units[name]) for name in names) for names in (inputs, outputs)))

    def terminal(self, output: int) -> int | None:
        """An input that has the unit of an output."""
        return next((k for k, unit in enumerate(self.inputs) if unit == self.outputs[output]), None)

    def fitted(
        self, tree: Sequence[tuple[Node, str | int | None]], output: int, factor: Sequence[Node]
    ) -> list[Node]:
        """The nodes of a prefix tree, `factor` (a product and its number) being put before what does not fit.

        Each node comes with the name of its operation, the index of its input, or None for a number.
        """
        stack: list[_Part[Node]] = []
        for node, meaning in reversed(tree):
            if isinstance(meaning, str):
                operands = [stack.pop() for _ in powers(meaning)]
                stack.append(_applied(node, meaning, operands, factor))
            else:
                stack.append(_Part((node,), None if meaning is None else self.inputs[meaning]))
        return list(_made(stack[0], self.outputs[output], factor).nodes)


def _applied(node: Node, name: str, operands: list[_Part[Node]], factor: Sequence[Node]) -> _Part[Node]:
    known = [unit for k in alike(name) if (unit := operands[k].unit) is not None]
    wanted: dict[int, Dimension] = dict.fromkeys(alike(name), known[0]) if known else {}
    wanted |= dict.fromkeys(pure(name), NONE)
    parts = [_made(part, wanted[k], factor) if k in wanted else part for k, part in enumerate(operands)]
    units = [wanted.get(k, part.unit) for k, part in enumerate(parts)]
    relevant = [(unit, power) for unit, power in zip(units, powers(name), strict=True) if power]
    nodes = (node, *(inner for part in parts for inner in part.nodes))
    if any(unit is None for unit, _ in relevant):
        return _Part(nodes, None)
    return _Part(nodes, product(*((unit, power) for unit, power in relevant if unit is not None)))


def _made(part: _Part[Node], wanted: Dimension, factor: Sequence[Node]) -> _Part[Node]:
    """The part if it has the unit wanted, or can have it, else a number times it."""
    if part.unit is None or part.unit == wanted:
        return part
    return _Part((*factor, *part.nodes), None)
