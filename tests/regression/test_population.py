"""The data machine against the lane machine and the interpreter, bit for bit; shared subtrees change nothing."""

import numpy as np
import pytest

from gpsynth.arrays import Floats
from gpsynth.builder import Builder
from gpsynth.errors import RegressionError
from gpsynth.kernels import elementary
from gpsynth.kernels.data_code import BINARY, NAMES, OPCODE
from gpsynth.kernels.data_machine import BLOCK
from gpsynth.regression.expressions import evaluate, flatten, program_of
from gpsynth.regression.population import columns_of, population, scores, scoring, share, values_of
from gpsynth.regression.population import evaluate as run
from tests.regression.helpers import random_expression

SPECIAL = (0.0, -0.0, 1.0, -2.5, 1e-310, 1e300, -1e9, np.inf, -np.inf, np.nan)


def same_bits(a: Floats, b: Floats) -> bool:
    known = ~(np.isnan(a) & np.isnan(b))
    return bool(np.array_equal(a.view(np.int64)[known], b.view(np.int64)[known]))


@pytest.mark.parametrize("name", NAMES)
def test_every_operation_is_its_scalar_function_bit_for_bit(name: str) -> None:
    rng = np.random.default_rng(1)
    pairs = np.array(
        [(a, b) for a in SPECIAL for b in SPECIAL] + [tuple(rng.normal(size=2)) for _ in range(60)]
    )
    tree = (name, ("variable", 0), ("variable", 1)) if name in BINARY else (name, ("variable", 0))
    found = evaluate([tree], pairs)[0]
    expected = [elementary.evaluate(name, *(pair if name in BINARY else pair[:1])) for pair in pairs.tolist()]
    assert same_bits(found, np.array(expected))


@pytest.mark.parametrize("constant", [0.0, -0.0, 2.5, -1e308])
@pytest.mark.parametrize("name", sorted(BINARY))
def test_a_number_as_operand_gives_the_same_bits_as_a_column(name: str, constant: float) -> None:
    rows = np.array([(a, constant) for a in (*SPECIAL, 3.7)])
    for order in ((0, 1), (1, 0)):
        operands = (("variable", 0), ("number", constant))
        columns = (("variable", 0), ("variable", 1))
        first, second = evaluate(
            [(name, *(operands[k] for k in order)), (name, *(columns[k] for k in order))], rows
        )
        assert same_bits(first, second)


def test_a_population_is_each_of_its_programs_bit_for_bit() -> None:
    rng = np.random.default_rng(2)
    rows = rng.normal(size=(70, 3))
    programs = [
        program_of([random_expression(rng, int(rng.integers(1, 30)), 3)], ("a", "b", "c"), ("y",))
        for _ in range(60)
    ]
    found = values_of(population(programs), rows)
    for values, program in zip(found, programs, strict=True):
        assert same_bits(values, program(rows)[:, 0])


def test_shared_subtrees_are_computed_once_and_give_the_same_bits() -> None:
    rng = np.random.default_rng(3)
    rows = rng.normal(size=(40, 2))
    parts = [random_expression(rng, 6, 2) for _ in range(5)]
    trees = [
        ("add", parts[i], ("mul", parts[j], parts[k])) for i in range(5) for j in range(5) for k in range(5)
    ]
    whole = flatten(trees).population
    shared = share(whole)
    assert shared.nodes < len(whole.ops) / 5
    together = run(shared, columns_of(rows))[shared.outputs, : len(rows)]
    alone = np.concatenate([evaluate([tree], rows) for tree in trees])
    assert same_bits(together, alone)


def test_numbers_that_differ_in_sign_of_zero_are_not_shared() -> None:
    values = evaluate([("div", ("number", 1.0), ("number", zero)) for zero in (0.0, -0.0)], np.ones((1, 1)))
    assert values[:, 0].tolist() == [np.inf, -np.inf]


