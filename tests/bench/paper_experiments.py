"""Both experiments of Shmalko and Yamshanov for ten seeds, as a table and as curves of T+ and of the cost."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from applications.rosbot.experiments import Experiment, experiment
from applications.rosbot.figures import BLACK, BLUE, ORANGE, STYLE
from applications.rosbot.scenario_file import read_scenario
from gpsynth.arrays import Floats
from gpsynth.evaluate import Evaluator
from gpsynth.optimizers import PSO
from gpsynth.planning import Objective, plan
from gpsynth.planning.literal import plan_literally
from gpsynth.planning.rounds import default_region
from gpsynth.schedule import Schedule
from gpsynth.simulation import simulate

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SEEDS = range(1, 11)
AT_START = 0.05  # m; a point this near to the start is left at once
SCENARIOS = Path(__file__).parents[2] / "applications" / "rosbot" / "scenarios"
DRAWN = MappingProxyType({"replica": BLUE, "replica, literally": ORANGE, "physical": BLACK})

Curve = Sequence[tuple[int, float]]  # evaluations, and what it is of


@dataclass(frozen=True, eq=False)
class Case:
    """A row of the table."""

    scenario: str
    reading: str
    experiment: Experiment
    initial: tuple[Schedule, ...] = ()
    literal: bool = False


class Found(NamedTuple):
    """What a seed came to."""

    points: Floats  # (k, n)
    arrival_time: float  # s; infinity without an arrival
    is_free: bool
    budgets: Curve  # T+ in s
    costs: Curve  # eq. 17 of the best, under the T+ of its time


def all_cases() -> list[Case]:
    """Both experiments under every reading; the replica also with its path kept clear, and begun in one place."""
    cases = []
    for name in ("paper", "paper_empty"):
        scenario = read_scenario(SCENARIOS / f"{name}.json")
        replica = experiment(scenario, "paper-replica")
        on_path = replace(replica, settings=replica.settings.on_path())
        cases.append(Case(name, "replica", replica))
        cases.append(Case(name, "replica, literally", replica, literal=True))
        if len(scenario.circles):
            cases.append(Case(name, "replica, path", on_path))
        else:
            cases.append(Case(name, "replica, all begin at the start", replica, _resting(replica)))
        cases.append(Case(name, "physical", experiment(scenario, "physical")))
    return cases


def run_cases() -> list[tuple[Case, list[Found]]]:
    """Every case with every seed."""
    return [
        (case, [(_literally if case.literal else _in_rounds)(case, seed) for seed in SEEDS])
        for case in all_cases()
    ]


def experiments(found: Sequence[tuple[Case, Sequence[Found]]]) -> str:
    """The table."""
    titles = ("experiment", "obstacle term", "first T+ (s)", "arrive", "clear", "inside", "at start")
    rows = (
        (f"`{case.scenario}`, {case.reading}", *_summary(case.experiment, plans)) for case, plans in found
    )
    return table((*titles, "arrival (s)", "clear arrival (s)"), rows)


def convergence_figure(found: Sequence[tuple[Case, Sequence[Found]]]) -> "Figure":
    """T+ above, the cost of the best below; the experiment with obstacles to the left, the one without to the right."""
    from matplotlib import rc_context
    from matplotlib.figure import Figure

    with rc_context(dict(STYLE)):
        figure = Figure(figsize=(7.0, 4.4), layout="constrained")
        axes = figure.subplots(2, 2, sharex="col")
        for case, plans in found:
            if case.reading in DRAWN:
                column, color = int(case.scenario == "paper_empty"), DRAWN[case.reading]
                _draw(axes[0, column], [each.budgets for each in plans], color, case.reading)
                _draw(axes[1, column], [each.costs for each in plans], color, case.reading)
        for column, title in enumerate(("with obstacles", "without obstacles")):
            axes[0, column].set_title(title)
            axes[1, column].set_xlabel("rollouts")
            axes[1, column].set_ylim(0.0, 1.4)  # first rounds without an arrival cost more
            for row, label in enumerate((r"$T^+$ (s)", "cost of the best, eq. 17")):
                axes[row, column].set_yscale("linear" if row else "log")
                axes[row, column].set_xscale("log")
                axes[row, 0].set_ylabel(label)
        handles, labels = axes[0, 0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside upper center", ncols=3)
    return figure


def _draw(axes: "Axes", curves: Sequence[Curve], color: str, label: str) -> None:
    """A thin line for each seed, and a dot where it ends."""
    for number, curve in enumerate(curves):
        spent, values = np.array(curve).T
        spent = np.maximum(spent, 1)  # 0 has no place on the axis
        axes.step(spent, values, where="post", color=color, linewidth=0.6, label=None if number else label)
        axes.plot(spent[-1], values[-1], ".", color=color, markersize=3.0)


def _in_rounds(case: Case, seed: int) -> Found:
    costs: list[tuple[int, float]] = []
    found = plan(
        *(case.experiment.problem, case.experiment.law, case.experiment.settings),
        seed=seed,
        initial=case.initial,
        threads=2,
        callback=lambda each: costs.append((each.evaluations, each.cost)),
    )
    return Found(found.schedule.points, found.arrival_time, found.is_free, found.history, costs)


def _literally(case: Case, seed: int) -> Found:
    problem, law, settings = case.experiment.problem, case.experiment.law, case.experiment.settings
    objective = Objective(
        Evaluator(problem, threads=2, margin=settings.margin), law, settings, problem.horizon
    )
    swarm = PSO.seed(
        *(np.tile(bound, settings.points) for bound in default_region(problem)), size=settings.particles
    )
    count = settings.particles * settings.iterations * settings.rounds
    found = plan_literally(objective, swarm, seed=seed, evaluations=count)
    path = simulate(problem, law, schedule=found.schedule, reach=settings.reach)
    is_free = bool(np.isfinite(path.arrival)) and path.clearance >= 0.0
    return Found(found.schedule.points, path.arrival, is_free, found.history, found.improvements)


def _resting(case: Experiment) -> tuple[Schedule, ...]:
    """For every particle a schedule whose points all lie at the start."""
    count = case.settings.points
    points = np.tile(case.problem.starts[0], (count, 1))
    return (Schedule(points, np.zeros(count)),) * case.settings.particles


def _summary(case: Experiment, found: Sequence[Found]) -> tuple[str, ...]:
    arrived = [each.arrival_time for each in found if np.isfinite(each.arrival_time)]
    clear = [each.arrival_time for each in found if each.is_free]
    objective = Objective(Evaluator(case.problem), case.law, case.settings, case.problem.horizon)
    points = np.array([each.points for each in found])
    at_start = np.hypot(*np.moveaxis(points[..., :2] - case.problem.starts[0, :2], -1, 0)) < AT_START
    counts = (
        f"{len(arrived)} of {len(found)}",
        f"{len(clear)}",
        f"{np.max(objective.covered(points)):g}",
        f"{np.mean(at_start):.0%}",
    )
    return (case.settings.obstacles, f"{case.problem.horizon:g}", *counts, _range(arrived), _range(clear))


def _range(times: Sequence[float]) -> str:
    return f"{min(times):.2f} to {max(times):.2f}" if times else "-"


def table(titles: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Markdown."""
    return "\n".join("| " + " | ".join(row) + " |" for row in (titles, ["---"] * len(titles), *rows))
