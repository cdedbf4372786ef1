"""Functions as symbols of variational trees and columns: the place in the table of operations, counted from 1.

So 0 is no function, and a variation of zeros alone changes nothing.
"""

from collections.abc import Sequence

from gpsynth.builder import Builder, Reference
from gpsynth.encodings.solution import Functions
from gpsynth.operations import CODES, OPERATIONS, operation


def symbol_of(name: str) -> int:
    """The symbol of an operation."""
    return CODES[name] + 1


def function_of(symbol: int) -> str | None:
    """The name of the operation with this symbol; None if there is none."""
    return OPERATIONS[symbol - 1].name if 1 <= symbol <= len(OPERATIONS) else None


def functions_by_arity(operations: Sequence[str]) -> Functions:
    """The symbols of the operations of one operand, of two, of three."""
    return tuple(
        tuple(symbol_of(name) for name in operations if operation(name).arity == arity) for arity in (1, 2, 3)
    )


def applied(builder: Builder, symbol: int, operands: Sequence[Reference]) -> Reference:
    """The value of a function; an operand that is the function's unit element is left out."""
    if symbol == IDENTITY:
        return operands[0]
    row = OPERATIONS[symbol - 1]
    if row.unit is not None and len(operands) == 2:
        rest = [operand for operand in operands if builder.value_of(operand) != row.unit]
        if len(rest) < 2:
            return rest[0] if rest else operands[0]
    return builder.apply(row.name, *operands)


NONE, ADD, MULTIPLY, IDENTITY = 0, symbol_of("add"), symbol_of("mul"), symbol_of("identity")
