"""Laws and programs as casadi functions, to differentiate, to optimize over, to put into a predictive controller.

The graph is built from the Program, instruction by instruction. casadi computes with libm, so values agree with the
law's to a few units in the last place and not bit for bit.
"""

from collections.abc import Callable, Mapping
from math import exp, pi
from types import MappingProxyType

from gpsynth.builder import bind
from gpsynth.checks import check_kind
from gpsynth.errors import LawError, MissingPackageError, ProgramError
from gpsynth.law import Law
from gpsynth.operations import Operation
from gpsynth.program import Leaf, Program

try:
    import casadi as ca
except ImportError:
    raise MissingPackageError("to_casadi needs casadi; install it with pip install gpsynth[casadi]") from None

_LARGE, _SMALL = 1e8, 1e-8
_LN_LARGE = 18.420680743952367


def to_casadi(source: Law | Program, name: str = "law") -> ca.Function:
    """A casadi Function of the law, (state, target) -> control, or of a program, (inputs, parameters) -> outputs.

    All are column vectors. A law is given with its numbers and its limits. Raises LawError for a name that
    casadi does not take, MissingPackageError without casadi.
    """
    check_kind("what to_casadi is given", source, Law, Program, error=ProgramError)
    if not isinstance(name, str) or not ca.Function.check_name(name):
        raise LawError(
            f"{name!r} cannot name a casadi function: a letter, then letters, digits, single _; not null, jac or hess"
        )
    if isinstance(source, Law):
        program = bind(source.complete, source.parameters.tolist())
        size = len(source.plant.state_names)
        state, target = ca.SX.sym("state", size), ca.SX.sym("target", size)
        control = _outputs(program, ca.vertsplit(ca.vertcat(state, target)), [])
        return ca.Function(name, [state, target], [control], ["state", "target"], ["control"])
    inputs, parameters = ca.SX.sym("inputs", len(source.inputs)), ca.SX.sym("p", len(source.parameters))
    outputs = _outputs(source, ca.vertsplit(inputs), ca.vertsplit(parameters) if source.parameters else [])
    return ca.Function(name, [inputs, parameters], [outputs], ["inputs", "parameters"], ["outputs"])


def _outputs(program: Program, inputs: list[ca.SX], parameters: list[ca.SX]) -> ca.SX:
    leaves = {"input": inputs, "parameter": parameters}

    def leaf(item: Leaf) -> ca.SX:
        return ca.SX(item.value) if item.kind == "constant" else leaves[item.kind][item.index]

    def node(operation: Operation, operands: tuple[ca.SX, ...]) -> ca.SX:
        return _FORMS[operation.name](*operands)

    return ca.vertcat(*program.fold(leaf, node))


def _truth(condition: ca.SX) -> ca.SX:
    return ca.if_else(condition, 1.0, 0.0)


def _sgn(a: ca.SX) -> ca.SX:
    return ca.if_else(a >= 0.0, 1.0, -1.0)


def _limit(a: ca.SX, low: ca.SX, high: ca.SX) -> ca.SX:
    number = ca.if_else(ca.fabs(a) <= ca.inf, a, 0.0)  # NaN counts as 0; casadi takes a == a for true
    return ca.if_else(number > high, high, ca.if_else(number < low, low, number))


def _cbrt(a: ca.SX) -> ca.SX:
    return _sgn(a) * ca.fabs(a) ** (1.0 / 3.0)


