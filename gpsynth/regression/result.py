"""What a regression found: a Pareto front of formulas, and the one that is chosen."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from gpsynth import formula
from gpsynth.arrays import Floats
from gpsynth.errors import RegressionError
from gpsynth.program import Program


@dataclass(frozen=True)
class Formula:
    """One formula of the front."""

    program: Program  # inputs: the columns of X by name; output: the target by name
    error: float  # weighted squared residual on the training rows as a share of y's deviation from its mean: 1 - R2
    size: int  # nodes: operations, variables and numbers; a square counts as the product it is

    def __str__(self) -> str:
        return "; ".join(formula.lines(self.program))


@dataclass(frozen=True)
class RegressionResult:
    """The front from the smallest formula to the most accurate; `best` is the shortest description of the data.

    The description length is n / 2 ln(error) + 2.5 nats for each node + ln(n) / 2 for each number (Rissanen 1978),
    errors below 1e-20 counting as equal.
    """

    front: tuple[Formula, ...]
    choice: int
    evaluations: int
    seconds: float  # of processor time
    history: tuple[tuple[int, str, float], ...]  # evaluations, what found it, error; at each progress

    @property
    def best(self) -> Formula:
        """The chosen formula."""
        return self.front[self.choice]

    @property
    def program(self) -> Program:
        """The program of the chosen formula, which every exporter of programs takes."""
        return self.best.program

    def predict(self, inputs: npt.ArrayLike) -> Floats:
        """The chosen formula (N,) on rows (N, m); raises RegressionError if they do not fit."""
        rows = np.asarray(inputs, dtype=np.float64)
        if rows.ndim != 2 or rows.shape[1] != len(self.program.inputs):
            raise RegressionError(f"X has shape {rows.shape}; expected (N, {len(self.program.inputs)})")
        return self.program(rows)[:, 0]

    def formulas(self) -> tuple[str, ...]:
        """The chosen formula as readable lines, shared parts first."""
        return formula.lines(self.program)

    def table(self) -> str:
        """The front as text; an asterisk marks the choice."""
        rows = [
            f"{'*' if k == self.choice else ' '} {item.size:5d}  {item.error:9.3e}  {item}"
            for k, item in enumerate(self.front)
        ]
        return "\n".join(["   size      error  formula", *rows])
