"""The scalar functions of the kernels as C99, translated from their Python source: the same arithmetic, no libm.

The translation knows what those functions are made of: assignments, conditional expressions, calls, float64 numbers and
64-bit words. What Python has built in (bits, absolute value, square root) stands in `elementary.c`.
"""

import ast
import inspect
import math
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cache
from importlib.resources import files
from typing import Any

from gpsynth.kernels.arithmetic import abs_
from gpsynth.kernels.bits import bits_of, float_of
from gpsynth.kernels.elementary import function_of

HEADERS = "#include <stdint.h>\n#include <string.h>\n"

_SYMBOLS: Mapping[type[ast.AST], str] = {
    **{ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.USub: "-"},
    **{ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">=", ast.Eq: "==", ast.NotEq: "!="},
    **{ast.BitAnd: "&", ast.BitOr: "|", ast.BitXor: "^", ast.LShift: "<<", ast.RShift: ">>"},
}
_FACTORS = (ast.Mult, ast.Div)
_TYPES = {"float": "double", "int": "uint64_t"}

Function = Callable[..., Any]


def functions(names: Iterable[str]) -> str:
    """C of the functions of these rows and of all they call, each once and before its first use."""
    texts: dict[str, str] = {}
    for name in names:
        _collect(function_of(name), texts)
    return "\n".join(texts.values())


def c_name(name: str) -> str:
    """The C function of the row called `name`."""
    return _c_name(function_of(name))


def c_number(value: float) -> str:
    """A C expression of exactly this float64, constant and free of math.h."""
    if math.isnan(value):
        return "(0.0 / 0.0)"
    if math.isinf(value):
        return "(1.0 / 0.0)" if value > 0.0 else "(-1.0 / 0.0)"
    return repr(float(value)) if math.copysign(1.0, value) > 0.0 else f"({float(value)!r})"


def _collect(function: Function, texts: dict[str, str]) -> None:
    """Put `function` into `texts`, what it calls before it."""
    name = _c_name(function)
    if name in texts:
        return
    text = _primitives().get(name) or _translated(function)
    known = {
        _c_name(f): f
        for f in (*function.__globals__.values(), abs_, bits_of, float_of)
        if inspect.isfunction(f)
    }
    for called in re.findall(r"\bgp_\w+(?=\()", text):
        if called != name:
            _collect(known[called], texts)
    texts[name] = text


def _c_name(function: Function) -> str:
    return "gp_" + function.__name__.strip("_")


@cache
def _primitives() -> Mapping[str, str]:
    """The functions of `elementary.c` by name; each starts with a comment that names it."""
    text = files("gpsynth.export").joinpath("elementary.c").read_text(encoding="ascii")
    parts = re.split(r"^(?=/\* gp_)", text, flags=re.MULTILINE)[1:]
    return {re.findall(r"\w+", part)[0]: part.rstrip() + "\n" for part in parts}


def _translated(function: Function) -> str:
    definition = ast.parse(inspect.getsource(function)).body[0]
    assert isinstance(definition, ast.FunctionDef)
    kinds = {a.arg: _TYPES[ast.unparse(a.annotation or a)] for a in definition.args.args}
    parameters = ", ".join(f"{kind} {name}" for name, kind in kinds.items())
    purpose = (inspect.getdoc(function) or "").splitlines()[0]
    body = _Body(function.__globals__, kinds)
    lines = [f"    {line}\n" for line in body.lines(definition.body[1:])]
    result = _TYPES[ast.unparse(definition.returns or definition)]
    name = _c_name(function)
    return f"/* {name}: {purpose} */\nstatic {result} {name}({parameters})\n{{\n{''.join(lines)}}}\n"


