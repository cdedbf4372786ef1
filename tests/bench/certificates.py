"""`python -m tests.bench.certificates`: certificates against the path sampled every 0.1 ms, and how fast reasons are.

Paths of a few arcs are drawn, and circles so that most of them graze the path: their centers lie on a normal of it, at
the sum of the radii and a gap between -1 cm and 1 cm whose size is drawn by its logarithm. A certificate is false if
its clearance is greater than what some sample shows. `--plans N` draws fewer.
"""

import argparse
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from applications.rosbot.certificate import Certificate, certify
from applications.rosbot.reachability import reachability
from applications.rosbot.scenario import Scenario
from applications.rosbot.scenario_file import read_scenario
from gpsynth.arrays import Floats
from gpsynth.seeds import stream

SAMPLING = 1e-4  # s
ROUNDED = 1e-13  # m, what rounding does to the samples themselves
PIECES, CIRCLES, DRAWN = 6, 4, 12
SCENARIOS = Path(__file__).parents[3] / "shared" / "scenarios"
REPEATS = 20


@dataclass(frozen=True, eq=False)
class Drawn:
    """A path among circles that it touches, nearly."""

    scenario: Scenario
    controls: Floats  # (PIECES, 2)
    durations: Floats  # (PIECES,) s
    samples: Floats  # (N, 4) t, x, y, theta


def drawn(rng: np.random.Generator, *, moving: bool) -> Drawn:
    """A plan; of the controls some stand, go straight or turn in place, and some hardly bend."""
    while True:
        shares = rng.choice([0.0, 1e-9, 1e-3, 1.0, 1.0, 1.0], (PIECES, 2))
        controls = rng.uniform([-1.0, -4.0], [1.0, 4.0], (PIECES, 2)) * shares
        durations = rng.uniform(0.0, 0.1, PIECES) * rng.choice([0.0, 1.0, 1.0, 1.0], PIECES)
        start, radius = rng.uniform(-3.0, 3.0, 3), rng.uniform(0.05, 0.3)
        samples = sampled(start, controls, durations)
        circles = _grazing(samples, radius, 0.4 * moving, rng)
        if len(circles):
            scenario = Scenario(start, [50.0, 0.0, 0.0], circles=circles, radius=radius)
            return Drawn(scenario, controls, durations, samples)


def _grazing(samples: Floats, radius: float, fastest: float, rng: np.random.Generator) -> Floats:
    """Up to CIRCLES circles that graze the path somewhere and cut it no deeper elsewhere."""
    t, x, y, theta = samples[rng.integers(len(samples), size=DRAWN)].T
    gaps = 10.0 ** rng.uniform(-9.0, -2.0, DRAWN) * rng.choice([-1.0, 1.0, 1.0, 1.0, 1.0, 1.0], DRAWN)
    circles = np.column_stack(
        [x, y, rng.uniform(-fastest, fastest, (DRAWN, 2)), rng.uniform(0.0, 0.5, DRAWN)]
    )
    away = (circles[:, 4] + radius + gaps) * rng.choice([-1.0, 1.0], DRAWN)
    circles[:, 0] -= away * np.sin(theta) + circles[:, 2] * t
    circles[:, 1] += away * np.cos(theta) - circles[:, 3] * t
    few = samples[:: len(samples) // 32 + 1, :, np.newaxis]
    x, y = few[:, 1] - circles[:, 2] * few[:, 0], few[:, 2] - circles[:, 3] * few[:, 0]
    cuts = np.hypot(x - circles[:, 0], y - circles[:, 1]) - circles[:, 4] - radius
    kept = (cuts.min(axis=0) >= np.minimum(gaps, 0.0)) & (cuts[0] >= 0.0)
    return circles[kept][:CIRCLES]


def sampled(start: Floats, controls: Floats, durations: Floats) -> Floats:
    """The path (N, 4) t, x, y, theta at least every 0.1 ms and at every change, by Simpson's rule in every step."""
    counts = np.ceil(durations / SAMPLING).astype(int)
    steps = np.repeat(durations / np.maximum(counts, 1), counts)
    v, omega = np.repeat(controls, counts, axis=0).T
    heading = np.concatenate([[0.0], np.cumsum(steps * omega)]) + start[2]
    directions = np.column_stack([np.cos(heading), np.sin(heading)])
    halfway = heading[:-1] + 0.5 * steps * omega
    middle = np.column_stack([np.cos(halfway), np.sin(halfway)])
    moved = (steps * v / 6.0)[:, np.newaxis] * (directions[:-1] + 4.0 * middle + directions[1:])
    path = np.empty((len(steps) + 1, 4))
    path[:, 0] = np.concatenate([[0.0], np.cumsum(steps)])
    path[:, 1:3] = start[:2]
    path[1:, 1:3] += np.cumsum(moved, axis=0)
    path[:, 3] = heading
    return path


def seen(plan: Drawn) -> float:
    """The smallest gap (m) that the samples show."""
    t, x, y, _ = plan.samples.T
    gaps = [
        np.sqrt(np.min((x - cx - vx * t) ** 2 + (y - cy - vy * t) ** 2)) - radius - plan.scenario.radius
        for cx, cy, vx, vy, radius in plan.scenario.circles
    ]
    return float(min(gaps))


def judged(count: int, *, moving: bool, seed: int = 1) -> Iterator[tuple[Certificate, float]]:
    """The certificates of so many plans, each with what the samples show."""
    rng = stream(seed, int(moving))
    for _ in range(count):
        plan = drawn(rng, moving=moving)
        yield certify(plan.scenario, plan.controls, plan.durations), seen(plan)


def _table(count: int) -> None:
    print(
        f"{'circles':9} {'plans':>7} {'false':>6} {'cleared':>8} {'collide':>8} "
        f"{'median gap m':>13} {'p99':>9} {'max':>9} {'ms each':>8}"
    )
    for name, moving in (("at rest", False), ("moving", True)):
        began = time.process_time()
        found = [
            (each.clearance, each.is_clear, sample) for each, sample in judged(count // 2, moving=moving)
        ]
        spent = 1e3 * (time.process_time() - began) / len(found)
        proved, clear, samples = np.array(found).T
        gap = samples - proved
        print(
            f"{name:9} {len(found):7} {np.sum(gap < -ROUNDED):6} {np.mean(clear):8.1%} {np.mean(samples < 0.0):8.1%} "
            f"{np.median(gap):13.2e} {np.quantile(gap, 0.99):9.2e} {gap.max():9.2e} {spent:8.2f}",
            flush=True,
        )


def _reasons() -> None:
    """How long the verdicts take on the public scenarios, warm."""
    print(f"\n{'scenario':20} {'verdict':12} {'median ms':>9} {'max ms':>7}  reason")
    for path in sorted(SCENARIOS.glob("p*.json")):
        scenario, times = read_scenario(path), []
        verdict = reachability(scenario)
        for _ in range(REPEATS):
            began = time.process_time()
            verdict = reachability(scenario)
            times.append(1e3 * (time.process_time() - began))
        print(
            f"{path.stem:20} {verdict.status:12} {np.median(times):9.2f} {max(times):7.2f}  {verdict.reason}"
        )


def main() -> None:
    """Print both tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--plans", type=int, default=100_000)
    _table(parser.parse_args().plans)
    _reasons()


if __name__ == "__main__":
    main()
