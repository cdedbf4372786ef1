"""Stage 1: synthesize a stabilizer u = g(x, x*), structure and numbers together, as a front of cost and complexity."""

import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Any, TypeVar, cast

import numpy as np

from gpsynth.arrays import Floats
from gpsynth.batch_cost import BatchCost
from gpsynth.checks import check_function, check_kind, check_whole
from gpsynth.encodings.protocol import Encoding
from gpsynth.epochs import Epochs
from gpsynth.errors import LawError, OptimizerError, ProblemError
from gpsynth.evaluate import Evaluator
from gpsynth.guesses import Guess, genomes_of
from gpsynth.islands import Islands, search_islands
from gpsynth.law import Law
from gpsynth.law_cost import LawCost, PlanCases, check_plans
from gpsynth.objective import Function, Objective, as_objective
from gpsynth.optimizers import Progress, minimize
from gpsynth.plotting import plot_front
from gpsynth.problem import Problem
from gpsynth.program import Program
from gpsynth.proportions import lower_bound
from gpsynth.runs import INTERRUPTED, checkpoint_in, run_search
from gpsynth.structure_search import Individual, StructureSearch
from gpsynth.tables import write_csv
from gpsynth.tuning import Tuner
from gpsynth.variational_ga import VariationalGA

if TYPE_CHECKING:
    from gpsynth.plotting import Axes

G = TypeVar("G")

SEARCH = 1  # stage of the random streams
MERIT = 1e-3  # share of the cost that a larger law of the front must save


@dataclass(frozen=True, eq=False)
class FrontEntry:
    """One law of the front and how it fares on the problem and the trials."""

    law: Law
    cost: (
        float  # mean over the starts, of the trials too, of running and terminal cost; that of plans is added
    )
    complexity: int  # instructions of the formula
    reached: float  # share of the starts that are at the goal at the end
    starts: int  # of the problem and the trials
    median_time: float  # s, of the arrivals
    worst_time: float  # s, of the arrivals
    reached_at_least: (
        float | None
    )  # what the probability is at least, at 95 %, by the worst trial; without trials None
    plan_cost: float | None = None  # mean cost of plans, where they count; weighted it is part of the cost


@dataclass(frozen=True, eq=False)
class SynthesisResult:
    """The Pareto front by rising complexity, each law better than all simpler ones."""

    front: tuple[FrontEntry, ...]
    evaluations: int  # parameter vectors rolled out from all starts
    history: tuple[tuple[int, float], ...]  # (evaluations, best cost) of the search
    reason: str

    @property
    def best(self) -> FrontEntry:
        """The entry of least cost among those that end at the goal from most starts.

        Where none does from all, an entry counts as one of those whose share the best one may have by chance, at 95 %:
        one start more or less is no reason to take a slower law. Raises LawError if no law has a finite cost.
        """
        if not self.front:
            raise LawError(f"no law with a finite cost was found in {self.evaluations} evaluations")
        first = max(self.front, key=lambda entry: entry.reached)
        enough = (
            1.0 if first.reached == 1.0 else lower_bound(round(first.reached * first.starts), first.starts)
        )
        return min((entry for entry in self.front if entry.reached >= enough), key=lambda entry: entry.cost)

    @property
    def law(self) -> Law:
        """The law of the best entry."""
        return self.best.law

    def __repr__(self) -> str:
        best = f", best: {'; '.join(self.law.formulas())}" if self.front else ""
        return f"<SynthesisResult of {len(self.front)} laws{best}>"

    def __str__(self) -> str:
        return self.table()

    def rows(self) -> list[dict[str, Any]]:
        """The front as one dictionary a law, ready for pandas.DataFrame; formulas are joined by '; '."""
        return [
            {
                "complexity": entry.complexity,
                "cost": entry.cost,
                "reached": entry.reached,
                "reached_at_least": entry.reached_at_least,
                "plan_cost": entry.plan_cost,
                "median_time": entry.median_time,
                "worst_time": entry.worst_time,
                "formulas": "; ".join(entry.law.formulas()),
            }
            for entry in self.front
        ]

    def to_csv(self, path: str | os.PathLike[str]) -> None:
        """Write `rows` as a CSV file with a header; raises FileError if that is not possible."""
        times = ("median_time", "worst_time")
        names = ("complexity", "cost", "reached", "reached_at_least", "plan_cost", *times, "formulas")
        write_csv(path, names, self.rows())

    def latex_table(self) -> str:
        """The front as a LaTeX tabular: size, cost, share reached, formulas (`gpsynth.export.latex_table`)."""
        from gpsynth.export import latex_table

        numbers = [(entry.complexity, entry.cost, entry.reached) for entry in self.front]
        return latex_table(("size", "cost", "reached"), numbers, [entry.law.bounded for entry in self.front])

    def plot(self, *, ax: "Axes | None" = None) -> "Axes":
        """Cost over complexity (`gpsynth.plotting.plot_front`)."""
        return plot_front(self.front, ax=ax)

    def table(self) -> str:
        """The front as text.

        Complexity, cost, share of starts reached and what its probability is at least, cost of plans, times (s),
        formulas.
        """
        head = f"{'size':>4} {'cost':>10} {'reached':>8} {'p >=':>6} {'plans':>7} {'median s':>9} {'worst s':>8}  law"
        lines = [head]
        for entry in self.front:
            least = "" if entry.reached_at_least is None else f"{entry.reached_at_least:.3f}"
            plans = "" if entry.plan_cost is None else f"{entry.plan_cost:.3f}"
            head = f"{entry.complexity:4d} {entry.cost:10.4g} {entry.reached:8.1%} {least:>6} {plans:>7} "
            head += f"{entry.median_time:9.2f} {entry.worst_time:8.2f}  "
            lines.append(head + ("\n" + " " * len(head)).join(entry.law.formulas()))
        return "\n".join(lines)


