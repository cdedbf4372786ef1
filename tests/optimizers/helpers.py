"""Every optimizer and every test function, to be crossed by the contract tests."""

from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from gpsynth.arrays import Floats
from gpsynth.optimizers import CMAES, NSGA2, PSO, DifferentialEvolution

Factory = Callable[[Floats, Floats], Any]

OPTIMIZERS: dict[str, Factory] = {
    "pso-clerc": lambda lower, upper: PSO.clerc(lower, upper, size=40),
    "pso-seed": lambda lower, upper: PSO.seed(lower, upper, size=40),
    "differential-evolution": lambda lower, upper: DifferentialEvolution(lower, upper, size=60),
    "cmaes": CMAES,
    "nsga2": lambda lower, upper: NSGA2(lower, upper, size=60),
}


@dataclass(frozen=True, eq=False)
class Problem:
    """A cost with minimum 0 inside a box whose center is not the solution."""

    cost: Callable[[Floats], Floats]
    lower: Floats
    upper: Floats


def sphere(x: Floats) -> Floats:
    return (x * x).sum(axis=1)


def rosenbrock(x: Floats) -> Floats:
    return (100 * (x[:, 1:] - x[:, :-1] ** 2) ** 2 + (1 - x[:, :-1]) ** 2).sum(axis=1)


def rastrigin(x: Floats) -> Floats:
    return (10 + x * x - 10 * np.cos(2 * np.pi * x)).sum(axis=1)


SPHERE = Problem(sphere, np.full(5, -3.0), np.full(5, 5.0))
ROSENBROCK = Problem(rosenbrock, np.full(5, -2.0), np.full(5, 2.5))
RASTRIGIN = Problem(rastrigin, np.full(10, -4.3), np.full(10, 5.12))


def columns(optimizer: Any, cost: Callable[[Floats], Floats]) -> Callable[[Floats], Floats]:
    """The cost in the shape that the optimizer wants: twice the same for two objectives."""
    return (lambda x: np.stack([cost(x)] * 2, axis=1)) if isinstance(optimizer, NSGA2) else cost


def same_state(a: Any, b: Any) -> bool:
    """Equal field by field and bit by bit, NaN equal to NaN."""
    return type(a) is type(b) and all(
        np.asarray(getattr(a, f.name)).tobytes() == np.asarray(getattr(b, f.name)).tobytes()
        for f in fields(a)
    )


def snapshot(state: Any) -> dict[str, bytes]:
    return {f.name: np.asarray(getattr(state, f.name)).tobytes() for f in fields(state)}
