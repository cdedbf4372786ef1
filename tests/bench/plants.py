"""`python -m tests.bench.plants [NAME ...]`: every example from scratch under several seeds, beside what is known.

One line a seed: cost on the example's own problem, the same with steps ten times finer (and, where the law has a
continuous clock, ten times as many of its values), the share of starts that end at the goal, the same from starts that
no search has seen, and the time taken. Under each table stands the reference.
"""

import argparse
import time
from collections.abc import Callable
from dataclasses import dataclass
from types import ModuleType

import numpy as np

import gpsynth as gs
from examples import (
    car_like,
    cart_pole,
    coupled_oscillators,
    landau_oscillator,
    parking,
    planar_quadrotor,
    swing_up,
    three_cars,
)
from examples.command import Finding
from gpsynth.arrays import Floats
from gpsynth.objective import costs_of
from tests.bench.landau_optimum import optimum
from tests.bench.three_cars_contact import deepest

UNSEEN = 200  # starts


@dataclass(frozen=True)
class Bar:
    """An example and what its law is held against."""

    module: ModuleType
    reference: str
    unseen: Callable[[np.random.Generator], Floats] | None = None  # starts (UNSEEN, n)
    check: Callable[[Finding], str] | None = None


def around(center: tuple[float, ...], width: tuple[float, ...]) -> Callable[[np.random.Generator], Floats]:
    """Uniform starts in a box."""
    return lambda rng: np.array(center) + np.array(width) * rng.uniform(-1.0, 1.0, (UNSEEN, len(center)))


BARS = {
    "landau_oscillator": Bar(landau_oscillator, "best clipped linear law 1.297"),
    "coupled_oscillators": Bar(coupled_oscillators, "published 0.003633"),
    "cart_pole": Bar(cart_pole, "published linear law 16.2648 by Simpson's rule, 16.2220 exactly"),
    "swing_up": Bar(swing_up, "none published", unseen=around((0, 0, 0, 0), (0.5, 0.5, np.pi, 1.0))),
    "car_like": Bar(car_like, "none published", unseen=lambda rng: car_like.poses(3, UNSEEN)),
    "planar_quadrotor": Bar(
        planar_quadrotor, "none published", unseen=around((0,) * 6, (4.0, 1.0, 4.0, 1.0, 0.5, 1.0))
    ),
    "parking": Bar(parking, "none published"),
    "three_cars": Bar(three_cars, "the published run reaches no goal", check=deepest),
}


def refined(problem: gs.Problem, starts: Floats | None = None) -> gs.Problem:
    """The same problem with steps ten times finer, from other starts if asked."""
    return gs.Problem(
        problem.plant,
        problem.starts if starts is None else starts,
        problem.goal,
        tolerance=problem.tolerance,
        horizon=problem.horizon,
        period=problem.period / (1 if problem.hold else 10),
        step=problem.step / 10,
        method=problem.method,
        features=problem.features,
        reached=problem.reached,
        running=problem.running,
        terminal=problem.terminal,
        hold=problem.hold,
        stop=problem.stop,
    )


def judged(problem: gs.Problem, law: gs.Law) -> tuple[float, float]:
    """Mean cost, and share of the starts from which the end is within the tolerance."""
    evaluator = gs.Evaluator(problem, threads=2)
    rolled = evaluator.of_program(law.program, law.parameters[np.newaxis])
    there = problem.arrival(np.hstack([rolled.final[0], evaluator.goals]))[:, 0] <= 0.0
    return float(costs_of(rolled)[0].mean()), float(there.mean())


def row(bar: Bar, seed: int) -> str:
    """One line of the table."""
    begin = time.perf_counter()
    options = {option.name: option.default for option in bar.module.main.params if option.name != "folder"}
    finding = bar.module.found(seed, options["budget"], options["tuning"])
    seconds = time.perf_counter() - begin
    problem, law = finding.problem, finding.best.law
    (cost, reached), (fine, still) = judged(problem, law), judged(refined(problem), law)
    cells = f"{seed:4d}{cost:12.6g}{fine:12.6g}{reached:9.1%}{still:9.1%}"
    if bar.unseen is not None:
        starts = bar.unseen(gs.stream(seed, 99))
        cells += f"{judged(refined(problem, starts), law)[1]:9.1%}"
    else:
        cells += f"{'-':>9}"
    return f"{cells}{law.complexity:6d}{seconds:8.0f}" + (
        "" if bar.check is None else "  " + bar.check(finding)
    )


def main() -> None:
    """Print a table for each example."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", default=list(BARS), metavar="NAME")
    parser.add_argument("--seeds", type=int, nargs="+", default=[1, 2, 3])
    arguments = parser.parse_args()
    for name in arguments.names:
        print(f"{name}: {BARS[name].reference}")
        if name == "landau_oscillator":
            value, cost = optimum(161, 0.05, [(1.0, 0.0), (0.0, 1.0)])
            print(f"  optimum over all controls {value:.4f}, cost of the control that attains it {cost:.4f}")
        print(f"seed{'cost':>12}{'finer':>12}{'at goal':>9}{'finer':>9}{'unseen':>9}{'size':>6}{'s':>8}")
        for seed in arguments.seeds:
            print(row(BARS[name], seed), flush=True)


if __name__ == "__main__":
    main()
