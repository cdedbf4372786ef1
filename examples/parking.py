"""A car that parks past the end of a wall: forward or backward into a lane, body and wall apart all the way.

`python -m examples.parking FOLDER` finds laws from scratch, prints the front and writes the exports of the best.

The car of Diveev (2016): 4 m by 2 m, |v| <= 5 m/s, |steer| <= 1 rad. Its place is the origin, in a lane that a wall 2 m
wide fills up to 3 m before it; the car comes along that wall, 2 to 6 m beside the lane, and is to stand within 0.1 m
and 0.15 rad of it. What comes from the right does the same as what comes from the left, in a mirror.
"""

from typing import Any

import numpy as np

import gpsynth as gs
from examples.command import Finding, command, start
from examples.rectangles import overlap

SPEED, HURRY = 5.0, 15.0  # m/s; 1/s, speed for each meter to go
RADIUS = 2.0 / np.tan(1.0)  # m, of the tightest turn
BODY, WALL = (2.0, 1.0), (6.0, 1.0)  # m, half lengths and widths
NEAR = (0.1, 0.1, 0.15)  # m, m, rad
BUDGET, TUNING = 10_000, 500  # evaluations
STATES = {"x": "m", "y": "m", "theta": "rad"}
STARTS = [(-5, 2, 0), (-10, 4, 0), (-15, 6, 0), (-4, 4, 0), (-4, 6, 0), (-15, 2, 0)]


def car(x: Any, u: Any) -> tuple[Any, ...]:
    """Its speed follows from the way to go; the law steers."""
    v = np.clip(-HURRY * x.x, -SPEED, SPEED)
    return v * np.cos(x.theta), v * np.sin(x.theta), 0.5 * v * np.tan(u.steer)


def sight(along: Any, aside: Any, turned: Any) -> dict[str, Any]:
    """The way to go by the errors of a pose (m, m, rad), as if the car came from the left.

    Two quarter turns at full lock lead to the place if they begin where `begin` is 0; one turn back at full lock ends
    in the lane, heading along it, if it begins where `turn` is 0.
    """
    heading = gs.where(along >= 0.0, 1.0, -1.0) * turned
    begin, turn = np.abs(along) - 2.0 * RADIUS, aside + RADIUS * (1.0 - np.cos(heading))
    return {"begin": begin, "aside": aside, "heading": heading, "turn": turn}


def contact(*pair: Any) -> Any:
    """Cost per second of two bodies in each other."""
    depth = overlap(*pair)
    return 100.0 * depth + gs.where(depth > 1e-6, 50.0, 0.0)


def spent(x: Any, u: Any, goal: Any) -> Any:
    """Time, and contact with the wall."""
    return 1.0 + contact(tuple(x), (-9.0, 0.0, 0.0 * x.x), BODY, WALL)


def parked(step: float) -> gs.Problem:
    """To the place."""
    return gs.Problem(
        plant,
        STARTS,
        goal=np.zeros(3),
        tolerance=NEAR,
        horizon=4.5,
        period=step,
        method="heun",
        features=lambda x, target: sight(*(target[k] - x[k] for k in range(3))),
        running=spent,
        terminal=lambda x, goal: 3.0 * np.sqrt(sum(value**2 for value in x)),
        hold=False,
    )


plant = gs.Plant(car, STATES, {"steer": ("rad", -1.0, 1.0)}, name="parking")
problem = parked(step=0.01)
operations = ("add", "sub", "mul", "min", "max", "signed_sqrt")
encoding = gs.TreeEncoding(
    problem.features.names, plant.control_names, operations, gs.ParameterSpace(8), max_size=20
)


def found(seed: int, budget: int, tuning: int) -> Finding:
    """What this seed finds."""
    rough, trials = parked(step=0.02), [parked(step=0.002)]
    result = gs.synthesize(
        problem, encoding, seed=seed, budget=budget, tuning=tuning, rough=rough, trials=trials
    )
    return Finding(problem, {"law": result})


main = command(found, budget=BUDGET, tuning=TUNING, reference="no published cost")

if __name__ == "__main__":
    start(main, "parking")
