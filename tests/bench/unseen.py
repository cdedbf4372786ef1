"""`python -m tests.bench.unseen`: plans for generated scenarios of the public ones' kinds.

Every kind in other sizes, turned, under other limits, tight, and with a start or goal that touches
(`tests/bench/kinds.py`). Columns are those of `tests.bench.planning`; T_ref is the best that a longer search with any
of the laws and with the polar ones finds in the same run, or a plan of the table. `--law FILE` (several times) plans
with these laws instead of the hand-tuned ones; `--seeds N` sets how many seeds, `--draw N` draws other scenarios;
beginnings of names restrict the table.
"""

import argparse
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from applications.rosbot.model import unicycle
from applications.rosbot.planner import Effort, plan_scenario
from applications.rosbot.polar_law import HOT, SATURATING, polar_law
from applications.rosbot.scenario import Scenario
from gpsynth.law import Law
from tests.bench.kinds import generated
from tests.bench.planning import HEAD, Attempt, attempt, row, summary

LONG = Effort(chased=8, refined=6)
LONG_SEED = 1000


def best_known(scenario: Scenario, laws: Sequence[Law], attempts: Sequence[Attempt]) -> float | None:
    """The least arrival time (s) of the attempts and of longer searches; None if nothing is found."""
    polar = [polar_law(unicycle(), gains) for gains in (SATURATING, HOT)]
    reports = [each.report for each in attempts]
    reports += [plan_scenario(scenario, some, seed=LONG_SEED, effort=LONG) for some in (laws, polar)]
    return min((each.replay.arrival_time for each in reports if each.replay is not None), default=None)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--law", action="append", default=[], type=Path)
    parser.add_argument("--seeds", type=int, default=2)
    parser.add_argument("--draw", type=int, default=0)
    parser.add_argument("scenarios", nargs="*", default=[""])
    chosen = parser.parse_args()
    laws = [Law.load(path) for path in chosen.law]
    laws = laws or [polar_law(unicycle(), gains) for gains in (SATURATING, HOT)]
    scenarios = [each for each in generated(chosen.draw) if each.name.startswith(tuple(chosen.scenarios))]
    plan_scenario(replace(scenarios[0], expect_feasible=None), laws)  # loads what is loaded once
    print(HEAD)
    counted, ratios, wrong = list[Attempt](), list[float](), 0
    for scenario in scenarios:
        attempts = [attempt(scenario, laws, seed) for seed in range(chosen.seeds)]
        wrong += sum((each.report.status == "unreachable") == scenario.expect_feasible for each in attempts)
        best = best_known(scenario, laws, attempts) if scenario.expect_feasible else None
        print(row(scenario.name, attempts, best), flush=True)
        if scenario.expect_feasible:
            counted += attempts
            times = [each.report.replay.arrival_time for each in attempts if each.report.replay is not None]
            ratios += [time / (best or np.nan) for time in times]
    print(summary(counted, ratios))
    above = ", ".join(
        f"{np.mean(np.array(ratios) > limit):.1%} above {limit:g}" for limit in (1.02, 1.05, 1.1)
    )
    print(f"of the ratios {above}; {wrong} verdicts on what can be reached are wrong")


if __name__ == "__main__":
    main()
