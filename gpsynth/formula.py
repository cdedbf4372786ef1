"""Programs as lines of readable text; shared values are named, numbers have six digits."""

from collections.abc import Callable, Mapping
from types import MappingProxyType

from gpsynth.notation import Brackets, Level, Notation, Piece, fresh_names, number_text, spell
from gpsynth.operations import Operation
from gpsynth.program import Leaf, Program

PARENTHESES = Brackets("(", ")")


def lines(program: Program) -> tuple[str, ...]:
    """One line `name = formula` for each intermediate value and output.

    What is not arithmetic stands as a function under its name in the table of operations, guards included.
    """
    return tuple(f"{name} = {piece.text}" for name, piece in spell(program, TEXT, fresh_names("z", program)))


def _leaf(leaf: Leaf) -> Piece:
    if leaf.kind != "constant":
        return Piece(leaf.name)
    text = number_text(leaf.value)
    return Piece(text, Level.SIGNED if text.startswith("-") else Level.ATOM, is_number=True)


def _node(operation: Operation, operands: tuple[Piece, ...]) -> Piece:
    if operation.name in _JOINED:
        return _JOINED[operation.name](*operands)
    template = _TEMPLATES.get(operation.name)
    texts = [operand.text for operand in operands]
    return Piece(template.format(*texts) if template else f"{operation.name}({', '.join(texts)})")


def _power(a: Piece, exponent: int) -> Piece:
    return Piece(f"{PARENTHESES.around(a, Level.ATOM)}^{exponent}", Level.POWER)


def _product(a: Piece, b: Piece) -> Piece:
    first, second = (b, a) if b.is_number else (a, b)
    level = Level.SIGNED if first.level == Level.SIGNED else Level.PRODUCT
    return Piece(
        f"{PARENTHESES.around(first, Level.SIGNED)} * {PARENTHESES.around(second, Level.PRODUCT)}", level
    )


def _quotient(a: Piece, b: Piece) -> Piece:
    level = Level.SIGNED if a.level == Level.SIGNED else Level.PRODUCT
    return Piece(f"{PARENTHESES.around(a, Level.SIGNED)} / {PARENTHESES.around(b, Level.FUNCTION)}", level)


_TEMPLATES: Mapping[str, str] = MappingProxyType(
    {"lt": "({0} < {1})", "le": "({0} <= {1})", "eq": "({0} == {1})", "where": "({1} if {0} else {2})"}
)
_JOINED: Mapping[str, Callable[..., Piece]] = MappingProxyType(
    {
        "add": PARENTHESES.add,
        "sub": PARENTHESES.subtract,
        "neg": PARENTHESES.negate,
        "mul": _product,
        "double": lambda a: _product(Piece("2", is_number=True), a),
        "div": _quotient,
        "half": lambda a: _quotient(a, Piece("2")),
        "square": lambda a: _power(a, 2),
        "cube": lambda a: _power(a, 3),
    }
)
TEXT = Notation(leaf=_leaf, node=_node, symbol=Piece, copies=lambda operation: (1,) * operation.arity)
