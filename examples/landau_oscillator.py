"""The Landau oscillator: a force on one coordinate is to calm a stable limit cycle at least cost.

`python -m examples.landau_oscillator FOLDER` finds laws from scratch, prints the front and writes the exports of the
best; `gpsynth synthesize examples/landau_oscillator.py` runs the same problem from the command line.

A standard problem of machine-learning control, the default of the program xMLC. Its cost is the mean over four starts
on the cycle of the integral of r^2 + 0.01 b^2 over 63 s, |b| <= 1. The best clipped linear law of a continuous clock is
b = 6.735 a1 - 6.080 a2 with J = 1.297; here the law is evaluated every 0.05 s and held in between.
"""

from typing import Any

import gpsynth as gs
from examples.command import Finding, command, start


def oscillator(x: Any, u: Any) -> tuple[Any, Any]:
    """Amplitude 1 attracts every orbit but the one at rest."""
    growth = 1.0 - x.a1**2 - x.a2**2
    return growth * x.a1 - x.a2, growth * x.a2 + x.a1 + u.b


def effort(x: Any, u: Any, goal: Any) -> Any:
    """Cost per second."""
    return x.a1**2 + x.a2**2 + 0.01 * u.b**2


def oscillation(period: float, horizon: float) -> gs.Problem:
    """From four points of the limit cycle to rest."""
    starts = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)]
    return gs.Problem(
        plant,
        starts,
        goal=(0.0, 0.0),
        tolerance=0.05,
        horizon=horizon,
        period=period,
        running=effort,
        stop=False,
    )


plant = gs.Plant(
    oscillator, states={"a1": "1", "a2": "1"}, controls={"b": ("1", -1.0, 1.0)}, name="landau_oscillator"
)
problem = oscillation(period=0.05, horizon=63.0)
encoding = gs.TreeEncoding(
    problem.features.names,
    plant.control_names,
    operations=("add", "sub", "mul", "tanh", "abs"),
    space=gs.ParameterSpace(6),
    max_size=20,
)


def found(seed: int, budget: int, tuning: int) -> Finding:
    """What this seed finds."""
    rough = oscillation(period=0.1, horizon=15.0)
    result = gs.synthesize(problem, encoding, seed=seed, budget=budget, tuning=tuning, rough=rough)
    return Finding(problem, {"law": result})


main = command(
    found,
    budget=40_000,
    tuning=2_000,
    reference="best linear law 1.297, optimum 1.2826",
)

if __name__ == "__main__":
    start(main, "landau_oscillator")