def synthesize(
    problem: Problem,
    encoding: Encoding[G],
    *,
    seed: int = 0,
    budget: int = 20_000,
    tuning: int = 2_000,
    search: StructureSearch[G] | Epochs[G] | VariationalGA | None = None,
    guesses: Sequence[Guess] = (),
    objective: Objective | Function | None = None,
    plans: PlanCases | None = None,
    rough: Problem | None = None,
    tuned: Problem | None = None,
    trials: Sequence[Problem] = (),
    islands: Islands | None = None,
    folder: str | os.PathLike[str] | None = None,
    resume: bool = False,
    threads: int = 2,
    progress: bool = False,
    callback: Callable[[Progress[Any]], bool | None] | None = None,
) -> SynthesisResult:
    """Search formulas of the problem's features for `budget` evaluations, then tune the front on the whole problem.

    An evaluation is one parameter vector of one formula rolled out from all starts. The search may use a `rough`
    problem (fewer starts, longer steps). Every law of the front is tuned on `problem` itself, or on the problem
    `tuned`, with at most `tuning` evaluations. The front that comes back is scored on `problem` and on all `trials`
    (other starts, shorter steps, another plant), which no search has seen, so that a law that only fits its training
    loses.

    The search begins with `guesses`: formulas as text, functions of the features, Programs or Laws. An `objective`, a
    function of the rollouts of many laws, takes the place of the problem's running and terminal costs. With `plans`
    (`gpsynth.planning.PlanCost`) a law also pays what plans cost that are made with it, in the search, in tuning and in
    the front. With a `folder` the search leaves checkpoints there, and with `resume` it goes on from the last one;
    Ctrl-C ends it early, with what was found so far. The same seed gives the same result for any number of threads and
    after any resume. `search` is of this encoding; `islands` merge, so they take a StructureSearch only.

    Raises ProblemError if the encoding's inputs and outputs are not features and controls of all problems,
    OptimizerError if `search` is of another encoding, EncodingError or FormulaError if a guess is no formula of the
    encoding, FileError if the folder's checkpoint is of another run.
    """
    check_encoding(problem, encoding)
    check_search(seed, budget, threads, callback)
    check_whole("tuning", tuning, 0)
    _check_parts(encoding, search, rough, tuned, trials)
    check_plans(plans, problem)
    _check_islands(islands, search)
    shape = None if islands is None else (islands, budget)  # shares depend on the budget
    wanted = as_objective(objective)
    strategy: Any = search or StructureSearch(encoding)
    strategy = replace(strategy, seeds=(*strategy.seeds, *genomes_of(guesses, encoding)))
    parts = {
        "problem": problem,
        "rough problem": rough,
        "search": strategy,
        "objective": wanted,
        "cost of plans": plans,
        "number of islands or their budget": shape,
    }
    cost = BatchCost(rough or problem, threads if islands is None else 1, wanted, plans)
    found, reason = run_search(
        cost,
        strategy,
        checkpoint_in(folder, parts, seed),
        run=minimize if islands is None else partial(search_islands, islands=islands, workers=threads),
        resume=resume,
        seed=seed,
        budget=budget,
        path=(SEARCH,),
        progress=progress,
        callback=callback,
    )
    tuning = 0 if reason == INTERRUPTED else tuning
    evaluators = [Evaluator(each) for each in (problem, *trials)]
    tuner = Tuner(LawCost(Evaluator(tuned or problem), wanted, plans), encoding.space, seed, tuning)

    def entry(numbered: tuple[int, Individual[G]]) -> FrontEntry:
        number, individual = numbered
        return _entry(evaluators, individual.program, tuner(individual, number), wanted, plans)

    with ThreadPoolExecutor(threads) as pool:
        entries = list(pool.map(entry, enumerate(found.state.front)))
    return SynthesisResult(_front(entries), found.evaluations, found.history, reason)


