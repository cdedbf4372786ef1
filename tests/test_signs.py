"""What is said to be at least 0 is at least 0 on random inputs, and the costs that people write are recognized."""

import numpy as np
import pytest

import gpsynth as gs
from gpsynth.builder import Builder
from gpsynth.operations import OPERATIONS
from gpsynth.signs import nonnegative
from gpsynth.tracing import trace


@pytest.mark.parametrize("operation", OPERATIONS, ids=lambda each: each.name)
@pytest.mark.parametrize("operand", ["any", "abs", "sqrt", "acos", "constant"])
def test_claims_hold_on_random_inputs(operation, operand):
    """Operands may be anything, at least 0, or NaN for half of the inputs."""
    names = ("a", "b", "c")[: operation.arity]
    rng = np.random.default_rng(1)
    inputs = rng.normal(0.0, 1.0, (2_000, len(names))) * 10.0 ** rng.integers(-3, 3, (2_000, 1))
    inputs[::5] = 0.0
    for odd in range(2 ** len(names)):  # which operands are of that kind; the others are absolute values
        builder = Builder(names)
        kinds = [operand if odd >> k & 1 else "abs" for k in range(len(names))]
        operands = [_operand(builder, *pair) for pair in zip(builder.inputs, kinds, strict=True)]
        program = builder.build([builder.apply(operation.name, *operands)])
        if nonnegative(program)[0]:
            assert not np.any(program(inputs)[:, 0] < 0.0)


def _operand(builder, place, kind):
    if kind == "constant":
        return builder.constant(0.5)
    return place if kind == "any" else builder.apply(kind, place)


def test_the_common_functions_of_what_is_at_least_0_are_recognized():
    for name in ("add", "mul", "min", "max", "tanh", "sqrt", "hypot", "square", "abs"):
        builder = Builder(("a", "b"))
        operands = [builder.apply("abs", each) for each in builder.inputs]
        arity = next(row.arity for row in OPERATIONS if row.name == name)
        assert nonnegative(builder.build([builder.apply(name, *operands[:arity])])) == (True,)


@pytest.mark.parametrize(
    "cost",
    [
        lambda x: x.a**2 + 0.1 * np.abs(x.b),
        lambda x: x.a * x.a + np.hypot(x.a, x.b),
        lambda x: gs.where(x.a < 0.5, 0.0, 1.0) + np.maximum(x.b, 0.0),
        lambda x: 1.0,
    ],
)
def test_usual_costs_are_recognized(cost):
    assert nonnegative(trace(cost, [("x", ("a", "b"))])) == (True,)


@pytest.mark.parametrize("cost", [lambda x: x.a, lambda x: x.a * x.b, lambda x: 1.0 - x.a**2, lambda x: -1.0])
def test_what_may_be_negative_is_not(cost):
    assert nonnegative(trace(cost, [("x", ("a", "b"))])) == (False,)
