"""`python -m tests.bench.plan_peers`: gpsynth's plans beside those of other planners, one core, in one run.

All see the same scenarios and are judged by the same replay of their controls, which shares no code with any of them.
Planners that can go on for ever stop at `--limit` seconds of processor time; controllers drive to the goal, and all
they compute on the way counts. `--seeds N` repeats what is random, `--plot FILE.png` draws quality over time, `--only`
names planners; names of scenarios restrict the table. Peers come with `pip install -e .[peers]`; those that are not
there are left out. T_ref and the scenarios are read from ../shared.
"""

import argparse
import json
from collections.abc import Iterator, Mapping, Sequence
from importlib import metadata
from pathlib import Path
from typing import NamedTuple

import numpy as np

from applications.rosbot.figures import save_figure
from applications.rosbot.replay import replay
from applications.rosbot.scenario import Scenario
from applications.rosbot.scenario_file import read_scenario
from tests.bench.measure import machine, pin
from tests.bench.planners.attempt import Planner, Watch
from tests.bench.planners.equilibria import equilibria
from tests.bench.planners.paper_swarm import paper_swarm
from tests.bench.planners.path_integral import path_integral
from tests.bench.planners.predictive_control import predictive_control
from tests.bench.planners.sampling_trees import no_constructor, over_controls, over_curves
from tests.bench.planners.transcription import transcription
from tests.bench.quality import quality_figure

SHARED = Path(__file__).parents[2].parent / "shared"
PLANNERS = (
    Planner("gpsynth", (), equilibria),
    Planner("IPOPT", ("casadi",), transcription),
    Planner("MPPI", (), path_integral),
    Planner("NMPC", ("casadi",), predictive_control),
    Planner("RRT*", ("ompl",), over_curves("RRTstar")),
    Planner("BIT*", ("ompl",), over_curves("BITstar")),
    Planner("SST", ("ompl",), over_controls("SST"), lambda: no_constructor("SST")),
    Planner("RRT", ("ompl",), over_controls("RRT")),
    Planner("pyswarms", ("pyswarms",), paper_swarm),
)


class Case(NamedTuple):
    """A scenario that has a solution, and the best time known for it (s)."""

    name: str
    scenario: Scenario
    best_known: float


class Run(NamedTuple):
    """What a planner made of a scenario."""

    planner: str
    case: str
    spent: float  # s of processor time, all in all
    found: tuple[tuple[float, float], ...]  # (s, T / T_ref) of every plan that the replay confirms
    clearance: float  # m, of the best of them

    @property
    def ratio(self) -> float:
        return min((ratio for _, ratio in self.found), default=np.inf)


def cases(names: Sequence[str]) -> list[Case]:
    """The public scenarios that can be solved; those that begin with one of `names`, if there are any."""
    known = json.loads((SHARED / "reference" / "planning.json").read_text())
    paths = sorted((SHARED / "scenarios").glob("p*.json"))
    chosen = [path for path in paths if path.stem in known and path.stem.startswith(tuple(names) or "")]
    return [Case(path.stem, read_scenario(path), known[path.stem]["T_ref"]) for path in chosen]


def why_missing(planner: Planner) -> str:
    """Why a planner cannot run here; empty if it can."""
    for package in planner.packages:
        try:
            metadata.version(package)
        except metadata.PackageNotFoundError:
            return f"{package} is not installed"
    return planner.missing()


def run(planner: Planner, case: Case, seed: int, limit: float) -> Run:
    """One run of a planner; replaying what it found takes none of its time."""
    watch = Watch(limit)
    answers = list(planner.plan(case.scenario, seed, watch))
    spent, found, best, clearance = watch.spent, [], np.inf, np.nan
    for answer in answers:
        check = replay(case.scenario, answer.controls, answer.durations)
        if check.solves:
            found.append((answer.spent, check.arrival_time / case.best_known))
            if check.arrival_time < best:
                best, clearance = check.arrival_time, check.clearance
    return Run(planner.name, case.name, spent, tuple(found), clearance)