class _Body:
    """The statements of one function; `kinds` holds the C type of every name met so far."""

    def __init__(self, names: Mapping[str, Any], kinds: dict[str, str]) -> None:
        self.names = names
        self.kinds = kinds

    def lines(self, statements: list[ast.stmt]) -> Iterator[str]:
        targets = [ast.unparse(s.targets[0]) for s in statements if isinstance(s, ast.Assign)]
        for statement in statements:
            match statement:
                case ast.Assign(targets=[ast.Name(id=name)], value=value):
                    yield (
                        self.declared(name, value, targets.count(name) == 1) + f"{name} = {self.text(value)};"
                    )
                case ast.Return(value=ast.expr() as value):
                    yield f"return {self.text(value)};"
                case _:
                    raise NotImplementedError(ast.unparse(statement))

    def declared(self, name: str, value: ast.expr, constant: bool) -> str:
        """What stands before the first assignment to a name."""
        if name in self.kinds:
            return ""
        self.kinds[name] = self.kind(value)
        return f"{'const ' if constant else ''}{self.kinds[name]} "

    def kind(self, node: ast.expr) -> str:
        """The C type of an expression."""
        match node:
            case ast.Compare() | ast.BinOp(left=ast.Compare()):
                return "int"
            case ast.BinOp(left=inner) | ast.UnaryOp(operand=inner) | ast.IfExp(body=inner):
                return self.kind(inner)
            case ast.Name(id=name) if name in self.kinds:
                return self.kinds[name]
            case ast.Call(func=ast.Name(id="bits_of")):
                return "uint64_t"
            case ast.Constant(value=int()):
                return "uint64_t"
            case ast.Name(id=name) if isinstance(self.names[name], int):
                return "uint64_t"
        return "double"

    def text(self, node: ast.expr) -> str:
        """The C text of an expression."""
        match node:
            case ast.Constant(value=int() | float() as value):
                return _constant(value)
            case ast.Name(id=name):
                return name if name in self.kinds else _constant(self.names[name])
            case ast.Call(func=ast.Name(id=name), args=arguments):
                called = self.names.get(name, abs_)
                return f"{_c_name(called)}({', '.join(map(self.text, arguments))})"
            case ast.UnaryOp(op=operator, operand=operand):
                return _SYMBOLS[type(operator)] + self.inner(operand)
            case ast.BinOp(left=left, op=operator, right=right):
                first = self.text(left) if _binds(left, operator) else self.inner(left)
                return f"{first} {_SYMBOLS[type(operator)]} {self.product(right, operator)}"
            case ast.Compare(left=left, ops=[comparison], comparators=[right]):
                return f"{self.inner(left)} {_SYMBOLS[type(comparison)]} {self.inner(right)}"
            case ast.IfExp(test=test, body=body, orelse=other):
                return f"{self.inner(test)} ? {self.inner(body)} : {self.inner(other)}"
        raise NotImplementedError(ast.unparse(node))

    def inner(self, node: ast.expr) -> str:
        """The text as an operand."""
        text = self.text(node)
        return text if isinstance(node, ast.Name | ast.Constant | ast.Call) else f"({text})"

    def product(self, node: ast.expr, operator: ast.operator) -> str:
        """The text as a right operand; a product needs no parentheses in a sum."""
        bare = isinstance(operator, ast.Add | ast.Sub) and isinstance(node, ast.BinOp)
        return self.text(node) if bare and isinstance(node.op, _FACTORS) else self.inner(node)  # type: ignore[attr-defined]


def _binds(left: ast.expr, operator: ast.operator) -> bool:
    """Whether a left operand needs no parentheses: both are arithmetic, and it binds at least as tightly."""
    if not isinstance(left, ast.BinOp):
        return False
    arithmetic = (ast.Add, ast.Sub, *_FACTORS)
    tight = isinstance(left.op, _FACTORS) or isinstance(operator, ast.Add | ast.Sub)
    return isinstance(left.op, arithmetic) and isinstance(operator, arithmetic) and tight


def _constant(value: float) -> str:
    if isinstance(value, int):
        return f"{value}u" if 0 <= value < 10_000 else f"0x{value % 2**64:016x}u"
    return c_number(value)
