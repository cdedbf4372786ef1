"""`python -m tests.bench.plan_laws [FOLDER ...]`: what laws are worth to plans, beside how fast they settle.

The laws: the one that ships, the polar laws, and those of the front that `python -m applications.rosbot synthesize`
left in each folder, as far as they arrive from the most unseen starts. "worth" is that of `gpsynth.planning.Worth` in
generated scenarios, "again" in others of the same kinds; no search has seen either. "public" is the mean of T_ref / T
over the public scenarios and the seeds, one search of 9600 rollouts each, 0 without a plan
(`tests.bench.plan_ablation`). "cut" is how deep the first schedules, which lie along guides, lead into obstacles, the
best of each generated scenario that has some: how badly a law follows points that move. "arrives" counts arrivals from
1000 starts within 3 m, "of the least time" is their median over the shortest Reeds-Shepp path: a stabilizer's quality,
which says little about that of its plans.
"""

import argparse
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from applications.rosbot.model import unicycle
from applications.rosbot.polar_law import HOT, SATURATING, SETTLING, polar_law
from applications.rosbot.reeds_shepp import distance
from applications.rosbot.replay import replay
from applications.rosbot.stabilization import poses, stabilization
from applications.rosbot.stabilizer import default_law
from applications.rosbot.training import plan_worth, training_scenarios
from gpsynth.evaluate import Evaluator
from gpsynth.files import read_json
from gpsynth.law import Law
from gpsynth.planning import Objective, Worth
from gpsynth.seeds import stream
from tests.bench.measure import machine, pin
from tests.bench.plan_ablation import PERIOD, Variant
from tests.bench.plan_peers import SHARED, Case, cases

STARTS, HORIZON = 1_000, 40.0  # of stabilization, s
SPEED, RADIUS = 0.5, 1.0  # m/s, m
SETS = (0, 1_000)  # seeds of the scenarios, those of the main job being others


def laws_of(folders: list[Path]) -> Iterator[tuple[str, Law]]:
    """Laws by name."""
    yield "shipped", default_law()
    for name, gains in (("saturating", SATURATING), ("hotter", HOT), ("from point to point", SETTLING)):
        yield f"polar, {name}", polar_law(unicycle(), gains)
    for folder in folders:
        front = read_json(folder / "front.json")["laws"]
        most = max(entry["reached"] for entry in front)
        for entry in (entry for entry in front if entry["reached"] == most):
            yield f"{folder.name}, size {entry['complexity']}", Law.from_dict(entry["law"])


def settling(law: Law) -> tuple[int, float]:
    """How many starts the law arrives from, and the median of its time over the least one."""
    starts = poses(stream(20_261_122), STARTS)
    problem = stabilization(starts, horizon=HORIZON)
    arrival = Evaluator(problem).of_program(law.program, law.parameters[np.newaxis]).arrival[0]
    there = np.isfinite(arrival)
    least = distance(np.zeros(3), starts[there], RADIUS) / SPEED
    return int(there.sum()), float(np.median(arrival[there] / least))


def first_cut(law: Law, worth: Worth) -> float:
    """How deep (cm) the best of the first schedules leads into an obstacle, the mean over tasks that have any."""
    depths = []
    for task in worth.tasks:
        if task.problem.obstacles is not None and len(task.problem.obstacles.circles):
            horizon = task.budget or task.problem.horizon
            objective = Objective(Evaluator(task.problem), law, worth.settings, horizon)
            first = objective.rollouts(task.schedules.points, task.schedules.dwell)
            depths.append(max(0.0, -float(first.clearance.max())))
    return 100.0 * float(np.mean(depths))


def public_worth(law: Law, known: list[Case], seeds: int) -> tuple[int, float]:
    """In how many runs a plan was found, and the mean of T_ref / T over all of them."""
    search, shares = Variant(law=lambda: law), []
    for case in known:
        for seed in range(seeds):
            controls = search.controls(case.scenario, seed)
            check = replay(case.scenario, controls, np.full(len(controls), PERIOD))
            shares.append(case.best_known / check.arrival_time if check.solves else 0.0)
    return int(np.count_nonzero(shares)), float(np.mean(shares))


def row(name: str, law: Law, worths: tuple[Worth, Worth], known: list[Case], seeds: int) -> str:
    """Markdown."""
    first, again = (worth(law) for worth in worths)
    solved, public = public_worth(law, known, seeds) if known else (0, np.nan)
    arrives, least = settling(law)
    return (
        f"| {name} | {first:.3f} | {again:.3f} | {public:.3f} | {solved} of {len(known) * seeds} "
        f"| {first_cut(law, worths[0]):.1f} | {arrives} | {least:.3f} | {law.complexity} |"
    )


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=2)
    parser.add_argument("--scenarios", type=int, default=20, help="of each set")
    parser.add_argument("folders", nargs="*", type=Path)
    asked = parser.parse_args()
    pin()
    print(machine())
    known = cases(()) if SHARED.exists() else []
    sets = tuple(plan_worth(training_scenarios(asked.scenarios, seed=seed)) for seed in SETS)
    print("| law | worth | again | public | solved | cut cm | arrives | of the least time | size |")
    print(f"|---|{'---:|' * 8}")
    for name, law in laws_of(asked.folders):
        print(row(name, law, (sets[0], sets[1]), known, asked.seeds), flush=True)


if __name__ == "__main__":
    main()
