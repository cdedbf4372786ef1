"""`python -m tests.bench.drawn_search`: the same search on the nominal plant and on draws of it, judged on new draws.

A cart of unknown mass and drag, with a force that comes late, is brought to rest. One search sees six starts, the
other each of them under six draws; both laws are assessed from 500 starts, each under a draw of its own.
"""

import argparse
from dataclasses import replace

import numpy as np

import gpsynth as gs

OPERATIONS = ("add", "sub", "mul", "abs", "tanh", "min", "max")
DELAY = (0.0, 0.1)  # s
CART = gs.Plant(
    lambda x, u, p: (x.v, (u.force - p.drag * x.v) / p.mass),
    states={"x": "m", "v": "m/s"},
    controls={"force": ("N", -1.0, 1.0)},
    parameters={"mass": ("kg", 0.5, 1.5, 0.8), "drag": ("kg/s", 0.0, 0.3)},
    name="cart",
)


def nominal(seed: int) -> gs.Problem:
    """Six starts, and a cost of being away and of moving, for the whole time."""
    return gs.Problem(
        CART,
        gs.stream(seed, 1).uniform(-1.0, 1.0, (6, 2)),
        goal=(0.0, 0.0),
        tolerance=0.02,
        horizon=8.0,
        step=0.025,
        method="heun",
        running=lambda x, u, goal: np.abs(x.x) + 0.2 * np.abs(x.v),
        stop=False,
    )


def drawn(seed: int) -> gs.Problem:
    """The same starts under six draws."""
    problem = nominal(seed)
    draws = gs.random_draws(CART, gs.stream(seed, 2), 6, delay=DELAY, noise=(0.002, 0.01))
    starts, rows = gs.crossed(problem.starts, draws)
    return replace(problem, starts=starts, draws=rows)


def unseen() -> gs.Problem:
    """500 starts with a draw each, of which no search knows."""
    draws = gs.random_draws(CART, gs.stream(0, 4), 500, delay=DELAY)
    starts = gs.stream(0, 3).uniform(-1.0, 1.0, (500, 2))
    return replace(nominal(0), starts=starts, draws=draws, horizon=20.0, step=0.01, method="rk4")


def main() -> None:
    """Print one line a seed and problem."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, nargs="+", default=[1, 2, 3, 4, 5])
    parser.add_argument("--budget", type=int, default=4_000)
    arguments = parser.parse_args()
    print(f"{'':22}{'reached':>9}{'median s':>10}{'worst s':>9}{'held':>7}{'slowdown, worst':>17}{'size':>6}")
    for seed in arguments.seeds:
        for name, problem in {"nominal plant": nominal(seed), "draws": drawn(seed)}.items():
            features = problem.features.names
            encoding = gs.TreeEncoding(features, ("force",), OPERATIONS, gs.ParameterSpace(6), max_size=15)
            law = gs.synthesize(problem, encoding, seed=seed, budget=arguments.budget).law
            report = gs.assess(law, unseen(), gs.Stress(refine=1, limits=()))
            trial, slowest = report.trials[0], report.slowest
            print(
                f"{f'seed {seed}, {name}':22}{trial.reached:9d}{trial.median:10.2f}{trial.worst:9.2f}"
                f"{trial.held:7.3f}{slowest.slowdown if slowest else 1.0:17.2f}{law.complexity:6d}",
                flush=True,
            )


if __name__ == "__main__":
    main()
