"""Formulas keep the signs they were told to keep, in every operation, and what fits is left alone."""

import numpy as np
import pytest

from gpsynth.builder import Builder
from gpsynth.encodings.parameters import ParameterSpace
from gpsynth.encodings.symmetry_rules import SymmetryRules
from gpsynth.encodings.tree import TreeEncoding
from gpsynth.errors import EncodingError
from gpsynth.operations import GP_NAMES, OPERATIONS, operation
from gpsynth.seeds import stream

SIGNS = {"x": "+-", "y": "--", "z": "-+", "u": "+-", "v": "-+"}
FLIPS = np.array([[1.0, -1.0, -1.0], [-1.0, -1.0, 1.0]])  # what each symmetry does to x, y, z
OUTPUTS = np.array([[1.0, -1.0], [-1.0, 1.0]])  # and to u, v


def _encoding(operations, **settings):
    return TreeEncoding(
        ("x", "y", "z"), ("u", "v"), operations, ParameterSpace(6, -4.0, 4.0), symmetries=SIGNS, **settings
    )


def _breaks(program, values, inputs):
    parameters = values[np.newaxis]
    before = program(inputs, parameters)
    for flips, outputs in zip(FLIPS, OUTPUTS, strict=True):
        after = program(inputs * flips, parameters)
        same = np.isclose(after, before * outputs, rtol=1e-9, atol=1e-12, equal_nan=True)
        yield not (same | ~np.isfinite(before)).all()


@pytest.mark.parametrize(
    "operations",
    [
        GP_NAMES,
        ("sub", "mul", "sgn", "div_protected", "div", "atan2", "nop_inverse"),
        ("sub", "signed_abs_max", "signed_hypot", "signed_decay", "nop_cbrt", "signed_sqrt"),
        ("add", "sub", "mul", "where", "lt", "hypot", "tanh", "cube"),
    ],
)
def test_all_formulas_keep_the_symmetries(operations):
    encoding, rng = _encoding(operations), stream(1)
    inputs = rng.normal(size=(50, 3))
    genome = encoding.random(rng)
    for _ in range(300):
        for child in encoding.crossover(encoding.mutate(genome, rng), encoding.random(rng), rng):
            assert not any(_breaks(encoding.decode(child), encoding.parameters(child), inputs))
        genome = encoding.mutate(genome, rng)


def test_without_symmetries_formulas_break_them():
    free = TreeEncoding(("x", "y", "z"), ("u", "v"), GP_NAMES, ParameterSpace(6, -4.0, 4.0))
    rng = stream(1)
    genomes = [free.random(rng) for _ in range(50)]
    inputs = rng.normal(size=(50, 3))
    broken = [any(_breaks(free.decode(each), free.parameters(each), inputs)) for each in genomes]
    assert np.mean(broken) > 0.5


@pytest.mark.parametrize("name", [row.name for row in OPERATIONS])
def test_what_the_rules_allow_an_operation_is_so(name):
    """Whatever combination of operands the rules leave in place, the result has the sign they say."""
    arity, rng = operation(name).arity, stream(2)
    leaves = [("x", 0), ("y", 1)]
    rules = SymmetryRules((0, 1), (0, 1))
    for index in np.ndindex(*(2,) * arity):
        tree = [(name, name), *(leaves[k] for k in index)]
        for output in range(2):
            if len(rules.fitted(tree, output)) == len(tree):
                builder = Builder(("x", "y"))
                program = builder.build([builder.apply(name, *(builder.inputs[k] for k in index))])
                inputs = rng.normal(size=(200, 2))
                sign = 1.0 if output == 0 else -1.0
                assert np.allclose(program(inputs * [1.0, -1.0]), sign * program(inputs), equal_nan=True)


def test_the_largest_part_that_fits_stays():
    rules = SymmetryRules.of({"a": "-", "b": "+", "u": "-"}, ("a", "b"), ("u",))
    tree = [("+", "add"), ("a", 0), ("*", "mul"), ("b", 1), ("+", "add"), ("a", 0), ("b", 1)]
    kept = [node for node, _ in rules.fitted(tree, 0)]
    assert kept == ["+", "a", "*", "b", "a"]  # a + b (a + b) becomes a + b a


def test_a_formula_that_fits_stays_whole():
    rules = SymmetryRules.of({"a": "-", "b": "+", "u": "-"}, ("a", "b"), ("u",))
    tree = [("*", "mul"), ("a", 0), ("cos", "cos"), ("+", "add"), ("b", 1), ("2", None)]
    assert rules.fitted(tree, 0) == tree


@pytest.mark.parametrize(
    ("signs", "sentence"),
    [
        ({"x": "+", "u": "-"}, "no input has the signs of u"),
        ({"x": "+-", "u": "+"}, "equally long.*x has '[+]-', u '[+]'"),
        ({"x": "*", "u": "+"}, "the signs of x are a text of [+] and -, not '[*]'"),
        ({"x": "", "u": ""}, "the signs of x are a text of [+] and -, not ''"),
        ({"x": 1, "u": -1}, "the signs of x are a text of [+] and -, not 1"),
        ({"x": "-"}, "'u' has none"),
        ({"x": "-", "u": "-", "w": "-"}, "'w' is none of them"),
    ],
)
def test_signs_that_make_no_sense_are_one_sentence(signs, sentence):
    with pytest.raises(EncodingError, match=sentence):
        TreeEncoding(("x",), ("u",), ("add",), symmetries=signs)
