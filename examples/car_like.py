"""A car-like robot, which cannot turn on the spot: to a pose, forward or backward, from any heading 1.5 to 4 m away.

`python -m examples.car_like FOLDER` finds laws from scratch, prints the front and writes the exports of the best;
`gpsynth synthesize examples/car_like.py` runs the same problem from the command line.

A kinematic bicycle of wheelbase 0.5 m that steers by at most 0.6 rad, so no turn is tighter than 0.73 m. Angles that
the law sees have the sign in which the wheels are to turn, so that backing up is the mirror image of driving forward.
"""

from typing import Any

import numpy as np

import gpsynth as gs
from examples.command import Finding, command, start

WHEELBASE, NEAR, HEADING = 0.5, 0.05, 0.1  # m, m, rad
STATES = {"x": "m", "y": "m", "theta": "rad"}
OPERATIONS = ("add", "sub", "mul", "min", "max", "abs", "tanh", "sin")


def bicycle(x: Any, u: Any) -> tuple[Any, ...]:
    """The middle of the rear axle; theta turns to the left."""
    return u.v * np.cos(x.theta), u.v * np.sin(x.theta), u.v * np.tan(u.steer) / WHEELBASE


def seen(x: Any, target: Any) -> dict[str, Any]:
    """Which way to drive, how far, and the angles of axle, line to the target and target to each other."""
    dx, dy = target.x - x.x, target.y - x.y
    forward = np.cos(x.theta) * dx + np.sin(x.theta) * dy
    left = np.cos(x.theta) * dy - np.sin(x.theta) * dx
    way = gs.where(forward < 0.0, -1.0, 1.0)
    bearing, turn = np.arctan2(way * left, np.abs(forward) + NEAR), gs.wrap_angle(target.theta - x.theta)
    angles = {"bearing": way * bearing, "approach": way * gs.wrap_angle(bearing - turn), "turn": way * turn}
    return {"way": way, "distance": np.hypot(dx, dy), **angles}


def errors(x: Any, goal: Any) -> tuple[Any, Any]:
    """Distance (m) and angle (rad)."""
    return np.hypot(goal.x - x.x, goal.y - x.y), np.abs(gs.wrap_angle(goal.theta - x.theta))


def reached(x: Any, goal: Any) -> Any:
    """At most 0 where both are small."""
    distance, turn = errors(x, goal)
    return np.maximum(distance / NEAR, turn / HEADING) - 1.0


def away(x: Any, u: Any, goal: Any) -> Any:
    """Time outside the tolerance, and a fifth of the errors."""
    return gs.where(reached(x, goal) > 0.0, 1.0, 0.0) + 0.2 * sum(errors(x, goal))


def poses(seed: int, count: int) -> Any:
    """Random starts (count, 3) around the origin."""
    rng = gs.stream(seed, 7)
    distance, angle = rng.uniform(1.5, 4.0, count), rng.uniform(-np.pi, np.pi, count)
    heading = rng.uniform(-np.pi, np.pi, count)
    return np.column_stack([distance * np.cos(angle), distance * np.sin(angle), heading])


def driven(starts: Any, period: float, horizon: float, *, stop: bool = False) -> gs.Problem:
    """To the origin, heading 0."""
    return gs.Problem(
        plant,
        starts,
        goal=np.zeros(3),
        tolerance=(NEAR, NEAR, HEADING),
        horizon=horizon,
        period=period,
        features=seen,
        reached=reached,
        running=away,
        terminal=lambda x, goal: 5.0 * sum(errors(x, goal)),
        stop=stop,
    )


plant = gs.Plant(
    bicycle,
    STATES,
    {"v": ("m/s", -1.0, 1.0), "steer": ("rad", -0.6, 0.6)},
    angles=("theta",),
    name="car_like",
)
problem = driven(poses(1, 32), period=0.05, horizon=25.0)
encoding = gs.TreeEncoding(
    problem.features.names, plant.control_names, OPERATIONS, gs.ParameterSpace(8), max_size=25
)


def found(seed: int, budget: int, tuning: int) -> Finding:
    """What this seed finds, judged by 100 further starts."""
    rough, trials = driven(poses(1, 24), 0.1, 15.0), [driven(poses(2, 100), 0.05, 25.0)]
    result = gs.synthesize(
        problem, encoding, seed=seed, budget=budget, tuning=tuning, rough=rough, trials=trials
    )
    return Finding(problem, {"law": result})


main = command(found, budget=20_000, tuning=200, reference="no published cost")

if __name__ == "__main__":
    start(main, "car_like")
