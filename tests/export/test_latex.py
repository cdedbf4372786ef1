import shutil

import numpy as np
import pytest

from gpsynth.builder import Builder
from gpsynth.export import to_document, to_latex
from gpsynth.export.latex import symbol
from gpsynth.law import Law
from tests.export.helpers import (
    LARGEST,
    law_of_numbers,
    law_of_operations,
    plant_of,
    random_law,
    robot_law,
    run,
    states_of,
)


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("x", "x"),
        ("theta", "\\theta"),
        ("omega", "\\omega"),
        ("x_target", "x^{*}"),
        ("theta_target", "\\theta^{*}"),
        ("error_theta", "\\Delta \\theta"),
        ("x1", "x_{1}"),
        ("speed", "\\mathrm{speed}"),
        ("x_dot", "x_{\\mathrm{dot}}"),
        ("omega_left_2", "\\omega_{\\mathrm{left},2}"),
    ],
)
def test_names_read_as_in_papers(name, expected):
    assert symbol(name) == expected


def _right_side(build, states=("a", "b", "c")) -> str:
    """What stands inside the saturation of the only control."""
    builder = Builder(states)
    program = builder.build([build(builder, *builder.inputs)], ["u"])
    law = Law(plant_of(states, ["u"], 1.0), states_of(states), program, np.empty(0))
    line = next(line for line in to_latex(law).splitlines() if line.startswith("  u &= "))
    return line.removeprefix("  u &= \\operatorname{sat}_{-1}^{1}\\left(").removesuffix("\\right)")


CASES = {
    "a + b \\, c": lambda m, a, b, c: m.apply("add", m.apply("mul", b, c), a),
    "c \\left(a + b\\right)": lambda m, a, b, c: m.apply("mul", c, m.apply("add", a, b)),
    "a - \\left(b - c\\right)": lambda m, a, b, c: m.apply("sub", a, m.apply("sub", b, c)),
    "a - b": lambda m, a, b, c: m.apply("add", a, m.apply("neg", b)),
    "b + c": lambda m, a, b, c: m.apply("sub", b, m.apply("neg", c)),
    "a + 2 \\, b": lambda m, a, b, c: m.apply("sub", a, m.apply("mul", b, m.constant(-2.0))),
    "\\left(a + b\\right)^{2}": lambda m, a, b, c: m.apply("square", m.apply("add", a, b)),
    "\\left(\\frac{a}{b}\\right)^{2}": lambda m, a, b, c: m.apply("square", m.apply("div", a, b)),
    "\\frac{a + b}{c}": lambda m, a, b, c: m.apply("div", m.apply("add", a, b), c),
    "b \\, \\sin a": lambda m, a, b, c: m.apply("mul", m.apply("sin", a), b),
    "\\sin a \\, \\cos b": lambda m, a, b, c: m.apply("mul", m.apply("sin", a), m.apply("cos", b)),
    "c \\, b \\, \\sin a": lambda m, a, b, c: m.apply("mul", m.apply("mul", m.apply("sin", a), b), c),
    "\\sin \\left(a \\, b\\right)": lambda m, a, b, c: m.apply("sin", m.apply("mul", a, b)),
    "3 \\cdot 2 \\, a": lambda m, a, b, c: m.apply("mul", m.constant(3.0), m.apply("double", a)),
    "\\tfrac{1}{2} \\, a": lambda m, a, b, c: m.apply("half", a),
    "-\\left(a + b\\right)": lambda m, a, b, c: m.apply("neg", m.apply("add", a, b)),
    "1.5 \\times 10^{-7} \\, a": lambda m, a, b, c: m.apply("mul", m.constant(1.5e-7), a),
    "-10^{9} \\, a": lambda m, a, b, c: m.apply("mul", m.constant(-1e9), a),
    "e^{a + b}": lambda m, a, b, c: m.apply("exp", m.apply("add", a, b)),
}


@pytest.mark.parametrize(("expected", "build"), CASES.items(), ids=CASES)
def test_parentheses_stand_where_they_are_needed_and_nowhere_else(expected, build):
    assert _right_side(build) == expected


def test_power_of_a_target_keeps_its_star():
    states = ("x",)
    builder = Builder(("x", "x_target"))
    features = builder.build([builder.apply("square", builder.inputs[1])], ["goal"])
    program = Builder(("goal",))
    law = Law(plant_of(states, ["u"], 1.0), features, program.build(program.inputs, ["u"]), np.empty(0))
    assert "\\left(x^{*}\\right)^{2}" in to_latex(law)


def test_names_that_would_look_alike_stand_as_they_are():
    states = ("x1", "x_1")
    program = Builder(states)
    value = program.apply("add", *program.inputs)
    law = Law(plant_of(states, ["u"], 1.0), states_of(states), program.build([value], ["u"]), np.empty(0))
    assert "\\mathtt{x1} + \\mathtt{x\\_1}" in to_latex(law)


def test_shared_values_are_written_once():
    builder = Builder(("x",))
    value = builder.inputs[0]
    for _ in range(60):  # sgn(a) sqrt|a| repeats its operand: written out, 2^60 times
        value = builder.apply("signed_sqrt", builder.apply("add", value, builder.apply("sin", value)))
    law = Law(plant_of(("x",), ["u"], 1.0), states_of(("x",)), builder.build([value], ["u"]), np.empty(0))
    assert len(to_latex(law)) < 20_000


def _pdf(document: str, folder) -> None:
    (folder / "law.tex").write_text(document)
    run(
        [
            "pdflatex",
            "-interaction=nonstopmode",
            "-halt-on-error",
            f"-output-directory={folder}",
            str(folder / "law.tex"),
        ]
    )
    assert (folder / "law.pdf").stat().st_size > 0


@pytest.mark.skipif(shutil.which("pdflatex") is None, reason="there is no pdflatex")
@pytest.mark.parametrize(
    "make",
    [
        robot_law,
        lambda: law_of_operations(limit=0.5),
        lambda: law_of_numbers([1e-300, -1e9, LARGEST, float("inf"), float("nan")]),
        lambda: random_law(np.random.default_rng(4)),
    ],
    ids=["robot", "every operation", "numbers", "random"],
)
def test_document_compiles(tmp_path, make):
    _pdf(to_document(make()), tmp_path)
