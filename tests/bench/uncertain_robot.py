"""`python -m tests.bench.uncertain_robot`: the public scenarios with a robot whose gains are off and whose wheels slip.

Every draw has factors on v and omega of standard deviation 5 %, further ones of 10 % each control period, and a pose
that is measured with 1 cm and 0.01 rad of noise. The same plan is driven three ways: its controls (open loop), the law
along its schedule (feedback), and the law along what the loop at 10 Hz makes of it (replanned). The plan keeps the
widest of MARGINS that it can be found with, and so does the loop. `--draws N`; names of scenarios restrict the table.
"""

import argparse
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from applications.rosbot.loop import drive_scenario
from applications.rosbot.planner import PlanReport, plan_scenario
from applications.rosbot.problems import PERIOD
from applications.rosbot.replanning import Replanning
from applications.rosbot.replay import Replay, replay
from applications.rosbot.scenario import Scenario
from applications.rosbot.scenario_file import read_scenario
from applications.rosbot.simulated_robot import UNCERTAIN, SimulatedRobot
from applications.rosbot.stabilizer import default_law
from gpsynth.arrays import Floats
from gpsynth.law import Law
from gpsynth.seeds import stream
from tests.bench.measure import machine, pin

SCENARIOS = Path(__file__).parents[3] / "shared" / "scenarios"
DRAWS = 50
MARGINS = (0.03, 0.02, 0.01, 0.005)  # m
WAYS = ("open loop", "feedback", "replanned")
OUTCOMES = ("arrives", "collides", "misses")


def planned(scenario: Scenario, law: Law) -> tuple[PlanReport, float]:
    """A plan with the widest margin (m) that there is one with; the last report if there is none."""
    for margin in MARGINS:
        report = plan_scenario(widened(scenario, margin), [law])
        if report.plan is not None:
            break
    return report, margin


def widened(scenario: Scenario, margin: float) -> Scenario:
    """The scenario with larger circles."""
    circles = scenario.circles.copy()
    circles[:, 4] += margin
    return replace(scenario, circles=circles)


def driven(scenario: Scenario, law: Law, report: PlanReport, margin: float, seed: int) -> list[Replay]:
    """One draw of the robot, driven in all three ways."""
    assert report.plan is not None
    plan, robot = report.plan, SimulatedRobot.drawn(UNCERTAIN, stream(seed, 0))
    speeds = np.array([robot.applied(control) for control in plan.trajectory.u])
    loops = [
        drive_scenario(
            scenario, law, schedule=plan.schedule, flaws=UNCERTAIN, settings=settings, seed=seed
        ).replay
        for settings in (None, Replanning.keeping(margin))
    ]
    return [replay(scenario, speeds, PERIOD), *loops]


def outcomes(runs: Sequence[Sequence[Replay]]) -> Floats:
    """How often (way, outcome) runs arrive safely, collide or leave the bounds, or miss the goal."""
    safe = np.array([[run.clearance >= 0.0 and run.in_bounds for run in draw] for draw in runs])
    timely = np.array([[run.in_time for run in draw] for draw in runs])
    return np.stack([safe & timely, ~safe, safe & ~timely], axis=-1).mean(axis=0)


def row(name: str, shares: Floats, rest: str = "") -> str:
    """A line of the table."""
    return f"{name:20} " + " ".join(f"{share:8.1%}" for share in shares.ravel()) + rest


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--draws", type=int, default=DRAWS)
    parser.add_argument("scenarios", nargs="*")
    chosen = parser.parse_args()
    pin()
    law, runs = default_law(), list[list[Replay]]()
    print(machine())
    print(" " * 20 + "".join(f"{way:>27}" for way in WAYS))
    print(f"{'scenario':20} " + " ".join(f"{outcome:>8}" for _ in WAYS for outcome in OUTCOMES), end="")
    print("  margin mm  plan s  replanned s")
    for path in sorted(SCENARIOS.glob("p*.json")):
        scenario = read_scenario(path)
        if not scenario.expect_feasible or (chosen.scenarios and path.stem not in chosen.scenarios):
            continue
        report, margin = planned(scenario, law)
        if report.replay is None:
            print(f"{path.stem:20} {report.status}: {report.reason}")
            continue
        here = [driven(scenario, law, report, margin, seed) for seed in range(chosen.draws)]
        taken = np.median([draw[-1].arrival_time for draw in here])
        rest = f"  {1e3 * margin:9.0f} {report.replay.arrival_time:7.2f} {taken:12.2f}"
        print(row(path.stem, outcomes(here), rest), flush=True)
        runs += here
    if runs:
        print(row(f"all {len(runs)} runs", outcomes(runs)))


if __name__ == "__main__":
    main()
