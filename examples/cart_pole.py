"""A cart-pole: drive the cart 2 m to the right with the pole upright at least cost.

`python -m examples.cart_pole FOLDER` finds laws from scratch, prints the front and writes the exports of the best;
`gpsynth synthesize examples/cart_pole.py` runs the same problem from the command line.

The plant and cost of Marchetti et al. (inclusive genetic programming): with gravity -9.8 the pole stands at theta = pi.
J is the integral over 10 s of (5 |e|^2 + u^2) / 2, and |e(10)|^2 / 2. There the force has no limits; here it has, far
beyond what good laws use. Their linear law costs 16.2648 by Simpson's rule on samples 0.01 s apart, 16.2220 exactly.
"""

from typing import Any

import numpy as np

import gpsynth as gs
from examples.command import Finding, command, start

CART, POLE, LENGTH, GRAVITY = 0.1, 0.02, 0.1, -9.8  # kg, kg, m, m/s^2


def cart_pole(x: Any, u: Any) -> tuple[Any, ...]:
    """A cart pushed by a force, a point mass on a rod above it."""
    sine, cosine = np.sin(x.theta), np.cos(x.theta)
    mass = CART + POLE * (1.0 - cosine**2)
    pull = POLE * LENGTH * x.omega**2 * sine
    v_rate = (pull + u.force - POLE * GRAVITY * cosine * sine) / mass
    turn = (POLE + CART) * GRAVITY * sine - (pull + u.force) * cosine
    return x.v, v_rate, x.omega, turn / (LENGTH * mass)


def squared(x: Any, goal: Any) -> Any:
    """|e|^2 of the four errors."""
    return sum((getattr(goal, name) - getattr(x, name)) ** 2 for name in ("x", "v", "theta", "omega"))


def transfer(period: float, horizon: float) -> gs.Problem:
    """From -1 m with the pole tilted by 0.1 rad to rest at 1 m."""
    return gs.Problem(
        plant,
        starts=[(-1.0, 0.0, np.pi + 0.1, 0.0)],
        goal=(1.0, 0.0, np.pi, 0.0),
        tolerance=0.05,
        horizon=horizon,
        period=period,
        running=lambda x, u, goal: (5.0 * squared(x, goal) + u.force**2) / 2.0,
        terminal=lambda x, goal: squared(x, goal) / 2.0,
        stop=False,
    )


states = {"x": "m", "v": "m/s", "theta": "rad", "omega": "rad/s"}
plant = gs.Plant(cart_pole, states, controls={"force": ("N", -50.0, 50.0)}, name="cart_pole")
problem = transfer(period=0.01, horizon=10.0)
operations = ("add", "sub", "mul", "sin", "cos")
space = gs.ParameterSpace(6)
encoding = gs.TreeEncoding(problem.features.names, plant.control_names, operations, space, max_size=30)


def found(seed: int, budget: int, tuning: int) -> Finding:
    """What this seed finds."""
    rough = transfer(period=0.02, horizon=5.0)
    search = gs.StructureSearch(encoding, lexicase=0.0)  # with one start there are no specialists to choose
    result = gs.synthesize(
        problem, encoding, seed=seed, budget=budget, tuning=tuning, search=search, rough=rough
    )
    return Finding(problem, {"law": result})


main = command(
    found,
    budget=40_000,
    tuning=2_000,
    reference="published linear law 16.2648, by Simpson's rule",
)

if __name__ == "__main__":
    start(main, "cart_pole")
