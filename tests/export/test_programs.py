"""Exported programs compute the same bits as the program, in C and in Python."""

import ctypes
import shutil
import subprocess

import numpy as np
import pytest

from gpsynth.builder import Builder
from gpsynth.errors import ProgramError
from gpsynth.export import program_to_c, program_to_latex, program_to_python
from gpsynth.export.c import FLAGS
from gpsynth.program import Program
from gpsynth.tracing import trace

COMPILER = shutil.which("cc") or shutil.which("gcc")


def formula() -> Program:
    return trace(
        lambda v: [np.sin(v.a * v.b) / (1.5 + np.exp(-v.a)), np.sqrt(v.b) - 0.25],
        [("v", ("a", "b"))],
        ("p", "q"),
    )


@pytest.mark.skipif(COMPILER is None, reason="no C compiler")
def test_the_c_computes_the_same_bits(tmp_path) -> None:
    source = tmp_path / "formula.c"
    source.write_text(program_to_c(formula()))
    library = tmp_path / "formula.so"
    subprocess.run(
        [COMPILER, *FLAGS.split(), "-shared", "-fPIC", str(source), "-o", str(library)], check=True
    )
    function = ctypes.CDLL(str(library)).formula
    rows = np.random.default_rng(1).uniform(0.1, 3.0, (50, 2))
    found = np.empty((50, 2))
    for x, y in zip(rows, found, strict=True):
        function(x.ctypes.data_as(ctypes.c_void_p), y.ctypes.data_as(ctypes.c_void_p))
    assert np.array_equal(found, formula()(rows))


def test_the_python_computes_the_same_bits() -> None:
    place: dict[str, object] = {}
    exec(compile(program_to_python(formula()), "formula.py", "exec"), place)
    rows = np.random.default_rng(2).uniform(0.1, 3.0, (20, 2))
    found = [place["formula"](row) for row in rows.tolist()]
    assert np.array_equal(np.array(found), formula()(rows))


def test_the_latex_reads_like_the_formula() -> None:
    assert program_to_latex(formula()) == (
        "\\begin{align*}\n  p &= \\frac{\\sin \\left(a \\, b\\right)}{e^{-a} + 1.5} \\\\\n"
        "  q &= \\sqrt{b} - 0.25\n\\end{align*}\n"
    )


def test_parameters_are_to_be_bound_first() -> None:
    builder = Builder(("x",), ("k",))
    program = builder.build([builder.apply("mul", builder.inputs[0], builder.parameters[0])])
    with pytest.raises(ProgramError, match="bind them to numbers first"):
        program_to_c(program)
