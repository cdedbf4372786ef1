"""`python -m tests.bench.planning`: plans for the public scenarios, replayed, beside the best known times.

`--law FILE` (several times) plans with these laws instead of the hand-tuned ones; `--seeds N` sets how many seeds;
names of scenarios restrict the table. T_ref is read from ../shared/reference where that is present.
"""

import argparse
import json
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from applications.rosbot.model import unicycle
from applications.rosbot.planner import PlanReport, plan_scenario
from applications.rosbot.polar_law import HOT, SATURATING, polar_law
from applications.rosbot.scenario import Scenario
from applications.rosbot.scenario_file import read_scenario
from gpsynth.law import Law

ROOT = Path(__file__).parents[2]
SHARED = ROOT.parent / "shared"
HEAD = (
    f"{'scenario':20} {'T_ref':>7} {'T/T_ref min':>11} {'median':>7} {'max':>7} {'T/bound':>8} "
    f"{'clear mm':>8} {'first s':>8} {'final s':>8} {'rollouts':>9}"
)


@dataclass(frozen=True)
class Attempt:
    """A plan and when the first and the final one were there (processor seconds)."""

    report: PlanReport
    first: float
    final: float


def attempt(scenario: Scenario, laws: Sequence[Law], seed: int) -> Attempt:
    """Plan on one core."""
    began, found = time.process_time(), []

    def note(report: PlanReport) -> None:
        if report.status == "planned" and not found:
            found.append(time.process_time() - began)

    report = plan_scenario(scenario, laws, seed=seed, callback=note)
    return Attempt(report, found[0] if found else np.nan, time.process_time() - began)


def row(name: str, attempts: Sequence[Attempt], best_known: float | None) -> str:
    """One line of the table."""
    solved = [each for each in attempts if each.report.replay is not None and each.report.replay.solves]
    if not solved:
        return f"{name:20} {attempts[0].report.status}: {attempts[0].report.reason}"
    times = np.array([each.report.replay.arrival_time for each in solved if each.report.replay is not None])
    ratios = times / (best_known or np.nan)
    clearance = min(each.report.replay.clearance for each in solved if each.report.replay is not None)
    first, final, rollouts = (
        np.median([value(each) for each in solved])
        for value in (lambda each: each.first, lambda each: each.final, lambda each: each.report.evaluations)
    )
    missing = (
        f"  {len(attempts) - len(solved)} of {len(attempts)} not solved"
        if len(solved) < len(attempts)
        else ""
    )
    return (
        f"{name:20} {best_known or np.nan:7.3f} {ratios.min():11.3f} {np.median(ratios):7.3f} {ratios.max():7.3f} "
        f"{np.median(times) / solved[0].report.lower_bound:8.3f} {1e3 * clearance:8.2f} {first:8.3f} {final:8.2f} "
        f"{rollouts:9.0f}{missing}"
    )


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--law", action="append", default=[], type=Path)
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("scenarios", nargs="*")
    chosen = parser.parse_args()
    laws = [Law.load(path) for path in chosen.law]
    laws = laws or [polar_law(unicycle(), gains) for gains in (SATURATING, HOT)]
    known = json.loads((SHARED / "reference" / "planning.json").read_text()) if SHARED.exists() else {}
    public = (SHARED / "scenarios").glob("p*.json")
    paths = sorted((*public, *(ROOT / "applications" / "rosbot" / "scenarios").glob("*.json")))
    print(HEAD)
    ratios: list[float] = []
    for path in paths:
        if chosen.scenarios and path.stem not in chosen.scenarios:
            continue
        scenario, best_known = read_scenario(path), known.get(path.stem, {}).get("T_ref")
        attempts = [attempt(scenario, laws, seed) for seed in range(chosen.seeds)]
        print(row(path.stem, attempts, best_known), flush=True)
        times = [each.report.replay.arrival_time for each in attempts if each.report.replay is not None]
        ratios += [arrival / best_known for arrival in times if best_known]
    if ratios:
        print(
            f"T/T_ref of {len(ratios)} plans: median {np.median(ratios):.4f}, mean {np.mean(ratios):.4f}, "
            f"max {max(ratios):.3f}"
        )


if __name__ == "__main__":
    main()
