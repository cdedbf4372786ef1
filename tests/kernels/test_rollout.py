"""Rollouts against scipy, and what happens at their edges: arrival, divergence, saturation, angles, schedules."""

import itertools
from collections.abc import Callable

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from gpsynth.arrays import Floats
from gpsynth.builder import Builder
from gpsynth.evaluate import Evaluator
from gpsynth.law import Law
from gpsynth.plant import Plant
from gpsynth.problem import Method, Problem
from gpsynth.program import Program
from gpsynth.rollouts import Rollouts
from gpsynth.tracing import trace

GAIN = np.array([[0.8, 0.6]])
NONE = np.empty((1, 0))


def _pendulum() -> Plant:
    return Plant(
        lambda x, u: (x.p, -np.sin(x.q) - 0.2 * x.p + u.f),
        states={"q": "rad", "p": "rad/s"},
        controls={"f": ("1/s2", -50.0, 50.0)},
        name="pendulum",
    )


def _law(features: tuple[str, ...] = ("error_q", "error_p")) -> Program:
    """f = tanh(k error_q) + d error_p."""
    b = Builder(features, ("k", "d"))
    push = b.apply("tanh", b.apply("mul", b.parameters[0], b.inputs[0]))
    return b.build([b.apply("add", push, b.apply("mul", b.parameters[1], b.inputs[1]))], ("f",))


def _swing(hold: bool, step: float, period: float, method: Method = "rk4") -> Problem:
    return Problem(
        _pendulum(),
        starts=[[2.0, -0.5], [-1.0, 1.5]],
        goal=[0.4, 0.0],
        tolerance=1e-9,
        horizon=18.0,
        period=period,
        step=step,
        method=method,
        running=lambda x, u, goal, t: (x.q - goal.q) ** 2 + 0.1 * u.f**2 + 0.01 * t,
        hold=hold,
        stop=False,
    )


def _reference(start: Floats, hold: bool, period: float) -> Floats:
    """(q, p, cost) after 18 s by DOP853, piece by piece where the control is held."""

    def control(z: Floats) -> float:
        return float(np.tanh(GAIN[0, 0] * (0.4 - z[0])) - GAIN[0, 1] * z[1])

    def rates(t: float, z: Floats, held: float | None) -> list[float]:
        f = control(z) if held is None else held
        return [z[1], -np.sin(z[0]) - 0.2 * z[1] + f, (z[0] - 0.4) ** 2 + 0.1 * f**2 + 0.01 * t]

    z = np.array([*start, 0.0])
    ends = np.arange(round(18.0 / period) + 1) * period if hold else np.array([0.0, 18.0])
    for begin, end in itertools.pairwise(ends):
        held = control(z) if hold else None
        z = solve_ivp(rates, (begin, end), z, "DOP853", args=(held,), rtol=1e-12, atol=1e-13).y[:, -1]
    return z


def _errors(problem: Problem, references: Floats) -> Floats:
    rolled = Evaluator(problem).of_program(_law(), GAIN)
    found = np.concatenate((rolled.final[0], rolled.cost[0][:, None]), axis=1)
    return np.abs(found - references)


@pytest.mark.parametrize("hold", [True, False], ids=["held", "continuous"])
def test_runge_kutta_4_follows_the_exact_solution_for_18_s(hold: bool) -> None:
    problem = _swing(hold, step=0.05, period=0.05)
    references = np.array([_reference(start, hold, 0.05) for start in problem.starts])
    assert np.max(_errors(problem, references)) < 1e-6


@pytest.mark.parametrize(
    ("method", "order", "step"), [("euler", 1, 0.002), ("heun", 2, 0.01), ("rk4", 4, 0.025)]
)
@pytest.mark.parametrize("hold", [True, False], ids=["held", "continuous"])
def test_the_error_falls_with_the_order_of_the_method(
    method: Method, order: int, step: float, hold: bool
) -> None:
    period = 0.2
    references = np.array(
        [_reference(np.array([2.0, -0.5]), hold, period), _reference(np.array([-1.0, 1.5]), hold, period)]
    )
    errors = [np.linalg.norm(_errors(_swing(hold, h, period, method), references)) for h in (step, step / 2)]
    assert abs(np.log2(errors[0] / errors[1]) - order) < 0.1


