"""A front as a LaTeX table: a line for each law or formula, its numbers before it."""

from collections.abc import Iterator, Sequence

from gpsynth.export.latex import number, symbol
from gpsynth.export.programs import latex_lines
from gpsynth.program import Program


def latex_table(heads: Sequence[str], numbers: Sequence[Sequence[float]], programs: Sequence[Program]) -> str:
    """A tabular (it needs amsmath) with a column for each of the heads and one for the formulas of the programs.

    Numbers have four digits; a name with a place in formulas is written as it is there.
    """
    lines = [
        f"{' & '.join(f'${_rounded(value)}$' for value in row)} & {_formulas(program)} \\\\"
        for row, program in zip(numbers, programs, strict=True)
    ]
    titles = " & ".join((*map(_head, heads), "formula"))
    return "\n".join(
        [f"\\begin{{tabular}}{{{'r' * len(heads)}l}}", f"{titles} \\\\ \\hline", *lines, "\\end{tabular}", ""]
    )


def _rounded(value: float) -> str:
    return number(float(f"{value:.4g}")).text


def _head(text: str) -> str:
    words = text.split("_", 1)
    return (
        f"{words[0]} ${symbol(words[1])}$"
        if len(words) == 2 and words[0] == "error"
        else text.replace("_", " ")
    )


def _formulas(program: Program) -> str:
    return f"$\\begin{{aligned}}[t]{' '.join(_joined(latex_lines(program)))}\\end{{aligned}}$"


def _joined(rows: Sequence[tuple[str, str]]) -> Iterator[str]:
    for place, (left, right) in enumerate(rows):
        yield f"{left} &= {right}" + (" \\\\" if place + 1 < len(rows) else "")
