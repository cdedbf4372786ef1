"""`python -m tests.bench.planning`: plans for the public scenarios, replayed, beside the best known times.

Columns: arrival over T_ref; arrival over the lower bound; smallest clearance; processor time until the first plan that
the other simulator confirms, until the last, and of replanning on the way, each its median and its worst; rollouts.
Replanning begins at a plan that was driven for 0.1 s by a robot that came less far than planned. All on one core, in a
process that has planned before. `--law FILE` (several times) plans with these laws instead of the hand-tuned ones;
`--seeds N` sets how many seeds; `--cold` measures the command, from its start to its end; names of scenarios
restrict the table. T_ref is read from ../shared/reference where that is present.
"""

import argparse
import json
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from applications.rosbot.model import unicycle
from applications.rosbot.planner import PlanReport, plan_scenario
from applications.rosbot.polar_law import HOT, SATURATING, polar_law
from applications.rosbot.problems import PERIOD
from applications.rosbot.scenario import Scenario
from applications.rosbot.scenario_file import read_scenario
from gpsynth.law import Law

ROOT = Path(__file__).parents[2]
SHARED = ROOT.parent / "shared"
REPLANS = 10  # of each plan
LAG = 0.2  # of a period, by which the robot is behind its plan
HEAD = (
    f"{'scenario':18} {'T_ref':>7} {'T/T_ref min':>11} {'median':>6} {'max':>6} {'T/bound':>7} {'mm':>6} "
    f"{'first ms':>11} {'final s':>11} {'replan ms':>11} {'rollouts':>8}"
)


@dataclass(frozen=True)
class Attempt:
    """A plan, and processor times in s."""

    report: PlanReport
    first: float  # until the first plan
    final: float
    replans: tuple[float, ...]


def attempt(scenario: Scenario, laws: Sequence[Law], seed: int) -> Attempt:
    """Plan on one core, and then on the way."""
    began, found = time.process_time(), []

    def note(report: PlanReport) -> None:
        if report.status == "planned" and not found:
            found.append(time.process_time() - began)

    report = plan_scenario(scenario, laws, seed=seed, callback=note)
    final = time.process_time() - began
    return Attempt(report, found[0] if found else np.nan, final, tuple(replans(report, laws)))


def replans(report: PlanReport, laws: Sequence[Law]) -> list[float]:
    """How long replanning took, again and again along the way; infinity where no plan came of it."""
    times: list[float] = []
    while report.plan is not None and len(times) < REPLANS and len(report.plan.trajectory.x) > 3:
        before, now = report.plan.trajectory.x[1:3]
        behind = replace(report.scenario, start=now + LAG * (before - now))
        began = time.process_time()
        report = plan_scenario(behind, laws, seed=report.seed, previous=report, elapsed=2 * PERIOD)
        times.append(time.process_time() - began if report.plan is not None else np.inf)
    return times


def row(name: str, attempts: Sequence[Attempt], best_known: float | None) -> str:
    """One line of the table."""
    solved = [each for each in attempts if each.report.replay is not None]
    if not solved:
        return f"{name:18} {attempts[0].report.status}: {attempts[0].report.reason}"
    times = np.array([each.report.replay.arrival_time for each in solved if each.report.replay is not None])
    ratios = times / (best_known or np.nan)
    clearance = min(each.report.replay.clearance for each in solved if each.report.replay is not None)
    again = [each for one in solved for each in one.replans]
    missing = f"  {len(attempts) - len(solved)} of {len(attempts)} not solved"
    return (
        f"{name:18} {best_known or np.nan:7.3f} {ratios.min():11.3f} {np.median(ratios):6.3f} {ratios.max():6.3f} "
        f"{np.median(times) / solved[0].report.lower_bound:7.3f} {1e3 * clearance:6.2f} "
        f"{_typical([1e3 * each.first for each in solved], 0):>11} "
        f"{_typical([each.final for each in solved], 2):>11} {_typical([1e3 * each for each in again], 0):>11} "
        f"{np.median([each.report.evaluations for each in solved]):8.0f}"
        f"{missing if len(solved) < len(attempts) else ''}"
    )


def _typical(values: Sequence[float], digits: int) -> str:
    """The median and the worst."""
    return f"{np.median(values):.{digits}f} {np.max(values):.{digits}f}" if values else ""


def summary(attempts: Sequence[Attempt], ratios: Sequence[float]) -> str:
    """What the table comes to, over the attempts at scenarios with a best known time."""
    solved = [each for each in attempts if each.report.status == "planned"]
    again = [1e3 * each for one in solved for each in one.replans]
    return (
        f"{len(solved)} of {len(attempts)} solved; T/T_ref median {np.median(ratios):.4f}, "
        f"mean {np.mean(ratios):.4f}, max {np.max(ratios):.3f}; median and worst: "
        f"first {_typical([1e3 * each.first for each in solved], 0)} ms, "
        f"final {_typical([each.final for each in solved], 2)} s, replanning {_typical(again, 1)} ms"
    )


def cold(paths: Sequence[Path]) -> str:
    """How long `python -m applications.rosbot plan` takes on one core, kernels being cached, picture included."""
    walls, computing = [], []
    for path in paths:
        with tempfile.TemporaryDirectory() as folder:
            began, before = time.perf_counter(), _children()
            command = ["-m", "applications.rosbot", "plan", str(path), "--out", folder, "--threads", "1"]
            subprocess.run([sys.executable, *command], cwd=ROOT, check=True, stdout=subprocess.DEVNULL)
            walls.append(time.perf_counter() - began)
            computing.append(_children() - before)
    return (
        f"the command, median and worst: processor {_typical(computing, 2)} s, clock {_typical(walls, 2)} s"
    )


def _children() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--law", action="append", default=[], type=Path)
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--cold", action="store_true")
    parser.add_argument("scenarios", nargs="*")
    chosen = parser.parse_args()
    laws = [Law.load(path) for path in chosen.law]
    laws = laws or [polar_law(unicycle(), gains) for gains in (SATURATING, HOT)]
    known = json.loads((SHARED / "reference" / "planning.json").read_text()) if SHARED.exists() else {}
    public = (SHARED / "scenarios").glob("p*.json")
    paths = sorted((*public, *(ROOT / "applications" / "rosbot" / "scenarios").glob("paper*.json")))
    paths = [path for path in paths if not chosen.scenarios or path.stem in chosen.scenarios]
    plan_scenario(read_scenario(paths[0]), laws)  # loads what is loaded once
    print(HEAD)
    ratios: list[float] = []
    counted: list[Attempt] = []
    for path in paths:
        scenario, best_known = read_scenario(path), known.get(path.stem, {}).get("T_ref")
        attempts = [attempt(scenario, laws, seed) for seed in range(chosen.seeds)]
        print(row(path.stem, attempts, best_known), flush=True)
        if best_known:
            counted += attempts
            times = [each.report.replay.arrival_time for each in attempts if each.report.replay is not None]
            ratios += [arrival / best_known for arrival in times]
    if ratios:
        print(summary(counted, ratios))
    if chosen.cold:
        print(cold([path for path in paths if read_scenario(path).expect_feasible is not False]))


if __name__ == "__main__":
    main()