def _integrator(
    law: Callable[..., object], *, lower: float = -1.0, upper: float = 1.0, **choices: object
) -> tuple[Problem, Program]:
    """x' = u in one dimension, the law given as a Python function of the error."""
    plant = Plant(lambda x, u: (u.v,), states={"x": "m"}, controls={"v": ("m/s", lower, upper)}, name="line")
    settings = {"starts": [[2.0]], "goal": [0.0], "tolerance": 0.1, "horizon": 5.0, "period": 0.25} | choices
    return Problem(plant, **settings), trace(law, [("e", ("error_x",))], ("v",))  # type: ignore[arg-type]


def _roll(problem: Problem, program: Program) -> Rollouts:
    return Evaluator(problem).of_program(program, NONE)


def test_controls_are_saturated() -> None:
    rolled = _roll(*_integrator(lambda e: 100.0 * e.error_x, stop=False, horizon=1.0))
    assert rolled.final[0, 0, 0] == 1.0


@pytest.mark.parametrize(
    ("lower", "upper", "speed"), [(-1.0, 1.0, 0.0), (0.25, 1.0, 0.25), (-1.0, -0.5, -0.5)]
)
def test_nan_from_the_law_is_the_admissible_number_nearest_zero(
    lower: float, upper: float, speed: float
) -> None:
    problem, program = _integrator(
        lambda e: np.sqrt(-1.0 - e.error_x**2), lower=lower, upper=upper, horizon=1.0
    )
    rolled = _roll(problem, program)
    assert rolled.final[0, 0, 0] == 2.0 + speed
    assert rolled.diverged[0, 0] == 0.0


def test_angles_stay_in_their_interval_at_every_tick() -> None:
    plant = Plant(lambda x, u: (1.0,), states={"a": "rad"}, controls={"v": ("1", -1.0, 1.0)}, angles=("a",))
    for horizon in np.arange(1, 60) * 0.25:
        problem = Problem(plant, [[3.0]], [0.0], tolerance=1e-9, horizon=horizon, period=0.25, stop=False)
        final = _roll(problem, trace(lambda e: e.error_a, [("e", ("error_a",))])).final[0, 0, 0]
        exact = (3.0 + horizon + np.pi) % (2 * np.pi) - np.pi
        assert -np.pi <= final < np.pi
        assert abs(final - exact) < 1e-13  # 60 additions and two wraps at magnitude 3


def test_a_lane_stops_at_the_first_tick_inside_the_goal() -> None:
    problem, program = _integrator(lambda e: e.error_x * 100.0)
    rolled = _roll(problem, program)
    assert rolled.arrival[0, 0] == rolled.end[0, 0] == rolled.cost[0, 0] == 2.0
    assert abs(rolled.final[0, 0, 0]) < 1e-15  # 8 sums of sixths and thirds


def test_without_stopping_arrival_is_noted_and_the_rollout_goes_on() -> None:
    rolled = _roll(*_integrator(lambda e: -1.0 + 0.0 * e.error_x, stop=False))
    assert (rolled.arrival[0, 0], rolled.end[0, 0], rolled.final[0, 0, 0]) == (2.0, 5.0, -3.0)


def test_a_goal_never_reached_has_an_infinite_arrival() -> None:
    rolled = _roll(*_integrator(lambda e: 0.0 * e.error_x))
    assert (rolled.arrival[0, 0], rolled.end[0, 0], rolled.cost[0, 0]) == (np.inf, 5.0, 5.0)


def test_terminal_costs_are_those_of_the_last_state() -> None:
    problem, program = _integrator(
        lambda e: -1.0 + 0.0 * e.error_x, stop=False, terminal=lambda x, goal: (x.x**2, x.x - goal.x + 1.0)
    )
    rolled = _roll(problem, program)
    assert rolled.terminal[0, 0].tolist() == [9.0, -2.0]


