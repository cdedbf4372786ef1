"""Which outputs of a program cannot be negative, whatever its inputs are (NaN left aside)."""

from dataclasses import dataclass

from gpsynth.operations import Operation
from gpsynth.program import Leaf, Program

ALWAYS = frozenset(
    {
        *("abs", "square", "sqrt", "sqrt_protected", "hypot", "exp", "exp_protected", "acos"),
        *("lt", "le", "eq", "not", "nop_square", "nop_exp", "step", "step_open", "sigmoid"),
    }
)
# of operands that are all at least 0
KEPT = frozenset(
    {
        *("add", "mul", "div", "div_protected", "half", "double", "cube", "floor", "atan", "atan2", "asin"),
        *("tanh", "cbrt", "min", "sign", "identity", "signed_sqrt", "nop_inverse", "tanh_half", "sgn"),
        *("nop_cube", "nop_cbrt", "clip_unit", "signed_log1p", "signed_expm1", "signed_decay", "nop_mul"),
        *("signed_saturation", "sgn_dead_zone", "circle", "notch"),
        *("signed_hypot", "signed_abs_sum", "signed_abs_max"),
    }
)


@dataclass(frozen=True, eq=False)
class _Node:
    nonnegative: bool


def nonnegative(program: Program) -> tuple[bool, ...]:
    """For each output whether it is proven to be at least 0; False says that it is not known."""

    def leaf(item: Leaf) -> _Node:
        return _Node(item.kind == "constant" and item.value >= 0.0)

    return tuple(output.nonnegative for output in program.fold(leaf, _node))


def _node(operation: Operation, operands: tuple[_Node, ...]) -> _Node:
    signs = [operand.nonnegative for operand in operands]
    if operation.name == "mul" and operands[0] is operands[1]:
        return _Node(True)
    if operation.name == "max":
        return _Node(any(signs))
    if operation.name == "where":
        return _Node(all(signs[1:]))
    if operation.name == "limit":
        return _Node(signs[1])
    return _Node(operation.name in ALWAYS or (operation.name in KEPT and all(signs)))
