"""Builders keep every bit: whatever they share, drop or compute at once, the values are those of the plain code."""

import itertools

import numpy as np
import pytest

from gpsynth.builder import Builder, bind, compose, simplify
from gpsynth.errors import OperationError, ProgramError
from gpsynth.kernels import elementary
from gpsynth.operations import CODES, OPERATIONS
from gpsynth.program import UNUSED, Program
from gpsynth.seeds import stream

SPECIAL = np.array(
    [0.0, -0.0, 1.0, -1.0, 0.5, np.pi, 1e-8, -1e-300, 5e-324, 1e8, 1e308, np.inf, -np.inf, np.nan]
)
SEEDS = pytest.mark.parametrize("seed", range(25))


def random_program(seed, inputs=3, parameters=2, constants=4, instructions=30):
    """Any operations on any earlier values, dead and double code among them; outputs anywhere."""
    rng = stream(100, seed)
    known = inputs + parameters + constants
    code = np.full((instructions, 4), UNUSED)
    code[:, 0] = rng.integers(0, len(OPERATIONS), instructions)
    for index, row in enumerate(code):
        arity = OPERATIONS[row[0]].arity
        row[1 : 1 + arity] = rng.integers(0, known + index, arity)
    code[instructions // 2] = code[instructions // 3]  # a common subexpression
    return Program(
        inputs=tuple(f"x{k}" for k in range(inputs)),
        parameters=tuple(f"q{k}" for k in range(parameters)),
        constants=rng.choice([0.0, -0.0, 1.0, -1.0, 0.3, 2.0, np.inf, np.nan], constants),
        code=code,
        outputs=rng.integers(0, known + instructions, 6),
        names=tuple(f"y{k}" for k in range(6)),
    )


def rows_of(count, seed):
    """Special and ordinary values, mixed."""
    rng = stream(101, seed)
    ordinary = rng.normal(0.0, 3.0, (60, count))
    return np.where(rng.random((60, count)) < 0.5, rng.choice(SPECIAL, (60, count)), ordinary)


def reference(program, inputs, parameters):
    """The outputs, instruction by instruction, without Program's or Builder's own code."""
    values = [*inputs, *parameters, *program.constants]
    for name, *operands in program.code.tolist():
        row = OPERATIONS[name]
        values.append(elementary.evaluate(row.name, *(values[operand] for operand in operands[: row.arity])))
    return np.array([values[output] for output in program.outputs])


def same_bits(a, b):
    """Equal in every bit, all NaN being one."""
    both_nan = np.isnan(a) & np.isnan(b)
    return np.all(both_nan | (np.asarray(a).view(np.int64) == np.asarray(b).view(np.int64)))


@SEEDS
def test_the_machine_computes_what_the_code_says(seed):
    program = random_program(seed)
    rows, parameters = rows_of(3, seed), rows_of(2, seed + 1000)
    expected = np.array([reference(program, *pair) for pair in zip(rows, parameters, strict=True)])
    assert same_bits(program(rows, parameters), expected)


@SEEDS
def test_simplify_keeps_every_bit(seed):
    program = random_program(seed)
    smaller = simplify(program)
    assert smaller.inputs == program.inputs
    assert smaller.parameters == program.parameters
    assert smaller.names == program.names
    assert smaller.complexity < program.complexity
    for inputs, parameters in zip(rows_of(3, seed), rows_of(2, seed + 1000), strict=True):
        assert same_bits(reference(smaller, inputs, parameters), reference(program, inputs, parameters))


@SEEDS
def test_simplify_twice_is_simplify_once(seed):
    once = simplify(random_program(seed))
    assert simplify(once) == once


@SEEDS
def test_bind_keeps_every_bit(seed):
    program = random_program(seed)
    for inputs, parameters in zip(rows_of(3, seed)[:8], rows_of(2, seed + 1000)[:8], strict=True):
        bound = bind(program, parameters)
        assert bound.parameters == ()
        assert same_bits(reference(bound, inputs, ()), reference(program, inputs, parameters))


@SEEDS
def test_compose_keeps_every_bit(seed):
    inner, outer = random_program(seed), random_program(seed + 50, inputs=6, parameters=1)
    inner = Program(inner.inputs, ("p0", "p1"), inner.constants, inner.code, inner.outputs, inner.names)
    both = compose(outer, inner)
    assert both.parameters == ("p0", "p1", "q0")
    for inputs, parameters in zip(rows_of(3, seed), rows_of(3, seed + 1000), strict=True):
        expected = reference(outer, reference(inner, inputs, parameters[:2]), parameters[2:])
        assert same_bits(reference(both, inputs, parameters), expected)


@pytest.mark.parametrize("row", OPERATIONS, ids=lambda row: row.name)
def test_constant_operands_keep_every_bit(row):
    """Each operation with each operand once constant, once not: every rewriting rule is met."""
    for constant_places in itertools.product((False, True), repeat=row.arity):
        for constants in itertools.product(SPECIAL[:10:2], repeat=row.arity):
            builder = Builder([f"x{k}" for k in range(row.arity)])
            operands = [
                builder.constant(constant) if is_constant else builder.inputs[k]
                for k, (constant, is_constant) in enumerate(zip(constants, constant_places, strict=True))
            ]
            program = builder.build([builder.apply(row.name, *operands)])
            for values in itertools.product(SPECIAL[::4], repeat=row.arity):
                chosen = np.where(constant_places, constants, values)
                expected = elementary.evaluate(row.name, *chosen)
                assert same_bits(reference(program, values, ()), np.array([expected]))


def build(expression, inputs=("x", "y")):
    builder = Builder(inputs)
    return builder.build([expression(builder, *builder.inputs)])


VANISHING = {
    "identity": lambda b, x, y: b.apply("identity", x),
    "times_one": lambda b, x, y: b.apply("mul", x, b.constant(1.0)),
    "one_times": lambda b, x, y: b.apply("mul", b.constant(1.0), x),
    "over_one": lambda b, x, y: b.apply("div", x, b.constant(1.0)),
    "minus_zero": lambda b, x, y: b.apply("sub", x, b.constant(0.0)),
    "minus_minus": lambda b, x, y: b.apply("neg", b.apply("neg", x)),
    "where_true": lambda b, x, y: b.apply("where", b.constant(np.nan), x, y),
    "where_false": lambda b, x, y: b.apply("where", b.constant(-0.0), y, x),
}


@pytest.mark.parametrize("expression", VANISHING.values(), ids=VANISHING)
def test_what_changes_no_bit_vanishes(expression):
    program = build(expression)
    assert program.complexity == 0
    assert program.outputs.tolist() == [0]


STAYING = {
    "plus_zero": lambda b, x, y: b.apply("add", x, b.constant(0.0)),  # -0.0 + 0.0 is 0.0
    "minus_negative_zero": lambda b, x, y: b.apply("sub", x, b.constant(-0.0)),
    "times_zero": lambda b, x, y: b.apply("mul", x, b.constant(0.0)),  # NaN for infinity
    "x_minus_x": lambda b, x, y: b.apply("sub", x, x),
    "x_over_x": lambda b, x, y: b.apply("div", x, x),
    "max_of_x_and_nan": lambda b, x, y: b.apply("max", x, b.constant(np.nan)),
}


@pytest.mark.parametrize("expression", STAYING.values(), ids=STAYING)
def test_what_could_change_a_bit_stays(expression):
    assert build(expression).complexity == 1


def test_equal_values_are_one_value():
    builder = Builder(("x", "y"))
    x, y = builder.inputs
    assert builder.apply("add", x, y) == builder.apply("add", y, x)
    assert builder.apply("max", x, y) != builder.apply("max", y, x)
    assert builder.constant(0.0) != builder.constant(-0.0)


def test_dead_values_are_dropped():
    builder = Builder(("x",), ("q",))
    builder.apply("sin", builder.apply("add", builder.inputs[0], builder.constant(3.0)))
    program = builder.build([builder.apply("cos", builder.inputs[0])])
    assert program.complexity == 1
    assert program.constants.size == 0
    assert program.inputs == ("x",)
    assert program.parameters == ("q",)


def test_default_names_of_outputs():
    builder = Builder(("x",))
    assert builder.build(builder.inputs * 2).names == ("y0", "y1")


def test_unknown_operation_is_an_error():
    with pytest.raises(OperationError, match="sine"):
        Builder(("x",)).apply("sine", 0)


@pytest.mark.parametrize("operands", [(), (0,), (0, 0, 0), (0, 99), (0, -1)])
def test_wrong_operands_are_an_error(operands):
    with pytest.raises(ProgramError):
        Builder(("x",)).apply("add", *operands)


@pytest.mark.parametrize("output", [1, -1])
def test_unknown_output_is_an_error(output):
    with pytest.raises(ProgramError):
        Builder(("x",)).build([output])


def test_bind_needs_one_number_for_each_parameter():
    with pytest.raises(ProgramError, match="2 parameters, got 3 and 1"):
        bind(random_program(0), [1.0])


def test_compose_needs_as_many_outputs_as_inputs():
    with pytest.raises(ProgramError, match="takes 3 inputs and 2 parameters, got 6"):
        compose(random_program(0), simplify(Program((), (), *_six_zeros())))


def _six_zeros():
    return np.zeros(1), np.empty((0, 4), dtype=np.int32), np.zeros(6, dtype=np.int32), tuple("abcdef")


def test_every_operation_can_be_built():
    for name in CODES:
        arity = OPERATIONS[CODES[name]].arity
        builder = Builder([f"x{k}" for k in range(arity)])
        expected = 0 if name == "identity" else 1
        assert builder.build([builder.apply(name, *builder.inputs)]).complexity == expected
