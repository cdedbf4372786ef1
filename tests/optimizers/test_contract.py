"""What every optimizer promises, whatever its algorithm."""

import random
from dataclasses import FrozenInstanceError, fields

import numpy as np
import pytest

from gpsynth.errors import OptimizerError
from gpsynth.optimizers import minimize
from gpsynth.seeds import stream
from tests.optimizers.helpers import (
    OPTIMIZERS,
    RASTRIGIN,
    ROSENBROCK,
    SPHERE,
    columns,
    same_state,
    snapshot,
)

LEVELS = [  # optimizer, problem, level to reach, budget in evaluations
    ("pso-clerc", SPHERE, 1e-8, 8_000),
    ("pso-seed", SPHERE, 0.5, 8_000),
    ("differential-evolution", SPHERE, 1e-8, 10_000),
    ("cmaes", SPHERE, 1e-8, 2_000),
    ("nsga2", SPHERE, 1e-3, 10_000),
    ("pso-clerc", ROSENBROCK, 0.1, 30_000),
    ("pso-seed", ROSENBROCK, 10.0, 30_000),
    ("differential-evolution", ROSENBROCK, 1e-8, 20_000),
    ("cmaes", ROSENBROCK, 1e-8, 10_000),
    ("nsga2", ROSENBROCK, 10.0, 10_000),
    ("pso-clerc", RASTRIGIN, 20.0, 40_000),
    ("pso-seed", RASTRIGIN, 50.0, 40_000),
    ("differential-evolution", RASTRIGIN, 1e-8, 50_000),
    ("cmaes", RASTRIGIN, 1e-8, 200_000),
    ("nsga2", RASTRIGIN, 10.0, 10_000),
]


@pytest.fixture(params=OPTIMIZERS)
def optimizer(request):
    return OPTIMIZERS[request.param](SPHERE.lower, SPHERE.upper)


def advanced(optimizer, generations):
    state = optimizer.init(stream(7, 0))
    cost = columns(optimizer, SPHERE.cost)
    for g in range(1, generations + 1):
        x, state = optimizer.ask(state, stream(7, g))
        state = optimizer.tell(state, x, cost(x))
    return state


@pytest.mark.parametrize("seed", [1, 2, 3])
@pytest.mark.parametrize(("name", "problem", "level", "budget"), LEVELS)
def test_reaches_the_level_within_the_budget(name, problem, level, budget, seed):
    optimizer = OPTIMIZERS[name](problem.lower, problem.upper)
    result = minimize(columns(optimizer, problem.cost), optimizer, seed=seed, budget=budget, target=level)
    assert result.cost <= level, result.reason
    assert problem.cost(result.x[None])[0] == result.cost


@pytest.mark.parametrize("generations", [0, 1, 5])
def test_ask_is_pure(optimizer, generations):
    state = advanced(optimizer, generations)
    before = snapshot(state)
    a, after_a = optimizer.ask(state, stream(7, 99))
    b, after_b = optimizer.ask(state, stream(7, 99))
    assert a.tobytes() == b.tobytes()
    assert same_state(after_a, after_b)
    assert snapshot(state) == before


def test_tell_is_pure(optimizer):
    x, state = optimizer.ask(advanced(optimizer, 5), stream(7, 99))
    costs = columns(optimizer, SPHERE.cost)(x)
    before, x_before, costs_before = snapshot(state), x.tobytes(), costs.tobytes()
    assert same_state(optimizer.tell(state, x, costs), optimizer.tell(state, x, costs))
    assert (snapshot(state), x.tobytes(), costs.tobytes()) == (before, x_before, costs_before)


def test_a_cost_that_scribbles_on_its_batch_cannot_change_the_state(optimizer):
    x, state = optimizer.ask(advanced(optimizer, 5), stream(7, 99))
    before = snapshot(state)
    x[:] = 0.0
    assert snapshot(state) == before


def test_states_and_settings_are_frozen(optimizer):
    state = advanced(optimizer, 3)
    arrays = [getattr(state, f.name) for f in fields(state) if isinstance(getattr(state, f.name), np.ndarray)]
    assert arrays
    assert not any(array.flags.writeable for array in arrays)
    with pytest.raises(FrozenInstanceError):
        state.generation = 3
    with pytest.raises(FrozenInstanceError):
        optimizer.size = 3


def test_same_seed_gives_the_same_bits_and_another_seed_does_not(optimizer):
    cost = columns(optimizer, SPHERE.cost)
    first, second, other = (minimize(cost, optimizer, seed=s, budget=900) for s in (3, 3, 4))
    assert same_state(first.state, second.state)
    assert first.history == second.history
    assert not same_state(first.state, other.state)


def test_global_random_states_are_left_alone(optimizer):
    python, numpy = random.getstate(), np.random.get_state()[1].tobytes()  # noqa: NPY002
    advanced(optimizer, 5)
    assert random.getstate() == python
    assert np.random.get_state()[1].tobytes() == numpy  # noqa: NPY002


