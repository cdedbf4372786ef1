"""Laws for several costs at once, such as time and effort: what each gives up for the other, as a front."""

import os
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from gpsynth.arrays import Floats
from gpsynth.checks import check_kind
from gpsynth.encodings.protocol import Encoding
from gpsynth.errors import ProblemError
from gpsynth.evaluate import Evaluator
from gpsynth.law import Law
from gpsynth.objective import Function, Objective, as_objective
from gpsynth.optimizers import Progress
from gpsynth.pareto_search import ParetoSearch
from gpsynth.plotting import plot_tradeoff
from gpsynth.problem import Problem
from gpsynth.program import Program
from gpsynth.runs import checkpoint_in, run_search
from gpsynth.structure_search import Candidate
from gpsynth.synthesis import check_encoding, check_same, check_search
from gpsynth.tables import write_csv

if TYPE_CHECKING:
    from gpsynth.plotting import Axes

G = TypeVar("G")

STAGE = 4  # of the random streams


@dataclass(frozen=True, eq=False)
class Tradeoff:
    """One law of the front and its costs, means over the starts."""

    law: Law
    costs: Mapping[str, float]
    complexity: int  # instructions of the formula


@dataclass(frozen=True, eq=False)
class Tradeoffs:
    """Laws none of which is beaten in all costs (and in size) by another, by rising first cost."""

    objectives: tuple[str, ...]
    front: tuple[Tradeoff, ...]
    evaluations: int
    reason: str

    def __repr__(self) -> str:
        return f"<Tradeoffs of {len(self.front)} laws between {', '.join(self.objectives)}>"

    def __str__(self) -> str:
        return self.table()

    def rows(self) -> list[dict[str, Any]]:
        """The front as one dictionary a law, ready for pandas.DataFrame."""
        return [
            {**entry.costs, "complexity": entry.complexity, "formulas": "; ".join(entry.law.formulas())}
            for entry in self.front
        ]

    def to_csv(self, path: str | os.PathLike[str]) -> None:
        """Write `rows` as a CSV file with a header; raises FileError if that is not possible."""
        write_csv(path, (*self.objectives, "complexity", "formulas"), self.rows())

    def table(self) -> str:
        """The front as text: costs, size, formulas."""
        lines = ["".join(f"{name:>12}" for name in (*self.objectives, "size")) + "  law"]
        for entry in self.front:
            head = (
                "".join(f"{entry.costs[name]:12.4g}" for name in self.objectives)
                + f"{entry.complexity:12d}  "
            )
            lines.append(head + ("\n" + " " * len(head)).join(entry.law.formulas()))
        return "\n".join(lines)

    def latex_table(self) -> str:
        """The front as a LaTeX tabular: costs, size, formulas (`gpsynth.export.latex_table`)."""
        from gpsynth.export import latex_table

        numbers = [
            [*(entry.costs[name] for name in self.objectives), entry.complexity] for entry in self.front
        ]
        return latex_table((*self.objectives, "size"), numbers, [entry.law.bounded for entry in self.front])

    def plot(self, *, ax: "Axes | None" = None) -> "Axes":
        """The second cost over the first (`gpsynth.plotting.plot_tradeoff`)."""
        first, second = self.objectives[:2]
        points = [(entry.costs[first], entry.costs[second]) for entry in self.front]
        return plot_tradeoff(points, (first, second), ax=ax)


def synthesize_tradeoffs(
    problem: Problem,
    encoding: Encoding[G],
    objectives: Mapping[str, Objective | Function],
    *,
    seed: int = 0,
    budget: int = 20_000,
    search: ParetoSearch[G] | None = None,
    folder: str | os.PathLike[str] | None = None,
    resume: bool = False,
    threads: int = 2,
    progress: bool = False,
    callback: Callable[[Progress[Any]], bool | None] | None = None,
) -> Tradeoffs:
    """Search formulas of the problem's features for several named objectives at once.

    An evaluation is one formula rolled out from all starts, for all objectives together; `folder`, `resume`, Ctrl-C and
    what the seed promises are those of `synthesize`. Raises ProblemError for fewer than two objectives or an encoding
    that does not fit the problem.
    """
    check_encoding(problem, encoding)
    check_search(seed, budget, threads, callback)
    check_kind("objectives, functions by name,", objectives, Mapping)
    check_kind("search", search, ParetoSearch, optional=True)
    if search is not None:
        check_same(encoding, search.encoding)
    if len(objectives) < 2:
        raise ProblemError(f"expected two objectives or more, got {', '.join(objectives) or 'none'}")
    wanted = {name: as_objective(given) for name, given in objectives.items()}
    strategy = search or ParetoSearch(encoding)
    found, reason = run_search(
        _cost(Evaluator(problem), tuple(wanted.values()), threads),
        strategy,
        checkpoint_in(folder, {"problem": problem, "search": strategy, "objectives": wanted}, seed),
        resume=resume,
        seed=seed,
        budget=budget,
        path=(STAGE,),
        progress=progress,
        callback=callback,
    )
    front = tuple(
        Tradeoff(
            Law(problem.plant, problem.features, member.program, member.values),
            dict(zip(wanted, member.costs.tolist(), strict=True)),
            member.program.complexity,
        )
        for member in found.state.front
    )
    return Tradeoffs(tuple(wanted), front, found.evaluations, reason)


def _cost(
    evaluator: Evaluator, objectives: Sequence[Objective], threads: int
) -> Callable[[Sequence[Candidate[Any]]], Floats]:
    paths = any(objective.paths for objective in objectives)

    def of_one(program: Program, values: Floats) -> Floats:
        rollouts = evaluator.of_program(program, values[np.newaxis], paths=paths)
        return np.array([objective(rollouts).mean() for objective in objectives])

    def cost(batch: Sequence[Candidate[Any]]) -> Floats:
        with ThreadPoolExecutor(threads) as pool:
            return np.array(list(pool.map(lambda each: of_one(each.program, each.values), batch)))

    return cost