def _scheduled(points: Floats, dwell: Floats, **choices: object) -> Rollouts:
    """Final states of x' = error held over 0.25 s, which keeps (3/4)^n of the error: targets show in the state."""
    problem, program = _integrator(lambda e: e.error_x, lower=-99.0, upper=99.0, tolerance=1e-12, **choices)
    law = Law(problem.plant, problem.features, program, np.empty(0))
    return Evaluator(problem).of_schedules(law, np.array(points, dtype=float), np.array(dwell, dtype=float))


def _by_hand(targets: list[float]) -> float:
    x = 2.0
    for target in targets:
        x += 0.25 * (target - x)
    return x


@pytest.mark.parametrize(
    ("dwell", "ticks"),
    [
        ([0.5, 0.25], [8.0] * 2 + [4.0] + [0.0] * 5),
        ([0.5, 0.0], [8.0] * 2 + [0.0] * 6),
        ([0.0, 0.75], [4.0] * 3 + [0.0] * 5),
        ([0.0, 0.0], [0.0] * 8),
        ([0.3, 0.3], [8.0] * 2 + [4.0] + [0.0] * 5),
        ([np.nextafter(0.5, 1.0), 99.0], [8.0] * 2 + [4.0] * 6),
    ],
)
def test_targets_switch_at_the_first_tick_that_is_due(dwell: list[float], ticks: list[float]) -> None:
    rolled = _scheduled([[[8.0], [4.0]]], [dwell], horizon=2.0)
    assert abs(rolled.final[0, 0, 0] - _by_hand(ticks)) < 1e-14


def test_each_lane_follows_its_own_schedule() -> None:
    points, dwell = np.array([[[8.0]], [[4.0]], [[-4.0]]]), np.array([[0.5], [1.0], [0.25]])
    together = _scheduled(points, dwell, horizon=2.0, starts=[[2.0], [1.0]])
    assert together.final.shape == (3, 2, 1)
    for k in range(3):
        alone = _scheduled(points[k : k + 1], dwell[k : k + 1], horizon=2.0, starts=[[2.0], [1.0]])
        assert np.array_equal(together.final[k], alone.final[0])


def _explosive() -> Problem:
    """x' = x^3 blows up from |x| > 0 and stays at 0."""
    plant = Plant(lambda x, u: (x.x**3 + u.v,), states={"x": "m"}, controls={"v": ("m/s", -1.0, 1.0)})
    starts = np.where(np.arange(100) % 7 == 3, 3.0, 0.0)[:, None]
    return Problem(plant, starts, [5.0], tolerance=0.1, horizon=5.0, period=0.05)


def test_divergence_costs_infinity_and_leaves_the_neighbors_alone() -> None:
    problem = _explosive()
    rolled = _roll(problem, trace(lambda e: 0.0 * e.error_x, [("e", ("error_x",))]))
    lost = problem.starts[:, 0] == 3.0
    assert np.all(rolled.cost[0, lost] == np.inf)
    assert np.array_equal(rolled.diverged[0], lost)
    assert np.all(rolled.end[0, lost] < 1.0)
    assert np.all(rolled.final[0, ~lost] == 0.0)
    assert np.allclose(rolled.cost[0, ~lost], 5.0, rtol=1e-13)  # 100 additions


def test_a_lane_that_has_ended_keeps_its_state_whoever_else_runs() -> None:
    plant = Plant(lambda x, u: (u.v,), states={"a": "rad"}, controls={"v": ("1", -1.0, 1.0)}, angles=("a",))
    law = trace(lambda e: 2.0 * e.error_a, [("e", ("error_a",))])
    starts = [
        [2.0 * np.pi + 0.01],
        [-0.0],
        [3.0],
        [-1.0],
    ]  # the first two are at the goal and outside [-pi, pi)
    problem = Problem(plant, starts, [0.0], tolerance=0.1, horizon=5.0, period=0.05)
    together = _roll(problem, law)
    for lane, start in enumerate(starts):
        alone = _roll(Problem(plant, [start], [0.0], tolerance=0.1, horizon=5.0, period=0.05), law)
        assert together.final[0, lane].tobytes() == alone.final[0, 0].tobytes()
        assert together.end[0, lane] == alone.end[0, 0]
    assert together.final[0, 0, 0] == starts[0][0]


