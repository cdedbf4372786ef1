"""What pages take from the code: `python -m docs.generate` writes operations.md from the table of operations and the
layers of the import contract into architecture.md.
"""

import re
import tomllib
from math import isnan, nan
from pathlib import Path

from gpsynth.encodings.network_operator_matrix import ROBOT_OPERATIONS
from gpsynth.kernels.elementary import evaluate
from gpsynth.operations import GP_NAMES, OPERATIONS, Operation
from tests.kernels.test_elementary_accuracy import EXACT, ROUNDED_TERMS

ROOT = Path(__file__).parents[1]
OPERATIONS_PAGE, ARCHITECTURE_PAGE = (
    Path(__file__).with_name(f"{name}.md") for name in ("operations", "architecture")
)
LAYERS = re.compile(r"(?<=```text\n).*?(?=\n```)", re.DOTALL)
SECTIONS = {
    "add": "Arithmetic",
    "sin": "Elementary functions",
    "max": "Order and choice",
    "identity": "Network operator, one operand",
    "nop_mul": "Network operator, two operands",
}  # a section begins with this row
HEADER = "| operation | computes | unit | number | GP | error |\n|---|---|---|---|---|---|"

INTRODUCTION = """\
# Operations

<!-- Written by `python -m docs.generate`; edit docs/generate.py or gpsynth/operations.py instead. -->

`gpsynth/operations.py` is the one table of everything a program can do. Laws, plants, costs and goal tests are made of
these {count} rows and nothing else.

- **computes**: operands are `a`, `b`, `c`. A guard, where there is one, is part of the operation: it holds in Python,
  in the kernels and in the exported C alike. `sgn(0)` is +1; 18.42... is -ln 1e-8.
- **unit**: the number `e` for which the operation of `z` and `e` is `z`.
- **number**: ρ*n* is unary function *n* of the network operator, χ*n* binary function *n*.
- **GP**: member of `GP_NAMES`, the usual set of genetic programming.
- **error**: against the exact value, as `tests/kernels/test_elementary_accuracy.py` checks it in 60-digit arithmetic.
  "as written" is the formula in float64, every step rounded once; "2 ulp" is at most two units in the last place;
  "2 ulp of a term" counts in units of the largest intermediate term, for sums in which terms can cancel.

A comparison gives 1 or 0. `sin`, `cos`, `tan` and `wrap` are NaN beyond |a| = 1e8 rather than inexact. NaN as operand
gives NaN, but for rows that choose or compare, in which a comparison with NaN is false:
{forgiving}.
"""

SETS = """\
## Ready-made sets

`gpsynth.operations.GP_NAMES`, finite for all finite operands up to 1e8:
{gp}.

`gpsynth.encodings.network_operator_matrix.ROBOT_OPERATIONS`, the functions that the published robot programs draw from:
{robot}.
"""


def operations_page() -> str:
    """The text of operations.md."""
    sets = SETS.format(gp=_listed(GP_NAMES), robot=_listed(ROBOT_OPERATIONS))
    forgiving = tuple(operation.name for operation in OPERATIONS if _forgives_nan(operation))
    lines = [INTRODUCTION.format(count=len(OPERATIONS), forgiving=_listed(forgiving)).rstrip()]
    for operation in OPERATIONS:
        if operation.name in SECTIONS:
            lines += ["", f"## {SECTIONS[operation.name]}", "", HEADER]
        lines.append(_row(operation))
    return "\n".join([*lines, "", sets])


def architecture_page() -> str:
    """The text of architecture.md with the layers of today."""
    return LAYERS.sub(lambda _: layers(), ARCHITECTURE_PAGE.read_text(encoding="utf-8"), count=1)


def layers() -> str:
    """The layers of the import contract, high to low, without modules that do not exist yet."""
    contracts = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["importlinter"][
        "contracts"
    ]
    (contract,) = (each for each in contracts if each.get("containers") == ["gpsynth"])
    rows = []
    for layer in contract["layers"]:
        separator = " : " if ":" in layer else " | "
        modules = [module for module in re.findall(r"\w+", layer) if _exists(module)]
        rows += [separator.join(modules)] if modules else []
    return "\n".join(rows)


def _exists(module: str) -> bool:
    return any((ROOT / "gpsynth" / place).exists() for place in (f"{module}.py", f"{module}/__init__.py"))


def _row(operation: Operation) -> str:
    formula = operation.formula.replace("|", "\\|")
    unit = "" if operation.unit is None else f"{operation.unit:g}"
    cells = [f"`{operation.name}`", f"`{formula}`", unit, _number(operation), _member(operation)]
    return "| " + " | ".join([*cells, _error(operation)]) + " |"


def _number(operation: Operation) -> str:
    if operation.unary_number is not None:
        return f"ρ{operation.unary_number}"
    return "" if operation.binary_number is None else f"χ{operation.binary_number}"


def _member(operation: Operation) -> str:
    return "yes" if operation.name in GP_NAMES else ""


def _error(operation: Operation) -> str:
    if operation.name in EXACT:
        return "as written"
    return "2 ulp of a term" if operation.name in ROUNDED_TERMS else "2 ulp"


def _forgives_nan(operation: Operation) -> bool:
    """Whether some operand may be NaN without the value being NaN."""
    operands = [
        [nan if k == place else 0.5 for k in range(operation.arity)] for place in range(operation.arity)
    ]
    return not all(isnan(evaluate(operation.name, *values)) for values in operands)


def _listed(names: tuple[str, ...]) -> str:
    return ", ".join(f"`{name}`" for name in names)


if __name__ == "__main__":
    OPERATIONS_PAGE.write_text(operations_page(), encoding="utf-8")
    ARCHITECTURE_PAGE.write_text(architecture_page(), encoding="utf-8")
