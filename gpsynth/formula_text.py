"""Formulas as people write them become programs; what `Law.formulas()` prints can be read again.

The text is parsed by Python's own grammar and walked node by node; nothing in it is ever evaluated as Python.
"""

import ast
import functools
import math
import operator
from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import Any

from gpsynth.builder import Builder
from gpsynth.errors import FormulaError, GpsynthError
from gpsynth.numpy_functions import FUNCTIONS
from gpsynth.operations import CODES, operation
from gpsynth.program import Program
from gpsynth.symbols import Symbol, elementwise

MOST_CHARACTERS = 10_000

_OPERATORS: Mapping[type[ast.AST], Callable[..., Any]] = MappingProxyType(
    {
        **{ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv},
        **{ast.Pow: operator.pow, ast.USub: operator.neg, ast.UAdd: operator.pos},
        **{ast.Lt: operator.lt, ast.LtE: operator.le, ast.Gt: operator.gt, ast.GtE: operator.ge},
        **{ast.Eq: operator.eq, ast.NotEq: operator.ne, ast.BitAnd: operator.and_, ast.BitOr: operator.or_},
        ast.Not: lambda a: a.apply("not"),
    }
)
_SYMPY = MappingProxyType({"Abs": "abs", "Eq": "eq", "Max": "max", "Min": "min"})  # what it prints otherwise


def read_formulas(text: str, inputs: Sequence[str], outputs: Sequence[str]) -> Program:
    """The program of `name = formula` lines, one for each output, intermediate values before their use.

    A single output may stand without its name. Formulas have numbers, the inputs, + - * / ^, comparisons,
    `a if c else b`, pi, and the functions of the table of operations and of numpy, by name; what sympy prints is read
    as well, Piecewise included. Raises FormulaError.
    """
    builder = Builder(tuple(inputs))
    known = {name: Symbol(builder, each) for name, each in zip(inputs, builder.inputs, strict=True)}
    known.setdefault("pi", Symbol(builder, builder.constant(math.pi)))
    for statement in _statements(text):
        if isinstance(statement, ast.Assign) and isinstance(statement.targets[0], ast.Name):
            name = statement.targets[0].id
        elif isinstance(statement, ast.Expr) and len(outputs) == 1:
            (name,) = outputs
        else:
            raise FormulaError(f"expected lines like {outputs[0]} = ..., got {ast.unparse(statement)!r}")
        try:
            known[name] = _value(statement.value, known, builder)
        except GpsynthError as error:
            raise FormulaError(f"in {ast.unparse(statement)!r}: {error}") from None
    missing = [name for name in outputs if name not in known]
    if missing:
        raise FormulaError(f"the text has no line {missing[0]} = ...")
    return builder.build([known[name].reference for name in outputs], outputs)


def _statements(text: str) -> list[ast.stmt]:
    if len(text) > MOST_CHARACTERS:
        raise FormulaError(f"the text has {len(text)} characters; at most {MOST_CHARACTERS} are read")
    try:
        statements = ast.parse("\n".join(map(str.strip, text.strip().splitlines())).replace("^", "**")).body
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        raise FormulaError(f"the text is not a formula: {getattr(error, 'msg', error)}") from None
    if not statements:
        raise FormulaError("the text is empty")
    return statements


def _value(node: ast.expr, known: Mapping[str, Symbol], builder: Builder) -> Any:
    def inner(*nodes: ast.expr) -> list[Any]:
        return [_value(each, known, builder) for each in nodes]

    match node:
        case ast.Constant(value=int() | float() as number) if not isinstance(number, bool):
            return Symbol(builder, builder.constant(float(number)))
        case ast.Name(id=name):
            if name not in known:
                raise FormulaError(f"there is no {name!r}; known are {', '.join(known)}")
            return known[name]
        case ast.BinOp(left, sign, right) | ast.Compare(left, [sign], [right]) if type(sign) in _OPERATORS:
            return _OPERATORS[type(sign)](*inner(left, right))
        case ast.UnaryOp(sign, operand) if type(sign) in _OPERATORS:
            return _OPERATORS[type(sign)](*inner(operand))
        case ast.IfExp(condition, chosen, otherwise):
            return elementwise("where", *inner(condition, chosen, otherwise))
        case ast.Call(ast.Name("Piecewise"), [*pieces], []):
            return _piecewise(pieces, inner)
        case ast.Call(ast.Name(name) | ast.Attribute(ast.Name("np" | "numpy"), name), operands, []):
            return _called(name, inner(*operands))
    raise FormulaError(f"{ast.unparse(node)!r} is nothing that a formula can hold")


def _piecewise(pieces: Sequence[ast.expr], inner: Callable[..., list[Any]]) -> Any:
    """The value of the first pair (value, condition) whose condition holds; the last one's is True."""
    match pieces:
        case [*first, ast.Tuple([last, ast.Constant(value=True)])]:
            (result,) = inner(last)
        case _:
            raise FormulaError("the last pair of Piecewise must be (value, True)")
    for piece in reversed(first):
        if not isinstance(piece, ast.Tuple) or len(piece.elts) != 2:
            raise FormulaError(f"Piecewise takes pairs (value, condition), got {ast.unparse(piece)!r}")
        value, condition = inner(*piece.elts)
        result = elementwise("where", condition, value, result)
    return result


def _called(name: str, operands: list[Any]) -> Any:
    name = _SYMPY.get(name, name)
    if name in ("max", "min") and len(operands) > 2:
        return functools.reduce(lambda a, b: a.apply(name, b), operands)
    if name in CODES and len(operands) == operation(name).arity:
        return operands[0].apply(name, *operands[1:])
    if name in FUNCTIONS:
        try:
            return elementwise(name, *operands)
        except TypeError:
            raise FormulaError(f"{name} does not take {len(operands)} operands") from None
    if name in CODES:
        raise FormulaError(f"{name} takes {operation(name).arity} operands, got {len(operands)}")
    raise FormulaError(f"there is no function {name!r}; the table of operations has {', '.join(CODES)}")