@pytest.mark.parametrize("hold", [True, False])
def test_blocks_and_threads_change_no_bit(hold: bool) -> None:
    rng = np.random.default_rng(11)
    plant = _pendulum()
    problem = Problem(
        plant, rng.normal(size=(37, 2)), [0.1, 0.0], tolerance=0.05, horizon=6.0, hold=hold,
        terminal=lambda x, goal: x.p**2,
    )  # fmt: skip
    gains = rng.normal(size=(9, 2))
    first = Evaluator(problem, threads=1, block=64).of_program(_law(), gains)
    for block in (8, 32, 64, 256):
        for threads in (1, 2, 3):
            other = Evaluator(problem, threads=threads, block=block).of_program(_law(), gains)
            for name in set(vars(first)) - {"paths"}:
                assert getattr(first, name).tobytes() == getattr(other, name).tobytes(), (
                    name,
                    block,
                    threads,
                )


def test_lanes_that_have_ended_make_room_and_change_no_bit() -> None:
    starts = np.random.default_rng(12).uniform(-4.0, 4.0, (70, 1))
    choices = {"running": lambda x, u, goal: x.x**2, "terminal": lambda x, goal: (np.sin(x.x),), "hold": True}
    problem, program = _integrator(lambda e: 2.0 * e.error_x, starts=starts, **choices)
    law = Law(problem.plant, problem.features, program, np.empty(0))
    points, dwell = np.array([[[1.0], [-1.0]], [[2.0], [0.5]]]), np.array([[0.5, 0.5], [1.25, 0.0]])

    def found(block: int) -> list[Rollouts]:
        by = Evaluator(problem, block=block)
        bounded = by.of_program(program, NONE, bound=4.0)
        return [
            by.of_program(program, NONE, paths=True),
            by.of_schedules(law, points, dwell, reach=0.2),
            bounded,
        ]

    for together, alone in zip(found(256), found(1), strict=True):
        assert len(np.unique(together.end)) > 10
        for name in set(vars(together)) - {"paths"}:
            assert getattr(together, name).tobytes() == getattr(alone, name).tobytes(), name
        if together.paths is not None and alone.paths is not None:
            for name, path in vars(together.paths).items():
                assert path.tobytes() == getattr(alone.paths, name).tobytes(), name


def _loop(rate):
    """x' = u from 1 and 2, a cost of x^2 a second, under the law u = rate * error."""
    plant = Plant(lambda x, u: (u.f,), states={"x": ""}, controls={"f": ("", -10.0, 10.0)}, name="point")
    problem = Problem(
        plant,
        [(1.0,), (2.0,)],
        goal=(0.0,),
        tolerance=0.01,
        horizon=4.0,
        running=lambda x, u, goal: x.x**2,
        stop=False,
    )
    return problem, trace(lambda e: rate * e.error_x, [("e", ("error_x",))])


def test_a_bound_changes_nothing_below_it_and_costs_infinity_above():
    problem, law = _loop(1.0)
    free = Evaluator(problem).of_program(law, np.empty((1, 0))).cost[0]
    above = Evaluator(problem).of_program(law, np.empty((1, 0)), bound=free.mean() * 1.001).cost[0]
    assert np.array_equal(above, free)
    below = Evaluator(problem).of_program(law, np.empty((1, 0)), bound=free.mean() * 0.999)
    assert np.all(below.cost == np.inf)


def test_a_bound_ends_what_is_hopeless_early():
    problem, law = _loop(-1.0)
    whole = Evaluator(problem).of_program(law, np.empty((1, 0)))
    bounded = Evaluator(problem).of_program(law, np.empty((1, 0)), bound=5.0)
    assert np.all(bounded.end < whole.end)


def test_no_bound_where_a_cost_may_fall_again():
    problem, law = _loop(1.0)
    sinking = Problem(
        problem.plant,
        problem.starts,
        goal=(0.0,),
        tolerance=0.01,
        horizon=4.0,
        running=lambda x, u, goal: x.x**2 - 0.1,
        stop=False,
    )
    bounded = Evaluator(sinking).of_program(law, np.empty((1, 0)), bound=0.1).cost
    assert np.array_equal(bounded, Evaluator(sinking).of_program(law, np.empty((1, 0))).cost)
