"""The same closed loops as a user of DEAP would write them."""

from collections.abc import Callable

import numpy as np
from deap import gp

from gpsynth.arrays import Floats
from gpsynth.program import Leaf, Program
from tests.bench.setting import STEP, STEPS, Setting

Law = Callable[..., Floats]


def _divide(a: Floats, b: Floats) -> Floats:
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(np.abs(b) <= 1e-8, a * np.where(b >= 0.0, 1.0, -1.0) * 1e8, a / b)


FUNCTIONS: tuple[tuple[str, Callable[..., Floats], int], ...] = (
    ("add", np.add, 2),
    ("sub", np.subtract, 2),
    ("mul", np.multiply, 2),
    ("div_protected", _divide, 2),
    ("min", np.minimum, 2),
    ("max", np.maximum, 2),
    ("sin", np.sin, 1),
    ("cos", np.cos, 1),
    ("tanh", np.tanh, 1),
    ("square", np.square, 1),
    ("abs", np.abs, 1),
    ("neg", np.negative, 1),
)


def deap_laws(setting: Setting) -> list[tuple[Law, ...]]:
    """Each law as functions compiled by DEAP, one per control."""
    names = setting.problem.features.names
    primitives = gp.PrimitiveSet("law", len(names))
    primitives.renameArguments(**{f"ARG{k}": name for k, name in enumerate(names)})
    for name, function, arity in FUNCTIONS:
        primitives.addPrimitive(function, arity, name=name)
    return [tuple(gp.compile(text, primitives) for text in _texts(law)) for law in setting.laws]


def _texts(law: Program) -> tuple[str, ...]:
    def leaf(item: Leaf) -> str:
        return item.name if item.kind == "input" else repr(item.value)

    return law.fold(leaf, lambda row, operands: f"{row.name}({', '.join(operands)})")


def roll(law: tuple[Law, ...], starts: Floats) -> Floats:
    """Costs (S,) by Runge-Kutta 4 on arrays over the starts."""
    state = np.vstack((starts.T, np.zeros(len(starts))))
    for _ in range(STEPS):
        k1 = _rates(law, state)
        k2 = _rates(law, state + STEP / 2 * k1)
        k3 = _rates(law, state + STEP / 2 * k2)
        k4 = _rates(law, state + STEP * k3)
        state = state + STEP / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return state[3]


def _rates(law: tuple[Law, ...], state: Floats) -> Floats:
    x, y, theta, _ = state
    v, omega = (np.clip(control(-x, -y, -theta), -1.0, 1.0) for control in law)
    squares = x * x + y * y + theta * theta
    return np.array([v * np.cos(theta), v * np.sin(theta), np.broadcast_to(omega, x.shape), squares])
