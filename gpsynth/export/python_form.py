"""A law as one Python module that needs the standard library alone and computes the same bits.

The functions are cut from the source of the kernels. Python differs from IEEE 754 in two places, division by zero and
the square root of a negative number; both are written out, so that nothing is ever raised on numbers.
"""

import ast
import builtins
import inspect
import keyword
import math
import re
from collections.abc import Callable, Iterable, Mapping
from textwrap import indent
from types import MappingProxyType
from typing import Any

from gpsynth.errors import LawError
from gpsynth.export.listing import OPERATORS, Syntax, listing
from gpsynth.export.reading import header_lines
from gpsynth.kernels.elementary import function_of
from gpsynth.law import Law
from gpsynth.operations import Operation

IMPORTS = "import math\nimport struct\nfrom collections.abc import Sequence\n"
# What the interpreter does its own way, in place of the kernels' function of the same name.
_PRIMITIVES: Mapping[str, str] = MappingProxyType(
    {
        "divide": '''\
def divide(a: float, b: float) -> float:
    """a / b, with infinity or NaN where Python raises."""
    if b != 0.0:
        return a / b
    if a == 0.0 or math.isnan(a):
        return math.nan
    return math.copysign(math.inf, a) * math.copysign(1.0, b)
''',
        "sqrt": '''\
def sqrt(a: float) -> float:
    """The square root, correctly rounded; NaN below 0."""
    return math.sqrt(a) if a >= 0.0 else math.nan
''',
        "bits_of": '''\
def bits_of(x: float) -> int:
    """The 64 bits of x as a signed integer."""
    return int(struct.unpack("<q", struct.pack("<d", x))[0])
''',
        "float_of": '''\
def float_of(bits: int) -> float:
    """The float64 that has these bits."""
    return float(struct.unpack("<d", struct.pack("<Q", bits & 0xFFFFFFFFFFFFFFFF))[0])
''',
    }
)

Function = Callable[..., Any]


def to_python(law: Law, name: str = "law") -> str:
    """A module with one function, `control(state, target)`, that gives the tuple of saturated controls."""
    lines = listing(law, Syntax(python_number, written, element="float({0}[{1}])"))
    title, *remarks = header_lines(law, name)
    called = [operation for operation in lines.operations if operation not in OPERATORS]
    statements = [
        *(
            f"{item.name} = {item.value}" + (f"  # {item.remark}" if item.remark else "")
            for item in lines.assignments
        ),
        f"return {', '.join(lines.controls)}"
        if len(lines.controls) > 1
        else f"return ({lines.controls[0]},)",
    ]
    return "\n".join(
        [
            f'"""{title}."""',
            "",
            *(f"# {line.strip()}" for line in remarks),
            "",
            IMPORTS,
            *definitions(called),
            "",
            "def control(state: Sequence[float], target: Sequence[float]) -> tuple[float, ...]:",
            '    """The saturated controls at a state and a target."""',
            indent("\n".join(statements), "    "),
            "",
        ]
    )


def check_name(name: str, definitions: Iterable[str]) -> None:
    """Raises LawError if a function beside these definitions cannot be called so."""
    taken = {
        *dir(builtins),
        *re.findall(r"(?:^|\n)(?:def |import |from \S+ import )?(\w+)", "\n".join([IMPORTS, *definitions])),
    }
    if keyword.iskeyword(name) or name in taken:
        raise LawError(
            f"{name!r} cannot name a Python function here: it is a keyword, or something else is called so"
        )


def python_number(value: float) -> str:
    """A number in Python, infinities and NaN included."""
    if math.isfinite(value):
        return repr(value)
    return "math.nan" if math.isnan(value) else ("math.inf" if value > 0.0 else "-math.inf")


def written(operation: Operation, operands: tuple[str, ...]) -> str:
    """An operation of these operands in Python."""
    if operation.name in OPERATORS:
        return OPERATORS[operation.name].format(*operands)
    return f"{_python_name(operation.name)}({', '.join(operands)})"


def _python_name(name: str) -> str:
    return "divide" if name == "div" else function_of(name).__name__


def definitions(names: Iterable[str]) -> list[str]:
    """The constants and functions these rows need, each before its first use."""
    constants: dict[str, str] = {}
    texts: dict[str, str] = {}
    for name in names:
        if name == "div":
            texts["divide"] = _PRIMITIVES["divide"]
        else:
            _collect(function_of(name), constants, texts)
    lines = "".join(f"{name} = {value}\n" for name, value in sorted(constants.items()))
    return [*([lines] if lines else []), *(f"\n{text}" for text in texts.values())]


def _collect(function: Function, constants: dict[str, str], texts: dict[str, str]) -> None:
    """Put `function` into `texts` and its constants into `constants`, what it calls before it."""
    name = function.__name__
    if name in texts:
        return
    if name in _PRIMITIVES:
        texts[name] = _PRIMITIVES[name]
        return
    definition = ast.parse(inspect.getsource(function)).body[0]
    assert isinstance(definition, ast.FunctionDef)
    definition.decorator_list = []
    text = ast.unparse(_WithoutDivision().visit(definition)).replace("e+", "e")
    if "divide(" in text:
        texts["divide"] = _PRIMITIVES["divide"]
    for used in _free_names(function):
        value = function.__globals__[used]
        if inspect.isfunction(value):
            _collect(value, constants, texts)
        else:
            spelled = (
                python_number(value) if isinstance(value, float) else f"{'-' * (value < 0)}0x{abs(value):X}"
            )
            assert constants.setdefault(used, spelled) == spelled
    texts[name] = f"{text}\n"


def _free_names(function: Function) -> list[str]:
    """The module's names that a function uses, in the order of the code."""
    return [name for name in function.__code__.co_names if name in function.__globals__]


class _WithoutDivision(ast.NodeTransformer):
    """a / b becomes divide(a, b)."""

    def visit_BinOp(self, node: ast.BinOp) -> ast.expr:
        self.generic_visit(node)
        if not isinstance(node.op, ast.Div):
            return node
        return ast.Call(func=ast.Name(id="divide", ctx=ast.Load()), args=[node.left, node.right], keywords=[])
