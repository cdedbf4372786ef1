"""`python -m tests.bench.plan_growth`: how the time of rollouts and of a plan grows with obstacles, particles, threads.

The room is a forest of one circle to 2 m^2 whatever their number, start and goal are 6 m apart in its middle; rollouts
follow random schedules for 10 s, and none ends early. "all looked at" is the same without the broad phase
(`gpsynth/kernels/buckets.py`). Times are the least of a few: processor time, or wall clock where threads are compared.
`--plot FILE.png` draws the first table; `--plans` adds what a plan takes.
"""

import argparse
import os
import time
from collections.abc import Callable, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING
from unittest.mock import patch

import numpy as np

from applications.rosbot.figures import BLUE, GRAY, STYLE, save_figure
from applications.rosbot.planner import plan_scenario
from applications.rosbot.problems import problem_of
from applications.rosbot.routes import routes
from applications.rosbot.scenario import Scenario
from applications.rosbot.stabilizer import default_law
from gpsynth import loop_arrays
from gpsynth.arrays import Floats
from gpsynth.evaluate import Evaluator
from gpsynth.kernels.buckets import NONE, buckets
from gpsynth.seeds import stream
from tests.bench.measure import machine, pin

if TYPE_CHECKING:
    from matplotlib.figure import Figure

OBSTACLES = (10, 40, 160, 640)
PARTICLES = (32, 128, 512, 1024, 4096)
BASE = (40, 256)  # obstacles and particles where they are not what varies
DENSITY = 0.5  # circles a square meter
APART = 0.9  # m between centers, at least
HORIZON = 10.0  # s
REPEATS = 25
POINTS = 6


def forest(count: int, seed: int = 1) -> Scenario:
    """Circles of 0.1 to 0.3 m in a square room, at random; start and goal stay clear."""
    rng, half = stream(seed, count), 0.5 * np.sqrt(count / DENSITY) + 1.0
    ends, places = np.array([[-3.0, 0.0], [3.0, 0.0]]), np.empty((0, 2))
    while len(places) < count:
        place = rng.uniform(-half, half, 2)
        if all(np.hypot(*(place - ends).T) > 0.7) and all(np.hypot(*(place - places).T) > APART):
            places = np.vstack([places, place])
    circles = np.column_stack([places, np.zeros((count, 2)), rng.uniform(0.1, 0.3, count)])
    bounds = np.array([-1.0, 1.0, -1.0, 1.0]) * max(half, 4.0)
    return Scenario(np.append(ends[0], 0.0), np.append(ends[1], 0.0), bounds=bounds, circles=circles)


def rollouts(scenario: Scenario, particles: int, *, threads: int = 1) -> Callable[[], object]:
    """A call that rolls so many random schedules out."""
    problem = problem_of(scenario, default_law())
    evaluator, rng = Evaluator(problem, threads=threads), stream(2, particles)
    points = rng.uniform([-4.0, -3.0, -np.pi], [4.0, 3.0, np.pi], (particles, POINTS, 3))
    dwell = rng.uniform(0.5, 2.5, (particles, POINTS))
    return lambda: evaluator.of_schedules(default_law(), points, dwell, HORIZON)


def least(work: Callable[[], object], clock: Callable[[], float]) -> float:
    """The least time (s) of REPEATS calls after a first one."""
    work()
    times = []
    for _ in range(REPEATS):
        began = clock()
        work()
        times.append(clock() - began)
    return min(times)


