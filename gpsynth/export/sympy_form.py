"""Programs and laws as sympy expressions, to read and to differentiate; the Program remains what is computed.

The expressions are the exact functions that the kernels round: real numbers, no signed zeros, no overflow. Guards are
written as Piecewise.
"""

import math
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import NamedTuple

import sympy as sp

from gpsynth.checks import check_kind
from gpsynth.errors import ProgramError
from gpsynth.export.reading import spell_law
from gpsynth.law import Law
from gpsynth.notation import Notation, fresh_names, spell
from gpsynth.operations import Operation
from gpsynth.program import Leaf, Program

LARGEST_EXPANSION = 2000  # operations
_LARGE = sp.Integer(10) ** 8
_SMALL = 1 / _LARGE
_LN_LARGE = sp.Float("18.420680743952367")


class SympyForm(NamedTuple):
    """Assignments (symbol, expression) in order, and the outputs in terms of them."""

    replacements: list[tuple[sp.Symbol, sp.Expr]]
    expressions: list[sp.Expr]

    def expanded(self) -> list[sp.Expr]:
        """The outputs with all assignments put in."""
        known: dict[sp.Symbol, sp.Expr] = {}
        for symbol, expression in self.replacements:
            known[symbol] = expression.xreplace(known)
        return [expression.xreplace(known) for expression in self.expressions]


def to_sympy(source: Law | Program, *, expanded: bool = False) -> SympyForm:
    """The law or program in assignment form, as `sympy.cse` gives it: shared values are symbols.

    A law is given from states and targets to saturated controls, with its numbers. With `expanded` there are no
    replacements; raises ProgramError if that would write out more than 2000 operations.
    """
    check_kind("what to_sympy is given", source, Law, Program, error=ProgramError)
    program = source.complete if isinstance(source, Law) else source
    if expanded and tree_size(program) > LARGEST_EXPANSION:
        raise ProgramError(
            f"written out, the expressions have {tree_size(program)} operations; "
            f"at most {LARGEST_EXPANSION} are allowed, take the assignment form"
        )
    if isinstance(source, Law):
        spelled = spell_law(source, _NOTATION, trivial=0)
    else:
        spelled = spell(source, _NOTATION, fresh_names("z", source), trivial=0)
    split = len(spelled) - len(program.names)
    form = SympyForm(
        [(_symbol(name), expression) for name, expression in spelled[:split]],
        [expression for _, expression in spelled[split:]],
    )
    return SympyForm([], form.expanded()) if expanded else form


def tree_size(program: Program) -> int:
    """How many operations the outputs have when nothing is shared."""
    return sum(program.fold(lambda leaf: 0, lambda operation, sizes: 1 + sum(sizes)))


def _symbol(name: str) -> sp.Symbol:
    return sp.Symbol(name, real=True)


def _leaf(leaf: Leaf) -> sp.Expr:
    if leaf.kind != "constant":
        return _symbol(leaf.name)
    if math.isnan(leaf.value):
        raise ProgramError("the program has a constant that is NaN; sympy cannot express it")
    is_short_integer = leaf.value.is_integer() and abs(leaf.value) < 1e6
    return sp.Integer(int(leaf.value)) if is_short_integer else sp.Float(leaf.value)


def _node(operation: Operation, operands: tuple[sp.Expr, ...]) -> sp.Expr:
    return _FORMS[operation.name](*operands)


def _if(condition: sp.Basic, then: sp.Expr, otherwise: sp.Expr) -> sp.Expr:
    return sp.Piecewise((then, condition), (otherwise, True))


def _sgn(a: sp.Expr) -> sp.Expr:
    return _if(a >= 0, sp.Integer(1), sp.Integer(-1))


def _limit(a: sp.Expr, low: sp.Expr, high: sp.Expr) -> sp.Expr:
    return sp.Piecewise((high, a > high), (low, a < low), (a, True))


def _wrap(a: sp.Expr) -> sp.Expr:
    return a - 2 * sp.pi * sp.floor((a + sp.pi) / (2 * sp.pi))


def _cbrt(a: sp.Expr) -> sp.Expr:
    return _sgn(a) * sp.Abs(a) ** sp.Rational(1, 3)


