"""A cart-pole that hangs: swing it up with a force too weak to lift it at once, catch it and hold it.

`python -m examples.swing_up FOLDER` finds both laws from scratch, prints their fronts and writes their exports.

At most 6 N move 1.3 kg, so a steady push lifts the pole by 50 degrees and the law must pump. First a law that
balances the pole near the top is found. The law that swings up then sees, beside place and energy, what the balancing
law would do within CATCH of the top; how to pump, when to lean on the catch and how to stay near the middle is left to
the search. The energy is that of the pole, in units of m g l, 0 at rest on the top.
"""

from typing import Any

import numpy as np

import gpsynth as gs
from examples.command import Finding, command, start

CART, POLE, LENGTH, GRAVITY, FORCE = 1.0, 0.3, 0.5, 9.81, 6.0  # kg, kg, m, m/s^2, N
CATCH = 0.5  # rad
NEAR_TOP = [(0, 0, 0.2, 0), (0.4, 0, 0, 0), (-0.3, 0, -0.1, 0.3), (0, 0.3, 0, -0.6)]
HANGING = [(0, 0, -np.pi, 0), (0.5, 0, 3, 0), (-0.5, 0, -3, 1), (0, 0, 1.5, 0), (0.3, 0.3, -0.5, 0)]
STATES = {"x": "m", "v": "m/s", "theta": "rad", "omega": "rad/s"}


def cart_pole(x: Any, u: Any) -> tuple[Any, ...]:
    """A cart, a point mass on a rod above it; push is the share of FORCE."""
    sine, cosine = np.sin(x.theta), np.cos(x.theta)
    pull = POLE * sine * (LENGTH * x.omega**2 - GRAVITY * cosine)
    v_rate = (FORCE * u.push + pull) / (CART + POLE * sine**2)
    return x.v, v_rate, x.omega, (GRAVITY * sine - v_rate * cosine) / LENGTH


def effort(x: Any, u: Any, goal: Any) -> Any:
    """Cost per second near the top."""
    return x.x**2 + 0.1 * x.v**2 + 10.0 * x.theta**2 + 0.1 * x.omega**2 + 0.3 * u.push**2


def away(x: Any, u: Any, goal: Any) -> Any:
    """Cost per second of a swing: height missing and place; beyond 2 m the track ends."""
    place = 0.2 * np.minimum(x.x**2, 4.0) + gs.where(np.abs(x.x) > 2.0, 5.0, 0.0)
    return 1.0 - np.cos(x.theta) + place + 0.1 * np.tanh(x.omega**2) + 0.1 * np.minimum(x.v**2, 1.0)


def balancing(period: float, horizon: float) -> gs.Problem:
    """From near the top to rest on it in the middle."""
    return to_top(NEAR_TOP, period, horizon, running=effort, features=motion)


def motion(x: Any, target: Any) -> dict[str, Any]:
    """What the balancing law sees."""
    return {"position": x.x, "speed": x.v, "angle": x.theta, "rate": x.omega}


def swinging(
    balance: gs.Law, starts: Any, period: float, horizon: float, step: float | None = None
) -> gs.Problem:
    """From hanging to rest on the top in the middle."""

    def seen(x: Any, target: Any) -> dict[str, Any]:
        (push,) = gs.inline(gs.bind(balance.program, balance.parameters), list(motion(x, target).values()))
        energy = 0.5 * LENGTH / GRAVITY * x.omega**2 + np.cos(x.theta) - 1.0
        catch = gs.where(np.abs(x.theta) < CATCH, push, 0.0)
        place = {"position": x.x, "speed": x.v, "upright": np.cos(x.theta)}
        return {"catch": catch, **place, "pump": x.omega * np.cos(x.theta), "energy": energy}

    return to_top(starts, period, horizon, step=step, running=away, features=seen)


def to_top(starts: Any, period: float, horizon: float, **choices: Any) -> gs.Problem:
    """Every state at 0, and there it stays."""
    return gs.Problem(
        plant, starts, np.zeros(4), tolerance=0.05, horizon=horizon, period=period, stop=False, **choices
    )


def trees(problem: gs.Problem, operations: tuple[str, ...], numbers: int, size: int) -> gs.TreeEncoding:
    """Formulas of what the problem's law sees."""
    space = gs.ParameterSpace(numbers)
    return gs.TreeEncoding(problem.features.names, plant.control_names, operations, space, max_size=size)


plant = gs.Plant(cart_pole, STATES, {"push": ("1", -1.0, 1.0)}, angles=("theta",), name="swing_up")


def found(seed: int, budget: int, tuning: int) -> Finding:
    """The law that balances, then the law that swings up with its help."""
    problem = balancing(0.02, 6.0)
    formulas = trees(problem, ("add", "sub", "mul"), numbers=6, size=20)
    share = 2 * budget // 3
    top = gs.synthesize(problem, formulas, seed=seed, budget=share, tuning=tuning, rough=balancing(0.05, 5.0))
    problem, rough = swinging(top.law, HANGING, 0.02, 12.0), swinging(top.law, HANGING, 0.04, 10.0)
    formulas = trees(problem, ("add", "sub", "mul", "tanh", "sign"), numbers=8, size=30)
    up = gs.synthesize(problem, formulas, seed=seed, budget=budget, tuning=tuning, rough=rough)
    return Finding(problem, {"balance": top, "law": up})


main = command(found, budget=12_000, tuning=200, reference="no published cost", seed=0)

if __name__ == "__main__":
    start(main, "swing_up")
