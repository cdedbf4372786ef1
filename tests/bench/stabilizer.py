"""`python -m tests.bench.stabilizer`: laws for the ROSbot from scratch, tried on starts that no search has seen.

Each seed is one run of stage 1 as the main job does it, then 1000 starts within 3 m, any heading, 40 s: how many
reach the goal with control periods of 0.05 s and 0.005 s, and with the robot's dynamics under 20 draws of its
parameters and delay; with what probability at least, at 95 % confidence, a start under a draw of its own does; the
median of arrival time over the least time to the same pose (Reeds and Shepp); median and worst time (s); the share
still there at the end; how much the controls move on the way (total variation per run), instructions, and what the
search took (s).
"""

import argparse
import time

import numpy as np

from applications.rosbot.model import DELAY, dynamic_unicycle
from applications.rosbot.reeds_shepp import distance
from applications.rosbot.stabilization import poses, stabilization
from applications.rosbot.stabilizer import SEARCH_BUDGET, default_law, synthesize_stabilizer
from gpsynth.draws import Draws, crossed, random_draws
from gpsynth.evaluate import Evaluator
from gpsynth.law import Law
from gpsynth.problem import Problem
from gpsynth.proportions import lower_bound
from gpsynth.rollouts import Rollouts
from gpsynth.seeds import stream
from gpsynth.simulation import simulate

PERIODS = (0.05, 0.005)  # s
HORIZON = 40.0  # s
STARTS, DRAWS = 1_000, 20
WATCHED = 30  # starts whose controls are followed
SPEED, RADIUS = 0.5, 1.0  # m/s, m
HEAD = (
    f"{'':9}{'0.05 s':>8}{'0.005 s':>8}{'20 draws':>9}{'p >=':>8}{'/least':>8}{'median':>8}{'worst':>7}{'held':>7}"
    f"{'|dv|':>7}{'|dw|':>7}{'size':>6}{'search':>8}"
)


def _rolled(law: Law, problem: Problem) -> Rollouts:
    return Evaluator(problem, threads=2).of_program(law.program, law.parameters[np.newaxis])


def _reached(rollouts: Rollouts) -> int:
    return int(np.isfinite(rollouts.arrival).sum())


def _dynamic(starts: np.ndarray, draws: Draws) -> Problem:
    return stabilization(starts, plant=dynamic_unicycle(), draws=draws, horizon=HORIZON)


def _held(law: Law, starts: np.ndarray) -> float:
    problem = stabilization(starts, horizon=HORIZON, stop=False)
    final = _rolled(law, problem).final[0]
    return float(np.mean(problem.arrival(np.hstack([final, np.zeros_like(final)]))[:, 0] <= 0.0))


def _cells(law: Law) -> str:
    rng = stream(20_261_122)
    starts = poses(rng, STARTS)
    coarse, fine = (_rolled(law, stabilization(starts, period=each, horizon=HORIZON)) for each in PERIODS)
    draws = random_draws(dynamic_unicycle(), rng, DRAWS, delay=DELAY)
    crossing = _reached(_rolled(law, _dynamic(*crossed(starts, draws))))
    own = random_draws(dynamic_unicycle(), rng, STARTS, delay=DELAY)
    sure = lower_bound(_reached(_rolled(law, _dynamic(starts, own))), STARTS)
    there = np.isfinite(coarse.arrival[0])
    times = coarse.arrival[0][there]
    least = distance(np.zeros(3), starts[there], RADIUS) / SPEED
    runs = [simulate(stabilization(starts), law, start).u for start in starts[:WATCHED]]
    moved = np.mean([np.abs(np.diff(controls, axis=0)).sum(axis=0) for controls in runs], axis=0)
    return (
        f"{_reached(coarse):8d}{_reached(fine):8d}{crossing:9d}{sure:8.4f}{np.median(times / least):8.3f}"
        f"{np.median(times):8.2f}{times.max():7.1f}{_held(law, starts):7.1%}{moved[0]:7.2f}{moved[1]:7.2f}"
        f"{law.complexity:6d}"
    )


def main() -> None:
    """Print a line a seed, the shipped law first."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, nargs="*", default=list(range(1, 11)))
    parser.add_argument("--budget", type=int, default=SEARCH_BUDGET)
    parser.add_argument("--objective", choices=["plans", "settling"], default="plans")
    arguments = parser.parse_args()
    print(HEAD)
    print(f"{'shipped':9}{_cells(default_law())}", flush=True)
    for seed in arguments.seeds:
        began = time.perf_counter()
        result = synthesize_stabilizer(seed=seed, budget=arguments.budget, objective=arguments.objective)
        taken = time.perf_counter() - began
        print(f"{f'seed {seed}':9}{_cells(result.law)}{taken:8.1f}", flush=True)
        print("\n".join(f"    {line}" for line in result.law.formulas()), flush=True)


if __name__ == "__main__":
    main()