def line(each: Run) -> str:
    """A row of the long table."""
    if not each.found:
        return f"{each.case:20} {each.planner:9} {'no plan':>8} {'':8} {'':8} {each.spent:8.2f}"
    return (
        f"{each.case:20} {each.planner:9} {each.ratio:8.3f} {1e3 * each.clearance:8.1f} "
        f"{each.found[0][0]:8.3f} {each.spent:8.2f}"
    )


def summary(runs: Mapping[str, Sequence[Run]]) -> Iterator[str]:
    """Markdown, one row a planner: ratios are over what it solved."""
    yield "| planner | solved | T/T_ref median | mean | max | clearance mm, least | first plan s | all s | at most |"
    yield f"|---|{'---:|' * 8}"
    for name, rows in runs.items():
        solved, cells = [each for each in rows if each.found], ["-"] * 5
        if solved:
            ratios, least = [each.ratio for each in solved], min(each.clearance for each in solved)
            cells = [f"{value:.3f}" for value in (np.median(ratios), np.mean(ratios), max(ratios))]
            cells += [f"{1e3 * least:.1f}", f"{np.median([each.found[0][0] for each in solved]):.2f}"]
        spent = [each.spent for each in rows]
        ends = f"{np.median(spent):.2f} | {max(spent):.2f}"
        yield f"| {name} | {len(solved)} of {len(rows)} | {' | '.join(cells)} | {ends} |"


def matrix(runs: Mapping[str, Sequence[Run]]) -> Iterator[str]:
    """Markdown, T/T_ref of every planner (median of the seeds) on every scenario."""
    yield f"| scenario | {' | '.join(runs)} |\n|---|{'---:|' * len(runs)}"
    for case in dict.fromkeys(each.case for rows in runs.values() for each in rows):
        medians = [np.median([each.ratio for each in rows if each.case == case]) for rows in runs.values()]
        cells = [f"{ratio:.3f}" if np.isfinite(ratio) else "-" for ratio in medians]
        yield f"| {case} | {' | '.join(cells)} |"


def main() -> None:
    """Run them all and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--limit", type=float, default=5.0)
    parser.add_argument("--seeds", type=int, default=1)
    parser.add_argument("--only", nargs="+", default=[])
    parser.add_argument("--plot", type=Path)
    parser.add_argument("scenarios", nargs="*")
    asked = parser.parse_args()
    if not SHARED.exists():
        raise SystemExit(f"this comparison needs the scenarios in {SHARED}, which are not there")
    pin()
    print(machine())
    present = []
    for planner in PLANNERS:
        missing = why_missing(planner)
        versions = ", ".join(f"{name} {metadata.version(name)}" for name in planner.packages if not missing)
        print(f"{planner.name}: left out, {missing}" if missing else f"{planner.name}: {versions or 'here'}")
        if not missing and planner.name in (asked.only or planner.name):
            present.append(planner)
            list(planner.plan(cases(["p02"])[0].scenario, 0, Watch(0.5)))  # imports, compiled code
    print(f"\n{'scenario':20} {'planner':9} {'T/T_ref':>8} {'clear mm':>8} {'first s':>8} {'all s':>8}")
    runs: dict[str, list[Run]] = {planner.name: [] for planner in present}
    for case in cases(asked.scenarios):
        for planner in present:
            for seed in range(asked.seeds):
                runs[planner.name].append(run(planner, case, seed, asked.limit))
                print(line(runs[planner.name][-1]), flush=True)
    print(f"\n{asked.limit:g} s at most, {asked.seeds} seeds\n")
    print(*summary(runs), "", *matrix(runs), sep="\n")
    if asked.plot:
        save_figure(
            quality_figure({name: [each.found for each in rows] for name, rows in runs.items()}), asked.plot
        )


if __name__ == "__main__":
    main()