_FORMS: Mapping[str, Callable[..., ca.SX]] = MappingProxyType(
    {
        "add": lambda a, b: a + b,
        "sub": lambda a, b: a - b,
        "mul": lambda a, b: a * b,
        "div": lambda a, b: a / b,
        "div_protected": lambda a, b: ca.if_else(ca.fabs(b) <= _SMALL, a * _sgn(b) * _LARGE, a / b),
        "neg": lambda a: -a,
        "abs": ca.fabs,
        "half": lambda a: 0.5 * a,
        "double": lambda a: 2.0 * a,
        "square": lambda a: a * a,
        "cube": lambda a: a * a * a,
        "sqrt": ca.sqrt,
        "sqrt_protected": lambda a: ca.sqrt(ca.fabs(a)),
        "floor": ca.floor,
        "sin": ca.sin,
        "cos": ca.cos,
        "tan": ca.tan,
        "atan": ca.atan,
        "atan2": ca.atan2,
        "asin": ca.asin,
        "acos": ca.acos,
        "exp": ca.exp,
        "exp_protected": lambda a: ca.exp(ca.if_else(a > _LN_LARGE, _LN_LARGE, a)),
        "log": ca.log,
        "log_protected": lambda a: ca.log(ca.if_else(ca.fabs(a) < _SMALL, _SMALL, ca.fabs(a))),
        "tanh": ca.tanh,
        "cbrt": _cbrt,
        "hypot": lambda a, b: ca.sqrt(a * a + b * b),
        "wrap": lambda a: a - 2.0 * pi * ca.floor((a + pi) / (2.0 * pi)),
        "max": lambda a, b: ca.if_else(a >= b, a, b),
        "min": lambda a, b: ca.if_else(a < b, a, b),
        "lt": lambda a, b: _truth(a < b),
        "le": lambda a, b: _truth(a <= b),
        "eq": lambda a, b: _truth(a == b),
        "not": lambda a: _truth(a == 0.0),
        "where": lambda a, b, c: ca.if_else(a != 0.0, b, c),
        "limit": _limit,
        "sign": lambda a: _truth(a > 0.0) - _truth(a < 0.0),
        "identity": lambda a: a,
        "nop_square": lambda a: ca.if_else(ca.fabs(a) > 1e4, _LARGE, a * a),
        "signed_sqrt": lambda a: _sgn(a) * ca.sqrt(ca.fabs(a)),
        "nop_inverse": lambda a: ca.if_else(ca.fabs(a) <= _SMALL, _sgn(a) * _LARGE, 1.0 / a),
        "nop_exp": lambda a: ca.if_else(a > _LN_LARGE, _LN_LARGE, ca.exp(a)),
        "nop_log": lambda a: ca.if_else(ca.fabs(a) < exp(-8.0), -_LN_LARGE, ca.log(ca.fabs(a))),
        "tanh_half": lambda a: ca.if_else(ca.fabs(a) > _LN_LARGE, _sgn(a), ca.tanh(0.5 * a)),
        "step": lambda a: _truth(a >= 0.0),
        "sgn": _sgn,
        "nop_cube": lambda a: ca.if_else(ca.fabs(a) > 464.1588833612782, _sgn(a) * _LARGE, a * a * a),
        "nop_cbrt": lambda a: ca.if_else(ca.fabs(a) < _SMALL, _sgn(a) * _SMALL, _cbrt(a)),
        "clip_unit": lambda a: ca.if_else(ca.fabs(a) < 1.0, a, _sgn(a)),
        "signed_log1p": lambda a: _sgn(a) * ca.log(ca.fabs(a) + 1.0),
        "signed_expm1": lambda a: (
            _sgn(a) * ca.if_else(ca.fabs(a) > _LN_LARGE, _LARGE, ca.exp(ca.fabs(a)) - 1.0)
        ),
        "signed_decay": lambda a: _sgn(a) * ca.if_else(ca.fabs(a) > _LARGE, _SMALL, ca.exp(-ca.fabs(a))),
        "signed_saturation": lambda a: _sgn(a) * (1.0 - ca.exp(-ca.fabs(a))),
        "minus_cube": lambda a: ca.if_else(ca.fabs(a) > _LARGE, -_sgn(a) * _LARGE, a - a * (a * a)),
        "sigmoid": lambda a: ca.if_else(
            a > _LARGE, 1.0, ca.if_else(ca.exp(-a) > _LARGE, 0.0, 1.0 / (1.0 + ca.exp(-a)))
        ),
        "step_open": lambda a: _truth(a > 0.0),
        "sgn_dead_zone": lambda a: ca.if_else(ca.fabs(a) < 0.01, 0.0, _sgn(a)),
        "circle": lambda a: _sgn(a) * ca.if_else(ca.fabs(a) > 1.0, 1.0, 1.0 - ca.sqrt(1.0 - a * a)),
        "notch": lambda a: a * ca.if_else(a * a > _LN_LARGE, 1.0 - _SMALL, 1.0 - ca.exp(-(a * a))),
        "nop_mul": lambda a, b: _limit(a * b, -_LARGE, _LARGE),
        "prob_sum": lambda a, b: a + b - a * b,
        "signed_hypot": lambda a, b: _sgn(a + b) * ca.sqrt(a * a + b * b),
        "signed_abs_sum": lambda a, b: _sgn(a + b) * (ca.fabs(a) + ca.fabs(b)),
        "signed_abs_max": lambda a, b: _sgn(a + b) * ca.fmax(ca.fabs(a), ca.fabs(b)),
    }
)
