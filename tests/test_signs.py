"""What is said to be at least 0 is at least 0 on random inputs, and the costs that people write are recognized."""

import numpy as np
import pytest

import gpsynth as gs
from gpsynth.builder import Builder
from gpsynth.operations import OPERATIONS
from gpsynth.signs import nonnegative
from gpsynth.tracing import trace


@pytest.mark.parametrize("operation", OPERATIONS, ids=lambda each: each.name)
@pytest.mark.parametrize("signed", [False, True], ids=["operands at least 0", "any operands"])
def test_claims_hold_on_random_inputs(operation, signed):
    names = ("a", "b", "c")[: operation.arity]
    builder = Builder(names)
    operands = [each if signed else builder.apply("abs", each) for each in builder.inputs]
    program = builder.build([builder.apply(operation.name, *operands)])
    rng = np.random.default_rng(1)
    inputs = rng.normal(0.0, 1.0, (2_000, len(names))) * 10.0 ** rng.integers(-3, 3, (2_000, 1))
    values = program(inputs)[:, 0]
    if nonnegative(program)[0]:
        assert not np.any(values < 0.0)
    else:
        assert signed or np.any(~(values >= 0.0)) or operation.name in {"max", "where", "cos", "log"}


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
