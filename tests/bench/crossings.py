"""`python -m tests.bench.crossings`: the loop at 10 Hz among random movers, beside the plan that knows all of them.

`--scenes N` drives the first N scenes only, `--seed` draws others. The clairvoyant plan is the planner's, which knows
every circle for all time; the loop sees what is within 3 m. One core; cycle times are processor time.
"""

import argparse
from dataclasses import dataclass

import numpy as np

from applications.rosbot.crossings import crossing
from applications.rosbot.loop import Drive, drive_scenario
from applications.rosbot.planner import plan_scenario
from applications.rosbot.stabilizer import default_law
from gpsynth.law import Law
from tests.bench.measure import machine, pin

SCENES = 100
SHARES = (0.5, 0.9, 1.0)


@dataclass(frozen=True)
class Meeting:
    """A scene, what came of it, and when the clairvoyant plan arrives (s; infinity without one)."""

    name: str
    movers: int
    drive: Drive
    clairvoyant: float

    @property
    def ratio(self) -> float:
        """Arrival time over that of the clairvoyant plan."""
        return self.drive.replay.arrival_time / self.clairvoyant

    def row(self) -> str:
        """A line of the table."""
        check = self.drive.replay
        cycles = 1e3 * self.drive.cycles
        flags = ("" if self.drive.is_safe else "  COLLISION") + (
            "" if self.drive.arrives else "  not arrived"
        )
        return (
            f"{self.name:14} {self.movers:6} {self.clairvoyant:12.2f} {check.arrival_time:7.2f} {self.ratio:7.3f} "
            f"{1e3 * check.clearance:9.0f} {np.median(cycles):9.1f} {cycles.max():7.1f}{flags}"
        )


def met(number: int, seed: int, law: Law) -> Meeting:
    """Plan for a scene with all that is to come, and drive through it."""
    scene = crossing(number, seed=seed)
    report = plan_scenario(scene, [law], seed=number)
    clairvoyant = np.inf if report.replay is None else report.replay.arrival_time
    return Meeting(scene.name, len(scene.circles), drive_scenario(scene, law, seed=number), clairvoyant)


def summary(meetings: list[Meeting]) -> str:
    """Safety, delay and cycle times over all scenes that have a clairvoyant plan."""
    possible = [each for each in meetings if np.isfinite(each.clairvoyant)]
    safe = sum(each.drive.is_safe for each in possible)
    arrived = [each for each in possible if each.drive.arrives and each.drive.is_safe]
    ratios = np.quantile([each.ratio for each in arrived], SHARES)
    cycles = 1e3 * np.quantile(np.concatenate([each.drive.cycles for each in meetings]), (0.5, 0.99, 1.0))
    return (
        f"clairvoyant plans: {len(possible)} of {len(meetings)}; of these without a collision {safe}, "
        f"and arrived {len(arrived)}\n"
        f"arrival / clairvoyant: median {ratios[0]:.3f}, p90 {ratios[1]:.3f}, max {ratios[2]:.3f}\n"
        f"cycle, ms: median {cycles[0]:.1f}, p99 {cycles[1]:.1f}, max {cycles[2]:.1f}"
    )


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenes", type=int, default=SCENES)
    parser.add_argument("--seed", type=int, default=0)
    chosen = parser.parse_args()
    pin()
    law, meetings = default_law(), []
    drive_scenario(
        crossing(0, seed=chosen.seed), law
    )  # so that nothing is compiled or loaded in a timed cycle
    print(machine())
    print("scene          movers  clairvoyant    loop   ratio  clear mm  cycle ms     max")
    for number in range(chosen.scenes):
        meetings.append(met(number, chosen.seed, law))
        print(meetings[-1].row(), flush=True)
    print(summary(meetings))


if __name__ == "__main__":
    main()
