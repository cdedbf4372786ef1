"""What a regression found: a Pareto front of formulas, and the one that is chosen."""

import os
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from gpsynth import formula
from gpsynth.arrays import Floats
from gpsynth.errors import RegressionError
from gpsynth.plotting import plot_errors
from gpsynth.program import Program
from gpsynth.tables import write_csv

if TYPE_CHECKING:
    import numpy.typing as npt

    from gpsynth.export import SympyForm
    from gpsynth.plotting import Axes


@dataclass(frozen=True)
class Formula:
    """One formula of the front, or one for each target together."""

    program: Program  # inputs: the columns of X by name; outputs: the targets by name
    errors: tuple[
        float, ...
    ]  # of each target: weighted squared residual as a share of its deviation from its mean
    size: int  # nodes: operations, variables and numbers; a square counts as the product it is

    @property
    def error(self) -> float:
        """The mean of the targets' errors: 1 - R2."""
        return sum(self.errors) / len(self.errors)

    def __str__(self) -> str:
        return "; ".join(formula.lines(self.program))


@dataclass(frozen=True)
class RegressionResult:
    """The front from the smallest formula to the most accurate; `best` is the shortest description of the data.

    The description length is n / 2 ln(error) for each target + 2.5 nats for each node + ln(n) / 2 for each number
    (Rissanen 1978), errors below 1e-20 counting as equal. Accurate is, among formulas for several targets, what has the
    least product of errors: each target has a noise of its own. An operation that two of them share counts once, and
    as one node where it is used again.
    """

    front: tuple[Formula, ...]
    choice: int
    evaluations: int
    seconds: float  # of processor time
    history: tuple[
        tuple[int, str, float], ...
    ]  # evaluations, what found it, error of that target; at each progress

    def __repr__(self) -> str:
        return f"<RegressionResult of {len(self.front)} formulas, best: {self.best}>"

    def __str__(self) -> str:
        return self.table()

    @property
    def best(self) -> Formula:
        """The chosen formula."""
        return self.front[self.choice]

    @property
    def program(self) -> Program:
        """The program of the chosen formula, which every exporter of programs takes."""
        return self.best.program

    def predict(self, inputs: "npt.ArrayLike") -> Floats:
        """The chosen formula (N,) on rows (N, m), of k targets (N, k); raises RegressionError if they do not fit."""
        try:
            rows = np.asarray(inputs, dtype=np.float64)
        except (TypeError, ValueError):
            raise RegressionError("X must hold numbers in rows of equal length") from None
        if rows.ndim != 2 or rows.shape[1] != len(self.program.inputs):
            raise RegressionError(f"X has shape {rows.shape}; expected (N, {len(self.program.inputs)})")
        values = self.program(rows)
        return values[:, 0] if values.shape[1] == 1 else values

    def formulas(self) -> tuple[str, ...]:
        """The chosen formula as readable lines, shared parts first."""
        return formula.lines(self.program)

    def table(self) -> str:
        """The front as text; an asterisk marks the choice."""
        names = self.program.names if len(self.program.names) > 1 else ("error",)
        head = "   size" + "".join(f"  {name:>9}" for name in names) + "  formula"
        rows = [
            f"{'*' if k == self.choice else ' '} {item.size:5d}"
            + "".join(f"  {error:9.3e}" for error in item.errors)
            + f"  {item}"
            for k, item in enumerate(self.front)
        ]
        return "\n".join([head, *rows])

    def rows(self) -> list[dict[str, Any]]:
        """The front as one dictionary a formula, ready for pandas.DataFrame; of several targets each has its error."""
        names = self.program.names

        def each(item: Formula) -> dict[str, float]:
            errors = zip(names, item.errors, strict=True) if len(names) > 1 else ()
            return {f"error_{name}": error for name, error in errors}

        return [
            {"size": item.size, "error": item.error, **each(item), "formula": str(item)}
            for item in self.front
        ]

    def to_csv(self, path: str | os.PathLike[str]) -> None:
        """Write `rows` as a CSV file with a header; raises FileError if that is not possible."""
        rows = self.rows()
        write_csv(path, tuple(rows[0]), rows)

    def latex_table(self) -> str:
        """The front as a LaTeX tabular: size, errors, formulas (`gpsynth.export.latex_table`)."""
        from gpsynth.export import latex_table

        names = self.program.names
        heads = ("size", *(f"error_{name}" for name in names)) if len(names) > 1 else ("size", "error")
        numbers = [(item.size, *item.errors) for item in self.front]
        return latex_table(heads, numbers, [item.program for item in self.front])

    def plot(self, *, ax: "Axes | None" = None) -> "Axes":
        """Error over size, a line for each target (`gpsynth.plotting.plot_errors`)."""
        errors = np.array([item.errors for item in self.front])
        return plot_errors([item.size for item in self.front], errors, self.program.names, ax=ax)

    def to_sympy(self, *, expanded: bool = False) -> "SympyForm":
        """The chosen formula as sympy expressions (`gpsynth.export.to_sympy`)."""
        from gpsynth import export

        return export.to_sympy(self.program, expanded=expanded)

    def to_latex(self) -> str:
        """An align* environment (`gpsynth.export.program_to_latex`)."""
        from gpsynth import export

        return export.program_to_latex(self.program)

    def to_c(self, name: str = "formula") -> str:
        """C99 source that computes the same bits (`gpsynth.export.program_to_c`)."""
        from gpsynth import export

        return export.program_to_c(self.program, name)

    def to_python(self, name: str = "formula") -> str:
        """A module of plain Python that computes the same bits (`gpsynth.export.program_to_python`)."""
        from gpsynth import export

        return export.program_to_python(self.program, name)

    def to_casadi(self, name: str = "formula") -> Any:
        """A casadi.Function (inputs, parameters) -> outputs, without parameters (`gpsynth.export.to_casadi`)."""
        from gpsynth import export

        return export.to_casadi(self.program, name)
