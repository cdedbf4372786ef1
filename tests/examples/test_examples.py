"""Each example from scratch: what it prints and writes, and its law under an integrator and a compiler of others."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from scipy.integrate import simpson, solve_ivp

from examples import cart_pole, coupled_oscillators, landau_oscillator, planar_quadrotor
from gpsynth.arrays import Floats
from gpsynth.command_line import run
from gpsynth.evaluate import Evaluator
from gpsynth.law import Law
from gpsynth.objective import costs_of
from tests.export.helpers import compiled, needs_compiler, same_bits

pytestmark = pytest.mark.slow

Rates = Callable[
    [Floats, Floats], Floats
]  # state (n,), controls (m,) -> derivatives, cost per second (n + 1,)


@dataclass(frozen=True)
class Case:
    """An example, the budget of its short run, and its plant and cost written down once more."""

    module: ModuleType
    budget: int
    bar: float  # the best or published linear law under the same clock and cost, or else doing nothing
    rates: Rates
    at_end: Callable[[Floats], float]


def landau_rates(x: Floats, u: Floats) -> Floats:
    (a1, a2), b = x, u[0]
    square = a1 * a1 + a2 * a2
    return np.array([(1 - square) * a1 - a2, (1 - square) * a2 + a1 + b, square + 0.01 * b * b])


def coupled_rates(x: Floats, u: Floats) -> Floats:
    waves = x[0::2] + 1j * x[1::2]
    square = abs(waves) ** 2
    sigma = np.array([-square[0] + square[1] - square[2], 0.1 - square[1], -0.1])
    moved = (sigma + 1j * np.pi ** np.arange(3)) * waves + 1j * u[0] * np.array([0, 1, 1])
    return np.array([*np.column_stack([moved.real, moved.imag]).ravel(), (square[0] + u[0] ** 2) / 50.0])


def quadrotor_rates(state: Floats, u: Floats) -> Floats:
    x, vx, y, vy, theta, omega = state
    rotors = 9.0 * np.clip(u[0] + np.array([1, -1]) * u[1], 0.0, 1.0)
    force = rotors.sum() * np.array([-np.sin(theta), np.cos(theta)]) - (0.0, 9.81)
    cost = np.hypot(x, y) + 0.1 * np.hypot(vx, vy) + 0.2 * abs(theta) + 0.03 * abs(omega)
    cost += 0.3 * u[1] ** 2 + 0.1 * (u[0] - 9.81 / 18.0) ** 2
    return np.array([vx, force[0], vy, force[1], omega, 0.2 * (rotors[1] - rotors[0]) / 0.05, cost])


def cart_pole_rates(state: Floats, control: Floats) -> Floats:
    u = float(control[0])
    heavy, light, rod, g = 0.1, 0.02, 0.1, -9.8
    _, v, theta, omega = state
    s, c = np.sin(theta), np.cos(theta)
    d = heavy + light * (1 - c**2)
    forward = (-light * g * c * s + light * rod * omega**2 * s + u) / d
    turn = ((light + heavy) * g * s - light * rod * omega**2 * c * s - u * c) / (rod * d)
    return np.array([v, forward, omega, turn, (5 * cart_pole_miss(state) + u * u) / 2])


def cart_pole_miss(state: Floats) -> float:
    return float(((state - (1.0, 0.0, np.pi, 0.0)) ** 2).sum())


CASES = {
    "landau_oscillator": Case(landau_oscillator, 12_000, 1.29644, landau_rates, lambda state: 0.0),
    "coupled_oscillators": Case(coupled_oscillators, 1_500, 0.006584, coupled_rates, lambda state: 0.0),
    "planar_quadrotor": Case(planar_quadrotor, 1_500, 300.0, quadrotor_rates, lambda state: 0.0),
    "cart_pole": Case(cart_pole, 12_000, 16.2219, cart_pole_rates, lambda state: cart_pole_miss(state) / 2),
}


@dataclass(frozen=True)
class Outcome:
    case: Case
    folder: Path
    printed: str
    law: Law


@pytest.fixture(scope="module", params=CASES)
def outcome(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Outcome:
    """The example's own command, with less to spend."""
    case = CASES[request.param]
    folder = tmp_path_factory.mktemp(request.param)
    lines: list[str] = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("builtins.print", lambda *words: lines.append(" ".join(map(str, words))))
        arguments = [str(folder), "--budget", str(case.budget), "--tuning", str(case.budget // 12)]
        assert run(case.module.main, arguments, name=request.param) == 0
    return Outcome(case, folder, "\n".join(lines), Law.load(folder / "law.json"))


def replayed(case: Case, law: Law, start: Floats) -> tuple[float, Floats, Floats]:
    """Cost, states (N + 1, n) and controls (N + 1, m) by DOP853, at the ends only if the control is not held."""
    problem = case.module.problem
    controls = law(start, problem.goal)
    states, laws, cost = [np.array(start)], [controls], 0.0

    def rates(_: float, y: Floats) -> Floats:
        return case.rates(y[:-1], laws[-1] if problem.hold else law(y[:-1], problem.goal))

    length = problem.period if problem.hold else problem.horizon
    for _ in range(round(problem.horizon / length)):
        span, begin = (0.0, length), (*states[-1], 0.0)
        end = solve_ivp(rates, span, begin, method="DOP853", rtol=1e-9, atol=1e-11).y[:, -1]
        cost += float(end[-1])
        states.append(end[:-1])
        laws.append(law(end[:-1], problem.goal))
    return cost + case.at_end(states[-1]), np.array(states), np.array(laws)


def test_prints_the_front_and_writes_every_export(outcome: Outcome) -> None:
    files = ["law.c", "law.h", "law.json", "law.py", "law.tex", "law.txt"]
    assert sorted(path.name for path in outcome.folder.iterdir()) == files
    assert outcome.law.formulas()[-1] in outcome.printed


def test_beats_the_bar_as_another_integrator_sees_it(outcome: Outcome) -> None:
    case, problem = outcome.case, outcome.case.module.problem
    ours = costs_of(Evaluator(problem).of_program(outcome.law.program, outcome.law.parameters))[0]
    theirs = [replayed(case, outcome.law, start)[0] for start in problem.starts]
    np.testing.assert_allclose(ours, theirs, rtol=1e-4)
    assert np.mean(theirs) < case.bar


@pytest.mark.parametrize("outcome", ["cart_pole"], indirect=True)
def test_beats_the_published_cost_under_the_published_quadrature(outcome: Outcome) -> None:
    _, states, forces = replayed(outcome.case, outcome.law, cart_pole.problem.starts[0])
    rates = [(5 * cart_pole_miss(x) + u * u) / 2 for x, u in zip(states, forces[:, 0], strict=True)]
    assert simpson(rates, dx=0.01) + cart_pole_miss(states[-1]) / 2 < 16.264779


@needs_compiler
def test_compiled_law_agrees_in_every_bit(outcome: Outcome, tmp_path: Path) -> None:
    rng = np.random.default_rng(11)
    states = rng.normal(0.0, 3.0, (10_000, len(outcome.law.plant.state_names)))
    targets = np.broadcast_to(outcome.case.module.problem.goal, states.shape)
    controls = compiled(outcome.law, tmp_path, "-O2")(states, targets)
    assert same_bits(controls, outcome.law(states, targets))