_FORMS: Mapping[str, Callable[..., sp.Expr]] = MappingProxyType(
    {
        "add": lambda a, b: a + b,
        "sub": lambda a, b: a - b,
        "mul": lambda a, b: a * b,
        "div": lambda a, b: a / b,
        "div_protected": lambda a, b: _if(sp.Abs(b) <= _SMALL, a * _sgn(b) * _LARGE, a / b),
        "neg": lambda a: -a,
        "abs": sp.Abs,
        "half": lambda a: a / 2,
        "double": lambda a: 2 * a,
        "square": lambda a: a**2,
        "cube": lambda a: a**3,
        "sqrt": sp.sqrt,
        "sqrt_protected": lambda a: sp.sqrt(sp.Abs(a)),
        "floor": sp.floor,
        "sin": sp.sin,
        "cos": sp.cos,
        "tan": sp.tan,
        "atan": sp.atan,
        "atan2": sp.atan2,
        "asin": sp.asin,
        "acos": sp.acos,
        "exp": sp.exp,
        "exp_protected": lambda a: sp.exp(_if(a > _LN_LARGE, _LN_LARGE, a)),
        "log": sp.log,
        "log_protected": lambda a: sp.log(_if(sp.Abs(a) < _SMALL, _SMALL, sp.Abs(a))),
        "tanh": sp.tanh,
        "cbrt": _cbrt,
        "hypot": lambda a, b: sp.sqrt(a**2 + b**2),
        "wrap": _wrap,
        "max": lambda a, b: _if(a >= b, a, b),
        "min": lambda a, b: _if(a < b, a, b),
        "lt": lambda a, b: _if(a < b, sp.Integer(1), sp.Integer(0)),
        "le": lambda a, b: _if(a <= b, sp.Integer(1), sp.Integer(0)),
        "eq": lambda a, b: _if(sp.Eq(a, b), sp.Integer(1), sp.Integer(0)),
        "not": lambda a: _if(sp.Eq(a, 0), sp.Integer(1), sp.Integer(0)),
        "where": lambda a, b, c: _if(sp.Ne(a, 0), b, c),
        "limit": _limit,
        "sign": lambda a: sp.Piecewise((-1, a < 0), (1, a > 0), (0, True)),
        "identity": lambda a: a,
        "nop_square": lambda a: _if(sp.Abs(a) > 10**4, _LARGE, a**2),
        "signed_sqrt": lambda a: _sgn(a) * sp.sqrt(sp.Abs(a)),
        "nop_inverse": lambda a: _if(sp.Abs(a) <= _SMALL, _sgn(a) * _LARGE, 1 / a),
        "nop_exp": lambda a: _if(a > _LN_LARGE, _LN_LARGE, sp.exp(a)),
        "nop_log": lambda a: _if(sp.Abs(a) < sp.exp(-8), -_LN_LARGE, sp.log(sp.Abs(a))),
        "tanh_half": lambda a: _if(sp.Abs(a) > _LN_LARGE, _sgn(a), sp.tanh(a / 2)),
        "step": lambda a: _if(a >= 0, sp.Integer(1), sp.Integer(0)),
        "sgn": _sgn,
        "nop_cube": lambda a: _if(sp.Abs(a) > _LARGE ** sp.Rational(1, 3), _sgn(a) * _LARGE, a**3),
        "nop_cbrt": lambda a: _if(sp.Abs(a) < _SMALL, _sgn(a) * _SMALL, _cbrt(a)),
        "clip_unit": lambda a: _if(sp.Abs(a) < 1, a, _sgn(a)),
        "signed_log1p": lambda a: _sgn(a) * sp.log(sp.Abs(a) + 1),
        "signed_expm1": lambda a: _sgn(a) * _if(sp.Abs(a) > _LN_LARGE, _LARGE, sp.exp(sp.Abs(a)) - 1),
        "signed_decay": lambda a: _sgn(a) * _if(sp.Abs(a) > _LARGE, _SMALL, sp.exp(-sp.Abs(a))),
        "signed_saturation": lambda a: _sgn(a) * (1 - sp.exp(-sp.Abs(a))),
        "minus_cube": lambda a: _if(sp.Abs(a) > _LARGE, -_sgn(a) * _LARGE, a - a**3),
        "sigmoid": lambda a: sp.Piecewise(
            (1, a > _LARGE), (0, sp.exp(-a) > _LARGE), (1 / (1 + sp.exp(-a)), True)
        ),
        "step_open": lambda a: _if(a > 0, sp.Integer(1), sp.Integer(0)),
        "sgn_dead_zone": lambda a: _if(sp.Abs(a) < sp.Rational(1, 100), sp.Integer(0), _sgn(a)),
        "circle": lambda a: _sgn(a) * _if(sp.Abs(a) > 1, sp.Integer(1), 1 - sp.sqrt(1 - a**2)),
        "notch": lambda a: a * _if(a**2 > _LN_LARGE, 1 - _SMALL, 1 - sp.exp(-(a**2))),
        "nop_mul": lambda a, b: _limit(a * b, -_LARGE, _LARGE),
        "prob_sum": lambda a, b: a + b - a * b,
        "signed_hypot": lambda a, b: _sgn(a + b) * sp.sqrt(a**2 + b**2),
        "signed_abs_sum": lambda a, b: _sgn(a + b) * (sp.Abs(a) + sp.Abs(b)),
        "signed_abs_max": lambda a, b: _sgn(a + b) * sp.Max(sp.Abs(a), sp.Abs(b)),
    }
)
# Where a form repeats an operand, that operand gets a symbol of its own.
_ONCE = (
    "add sub mul div neg abs half double square cube sqrt sqrt_protected floor sin cos tan atan atan2 asin acos exp "
    "log tanh hypot identity"
)
_NOTATION: Notation[sp.Expr] = Notation(
    leaf=_leaf,
    node=_node,
    symbol=_symbol,
    copies=lambda operation: (1 if operation.name in _ONCE.split() else 2,) * operation.arity,
)
