"""1, 2, 4 and 8 robots that change places across a circle, streets and a corridor; and how surely pairs are clear.

python -m tests.bench.fleets
"""

import statistics
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from applications.rosbot.arcs import Arcs, arcs
from applications.rosbot.encounters import least_distance
from applications.rosbot.fleet import plan_fleet
from applications.rosbot.fleet_file import read_fleet
from applications.rosbot.planner import plan_scenario
from applications.rosbot.replay import drive
from applications.rosbot.scenario import Scenario
from applications.rosbot.stabilizer import default_law
from gpsynth.arrays import Floats
from gpsynth.seeds import stream
from tests.bench.measure import pin

SEEDS = range(3)
SIZES = (1, 2, 4, 8)
PAIRS = 3000
SCENARIOS = Path("applications/rosbot/scenarios")
FILES = ("corridor_exchange", "street_crossing")
EXACT = 1e-9  # m; rounding of the reference


def circle(count: int, radius: float = 3.0) -> list[Scenario]:
    """Robots on a circle (m), each of which goes straight across to where another one starts, or to the other side."""
    angles = 2.0 * np.pi * np.arange(count) / count
    ends = radius * np.column_stack([np.cos(angles), np.sin(angles)])
    bounds = np.array([-1.0, 1.0, -1.0, 1.0]) * (radius + 0.5)
    return [
        Scenario(start=[*-end, angle], goal=[*end, angle], bounds=bounds)
        for end, angle in zip(ends, angles, strict=True)
    ]


def main() -> None:
    """Print both tables."""
    pin()
    print("| robots | scene | planned | last arrival / alone: median, worst | clearance mm | processor s |")
    print("|---:|---|---:|---:|---:|---:|", flush=True)
    for size in SIZES:
        _row("circle of 6 m", circle(size))
    for name in FILES:
        fleet = read_fleet(SCENARIOS / f"{name}.json")
        _row(fleet.name, fleet.scenarios)
    found = np.array([_judged(*pair) for pair in random_pairs(PAIRS, seed=1)])
    gaps = found[:, 1] - found[:, 0]
    print(f"\n{PAIRS} random pairs: {np.sum(gaps < -EXACT)} false, median gap {np.median(gaps):.1e} m")


def _row(name: str, scenarios: Sequence[Scenario]) -> None:
    """A scene under all seeds."""
    planned, ratios, clearances, times, law = 0, [], [], [], default_law()
    for seed in SEEDS:
        begin = time.process_time()
        if len(scenarios) == 1:
            planned += plan_scenario(scenarios[0], [law], seed=seed).status == "planned"
            times.append(time.process_time() - begin)
            continue
        report = plan_fleet(scenarios, [law], seed=seed)
        times.append(time.process_time() - begin)
        if report.status == "planned":
            planned += 1
            ratios.append(max(report.arrivals) / max(each.replay.arrival_time for each in report.alone))
            clearances.append(report.clearance)
    ratio = f"{statistics.median(ratios):.3f}, {max(ratios):.3f}" if ratios else "-"
    clear = f"{1e3 * min(clearances):.1f}" if clearances else "-"
    print(
        f"| {len(scenarios)} | {name} | {planned} of {len(SEEDS)} | {ratio} | {clear} | "
        f"{statistics.median(times):.1f} |",
        flush=True,
    )


Driven = tuple[Floats, Floats, Floats]  # start, controls, durations


def random_pairs(count: int, *, seed: int) -> Iterator[tuple[Driven, Driven]]:
    """Robots that drive up to 6 random pieces within a few meters; some stand, some have nothing to drive."""
    rng = stream(seed, 0)

    def driven() -> Driven:
        pieces = int(rng.integers(0, 7))
        controls = rng.uniform(-1.0, 1.0, (pieces, 2)) * [0.5, 1.5] * (rng.random((pieces, 2)) < 0.8)
        return rng.uniform(-1.0, 1.0, 3) * [1.0, 1.0, np.pi], controls, rng.uniform(0.0, 2.0, pieces)

    for _ in range(count):
        yield driven(), driven()


def sampled(first: Driven, second: Driven) -> float:
    """The least distance (m) of the centers at the samples of another simulator, at most 1 ms apart."""
    changes = np.unique(np.concatenate([np.append(0.0, np.cumsum(each[2])) for each in (first, second)]))
    one, two = (drive(each[0], _held(each, changes), np.diff(changes)) for each in (first, second))
    return float(np.hypot(*(one - two)[:, 1:3].T).min())


def _held(driven: Driven, changes: Floats) -> Floats:
    """The controls between the times at which either robot changes its own; none after its end."""
    piece = np.searchsorted(np.cumsum(driven[2]), changes[:-1], side="right")
    held: Floats = np.vstack([driven[1], [[0.0, 0.0]]])[piece]
    return held


def path_of(driven: Driven) -> Arcs:
    """The same as arcs."""
    return arcs(*driven)


def _judged(first: Driven, second: Driven) -> tuple[float, float]:
    return least_distance(path_of(first), path_of(second))[0], sampled(first, second)


if __name__ == "__main__":
    main()
