"""A planar quadrotor: two rotors that only push, to fly to a point and hover there.

`python -m examples.planar_quadrotor FOLDER` finds laws from scratch, prints the front and writes the best exports;
`gpsynth synthesize examples/planar_quadrotor.py` runs the same problem from the command line.

The law says how much both rotors push (lift) and by how much the left one more (twist), as shares of a rotor's most
thrust; each rotor gives what it can of that. Hovering takes 0.545 of both; only tilting moves the craft sideways.
"""

from typing import Any

import numpy as np

import gpsynth as gs
from examples.command import Finding, command, start

MASS, INERTIA, ARM, GRAVITY, THRUST = (
    1.0,
    0.05,
    0.2,
    9.81,
    9.0,
)  # kg, kg m^2, m, m/s^2, N of one rotor at most
STATES = {"x": "m", "vx": "m/s", "y": "m", "vy": "m/s", "theta": "rad", "omega": "rad/s"}
STARTS = [
    *((4, 0, 0, 0, 0, 0), (-4, 0, -3, 0, 0, 0), (0, 0, 4, 0, 0, 0)),
    *((-2, 0, -4, 0, 0.5, 0), (3, 0, 3, 0, -0.5, 2), (-0.5, 1, 0.3, -1, 0, 0)),
]


def quadrotor(x: Any, u: Any) -> tuple[Any, ...]:
    """A rigid body in a vertical plane; theta turns to the left."""
    left, right = np.clip(u.lift + u.twist, 0.0, 1.0), np.clip(u.lift - u.twist, 0.0, 1.0)
    push = THRUST * (left + right) / MASS
    turn = THRUST * ARM * (right - left) / INERTIA
    return x.vx, -push * np.sin(x.theta), x.vy, push * np.cos(x.theta) - GRAVITY, x.omega, turn


def seen(x: Any, target: Any) -> dict[str, Any]:
    """How far the target is, and how the craft moves."""
    place = {"right": target.x - x.x, "above": target.y - x.y}
    return {**place, "drift": x.vx, "climb": x.vy, "tilt": x.theta, "spin": x.omega}


def away(x: Any, u: Any, goal: Any) -> Any:
    """Distance and a little of everything else, so that the craft comes to rest and the rotors do not rattle."""
    distance, speed = np.hypot(goal.x - x.x, goal.y - x.y), np.hypot(x.vx, x.vy)
    unrest = 0.1 * speed + 0.2 * np.abs(x.theta) + 0.03 * np.abs(x.omega)
    return distance + unrest + 0.3 * u.twist**2 + 0.1 * (u.lift - GRAVITY * MASS / (2.0 * THRUST)) ** 2


def flight(starts: Any, period: float, horizon: float, step: float | None = None) -> gs.Problem:
    """To the origin, and stay."""
    return gs.Problem(
        plant,
        starts,
        goal=np.zeros(6),
        tolerance=0.05,
        horizon=horizon,
        period=period,
        step=step,
        features=seen,
        running=away,
        stop=False,
    )


plant = gs.Plant(
    quadrotor, STATES, controls={"lift": ("1", 0.0, 1.0), "twist": ("1", -1.0, 1.0)}, name="planar_quadrotor"
)
problem = flight(STARTS, period=0.02, horizon=10.0)
operations, space = ("add", "sub", "mul", "tanh"), gs.ParameterSpace(10, -5.0, 5.0)
encoding = gs.TreeEncoding(problem.features.names, plant.control_names, operations, space, max_size=25)


def found(seed: int, budget: int, tuning: int) -> Finding:
    """What this seed finds."""
    rough = flight(STARTS, period=0.04, horizon=6.0)
    result = gs.synthesize(problem, encoding, seed=seed, budget=budget, tuning=tuning, rough=rough)
    return Finding(problem, {"law": result})


main = command(found, budget=15_000, tuning=300, reference="no published cost")

if __name__ == "__main__":
    start(main, "planar_quadrotor")