def cpus() -> int:
    """Cores that this process may use; with one of them threads gain nothing."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


@contextmanager
def without_buckets():
    """All circles are looked at everywhere."""
    loop_arrays._sorted_circles.cache_clear()
    with patch("gpsynth.loop_arrays.buckets", lambda circles: NONE):
        yield
    loop_arrays._sorted_circles.cache_clear()


def by_obstacles() -> list[tuple[int, float, float, float]]:
    """Obstacles, us a particle with the broad phase and without, and ms to set the broad phase up."""
    found = []
    for count in OBSTACLES:
        scenario = forest(count)
        ours = everywhere = np.inf
        for _ in range(3):  # in turn, so that what else the machine does meets both
            ours = min(ours, least(rollouts(scenario, BASE[1]), time.process_time))
            with without_buckets():
                everywhere = min(everywhere, least(rollouts(scenario, BASE[1]), time.process_time))
        laid = least(lambda circles=scenario.circles: buckets(circles), time.process_time)
        found.append((count, 1e6 * ours / BASE[1], 1e6 * everywhere / BASE[1], 1e3 * laid))
    return found


def by_particles() -> list[tuple[int, float, float]]:
    """Particles, us of processor time a particle, and how many times faster two threads are by the wall clock."""
    scenario, rows = forest(BASE[0]), []
    for count in PARTICLES:
        each = 1e6 * least(rollouts(scenario, count), time.process_time) / count
        one, two = (least(rollouts(scenario, count, threads=n), time.perf_counter) for n in (1, 2))
        rows.append((count, each, one / two))
    return rows


def by_plan(seeds: Sequence[int]) -> list[tuple[int, float, float, float, float]]:
    """Obstacles, s for the routes, s to the first plan and in all (medians), and how many of the plans were found."""
    found = []
    for count in OBSTACLES:
        scenario, rows, began = forest(count), [], time.process_time()
        routes(scenario)
        spent = time.process_time() - began
        for seed in seeds:
            firsts, began = [], time.process_time()

            def note(report, firsts=firsts, began=began) -> None:
                if report.plan is not None:
                    firsts.append(time.process_time() - began)

            report = plan_scenario(scenario, [default_law()], seed=seed, callback=note)
            rows.append(
                (min(firsts, default=np.nan), time.process_time() - began, report.status == "planned")
            )
        first, whole, planned = np.array(rows).T
        found.append((count, spent, float(np.median(first)), float(np.median(whole)), float(planned.sum())))
    return found


def growth_figure(rows: Sequence[tuple[int, float, float, float]]) -> "Figure":
    """us a particle over the number of obstacles, with the broad phase and without."""
    from matplotlib import rc_context
    from matplotlib.figure import Figure

    counts, ours, everywhere, _ = np.array(rows).T
    with rc_context(dict(STYLE)):
        figure = Figure(figsize=(4.2, 2.8), layout="constrained")
        axes = figure.subplots()
        axes.plot(counts, everywhere, "o-", color=GRAY, label="all looked at")
        axes.plot(counts, ours, "o-", color=BLUE, label="with the broad phase")
        axes.set_xscale("log", base=2)
        axes.set_yscale("log", base=2)
        axes.set_xticks(counts, [f"{count:g}" for count in counts])
        axes.yaxis.set_major_formatter(lambda value, _: f"{value:g}")
        axes.set_xlabel("obstacles")
        axes.set_ylabel("µs a particle")
        axes.legend()
    return figure


def table(titles: Sequence[str], rows: Sequence[Floats | tuple[float, ...]], digits: Sequence[int]) -> None:
    """Print Markdown."""
    print(f"\n| {' | '.join(titles)} |\n|{'---:|' * len(titles)}")
    for row in rows:
        print(f"| {' | '.join(f'{value:.{k}f}' for value, k in zip(row, digits, strict=True))} |")


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--plot", type=Path)
    parser.add_argument("--plans", type=int, default=0, help="seeds of whole plans")
    asked = parser.parse_args()
    print(machine())
    cores, threaded = cpus(), by_particles()
    pin()
    rows = by_obstacles()
    titles = ("obstacles", "us a particle", "all looked at", "ms to lay the grid")
    table(titles, rows, (0, 1, 1, 2))
    table(("particles", "us a particle", f"2 threads on {cores} cores faster by"), threaded, (0, 1, 2))
    if asked.plot:
        save_figure(growth_figure(rows), asked.plot)
    if asked.plans:
        titles = ("obstacles", "routes s", "first plan s", "all s", f"planned of {asked.plans}")
        table(titles, by_plan(range(asked.plans)), (0, 3, 3, 2, 0))


if __name__ == "__main__":
    main()
