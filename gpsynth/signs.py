"""Which outputs of a program are never negative, whatever its inputs are: at least 0, or NaN."""

from dataclasses import dataclass

from gpsynth.operations import Operation
from gpsynth.program import Leaf, Program

ALWAYS = frozenset(
    {
        *("abs", "square", "sqrt", "sqrt_protected", "hypot", "exp", "exp_protected", "acos"),
        *("lt", "le", "eq", "not", "nop_square", "nop_exp", "step", "step_open", "sigmoid"),
    }
)
# of operands that are all at least 0; functions that make a number of NaN, and quotients of -0, are not among them
KEPT = frozenset(
    {"add", "mul", "half", "double", "cube", "floor", "atan", "asin", "tanh", "cbrt", "min", "identity"}
)


@dataclass(frozen=True, eq=False)
class _Node:
    nonnegative: bool  # or NaN
    constant: bool = False


def nonnegative(program: Program) -> tuple[bool, ...]:
    """For each output whether it is proven to be at least 0; False says that it is not known."""

    def leaf(item: Leaf) -> _Node:
        constant = item.kind == "constant"
        return _Node(constant and item.value >= 0.0, constant)

    return tuple(output.nonnegative for output in program.fold(leaf, _node))


def _node(operation: Operation, operands: tuple[_Node, ...]) -> _Node:
    signs = [operand.nonnegative for operand in operands]
    if operation.name == "mul" and operands[0] is operands[1]:
        return _Node(True)
    if operation.name == "max":  # the second operand where the first is NaN
        return _Node(signs[1] or (signs[0] and operands[0].constant))
    if operation.name == "where":
        return _Node(all(signs[1:]))
    if operation.name == "limit":
        return _Node(signs[1] and signs[2])
    return _Node(operation.name in ALWAYS or (operation.name in KEPT and all(signs)))
