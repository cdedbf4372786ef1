"""Uncertain plants, controls that come late and noisy measurements, against a plain simulation with scipy."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from gpsynth.arrays import Floats
from gpsynth.draws import Draws, crossed, random_draws
from gpsynth.evaluate import Evaluator
from gpsynth.law import Law
from gpsynth.plant import Plant
from gpsynth.problem import Problem
from gpsynth.schedule import Schedule
from gpsynth.simulation import simulate
from gpsynth.tracing import trace

PERIOD, STEP, HORIZON = 0.05, 0.005, 3.0
V, OMEGA = (0.1, 0.6), (-0.5, 0.7)  # a speed of 0 is not admissible, so 0.1 acts before the first command
GAINS = np.array([0.9, 0.8, 0.3])
GOAL = np.array([0.4, -0.2, 3.0, 0.0, 0.0])
STARTS = np.array([[1.0, 0.5, 3.0, 0.0, 0.1], [-0.5, 1.0, -3.1, 0.2, 0.0], [0.3, -1.0, 0.4, 0.5, -0.3]])


def lagged() -> Plant:
    """A unicycle whose speeds follow their commands with a gain and a lag."""
    return Plant(
        lambda x, u, p: (
            *(x.speed * np.cos(x.theta), x.speed * np.sin(x.theta), x.turn_rate),
            *((u.v - x.speed) / p.tau, (p.gain * u.omega - x.turn_rate) / p.tau),
        ),
        states={"x": "m", "y": "m", "theta": "rad", "speed": "m/s", "turn_rate": "rad/s"},
        controls={"v": ("m/s", *V), "omega": ("rad/s", *OMEGA)},
        parameters={"gain": ("", 0.6, 1.05, 1.0), "tau": ("s", 0.2, 0.4)},
        angles=("theta",),
        name="lagged",
    )


def problem(starts: Floats = STARTS, draws: Draws | None = None, **choices: object) -> Problem:
    settings = {"horizon": HORIZON, "period": PERIOD, "step": STEP, "stop": False} | choices
    return Problem(
        *(lagged(), starts, GOAL),
        tolerance=1e-9,
        features=lambda x, target: {"ahead": target.x - x.x, "aside": target.y - x.y, "course": x.theta},
        running=lambda x, u, goal: x.speed**2 + u.omega**2,
        draws=draws,
        **settings,  # type: ignore[arg-type]
    )


def law(on: Problem) -> Law:
    program = trace(
        lambda e: (GAINS[0] * e.ahead + 0.3, GAINS[1] * e.aside - GAINS[2] * e.course),
        [("e", on.features.names)],
        on.plant.control_names,
    )
    return Law(on.plant, on.features, program, np.empty(0))


def drawn(count: int = 4, *, seed: int = 1) -> Draws:
    return random_draws(
        lagged(), np.random.default_rng(seed), count, delay=(0.0, 0.12), noise=[0.02, 0.02, 0.3, 0.0, 0.0], ticks=17
    )  # fmt: skip


def reference(start: Floats, vector: Floats, delay: float, noise: Floats, target: Floats = GOAL) -> Floats:
    """State and cost at the horizon: adaptive integration from step to step, controls looked up by their age."""
    gain, tau = vector
    delay = round(delay / STEP) * STEP

    def rates(t: float, z: Floats, v: float, omega: float) -> list[float]:
        return [
            *(z[3] * np.cos(z[2]), z[3] * np.sin(z[2]), z[4], (v - z[3]) / tau, (gain * omega - z[4]) / tau),
            z[3] ** 2 + omega**2,
        ]

    z, sent = np.append(start, 0.0), []
    for index in range(round(HORIZON / STEP)):
        now = index * STEP
        if index % round(PERIOD / STEP) == 0:
            z[2] = (z[2] + np.pi) % (2 * np.pi) - np.pi if index else z[2]
            seen = z[:5] + (noise[len(sent) % len(noise)] if len(noise) else 0.0)
            course = (seen[2] + np.pi) % (2 * np.pi) - np.pi if len(noise) else seen[2]
            raw = (
                GAINS[0] * (target[0] - seen[0]) + 0.3,
                GAINS[1] * (target[1] - seen[1]) - GAINS[2] * course,
            )
            sent.append((now, np.clip(raw[0], *V), np.clip(raw[1], *OMEGA)))
        arrived = [controls for time, *controls in sent if time + delay <= now + 1e-9]
        acting = arrived[-1] if arrived else [V[0], 0.0]
        z = solve_ivp(rates, (now, now + STEP), z, "DOP853", args=acting, rtol=1e-12, atol=1e-13).y[:, -1]
    z[2] = (z[2] + np.pi) % (2 * np.pi) - np.pi
    return z


CASES = {
    "parameters": lambda draws: Draws(draws.parameters),
    "delay": lambda draws: Draws(delay=draws.delay),
    "noise": lambda draws: Draws(noise=draws.noise),
    "all": lambda draws: draws,
}


@pytest.mark.parametrize("case", CASES.values(), ids=CASES)
def test_rollouts_follow_a_plain_simulation(case) -> None:
    starts, draws = crossed(STARTS, case(drawn(2)))
    on = problem(starts, draws)
    rolled = Evaluator(on).of_program(law(on).program, np.empty((1, 0)))
    noise = draws.noise[draws.tables] if len(draws.noise) else np.empty((len(starts), 0, 5))
    for row in range(len(starts)):
        expected = reference(starts[row], on.plant_parameters[row], draws.delay[row], noise[row])
        found = np.append(rolled.final[0, row], rolled.cost[0, row])
        np.testing.assert_allclose(found, expected, atol=1e-9)  # Runge-Kutta with 1/40 of the shortest lag


def test_trajectories_and_schedules_have_the_same_conditions() -> None:
    starts, draws = crossed(STARTS, drawn(2))
    on = problem(starts, draws)
    points, dwell = np.array([[[1.0, 1.0, 0.0, 0.0, 0.0]]]), np.array([[9.0]])
    rolled = Evaluator(on).of_schedules(law(on), points, dwell)
    for row in (0, 4):
        alone = simulate(on, law(on), schedule=Schedule(points[0], dwell[0]), row=row)
        assert alone.x[-1].tobytes() == rolled.final[0, row].tobytes()
        assert alone.cost == rolled.cost[0, row]
        expected = reference(
            *(starts[row], draws.parameters[row], draws.delay[row], draws.noise[draws.tables[row]]), points[0, 0]
        )  # fmt: skip
        np.testing.assert_allclose(alone.x[-1], expected[:5], atol=1e-9)


def test_a_start_of_ones_own_takes_the_conditions_of_its_row() -> None:
    draws = drawn(3)
    on = problem(draws=draws)
    moved = simulate(problem(STARTS[[2, 2, 2]], draws), law(on), row=1)
    assert simulate(on, law(on), STARTS[2], row=1).x.tobytes() == moved.x.tobytes()
    assert simulate(on, law(on), STARTS[2], row=0).x.tobytes() != moved.x.tobytes()


@pytest.mark.parametrize("stop", [False, True])
@pytest.mark.parametrize(("block", "threads"), [(1, 1), (8, 2), (32, 3), (256, 1)])
def test_blocks_and_threads_change_no_bit(block: int, threads: int, stop: bool) -> None:
    starts, draws = crossed(STARTS, drawn(13))
    on = problem(starts, draws, horizon=1.0, stop=stop, reached=lambda x, goal: 0.35 - x.speed)
    first = Evaluator(on).of_program(law(on).program, np.empty((1, 0)))
    assert len(np.unique(first.end)) > 3 or not stop  # lanes leave the block one after the other
    other = Evaluator(on, threads=threads, block=block).of_program(law(on).program, np.empty((1, 0)))
    for name in set(vars(first)) - {"paths"}:
        assert getattr(first, name).tobytes() == getattr(other, name).tobytes(), name


def test_nominal_draws_change_no_bit() -> None:
    plain = problem()
    nominal = np.tile(plain.plant.nominal, (3, 1))
    given = replace(plain, draws=Draws(nominal, delay=0.0, noise=np.zeros((1, 1, 5))))
    first = Evaluator(plain).of_program(law(plain).program, np.empty((1, 0)))
    other = Evaluator(given).of_program(law(plain).program, np.empty((1, 0)))
    assert first.final.tobytes() == other.final.tobytes()
    assert first.cost.tobytes() == other.cost.tobytes()


def test_noise_is_seen_at_every_stage_without_hold() -> None:
    shift = np.zeros((1, 1, 5))
    shift[0, 0, 0] = 0.25  # a constant error of x is a target that lies 0.25 nearer
    biased = problem(draws=Draws(np.empty((3, 0)), noise=shift), hold=False)
    moved = Evaluator(biased).of_program(law(biased).program, np.empty((1, 0))).final
    nearer = np.array([[GOAL - [0.25, 0.0, 0.0, 0.0, 0.0]]])
    plain = problem(hold=False)
    same = Evaluator(plain).of_schedules(law(plain), nearer, np.array([[99.0]])).final
    np.testing.assert_allclose(moved, same, atol=1e-12)
