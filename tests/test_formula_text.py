import numpy as np
import pytest
import sympy

from gpsynth.builder import bind
from gpsynth.encodings.parameters import ParameterSpace
from gpsynth.encodings.tree import TreeEncoding
from gpsynth.errors import FormulaError
from gpsynth.export import to_sympy
from gpsynth.formula import lines
from gpsynth.formula_text import read_formulas
from gpsynth.operations import GP_NAMES
from gpsynth.seeds import stream

ROWS = stream(1).uniform(-2.0, 2.0, (50, 2))
X, Y = ROWS.T


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("2*x + y/3 - 1", 2 * X + Y / 3 - 1),
        ("-x^2", -(X**2)),
        ("x**3 * +y", X**3 * Y),
        ("tanh(x) if x < y else max(x, 0.5)", np.where(X < Y, np.tanh(X), np.maximum(X, 0.5))),
        ("np.arctan2(y, x) + maximum(x, y)", np.arctan2(Y, X) + np.maximum(X, Y)),
        ("(x > 0) + (x >= y) + (x == x) + (x != y)", (X > 0) * 1.0 + (X >= Y) + 1 + (X != Y)),
        ("not (x < y)", (X >= Y) * 1.0),
        ("a = x + y\nb = a * a\nu = a * b + a", (X + Y) ** 3 + X + Y),
        ("u = 3", np.full(50, 3.0)),
    ],
)
def test_text_means_what_python_means_by_it(text, values):
    program = read_formulas(text, ("x", "y"), ("u",))
    assert program(ROWS)[:, 0] == pytest.approx(values, rel=1e-14, abs=1e-14)


def test_what_is_printed_can_be_read_again():
    encoding = TreeEncoding(("x", "y"), ("u", "v"), GP_NAMES, ParameterSpace(6, -2.0, 2.0))
    rng = stream(2)
    same = 0
    for _ in range(200):
        genome = encoding.random(rng)
        program = bind(encoding.decode(genome), genome.values)
        read = read_formulas("\n".join(lines(program)), encoding.inputs, encoding.outputs)
        assert read.complexity <= program.complexity
        same += np.allclose(
            read(ROWS), program(ROWS), rtol=1e-3, atol=1e-3
        )  # numbers are printed with six digits
    assert same > 180  # steep formulas and steps magnify the seventh digit


@pytest.mark.parametrize(
    "text",
    [
        "abs(x) - 0.25 * max(x, y) + min(y, 0.5)",
        "max(x, max(y, 1.5)) * pi",
        "tanh(2.5 * x) + y^2 / (1 + x^2) - sqrt(abs(x)) * exp(y)",
        "sign(x) * atan2(y, x) + cos(x)^3",
    ],
)
def test_what_sympy_has_rewritten_can_be_read_again(text):
    program = read_formulas(text, ("x", "y"), ("u",))
    (expression,) = to_sympy(program, expanded=True).expressions
    again = read_formulas(str(sympy.expand(sympy.simplify(expression))), ("x", "y"), ("u",))
    assert again(ROWS) == pytest.approx(program(ROWS), rel=1e-9, abs=1e-9)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "the text is empty"),
        ("2 x", "the text is not a formula: invalid syntax"),
        ("u = z + 1", "there is no 'z'; known are x, y, pi"),
        ("v = x", r"the text has no line u = \.\.\."),
        ("import os", "expected lines like u = ..., got 'import os'"),
        ("u = __import__('os')", r"'os'.* is nothing that a formula can hold"),
        ("Piecewise((x, x < 0))", r"the last pair of Piecewise must be \(value, True\)"),
        ("Piecewise(x, (y, True))", r"Piecewise takes pairs \(value, condition\), got 'x'"),
        ("u = x.y", "'x.y' is nothing that a formula can hold"),
        ("u = foo(x)", "there is no function 'foo'"),
        ("u = sin(x, y)", "sin does not take 2 operands|sin takes 1 operands"),
        ("u = [x for x in x]", "is nothing that a formula can hold"),
        ("u = True", "'True' is nothing that a formula can hold"),
        ("u = x < y < 1", "is nothing that a formula can hold"),
        ("u = 2.0**x", "power|exponent"),
        ("u = " + "-" * 9000 + "x", "not a formula|nested|characters"),
        ("u = " + "x + " * 4000 + "x", "at most 10000 are read"),
    ],
)
def test_what_is_no_formula_is_one_sentence(text, sentence):
    with pytest.raises(FormulaError, match=sentence):
        read_formulas(text, ("x", "y"), ("u",))
