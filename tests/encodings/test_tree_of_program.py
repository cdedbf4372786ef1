import numpy as np
import pytest

from gpsynth.builder import Builder
from gpsynth.encodings.parameters import ParameterSpace
from gpsynth.encodings.tree import TreeEncoding
from gpsynth.errors import EncodingError
from gpsynth.operations import GP_NAMES
from gpsynth.seeds import stream
from gpsynth.tracing import trace

POOR = ("add", "mul", "sin")
ROWS = stream(1).normal(size=(20, 2))


def traced(function, outputs=("u",)):
    return trace(function, [("f", ("x", "y"))], outputs)


def encoding(operations=POOR, outputs=("u",), count=8, **changes):
    return TreeEncoding(("x", "y"), outputs, operations, ParameterSpace(count, -10.0, 10.0), **changes)


def test_a_genome_s_program_gives_the_genome_s_values_again():
    space = TreeEncoding(("x", "y"), ("u", "v"), GP_NAMES, ParameterSpace(6, -2.0, 2.0))
    rng = stream(2)
    for _ in range(200):
        genome = space.random(rng)
        program = space.decode(genome)
        if program.complexity:
            again = space.from_program(program, genome.values)
            assert np.array_equal(
                space.decode(again)(ROWS, again.values), program(ROWS, genome.values), equal_nan=True
            )


@pytest.mark.parametrize(
    "function",
    [
        lambda f: -f.x,
        lambda f: f.x - 2.0 * f.y,
        lambda f: f.x**2 + f.y**3,
        lambda f: np.sin(0.5 * f.x) * (f.x - f.y) ** 2,
        lambda f: 3.0,
    ],
)
def test_what_is_not_offered_is_written_by_others_with_the_same_bits(function):
    program = traced(function)
    genome = encoding().from_program(program)
    assert np.array_equal(encoding().decode(genome)(ROWS, genome.values), program(ROWS))


def test_half_and_double_are_products():
    builder = Builder(("x", "y"))
    program = builder.build(
        [builder.apply("half", builder.inputs[0]), builder.apply("double", builder.inputs[1])], ("u", "v")
    )
    genome = encoding(outputs=("u", "v")).from_program(program)
    assert genome.values == (0.5, 2.0)


def test_parameters_come_with_their_numbers():
    builder = Builder(("x", "y"), ("k",))
    (k,), (x, y) = builder.parameters, builder.inputs
    shared = builder.apply("mul", k, builder.apply("add", x, y))
    program = builder.build([builder.apply("add", shared, builder.apply("sin", shared))], ("u",))
    genome = encoding().from_program(program, [2.5])
    assert genome.values == (2.5, 2.5)  # a tree shares nothing
    assert np.array_equal(encoding().decode(genome)(ROWS, genome.values), program(ROWS, [2.5]))


@pytest.mark.parametrize(
    ("function", "changes", "sentence"),
    [
        (lambda f: np.tanh(f.x), {}, "uses tanh, which is not one of the operations add, mul, sin; offer it"),
        (lambda f: f.x - f.y, {"operations": ("add", "sin")}, "uses sub"),
        (lambda f: 12.0 * f.x, {}, r"parameter 0 is 12.0; it must lie in \[-10.0, 10.0\]"),
        (lambda f: 2.0 * f.x, {"count": 0}, "the trees have 1 numbers; at most 0 are allowed"),
        (lambda f: f.x * f.y * f.x * f.y, {"max_size": 5}, "more than 5 nodes"),
        (
            lambda f: f.x * f.y * f.x * f.y,
            {"max_height": 1, "start_heights": (0, 1), "grown_heights": (0, 1)},
            "height",
        ),
        (lambda f: f.x, {"outputs": ("v",)}, "maps x, y to u; expected x, y to v"),
    ],
)
def test_a_formula_of_another_space_is_refused(function, changes, sentence):
    with pytest.raises(EncodingError, match=sentence):
        encoding(**changes).from_program(traced(function))


def test_an_input_may_be_called_like_an_operation():
    space = TreeEncoding(("sin", "y"), ("u",), POOR, ParameterSpace(2))
    program = trace(lambda f: np.sin(f[0]) + f[1], [("f", ("sin", "y"))], ("u",))
    assert np.array_equal(space.decode(space.from_program(program))(ROWS, ()), program(ROWS))


def test_missing_numbers_are_named():
    builder = Builder(("x", "y"), ("k",))
    program = builder.build([builder.apply("mul", builder.parameters[0], builder.inputs[0])], ("u",))
    with pytest.raises(EncodingError, match="has the parameters k; 0 values came"):
        encoding().from_program(program)
