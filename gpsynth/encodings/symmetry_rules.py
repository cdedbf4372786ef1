"""Trees that keep the symmetries of a problem: it is known which inputs and outputs change sign, so it is of each node.

A mirrored robot turns the other way: where left and right change places, some inputs and outputs change sign and the
others stay. A law that breaks such a symmetry only fits its training. Where a tree breaks one, what does not fit is
left out, and as much as possible stays.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import TypeVar

from gpsynth.errors import EncodingError
from gpsynth.operations import operation

Node = TypeVar("Node")
# A version of a subtree: how many nodes it has, its root, and the versions that are the root's operands.
Version = tuple[int, Node, tuple["Version[Node]", ...]]
Versions = dict[int, Version[Node]]  # by what changes its sign: one bit a symmetry

# A function that is 1 at 0, as sgn and protected quotients are, is not odd there, and there may be everywhere: x - x.
ALIKE = frozenset({"add", "sub"})  # f(-a, -b) = -f(a, b)
PRODUCTS = frozenset({"mul", "nop_mul"})
EVEN = frozenset(
    {"abs", "square", "cos", "hypot", "sqrt_protected", "log_protected", "nop_square", "nop_log"}
)  # the signs of operands do not matter
ODD = frozenset(
    {
        *("neg", "half", "double", "cube", "sin", "tan", "atan", "asin", "tanh", "cbrt", "wrap", "sign"),
        *("identity", "signed_sqrt", "tanh_half", "nop_cube", "clip_unit", "signed_log1p", "signed_expm1"),
        *("signed_saturation", "minus_cube", "sgn_dead_zone", "circle", "notch"),
    }
)


@dataclass(frozen=True)
class SymmetryRules:
    """What changes the signs of a formula's inputs and outputs, in their order: bit k is set if symmetry k does."""

    inputs: tuple[int, ...]
    outputs: tuple[int, ...]

    @classmethod
    def of(cls, signs: Mapping[str, str], inputs: Sequence[str], outputs: Sequence[str]) -> "SymmetryRules":
        """From texts such as "+-", one sign a symmetry: + stays, - changes its sign.

        Raises EncodingError unless inputs and outputs, and nothing else, have signs, as many each, and every output
        has an input with its own or is unchanged by all symmetries.
        """
        if set(signs) != {*inputs, *outputs}:
            odd = sorted(set(signs) ^ {*inputs, *outputs})[0]
            raise EncodingError(
                f"signs are given for inputs and outputs, {', '.join((*inputs, *outputs))}; "
                f"{odd!r} {'is none of them' if odd in signs else 'has none'}"
            )
        for name, text in signs.items():
            if not isinstance(text, str) or not text or set(text) - {"+", "-"}:
                raise EncodingError(f"the signs of {name} are a text of + and -, not {text!r}")
        first = next(iter(signs))
        for name, text in signs.items():
            if len(text) != len(signs[first]):
                raise EncodingError(
                    f"signs must be equally long, one for each symmetry; {first} has {signs[first]!r}, {name} {text!r}"
                )
        bits = {name: int(text.replace("+", "0").replace("-", "1"), 2) for name, text in signs.items()}
        rules = cls(tuple(bits[name] for name in inputs), tuple(bits[name] for name in outputs))
        for name in outputs:
            if bits[name] and bits[name] not in rules.inputs:
                raise EncodingError(
                    f"no input has the signs of {name}, {signs[name]!r}; the simplest formula would be one that has"
                )
        return rules

    def terminal(self, output: int) -> int | None:
        """An input that has the signs of an output, or None where a number has."""
        wanted = self.outputs[output]
        return next((k for k, signs in enumerate(self.inputs) if signs == wanted), None)

    def fitted(
        self, tree: Sequence[tuple[Node, str | int | None]], output: int
    ) -> list[tuple[Node, str | int | None]]:
        """The largest part of a prefix tree that has the signs of an output; nothing if there is none.

        Each node comes with the name of its operation, the index of its input, or None for a number.
        """
        if self._keeps([meaning for _, meaning in tree], output):
            return list(tree)
        stack: list[Versions[tuple[Node, str | int | None]]] = []
        for item in reversed(tree):
            meaning = item[1]
            if isinstance(meaning, str):
                operands = [stack.pop() for _ in range(operation(meaning).arity)]
                stack.append(_applied(item, meaning, operands))
            else:
                stack.append({0 if meaning is None else self.inputs[meaning]: (1, item, ())})
        largest = stack[0].get(self.outputs[output])
        return [] if largest is None else list(_nodes(largest))

    def _keeps(self, tree: Sequence[str | int | None], output: int) -> bool:
        """Whether the whole tree has the signs of an output."""
        stack: list[int] = []
        for meaning in reversed(tree):
            if isinstance(meaning, str):
                signs = _signs(meaning, [stack.pop() for _ in range(operation(meaning).arity)])
                if signs is None:
                    return False
                stack.append(signs)
            else:
                stack.append(0 if meaning is None else self.inputs[meaning])
        return stack[0] == self.outputs[output]


def _applied(node: Node, name: str, operands: Sequence[Versions[Node]]) -> Versions[Node]:
    """The largest version of a node for all signs that it can have, its operands' own among them."""
    found: Versions[Node] = {}
    for chosen in product(*(operand.items() for operand in operands)):
        signs = _signs(name, [signs for signs, _ in chosen])
        if signs is not None:
            size = 1 + sum(version[0] for _, version in chosen)
            if signs not in found or size > found[signs][0]:
                found[signs] = (size, node, tuple(version for _, version in chosen))
    for operand in operands:
        for signs, version in operand.items():
            if signs not in found or version[0] > found[signs][0]:
                found[signs] = version
    return found


def _nodes(version: Version[Node]) -> Iterator[Node]:
    """The nodes of a version in prefix order."""
    _, root, operands = version
    yield root
    for operand in operands:
        yield from _nodes(operand)


def _signs(name: str, operands: Sequence[int]) -> int | None:
    """What changes the sign of an operation's result, None if that would be more than a sign."""
    if name in EVEN:
        return 0
    if name in ODD:
        return operands[0]
    if name in PRODUCTS:
        return operands[0] ^ operands[1]
    if name in ALIKE:
        return operands[0] if operands[0] == operands[1] else None
    if name == "where":
        return operands[1] if operands[0] == 0 and operands[1] == operands[2] else None
    return None if any(operands) else 0
