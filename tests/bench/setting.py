"""The closed loop that all rows share: random laws of 20 operations steer a unicycle for 5 s."""

from typing import NamedTuple

import numpy as np

from gpsynth.arrays import Floats
from gpsynth.builder import Builder, Reference
from gpsynth.plant import Plant
from gpsynth.problem import Problem
from gpsynth.program import Program

LAWS, STARTS, MOST_STARTS = 64, 64, 1024
OPERATIONS_A_LAW = 20
STEP, HORIZON, STEPS = 0.05, 5.0, 100  # s; four stages a step: 400 law calls
UNARY = ("sin", "cos", "tanh", "square", "abs", "neg")
BINARY = ("add", "sub", "mul", "div_protected", "min", "max")


class Setting(NamedTuple):
    """Laws without parameters, features -> raw controls, and the problem they act on."""

    problem: Problem
    laws: tuple[Program, ...]
    starts: Floats  # (MOST_STARTS, 3), of which the problem has the first


def unicycle(starts: Floats) -> Problem:
    """Steer to the origin; cost: the integral of the squared error; the law acts at every stage, for the whole time."""
    plant = Plant(
        lambda x, u: (u.v * np.cos(x.theta), u.v * np.sin(x.theta), u.omega),
        states={"x": "m", "y": "m", "theta": "rad"},
        controls={"v": ("m/s", -1.0, 1.0), "omega": ("rad/s", -1.0, 1.0)},
        name="unicycle",
    )
    return Problem(
        plant,
        starts=starts,
        goal=np.zeros(3),
        tolerance=np.full(3, 0.05),
        horizon=HORIZON,
        period=STEP,
        running=lambda x, u, goal: (x.x - goal.x) ** 2 + (x.y - goal.y) ** 2 + (x.theta - goal.theta) ** 2,
        hold=False,
        stop=False,
    )


def setting(seed: int = 1) -> Setting:
    """The laws and starts of this seed."""
    rng = np.random.default_rng(seed)
    starts = rng.uniform([-2.0, -2.0, -np.pi], [2.0, 2.0, np.pi], (MOST_STARTS, 3))
    problem = unicycle(starts[:STARTS])
    return Setting(problem, tuple(random_law(problem.features.names, rng) for _ in range(LAWS)), starts)


def random_law(features: tuple[str, ...], rng: np.random.Generator) -> Program:
    """Two random trees that share nothing, OPERATIONS_A_LAW operations together."""
    while True:
        builder = Builder(features)
        program = builder.build([_tree(builder, OPERATIONS_A_LAW // 2, rng) for _ in range(2)])
        if program.complexity == OPERATIONS_A_LAW:
            return program


def _tree(builder: Builder, operations: int, rng: np.random.Generator) -> Reference:
    if operations == 0:
        constant = rng.random() < 0.3
        return builder.constant(rng.uniform(-2, 2)) if constant else int(rng.choice(builder.inputs))
    if rng.random() < 1 / 3:
        return builder.apply(str(rng.choice(UNARY)), _tree(builder, operations - 1, rng))
    left = int(rng.integers(operations))
    operands = (_tree(builder, left, rng), _tree(builder, operations - 1 - left, rng))
    return builder.apply(str(rng.choice(BINARY)), *operands)