@pytest.mark.parametrize("name", NAMES)
def test_an_operation_on_numbers_is_a_number_with_the_same_bits(name: str) -> None:
    rows = np.array([(a, b) for a in (*SPECIAL, 0.7, 31.25) for b in (*SPECIAL, -1.5)])
    arity = 2 if name in BINARY else 1
    trees = [(name, *(("number", x) for x in row[:arity])) for row in rows.tolist()]
    shared = share(flatten(trees).population)
    assert not np.isin(shared.code[:, 0], list(OPCODE.values())).any()
    columns = evaluate([(name, *(("variable", j) for j in range(arity)))], rows)[0]
    assert same_bits(np.ascontiguousarray(evaluate(trees, rows[:1])[:, 0]), columns)


def test_the_row_of_a_value_read_for_the_last_time_is_used_again() -> None:
    tree = ("variable", 0)
    for _ in range(20):
        tree = ("sin", ("mul", tree, ("variable", 1)))
    assert share(flatten([tree]).population).rows == 3


@pytest.mark.parametrize("second", ["add", "sub", "mul"])
@pytest.mark.parametrize("first", ["add", "sub", "mul"])
def test_two_operations_in_one_instruction_give_the_bits_of_two(first: str, second: str) -> None:
    rng = np.random.default_rng(7)
    rows = np.concatenate((rng.choice(SPECIAL, (300, 3)), rng.normal(size=(300, 3))))
    inner = (first, ("variable", 0), ("variable", 1))
    values = np.array([elementary.evaluate(first, *row[:2]) for row in rows.tolist()])
    for left in (True, False):
        tree = (second, inner, ("variable", 2)) if left else (second, ("variable", 2), inner)
        operands = zip(values.tolist(), rows[:, 2].tolist(), strict=True)
        expected = [elementary.evaluate(second, *(pair if left else pair[::-1])) for pair in operands]
        assert len(share(flatten([tree]).population).code) == 2
        assert same_bits(evaluate([tree], rows)[0], np.array(expected))
    squared = ("mul", inner, inner)
    assert same_bits(evaluate([squared], rows)[0], values * values)
    kept = evaluate([(second, inner, ("variable", 2)), ("neg", inner)], rows)[1]
    assert same_bits(kept, -values)


@pytest.mark.parametrize("count", [1, 15, 16, 17, BLOCK - 1, BLOCK, BLOCK + 1, 600])
def test_any_number_of_rows_gives_the_same_bits(count: int) -> None:
    rng = np.random.default_rng(4)
    trees = [random_expression(rng, 15, 2) for _ in range(8)]
    rows = rng.normal(size=(600, 2))
    assert same_bits(evaluate(trees, rows[:count]), np.ascontiguousarray(evaluate(trees, rows)[:, :count]))


def test_scores_are_those_of_least_squares() -> None:
    rng = np.random.default_rng(5)
    rows, weights = rng.uniform(0.5, 2.0, (301, 2)), rng.uniform(0.5, 2.0, 301)
    y = rows[:, 0] * rows[:, 1] + 1000.0
    trees = [random_expression(rng, 9, 2) for _ in range(100)]
    found = scores(flatten(trees).population, scoring(rows, y, weights))
    w, target = weights.astype(np.longdouble), y.astype(np.longdouble)
    target -= w @ target / w.sum()
    total = w @ target**2
    for values, error, slope, constant in zip(evaluate(trees, rows), *found, strict=True):
        if not np.all(np.isfinite(values)):
            assert error == np.inf
            continue
        centered = values - w @ values / w.sum()
        overlap, squares = w @ (centered * target), w @ centered**2
        assert error == pytest.approx(
            float(1.0 - (overlap**2 / squares if squares > 0.0 else 0.0) / total), abs=1e-9
        )
        assert w @ (y - slope * values - constant) ** 2 / total == pytest.approx(error, abs=1e-6)


def test_an_operation_without_derivative_is_named() -> None:
    builder = Builder(("x",))
    program = builder.build([builder.apply("sign", builder.inputs[0])])
    with pytest.raises(RegressionError, match="sign is no operation of regression"):
        population([program])
