"""The table of operations: everything a program can do, and the only place that numbers it.

A row says what an operation is; how it is computed stands in `kernels/elementary.py` (Python and numba) and in the
exported C, each under the row's name. Guards of the network-operator functions follow the library of Diveev and
Shmalko (2022 edition): INF = 1e8, EPS = 1e-8, sgn(0) = +1.
"""

from dataclasses import dataclass
from types import MappingProxyType

from gpsynth.errors import OperationError


@dataclass(frozen=True)
class Operation:
    """One row of the table."""

    name: str
    arity: int
    formula: str  # what it computes, operands a, b, c; guards included
    latex: str  # template over {0}, {1}, {2}
    unit: float | None = None  # e with operation(z, e) = z
    unary_number: int | None = None  # number of rho in the network operator, 1..28
    binary_number: int | None = None  # number of chi in the network operator, 1..8
    commutative: bool = False  # in every bit, so max and min are not: max(1, NaN) is NaN, max(NaN, 1) is 1


def _unary(
    name: str, formula: str, latex: str, number: int | None = None, unit: float | None = None
) -> Operation:
    return Operation(name, 1, formula, latex, unit=unit, unary_number=number)


def _binary(
    name: str,
    formula: str,
    latex: str,
    *,
    unit: float | None = None,
    number: int | None = None,
    commutative: bool = False,
) -> Operation:
    return Operation(name, 2, formula, latex, unit=unit, binary_number=number, commutative=commutative)


