"""Intervals hold what the lane machine computes."""

import numpy as np
import pytest

from gpsynth.builder import Builder
from gpsynth.intervals import RULES, enclose
from gpsynth.operations import CODES, OPERATIONS
from gpsynth.tracing import trace


def program_of(name: str):
    names = ("a", "b", "c")[: OPERATIONS[CODES[name]].arity]
    builder = Builder(names)
    return builder.build([builder.apply(name, *builder.inputs)], ("y",))


@pytest.mark.parametrize("name", sorted(RULES))
def test_every_value_lies_within_its_bounds(name):
    program, rng = program_of(name), np.random.default_rng(7)
    size = (4000, len(program.inputs))
    low = rng.normal(0.0, 3.0, size) * rng.choice([0.0, 1.0, 30.0], size)
    high = low + rng.choice([0.0, 1e-9, 0.3, 5.0, 40.0], size) * rng.random(size)
    if name == "limit":
        low[:, 2], high[:, 2] = high[:, 1] + 0.1, high[:, 1] + 0.2
    bounds = enclose(program, low, high)
    for share in rng.random((30, *size)).round(1):  # the ends as well
        inside = np.minimum(low + share * (high - low), high)
        values = program(inside)
        known = ~np.isinf(bounds[0]) | ~np.isinf(bounds[1])
        assert np.all((values >= bounds[0]) & (values <= bounds[1]) | ~known)
        assert np.all(known | ~np.isnan(values) | np.isinf(bounds[0]))
    assert np.any(known)


def test_bounds_are_near_the_values_of_a_narrow_box():
    program = trace(
        lambda x: np.sin(x[0]) * np.cos(x[1]) + np.tan(x[0]) / np.hypot(x[0], x[1]) - np.exp(-np.abs(x[1])),
        [("x", ("x0", "x1"))],
        ("y",),
    )
    point = np.random.default_rng(1).uniform(0.2, 1.2, (200, 2))
    low, high = enclose(program, point, point)
    assert np.all(high - low <= 1e-12)
    low, high = enclose(program, point - 1e-6, point + 1e-6)
    assert np.all(high - low <= 1e-4)


def test_nothing_is_known_where_nothing_can_be():
    root, quotient = program_of("sqrt"), program_of("div")
    assert np.array_equal(enclose(root, np.array([[-1.0]]), np.array([[1.0]]))[0], [[-np.inf]])
    assert np.array_equal(enclose(quotient, np.array([[1.0, -1.0]]), np.array([[1.0, 1.0]]))[1], [[np.inf]])
    odd = program_of("sigmoid")
    assert np.array_equal(np.hstack(enclose(odd, np.zeros((1, 1)), np.ones((1, 1)))), [[-np.inf, np.inf]])
