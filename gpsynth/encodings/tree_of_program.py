"""A program as trees: shared values are written out, numbers become leaves of their own."""

from collections.abc import Mapping, Sequence
from itertools import chain
from types import MappingProxyType

from gpsynth.errors import EncodingError
from gpsynth.operations import Operation
from gpsynth.program import Leaf, Program

Tree = tuple[str | int | float, ...]  # prefix order: operations by name, inputs by index, numbers as floats


def trees_of(
    program: Program, parameters: Sequence[float], inputs: Sequence[str], operations: Sequence[str], most: int
) -> list[Tree]:
    """A tree for each output, made of `operations` alone, with the parameters' numbers put in.

    Where an operation is not among them it is written by others with the same bits, if that is possible. Raises
    EncodingError where it is not, or where a tree has more than `most` nodes.
    """
    if len(parameters) != len(program.parameters):
        raise EncodingError(
            f"the formula has the parameters {', '.join(program.parameters) or '(none)'}; {len(parameters)} values came"
        )

    def leaf(item: Leaf) -> Tree:
        if item.kind == "input":
            return (inputs.index(item.name),)
        return (item.value if item.kind == "constant" else float(parameters[item.index]),)

    def node(row: Operation, operands: tuple[Tree, ...]) -> Tree:
        tree = _written(row.name, operands, operations)
        if len(tree) > most:
            raise EncodingError(f"written as a tree, the formula has more than {most} nodes")
        return tree

    return list(program.fold(leaf, node))


# Operand numbers are integers; each row has the bits of the operation it stands for.
_SAME: Mapping[str, tuple[str | float | int, ...]] = MappingProxyType(
    {
        "neg": ("mul", -1.0, 0),
        "double": ("mul", 2.0, 0),
        "half": ("mul", 0.5, 0),
        "square": ("mul", 0, 0),
        "cube": ("mul", "mul", 0, 0, 0),
        "sub": ("add", 0, "mul", -1.0, 1),
    }
)


def _written(name: str, operands: Sequence[Tree], operations: Sequence[str]) -> Tree:
    if name in operations:
        return (name, *chain.from_iterable(operands))
    same = _SAME.get(name, (name,))
    if not all(item in operations for item in same if isinstance(item, str)):
        raise EncodingError(
            f"the formula uses {name}, which is not one of the operations {', '.join(operations)}; offer it"
        )
    return tuple(chain.from_iterable(operands[item] if isinstance(item, int) else (item,) for item in same))