def check_encoding(problem: Problem, encoding: Encoding[Any], name: str = "problem") -> None:
    """Raises ProblemError unless the encoding maps the problem's features to its controls."""
    check_kind(name, problem, Problem)
    check_kind("encoding", encoding, Encoding)
    features, controls = problem.features.names, problem.plant.control_names
    if encoding.inputs != features or encoding.outputs != controls:
        raise ProblemError(
            f"the encoding maps {encoding.inputs} to {encoding.outputs}; the {name} has features {features} "
            f"and controls {controls}"
        )


def check_same(encoding: Encoding[Any], searched: Encoding[Any]) -> None:
    """Raises OptimizerError unless a search looks for the formulas of the encoding."""
    if searched != encoding:
        raise OptimizerError(
            f"search is of another encoding, a {type(searched).__name__}, than the {type(encoding).__name__} given"
        )


def check_search(seed: int, budget: int, threads: int, callback: object) -> None:
    """Raises ProblemError unless these are settings that a search can run with."""
    check_whole("seed", seed, 0)
    check_whole("budget", budget, 1)
    check_whole("threads", threads, 1)
    check_function("callback", callback, optional=True)


def _check_parts(
    encoding: Encoding[Any], search: object, rough: object, tuned: object, trials: object
) -> None:
    check_kind("search", search, StructureSearch, Epochs, VariationalGA, optional=True)
    inner = search.search if isinstance(search, Epochs) else search
    if isinstance(inner, StructureSearch | VariationalGA):
        check_same(encoding, inner.encoding)
    check_kind("rough", rough, Problem, optional=True)
    check_kind("tuned", tuned, Problem, optional=True)
    check_kind("trials", trials, list, tuple)
    others = {f"problem of trial {number}": trial for number, trial in enumerate(cast(Sequence[Any], trials))}
    for name, other in {"rough problem": rough, "tuned problem": tuned, **others}.items():
        if other is not None or name in others:
            check_encoding(cast(Problem, other), encoding, name)


def _check_islands(islands: object, search: object) -> None:
    check_kind("islands", islands, Islands, optional=True)
    if islands is not None and not isinstance(search, StructureSearch | None):
        raise OptimizerError(
            f"islands merge, which a {type(search).__name__} cannot; use a StructureSearch, or no islands"
        )


def _entry(
    evaluators: Sequence[Evaluator],
    program: Program,
    values: Floats,
    objective: Objective,
    plans: PlanCases | None,
) -> FrontEntry:
    problem = evaluators[0].problem
    rollouts = [
        evaluator.of_program(program, values[np.newaxis], paths=objective.paths) for evaluator in evaluators
    ]
    arrival = np.concatenate([each.arrival[0] for each in rollouts])
    there = [evaluator.stays(each)[0] for evaluator, each in zip(evaluators, rollouts, strict=True)]
    reached = np.concatenate(there)
    cost = float(np.concatenate([objective(each)[0] for each in rollouts]).mean())
    of_plans = None
    if plans is not None:
        of_plans = float(plans(program, values[np.newaxis]).mean())
        cost += plans.weight * of_plans
    return FrontEntry(
        law=Law(problem.plant, problem.features, program, values),
        cost=cost,
        complexity=program.complexity,
        reached=float(reached.mean()),
        starts=len(reached),
        median_time=float(np.median(arrival[reached])) if reached.any() else float("inf"),
        worst_time=float(arrival[reached].max()) if reached.any() else float("inf"),
        reached_at_least=min((lower_bound(int(each.sum()), len(each)) for each in there[1:]), default=None),
        plan_cost=of_plans,
    )


def _front(entries: Sequence[FrontEntry]) -> tuple[FrontEntry, ...]:
    """Each entry better than all simpler ones, and by enough to be worth its size."""
    front: list[FrontEntry] = []
    for entry in sorted(entries, key=lambda each: (each.complexity, each.cost)):
        if np.isfinite(entry.cost) and (
            not front or entry.cost < front[-1].cost - MERIT * abs(front[-1].cost)
        ):
            front.append(entry)
    return tuple(front)