@pytest.mark.parametrize("name", OPTIMIZERS)
@pytest.mark.parametrize("first", [200, 1_000, 2_500])
def test_resume_equals_the_uninterrupted_run(name, first):
    optimizer = OPTIMIZERS[name](
        RASTRIGIN.lower[:2], RASTRIGIN.upper[:2]
    )  # small: CMA-ES restarts on the way
    cost = columns(optimizer, RASTRIGIN.cost)
    whole = minimize(cost, optimizer, seed=5, budget=5_000)
    part = minimize(cost, optimizer, seed=5, budget=first)
    rest = minimize(cost, optimizer, seed=5, budget=5_000, resume=part.progress)
    assert part.evaluations <= first < rest.evaluations
    assert same_state(rest.state, whole.state)
    assert (rest.history, rest.evaluations, rest.generations, rest.nonfinite, rest.reason) == (
        whole.history,
        whole.evaluations,
        whole.generations,
        whole.nonfinite,
        whole.reason,
    )


@pytest.mark.parametrize("poison", [np.nan, np.inf, -np.inf])
def test_costs_that_are_not_finite_are_counted_and_never_best(optimizer, poison):
    seen = 0

    def cost(x):
        nonlocal seen
        bad = x[:, 0] < 1.0
        seen += int(bad.sum())
        return np.where(bad, poison, SPHERE.cost(x))

    result = minimize(columns(optimizer, cost), optimizer, seed=2, budget=3_000)
    assert seen > 0
    assert result.nonfinite == seen
    assert result.x[0] >= 1.0
    assert result.cost == SPHERE.cost(result.x[None])[0]
    assert all(np.isfinite(best) for _, best in result.history)


def test_a_run_without_any_finite_cost_ends_and_says_so(optimizer):
    cost = columns(optimizer, lambda x: np.full(len(x), np.nan))
    result = minimize(cost, optimizer, seed=2, budget=2_000)
    assert result.cost == np.inf
    assert result.history == ()
    assert result.nonfinite == result.evaluations


def test_the_first_generation_may_fail_and_the_next_succeed(optimizer):
    state = optimizer.init(stream(1, 0))
    x, state = optimizer.ask(state, stream(1, 1))
    state = optimizer.tell(state, x, columns(optimizer, lambda x: np.full(len(x), np.nan))(x))
    for g in range(2, 6):
        x, state = optimizer.ask(state, stream(1, g))
        state = optimizer.tell(state, x, columns(optimizer, SPHERE.cost)(x))
    best_x, best_cost = optimizer.best(state)
    assert best_cost == SPHERE.cost(best_x[None])[0]


@pytest.mark.parametrize("name", OPTIMIZERS)
@pytest.mark.parametrize("target", [-5.0, 20.0])
def test_every_position_lies_in_the_box_even_when_the_optimum_does_not(name, target):
    lower, upper = np.array([-1.0, 1e-7, 1e6, -0.3]), np.array([0.1, 3e-7, 1e6 + 0.7, 0.1 + 0.2])
    optimizer = OPTIMIZERS[name](lower, upper)

    def cost(x):
        assert ((lower <= x) & (x <= upper)).all()
        return (((x - lower) / (upper - lower) - target) ** 2).sum(axis=1)

    result = minimize(columns(optimizer, cost), optimizer, seed=6, budget=3_000)
    corner = lower if target < 0 else upper
    assert np.abs((result.x - corner) / (upper - lower)).max() < 0.02


@pytest.mark.parametrize("name", OPTIMIZERS)
def test_huge_and_equal_costs_do_no_harm(name):
    optimizer = OPTIMIZERS[name](SPHERE.lower, SPHERE.upper)
    flat = minimize(columns(optimizer, lambda x: np.ones(len(x))), optimizer, seed=1, budget=2_000)
    huge = columns(optimizer, lambda x: np.where(x[:, 0] < 1, -1.7e308, 1.7e308))
    assert flat.cost == 1.0
    assert minimize(huge, optimizer, seed=1, budget=2_000).cost == -1.7e308


def test_costs_of_the_wrong_shape_are_refused_by_tell(optimizer):
    x, state = optimizer.ask(optimizer.init(stream(1, 0)), stream(1, 1))
    with pytest.raises(OptimizerError, match="one row per candidate"):
        optimizer.tell(state, x, np.zeros(len(x) + 1))


@pytest.mark.parametrize("name", OPTIMIZERS)
@pytest.mark.parametrize(
    ("lower", "upper", "sentence"),
    [
        ([0, 0], [1, 1, 1], r"lower has shape \(2,\), upper \(3,\)"),
        ([0, 2], [1, 2], r"component 1 has lower 2.0 and upper 2.0"),
        ([0, np.nan], [1, 1], r"component 1 has lower nan"),
        ([0, 0], [np.inf, 1], r"component 0 has lower 0.0 and upper inf"),
        ([-1.7e308], [1.7e308], r"both finite"),
        ([], [], r"must be vectors of one length"),
        ([[0.0]], [[1.0]], r"must be vectors of one length"),
    ],
)
def test_a_box_that_is_none_is_refused(name, lower, upper, sentence):
    with pytest.raises(OptimizerError, match=sentence):
        OPTIMIZERS[name](np.array(lower, float), np.array(upper, float))
