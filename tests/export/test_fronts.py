"""Fronts as LaTeX tables: numbers and formulas in their cells, and what pdflatex takes."""

import shutil
import subprocess

import numpy as np
import pytest

import gpsynth as gs
from gpsynth.export import latex_table

PROGRAM = gs.trace(lambda v: [np.sin(v.a * v.b) / (1.5 + v.a), v.b - 0.25], [("v", ("a", "b"))], ("p", "q"))
X = np.linspace(0.5, 2.0, 20).reshape(10, 2)


def test_a_line_has_its_numbers_and_all_formulas_of_its_program():
    text = latex_table(("size", "error_p"), [(7, 1.23456e-7), (3, 0.5)], [PROGRAM, PROGRAM])
    head, titles, first, second, end, rest = text.split("\n")
    assert head == "\\begin{tabular}{rrl}"
    assert titles == "size & error $p$ & formula \\\\ \\hline"
    assert first.startswith("$7$ & $1.235 \\times 10^{-7}$ & $\\begin{aligned}[t]p &= \\frac{\\sin")
    assert first.endswith("\\\\ q &= b - 0.25\\end{aligned}$ \\\\")
    assert second.startswith("$3$ & $0.5$ & ")
    assert (end, rest) == ("\\end{tabular}", "")


def test_results_have_a_table():
    result = gs.regress(X, X[:, 0] * X[:, 1], evaluations=3_000)
    assert len(result.latex_table().splitlines()) == len(result.front) + 3
    assert "size & error & formula" in result.latex_table()
    several = gs.regress(X, X, evaluations=2_000)
    assert "size & error $y_{0}$ & error $y_{1}$ & formula" in several.latex_table()


@pytest.mark.skipif(shutil.which("pdflatex") is None, reason="there is no pdflatex")
def test_the_table_compiles(tmp_path):
    text = latex_table(("size", "error_p"), [(7, 1.2e-7), (3, float("inf"))], [PROGRAM, PROGRAM])
    source = f"\\documentclass{{article}}\\usepackage{{amsmath}}\\begin{{document}}{text}\\end{{document}}"
    (tmp_path / "table.tex").write_text(source)
    command = ["pdflatex", "-interaction=nonstopmode", "-halt-on-error", "table.tex"]
    subprocess.run(command, check=True, cwd=tmp_path, capture_output=True)