OPERATIONS: tuple[Operation, ...] = (
    # arithmetic, IEEE 754
    _binary("add", "a + b", "{0} + {1}", unit=0.0, number=1, commutative=True),
    _binary("sub", "a - b", "{0} - {1}", unit=0.0),
    _binary("mul", "a b", "{0} \\, {1}", unit=1.0, commutative=True),
    _binary("div", "a / b", "\\frac{{{0}}}{{{1}}}", unit=1.0),
    _binary("div_protected", "a / b, but a sgn(b) 1e8 if |b| <= 1e-8", "\\frac{{{0}}}{{{1}}}", unit=1.0),
    _unary("neg", "-a", "-{0}", number=3),
    _unary("abs", "|a|", "\\left|{0}\\right|"),
    _unary("half", "a / 2", "\\tfrac{{1}}{{2}} {0}", number=20),
    _unary("double", "2 a", "2 \\, {0}", number=21),
    _unary("square", "a a", "{0}^{{2}}"),
    _unary("cube", "a a a", "{0}^{{3}}"),
    _unary("sqrt", "square root of a", "\\sqrt{{{0}}}"),
    _unary("sqrt_protected", "square root of |a|", "\\sqrt{{\\left|{0}\\right|}}"),
    _unary("floor", "largest integer not above a", "\\left\\lfloor {0} \\right\\rfloor"),
    # elementary functions
    _unary("sin", "sine, NaN if |a| > 1e8", "\\sin {0}", number=12),
    _unary("cos", "cosine, NaN if |a| > 1e8", "\\cos {0}", number=11),
    _unary("tan", "tangent, NaN if |a| > 1e8", "\\tan {0}"),
    _unary("atan", "arc tangent", "\\arctan {0}", number=13),
    _binary(
        "atan2", "angle of the point (b, a), in [-pi, pi]", "\\operatorname{{atan2}}\\left({0}, {1}\\right)"
    ),
    _unary("asin", "arc sine", "\\arcsin {0}"),
    _unary("acos", "arc cosine", "\\arccos {0}"),
    _unary("exp", "exponential", "e^{{{0}}}"),
    _unary("exp_protected", "exponential of min(a, 18.42...)", "e^{{\\min({0}, 18.42)}}"),
    _unary("log", "natural logarithm", "\\ln {0}"),
    _unary("log_protected", "ln max(|a|, 1e-8)", "\\ln \\left|{0}\\right|"),
    _unary("tanh", "hyperbolic tangent", "\\tanh {0}"),
    _unary("cbrt", "real cube root", "\\sqrt[3]{{{0}}}"),
    _binary("hypot", "sqrt(a a + b b)", "\\sqrt{{{0}^2 + {1}^2}}", unit=None, commutative=True),
    _unary("wrap", "a + 2 pi k in [-pi, pi), NaN if |a| > 1e8", "\\operatorname{{wrap}}\\left({0}\\right)"),
    # order and choice; a comparison is 1.0 or 0.0, and 0.0 when an operand is NaN
    _binary("max", "a if a >= b else b", "\\max\\left({0}, {1}\\right)", unit=-1e8, number=3),
    _binary("min", "a if a < b else b", "\\min\\left({0}, {1}\\right)", unit=1e8, number=4),
    _binary("lt", "1 if a < b else 0", "\\left[{0} < {1}\\right]"),
    _binary("le", "1 if a <= b else 0", "\\left[{0} \\le {1}\\right]"),
    _binary("eq", "1 if a = b else 0", "\\left[{0} = {1}\\right]", commutative=True),
    _unary("not", "1 if a = 0 else 0", "\\neg {0}"),
    Operation("where", 3, "b if a != 0 else c", "\\left({1} \\text{{ if }} {0} \\text{{ else }} {2}\\right)"),
    Operation(
        "limit",
        3,
        "a kept in [b, c]; if a is NaN the number of [b, c] nearest to 0",
        "\\operatorname{{sat}}_{{{1}}}^{{{2}}}\\left({0}\\right)",
    ),
    _unary("sign", "-1, 0 or 1", "\\operatorname{{sign}} {0}"),
    # network operator, unary: rho_n; rho_3, 11, 12, 13, 20, 21 stand above
    _unary("identity", "a", "{0}", number=1),
    _unary("nop_square", "a a, but 1e8 if |a| > 1e4", "{0}^{{2}}", number=2),
    _unary(
        "signed_sqrt", "sgn(a) sqrt|a|", "\\operatorname{{sgn}}({0})\\sqrt{{\\left|{0}\\right|}}", number=4
    ),
    _unary("nop_inverse", "1 / a, but sgn(a) 1e8 if |a| <= 1e-8", "{0}^{{-1}}", number=5),
    _unary("nop_exp", "e^a, but 18.42... = -ln 1e-8 if a > 18.42...", "e^{{{0}}}", number=6),
    _unary("nop_log", "ln|a|, but -18.42... if |a| < e^-8", "\\ln\\left|{0}\\right|", number=7),
    _unary("tanh_half", "tanh(a / 2), sgn(a) if |a| > 18.42...", "\\tanh\\tfrac{{{0}}}{{2}}", number=8),
    _unary("step", "1 if a >= 0 else 0", "\\operatorname{{H}}\\left({0}\\right)", number=9),
    _unary("sgn", "1 if a >= 0 else -1", "\\operatorname{{sgn}}\\left({0}\\right)", number=10),
    _unary("nop_cube", "a a a, but sgn(a) 1e8 if |a| > 464.158...", "{0}^{{3}}", number=14),
    _unary("nop_cbrt", "sgn(a) |a|^(1/3), but sgn(a) 1e-8 if |a| < 1e-8", "\\sqrt[3]{{{0}}}", number=15),
    _unary(
        "clip_unit",
        "a if |a| < 1 else sgn(a)",
        "\\operatorname{{sat}}_{{-1}}^{{1}}\\left({0}\\right)",
        number=16,
    ),
    _unary(
        "signed_log1p",
        "sgn(a) ln(|a| + 1)",
        "\\operatorname{{sgn}}({0})\\ln\\left(\\left|{0}\\right| + 1\\right)",
        number=17,
    ),
    _unary(
        "signed_expm1",
        "sgn(a) (e^|a| - 1), but sgn(a) 1e8 if |a| > 18.42...",
        "\\operatorname{{sgn}}({0})\\left(e^{{\\left|{0}\\right|}} - 1\\right)",
        number=18,
    ),
    _unary(
        "signed_decay",
        "sgn(a) e^-|a|, but sgn(a) 1e-8 if |a| > 1e8",
        "\\operatorname{{sgn}}({0}) e^{{-\\left|{0}\\right|}}",
        number=19,
    ),
    _unary(
        "signed_saturation",
        "sgn(a) (1 - e^-|a|)",
        "\\operatorname{{sgn}}({0})\\left(1 - e^{{-\\left|{0}\\right|}}\\right)",
        number=22,
    ),
    _unary(
        "minus_cube", "a - a (a a), but -sgn(a) 1e8 if |a| > 1e8", "\\left({0} - {0}^{{3}}\\right)", number=23
    ),
    _unary(
        "sigmoid", "1 / (1 + e^-a), 1 if a > 1e8, 0 if e^-a > 1e8", "\\frac{{1}}{{1 + e^{{-{0}}}}}", number=24
    ),
    _unary("step_open", "1 if a > 0 else 0", "\\operatorname{{H}}_0\\left({0}\\right)", number=25),
    _unary(
        "sgn_dead_zone",
        "0 if |a| < 0.01 else sgn(a)",
        "\\operatorname{{sgn}}_{{0.01}}\\left({0}\\right)",
        number=26,
    ),
    _unary(
        "circle",
        "sgn(a) (1 - sqrt(1 - a a)), but sgn(a) if |a| > 1",
        "\\operatorname{{sgn}}({0})\\left(1 - \\sqrt{{1 - {0}^2}}\\right)",
        number=27,
    ),
    _unary(
        "notch",
        "a (1 - e^(-a a)), but a (1 - 1e-8) if a a > 18.42...",
        "{0}\\left(1 - e^{{-{0}^2}}\\right)",
        number=28,
    ),
    # network operator, binary: chi_n; chi_1, 3, 4 stand above; 6 and 7 are not associative
    _binary("nop_mul", "a b, kept in [-1e8, 1e8]", "{0} \\, {1}", unit=1.0, number=2, commutative=True),
    _binary(
        "prob_sum", "a + b - a b", "\\left({0} + {1} - {0} {1}\\right)", unit=0.0, number=5, commutative=True
    ),
    _binary(
        "signed_hypot",
        "sgn(a + b) sqrt(a a + b b)",
        "\\operatorname{{sgn}}({0}+{1})\\sqrt{{{0}^2 + {1}^2}}",
        unit=0.0,
        number=6,
        commutative=True,
    ),
    _binary(
        "signed_abs_sum",
        "sgn(a + b) (|a| + |b|)",
        "\\operatorname{{sgn}}({0}+{1})\\left(\\left|{0}\\right| + \\left|{1}\\right|\\right)",
        unit=0.0,
        number=7,
        commutative=True,
    ),
    _binary(
        "signed_abs_max",
        "sgn(a + b) max(|a|, |b|)",
        "\\operatorname{{sgn}}({0}+{1})\\max\\left(\\left|{0}\\right|, \\left|{1}\\right|\\right)",
        unit=0.0,
        number=8,
    ),
)

CODES = MappingProxyType({operation.name: code for code, operation in enumerate(OPERATIONS)})
UNARY_BY_NUMBER = MappingProxyType(
    {operation.unary_number: operation for operation in OPERATIONS if operation.unary_number is not None}
)
BINARY_BY_NUMBER = MappingProxyType(
    {operation.binary_number: operation for operation in OPERATIONS if operation.binary_number is not None}
)
GP_NAMES: tuple[str, ...] = (
    *("add", "sub", "mul", "div_protected", "min", "max", "sin", "cos", "tan", "atan2", "exp_protected"),
    *("log_protected", "sqrt_protected", "tanh", "square", "cube", "lt", "le", "where"),
)  # the usual set of genetic programming, total on all finite operands up to 1e8


def operation(name: str) -> Operation:
    """The row called `name`; raises OperationError if there is none."""
    if name not in CODES:
        raise OperationError(f"there is no operation {name!r}; the table has {', '.join(CODES)}")
    return OPERATIONS[CODES[name]]
