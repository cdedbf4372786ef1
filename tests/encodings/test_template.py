import numpy as np
import pytest

from gpsynth.encodings.parameters import ParameterSpace
from gpsynth.encodings.template import TemplateEncoding
from gpsynth.encodings.tree import TreeEncoding
from gpsynth.errors import EncodingError
from gpsynth.seeds import stream
from gpsynth.tracing import trace

HOLES = TreeEncoding(("x", "y"), ("g", "h"), ("add", "mul", "sin"), ParameterSpace(4))


def test_the_formulas_stand_in_the_holes():
    encoding = TemplateEncoding(HOLES, lambda f, g, h: (g, f.x * h), ("u", "v"))
    rng, rows = stream(1), stream(2).normal(size=(10, 2))
    for _ in range(50):
        genome = encoding.random(rng)
        g, h = HOLES.decode(genome)(rows, genome.values).T
        program = encoding.decode(genome)
        assert (program.inputs, program.names) == (("x", "y"), ("u", "v"))
        assert np.array_equal(program(rows, genome.values), np.column_stack([g, rows[:, 0] * h]))


def test_holes_may_see_fewer_inputs_than_the_skeleton():
    holes = TreeEncoding(("y",), ("g",), ("sin",))
    encoding = TemplateEncoding(holes, lambda f, g: f.x * g, ("u",), inputs=("x", "y", "z"))
    program = encoding.decode(holes.from_program(trace(lambda f: np.sin(f.y), [("f", ("y",))], ("g",))))
    assert program(np.array([[2.0, 1.0, 9.0]]))[0, 0] == pytest.approx(2.0 * np.sin(1.0))


def test_a_skeleton_may_be_a_program():
    skeleton = trace(lambda f, g, h: g + h * f.y, [("f", ("x", "y")), ("g", "g"), ("h", "h")], ("u",))
    assert TemplateEncoding(HOLES, skeleton, ("u",)) == TemplateEncoding(
        HOLES, lambda f, g, h: g + h * f.y, ("u",)
    )


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"skeleton": lambda f, g, h: g}, "the skeleton does not use the hole 'h'"),
        ({"inputs": ("x",)}, "the holes see 'y', which is not one of the inputs x"),
        ({"inputs": ("x", "y", "g")}, "'g' is the name of a hole and of an input"),
        ({"outputs": ()}, "outputs must be one name or more"),
        (
            {"skeleton": trace(lambda f: f.x, [("f", ("x", "y"))], ("u",))},
            "the skeleton maps x, y to u; expected x, y, g, h to u",
        ),
    ],
)
def test_wrong_templates_are_named(changes, sentence):
    settings = {"skeleton": lambda f, g, h: g + h, "outputs": ("u",), **changes}
    with pytest.raises(EncodingError, match=sentence):
        TemplateEncoding(HOLES, **settings)
