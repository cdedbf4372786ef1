"""Three cars that park behind each other in one lane, from either side of it, without touching anything.

`python -m examples.three_cars FOLDER` finds both laws from scratch, prints their fronts and writes their exports.

The problem of Diveev (2016). The cars of `examples.parking` start above each other at x = -10 or 10 and y = 2, 4, 6,
flush with each other and with the walls of the lane, in which 1 m is left before and behind each parked car. All three
are to be within 0.1 m and 0.15 rad of their poses in 8 s from each of the 8 combinations. First the law is found that
parks one car. To slow a car down does not change its path, so the joint law says what share of its speed each car may
drive at, and so who waits for whom; it sees how far each car has still to go to the right.
"""

import itertools
from collections.abc import Callable
from typing import Any

import numpy as np

import gpsynth as gs
from examples import parking
from examples.command import Finding, command, start

PLACES, MARGIN = (-5.0, 0.0, 5.0), 0.04  # m
STARTS = [(a, 2, 0, b, 4, 0, c, 6, 0) for a, b, c in itertools.product((-10, 10), repeat=3)]


def cars(law: gs.Law) -> gs.Plant:
    """Three cars under one law, each driving a share of its pace."""

    def motion(x: Any, u: Any) -> list[Any]:
        rates: list[Any] = []
        for k, place in enumerate(PLACES):
            along, y, theta = place - x[3 * k], x[3 * k + 1], x[3 * k + 2]
            (steer,) = gs.inline(law.bounded, list(parking.sight(along, -y, -theta).values()))
            v = u[k] * np.clip(parking.HURRY * along, -parking.SPEED, parking.SPEED)
            rates += [v * np.cos(theta), v * np.sin(theta), 0.5 * v * np.tan(steer)]
        return rates

    names = {f"{name}{k}": unit for k in (1, 2, 3) for name, unit in parking.STATES.items()}
    return gs.Plant(motion, names, {f"go{k}": ("1", 0.0, 1.0) for k in (1, 2, 3)}, name="three_cars")


def together(body: tuple[float, float]) -> Callable[[Any, Any, Any], Any]:
    """Time, way to go, and contacts between cars with these half lengths and widths."""

    def spent(x: Any, u: Any, goal: Any) -> Any:
        poses = [(x[k], x[k + 1], x[k + 2]) for k in (0, 3, 6)]
        far = sum(np.abs(x[k] - goal[k]) for k in (0, 1, 3, 4, 6, 7))
        contacts = [parking.contact(a, b, body, body) for a, b in itertools.combinations(poses, 2)]
        return 1.0 + 0.02 * far + sum(contacts)

    return spent


def meeting(plant: gs.Plant, step: float, *, longer: float = 0.0) -> gs.Problem:
    """All three to their places, kept apart as if each car were `longer` (m) at both ends."""
    length, width = parking.BODY
    return gs.Problem(
        plant,
        STARTS,
        goal=[number for place in PLACES for number in (place, 0.0, 0.0)],
        tolerance=3 * parking.NEAR,
        horizon=8.0,
        period=step,
        method="heun",
        features=lambda x, target: {f"along{k + 1}": place - x[3 * k] for k, place in enumerate(PLACES)},
        running=together((length + longer, width)),
        terminal=lambda x, goal: 0.3 * sum(np.abs(goal[k] - x[k]) for k in range(9)),
        hold=False,
    )


def found(seed: int, budget: int, tuning: int) -> Finding:
    """The law that parks one car, from its own seed, then the law that lets three do so."""
    park = parking.found(1, min(budget, parking.BUDGET), min(tuning, parking.TUNING)).results["law"]
    plant = cars(park.law)
    problem, rough, trials = meeting(plant, 0.01), meeting(plant, 0.04), [meeting(plant, 0.002)]
    apart = meeting(plant, 0.01, longer=MARGIN)
    operations, space = ("add", "sub", "mul", "abs", "min", "max"), gs.ParameterSpace(8)
    encoding = gs.TreeEncoding(problem.features.names, plant.control_names, operations, space, max_size=15)
    joint = gs.synthesize(
        apart, encoding, seed=seed, budget=budget, tuning=tuning, rough=rough, trials=[problem, *trials]
    )
    return Finding(problem, {"parking": park, "law": joint})


main = command(found, budget=14_000, tuning=500, reference="the published run reaches no goal", seed=2)

if __name__ == "__main__":
    start(main, "three_cars")
