"""Three coupled oscillators: a force that all but the first one feel is to calm the first at least cost.

`python -m examples.coupled_oscillators FOLDER` finds laws from scratch, prints the front and writes the exports of the
best; `gpsynth synthesize examples/coupled_oscillators.py` runs the same problem from the command line.

Li et al. 2018, eq. 3.1: the first oscillator grows if the second is strong and decays if the third is. J is the mean
of a1^2 + a2^2 + b^2 over 50 s. Their law reads the clock as well, b = tanh(sin(tanh(3 a2 sin t sin(pi^2 t) - a4))),
and costs 0.003633; ours reads the states alone.
"""

from typing import Any

import numpy as np

import gpsynth as gs
from examples.command import Finding, command, start

STATES = ("a1", "a2", "a3", "a4", "a5", "a6")
HORIZON = 50.0  # s


def oscillators(x: Any, u: Any) -> tuple[Any, ...]:
    """Natural frequencies 1, pi and pi^2 rad/s."""
    first, second, third = x.a1**2 + x.a2**2, x.a3**2 + x.a4**2, x.a5**2 + x.a6**2
    growth = -first + second - third, 0.1 - second, -0.1
    return (
        *(growth[0] * x.a1 - x.a2, growth[0] * x.a2 + x.a1),
        *(growth[1] * x.a3 - np.pi * x.a4, growth[1] * x.a4 + np.pi * x.a3 + u.b),
        *(growth[2] * x.a5 - np.pi**2 * x.a6, growth[2] * x.a6 + np.pi**2 * x.a5 + u.b),
    )


def calming(step: float) -> gs.Problem:
    """From an amplitude of 0.1 in all three, under a continuous clock."""
    return gs.Problem(
        plant,
        starts=[(0.1, 0.0) * 3],
        goal=np.zeros(6),
        tolerance=0.1,
        horizon=HORIZON,
        period=step,
        features=lambda x, target: {f"{name}_now": getattr(x, name) for name in STATES},
        running=lambda x, u, goal: (x.a1**2 + x.a2**2 + u.b**2) / HORIZON,
        hold=False,
        stop=False,
    )


plant = gs.Plant(
    oscillators,
    states=dict.fromkeys(STATES, "1"),
    controls={"b": ("1", -1.0, 1.0)},
    name="coupled_oscillators",
)
problem = calming(step=0.01)
operations = ("add", "sub", "mul", "tanh", "abs")
encoding = gs.TreeEncoding(
    problem.features.names, plant.control_names, operations, gs.ParameterSpace(6), max_size=20
)


def found(seed: int, budget: int, tuning: int) -> Finding:
    """What this seed finds."""
    search = gs.StructureSearch(encoding, lexicase=0.0)  # with one start there are no specialists to choose
    result = gs.synthesize(
        problem, encoding, seed=seed, budget=budget, tuning=tuning, search=search, rough=calming(step=0.05)
    )
    return Finding(problem, {"law": result})


main = command(found, budget=8_000, tuning=200, reference="published 0.003633")

if __name__ == "__main__":
    start(main, "coupled_oscillators")
