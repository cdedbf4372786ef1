"""The lane machine against the scalar functions: its numbers are the table's, and lanes never see each other."""

import itertools
import os
import subprocess
import sys

import numpy as np
import pytest

from gpsynth.arrays import Floats, frozen
from gpsynth.builder import Builder
from gpsynth.kernels import elementary, machine, pairs, vectors
from gpsynth.operations import OPERATIONS, Operation
from gpsynth.program import Program

SPECIAL = (
    *(0.0, -0.0, 1.0, -1.0, 0.5, -0.01, 3.0, np.pi, -np.pi, 1e-8, -1e-9, 2.5e-308, 5e-324, 18.5, -465.0, 1e4),
    *(-1.5e8, 1e300, np.inf, -np.inf, np.nan),
)


def _same_bits(a: Floats, b: Floats) -> bool:
    """Equal in every bit; a NaN has no sign and no payload that anybody should read."""
    known = ~(np.isnan(a) & np.isnan(b))
    return np.array_equal(a.view(np.int64)[known], b.view(np.int64)[known])


def _operands(arity: int, rng: np.random.Generator) -> Floats:
    """Rows of special values in every combination, then of random ones over many magnitudes."""
    few = SPECIAL if arity < 3 else (*SPECIAL[::3], np.nan)
    special = np.array(list(itertools.product(few, repeat=arity)))
    ordinary = rng.normal(size=(150, arity)) * 10.0 ** rng.uniform(-9, 9, (150, arity))
    return np.concatenate((special, ordinary, rng.uniform(-3, 3, (150, arity))))


def _program(rng: np.random.Generator, instructions: int = 40) -> Program:
    """A random program over all operations that are total, with two parameters."""
    builder = Builder(("a", "b", "c"), ("p", "q"))
    values = [*builder.inputs, *builder.parameters, builder.constant(0.3)]
    for _ in range(instructions):
        row = OPERATIONS[rng.integers(len(OPERATIONS))]
        values.append(builder.apply(row.name, *(int(v) for v in rng.choice(values, row.arity))))
    return builder.build(values[-6:])


@pytest.mark.parametrize("row", OPERATIONS, ids=[row.name for row in OPERATIONS])
def test_every_operation_is_its_scalar_function_bit_for_bit(row: Operation) -> None:
    operands = _operands(row.arity, np.random.default_rng(3))
    code = np.array(
        [[OPERATIONS.index(row), 0, *range(1, row.arity), *[0] * (3 - row.arity)]], dtype=np.int32
    )
    outputs = np.array([row.arity], dtype=np.int32)
    found = machine.evaluate(code, np.empty(0), outputs, operands, np.empty((1, 0)))[:, 0]
    expected = np.array([elementary.evaluate(row.name, *values) for values in operands.tolist()])
    assert _same_bits(np.ascontiguousarray(found), expected)


def test_sine_and_cosine_together_are_those_apart() -> None:
    angles = np.concatenate(
        (_operands(1, np.random.default_rng(4))[:, 0], [1e8, -1e8, np.nextafter(1e8, 1e9)])
    )
    w = np.zeros((3, -(-len(angles) // vectors.WIDTH) * vectors.WIDTH))
    w[0, : len(angles)] = angles
    machine.execute(
        frozen(np.array([[machine.SINE_AND_COSINE, 1, 0, 2, 0]], dtype=np.int32)), 0, 1, w, len(angles)
    )
    for row, name in ((1, "sin"), (2, "cos")):
        apart = np.array([elementary.evaluate(name, angle) for angle in angles.tolist()])
        assert _same_bits(w[row, : len(angles)].copy(), apart)


@pytest.mark.parametrize("first", [row for row, leads in zip(OPERATIONS, pairs.FIRSTS, strict=True) if leads])
def test_a_pair_gives_the_bits_of_its_two_instructions(first: Operation) -> None:
    operands = _operands(first.arity + 1, np.random.default_rng(5))
    lanes, other = len(operands), first.arity
    w = np.zeros((other + 2, -(-lanes // vectors.WIDTH) * vectors.WIDTH))
    w[: other + 1, :lanes] = operands.T
    for second, numbers in zip(OPERATIONS, pairs.SECONDS, strict=True):
        for number, ahead in zip(numbers.tolist(), (True, False), strict=True):
            if number < 0:
                continue
            operation = pairs.JOINED + pairs.FIRST_NUMBERS * number + OPERATIONS.index(first)
            code = frozen(np.array([[operation, other + 1, 0, 1, 2]], dtype=np.int32))
            machine.execute(code, 0, 1, w, lanes)
            values = [elementary.evaluate(first.name, *row[:other]) for row in operands.tolist()]
            both = [(value, row[other]) for value, row in zip(values, operands.tolist(), strict=True)]
            taken = [pair if ahead else pair[::-1] for pair in both]
            expected = [elementary.evaluate(second.name, *pair[: second.arity]) for pair in taken]
            assert _same_bits(w[other + 1, :lanes].copy(), np.array(expected)), (second.name, ahead)


def test_without_the_compiler_the_machine_gives_the_same_bits() -> None:
    code = (
        "import numpy as np\n"
        "from tests.kernels.test_machine import _program\n"
        "rng = np.random.default_rng(8)\n"
        "program = _program(rng)\n"
        "with np.errstate(all='ignore'):\n"
        "    found = program(rng.normal(size=(50, 3)), rng.normal(size=2))\n"
        "print(np.where(np.isnan(found), np.nan, found).tobytes().hex())"
    )
    compiled, plain = (
        subprocess.run(
            [sys.executable, "-c", code],
            env={**os.environ, **environment},
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for environment in ({}, {"NUMBA_DISABLE_JIT": "1"})
    )
    assert compiled == plain


def test_any_number_of_lanes_gives_the_same_bits() -> None:
    rng = np.random.default_rng(5)
    program = _program(rng)
    inputs, parameters = rng.normal(size=(130, 3)), rng.normal(size=(130, 2))
    whole = program(inputs, parameters)
    for lanes in range(131):
        assert _same_bits(program(inputs[:lanes], parameters[:lanes]), whole[:lanes])


def test_one_parameter_vector_serves_all_rows() -> None:
    rng = np.random.default_rng(6)
    program = _program(rng)
    inputs, parameters = rng.normal(size=(70, 3)), rng.normal(size=2)
    assert _same_bits(program(inputs, parameters), program(inputs, np.tile(parameters, (70, 1))))


def test_each_row_takes_its_own_parameters() -> None:
    builder = Builder(("x",), ("p",))
    program = builder.build([builder.apply("mul", builder.inputs[0], builder.parameters[0])])
    inputs, parameters = np.arange(100.0)[:, None], np.arange(100.0, 200.0)[:, None]
    assert np.array_equal(program(inputs, parameters), inputs * parameters)


def test_an_output_may_be_an_input_a_parameter_or_a_constant() -> None:
    builder = Builder(("x",), ("p",))
    program = builder.build([builder.inputs[0], builder.parameters[0], builder.constant(2.5)])
    assert program(np.array([[1.0], [2.0]]), [7.0]).tolist() == [[1.0, 7.0, 2.5], [2.0, 7.0, 2.5]]
