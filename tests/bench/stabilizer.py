"""`python -m tests.bench.stabilizer`: laws for the ROSbot from scratch, tried on starts that no search has seen.

Each seed is one run of stage 1 as the main job does it; then 200 starts within 2 m, 30 s, at control periods of 0.05 s
and 0.005 s: how many reach the goal, in what time (s), how many are still there after 30 s, and how much the controls
move on the way (total variation per run).
"""

import argparse
import time

import numpy as np

from applications.rosbot.stabilizer import (
    SEARCH_BUDGET,
    default_law,
    poses,
    stabilization,
    synthesize_stabilizer,
)
from gpsynth.evaluate import Evaluator
from gpsynth.law import Law
from gpsynth.seeds import stream
from gpsynth.simulation import simulate

PERIODS = (0.05, 0.005)  # s
STARTS = 200
WATCHED = 30  # starts whose controls are followed


def _cells(law: Law) -> str:
    starts = poses(stream(20_261_122), STARTS)
    text = ""
    for period in PERIODS:
        problem = stabilization(starts, period=period)
        arrival = Evaluator(problem, threads=2).of_program(law.program, law.parameters[np.newaxis]).arrival[0]
        reached = arrival[np.isfinite(arrival)]
        on = stabilization(starts, period=period, stop=False)
        final = Evaluator(on, threads=2).of_program(law.program, law.parameters[np.newaxis]).final[0]
        held = int(np.sum(on.arrival(np.hstack([final, np.zeros_like(final)]))[:, 0] <= 0.0))
        text += f"{len(reached):6d}/{STARTS}{np.median(reached):8.2f}{reached.max():8.2f}{held:6d}"
    runs = [simulate(stabilization(starts), law, start).u for start in starts[:WATCHED]]
    moved = np.mean([np.abs(np.diff(controls, axis=0)).sum(axis=0) for controls in runs], axis=0)
    return text + f"{moved[0]:8.2f}{moved[1]:8.2f}{law.complexity:6d}"


def main() -> None:
    """Print a line a seed, the shipped law first."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, nargs="*", default=[1, 2, 3])
    parser.add_argument("--budget", type=int, default=SEARCH_BUDGET)
    arguments = parser.parse_args()
    head = "".join(f"{f'{period:g} s':>10}{'median':>8}{'worst':>8}{'held':>6}" for period in PERIODS)
    print(f"{'':14}{head}{'|dv|':>8}{'|dw|':>8}{'size':>6}{'search s':>10}")
    print(f"{'shipped':14}{_cells(default_law())}", flush=True)
    for seed in arguments.seeds:
        began = time.perf_counter()
        result = synthesize_stabilizer(seed=seed, budget=arguments.budget)
        taken = time.perf_counter() - began
        print(f"{f'seed {seed}':14}{_cells(result.law)}{taken:10.1f}", flush=True)


if __name__ == "__main__":
    main()
