import math

import numpy as np
import pytest
import sympy as sp

from gpsynth.builder import Builder
from gpsynth.errors import ProgramError
from gpsynth.export import to_sympy
from gpsynth.kernels import elementary
from gpsynth.operations import OPERATIONS
from gpsynth.program import Program
from tests.export.helpers import random_law, robot_law

# Away from where a formula of the table cancels by itself, as 1 - exp(-|a|) near 0 does; then both sides of the guards.
POINTS = (0.125, 0.3, -0.7, 0.9, -1.5, 2.25, -3.0, 5.5)
GUARDED = (1e-9, -1e-9, 1e-4, 0.005, -0.005, 20.0, -20.0, 500.0, -500.0, 2e4, 2e7, -3e8)


def _program_of(operation) -> Program:
    builder = Builder(("a", "b", "c"))
    return builder.build([builder.apply(operation.name, *builder.inputs[: operation.arity])], ["u"])


def _value(form, values) -> list[float]:
    """The outputs, all arithmetic done with 40 digits on exactly the given float64 numbers."""
    known = {
        sp.Symbol(name, real=True): sp.Rational(*value.as_integer_ratio()) for name, value in values.items()
    }
    for symbol, expression in form.replacements:
        known[symbol] = expression.xreplace(known).evalf(40)
    return [complex(expression.xreplace(known).evalf(40)).real for expression in form.expressions]


def _operands(operation):
    """Operands inside the domain of the operation."""
    unary = [*POINTS, *GUARDED]
    if operation.name in ("asin", "acos"):
        unary = [point for point in POINTS if abs(point) <= 1.0]
    if operation.name in ("sqrt", "log"):
        unary = [point for point in unary if point > 0.0]
    if operation.name in ("exp", "sigmoid", "nop_exp", "exp_protected"):
        unary = [point for point in unary if abs(point) < 600.0]
    if operation.name in ("sin", "cos", "tan", "wrap"):
        unary = [point for point in unary if abs(point) <= 1e8]
    if operation.name == "signed_decay":
        unary = [point for point in unary if abs(point) < 600.0 or abs(point) > 1e8]
    if operation.name in ("circle", "notch", "signed_expm1", "signed_saturation", "signed_log1p"):
        unary = [point for point in unary if abs(point) > 0.1]
    if operation.arity == 1:
        return [(point,) for point in unary]
    pairs = [(a, b) for a in POINTS for b in (*POINTS, 1e-9, -1e-9)]
    if operation.arity == 2:
        return [*pairs, (1e6, 1e5), (-1e6, 1e5), (0.3, 0.3)]
    return [(a, b, b + 1.0) for a, b in pairs] + [(0.0, 1.0, 2.0)]


@pytest.mark.parametrize("operation", OPERATIONS, ids=lambda operation: operation.name)
def test_sympy_form_equals_the_kernel(operation):
    form = to_sympy(_program_of(operation))
    for operands in _operands(operation):
        computed = elementary.evaluate(operation.name, *operands)
        exact = _value(form, dict(zip("abc", operands, strict=False)))[0]
        # absolute where sums or angles near a multiple of pi cancel: the operands have magnitude 10 at most
        assert math.isclose(computed, exact, rel_tol=1e-12, abs_tol=1e-15), operands


def test_law_in_assignment_form_equals_the_law():
    law = robot_law()
    form = to_sympy(law)
    names = law.features.inputs
    rng = np.random.default_rng(3)
    for row in rng.normal(size=(20, 6)):
        exact = _value(form, dict(zip(names, row.tolist(), strict=True)))
        assert np.allclose(law(row[:3], row[3:]), exact, rtol=1e-11, atol=1e-13)  # a dozen roundings


def test_expanded_form_has_inputs_alone():
    law = robot_law()
    form = to_sympy(law, expanded=True)
    assert form.replacements == []
    assert {str(s) for e in form.expressions for s in e.free_symbols} <= set(law.features.inputs)
    row = [0.1, -0.2, 0.3, 0.5, 0.6, -0.7]
    exact = _value(form, dict(zip(law.features.inputs, row, strict=True)))
    assert np.allclose(law(row[:3], row[3:]), exact, rtol=1e-11)


def _doubling(depth: int) -> Program:
    builder = Builder(("x",))
    value = builder.inputs[0]
    for _ in range(depth):
        value = builder.apply("add", builder.apply("mul", value, value), builder.apply("sin", value))
    return builder.build([value], ["y"])


def test_shared_values_are_written_once():
    form = to_sympy(_doubling(40))  # a tree of more than 10^12 operations
    assert sum(expression.count_ops() for _, expression in form.replacements) < 200


def test_expanding_what_is_too_large_is_refused():
    with pytest.raises(ProgramError, match="take the assignment form"):
        to_sympy(_doubling(40), expanded=True)


def test_long_chains_do_not_exhaust_the_stack():
    builder = Builder(("x",))
    value = builder.inputs[0]
    for _ in range(2000):
        value = builder.apply("sin", value)
    assert len(to_sympy(builder.build([value], ["y"])).replacements) > 100


def test_random_laws_have_a_sympy_form():
    laws = [random_law(np.random.default_rng(seed)) for seed in range(8)]
    without_nan = [law for law in laws if not np.any(np.isnan(law.bounded.constants))]
    assert len(without_nan) >= 3
    for law in without_nan:
        assert len(to_sympy(law).expressions) == 5


def test_nan_constant_is_refused():
    builder = Builder(("x",))
    program = builder.build([builder.apply("add", builder.inputs[0], builder.constant(math.nan))], ["y"])
    with pytest.raises(ProgramError, match="NaN"):
        to_sympy(program)
