"""The swarm's equations, its presets, and the re-scoring that a changing cost needs."""

from dataclasses import replace

import numpy as np
import pytest

from gpsynth.errors import OptimizerError
from gpsynth.optimizers import PSO, PSOState, minimize, rescore
from gpsynth.seeds import stream
from tests.optimizers.helpers import SPHERE


def rms_growth(inertia, c1, c2):
    """Root of the spectral radius of the second-moment recursion of eqs. 15-16 with both attractors at 0."""
    mean = 1 + inertia - (c1 + c2) / 2  # of a in x[t+1] = a x[t] - inertia x[t-1]
    square = mean**2 + (c1**2 + c2**2) / 12
    moments = np.array([[square, inertia**2, -2 * inertia * mean], [1, 0, 0], [mean, 0, -inertia]])
    return np.sqrt(np.abs(np.linalg.eigvals(moments)).max())


def wandering(swarm, generations):
    """A swarm whose attractors are all at 0, where no cost is ever better, after so many generations."""
    zero = np.zeros((swarm.size, swarm.lower.size))
    state = PSOState(1, swarm.init(stream(1, 0)).x, zero, zero, np.full(swarm.size, -1.0))
    for g in range(1, generations + 1):
        x, state = swarm.ask(state, stream(1, g))
        state = swarm.tell(state, x, np.zeros(swarm.size))
    return state


def test_a_step_is_equations_15_and_16():
    swarm = PSO(
        np.full(3, -9.0), np.full(3, 9.0), size=4, inertia=0.6, cognitive=1.1, social=1.3, speed=np.inf
    )
    rng = stream(3)
    x, v, p = rng.uniform(-1, 1, (3, 4, 3))
    state = PSOState(5, x, v, p, np.array([3.0, 1.0, 2.0, 4.0]))
    moved, after = swarm.ask(state, stream(8))
    r = stream(8).random((2, 4, 3))
    for i in range(4):
        for j in range(3):
            to_own, to_leader = p[i, j] - x[i, j], p[1, j] - x[i, j]
            velocity = 0.6 * v[i, j] + 1.1 * r[0, i, j] * to_own + 1.3 * r[1, i, j] * to_leader
            assert after.v[i, j] == velocity
            assert moved[i, j] == x[i, j] + velocity


@pytest.mark.parametrize(("preset", "growth"), [(PSO.seed, 1.0328), (PSO.clerc, 0.9717)])
def test_a_preset_grows_as_the_second_moments_say(preset, growth):
    swarm = preset([-1], [1])
    assert rms_growth(swarm.inertia, swarm.cognitive, swarm.social) == pytest.approx(growth, abs=5e-5)


def test_the_papers_velocities_grow_without_a_limit_and_stay_bounded_with_one():
    far = np.full(100, 1e9)
    starts = stream(2).uniform(-1, 1, (1000, 100))
    free = replace(PSO.seed(-far, far, size=1000, x0=starts), speed=np.inf)
    early, late = (np.sqrt((wandering(free, g).v ** 2).mean()) for g in (20, 60))
    assert (late / early) ** (1 / 40) == pytest.approx(1.0328, abs=0.002)  # 1e5 paths, heavy tails
    limited = replace(free, speed=1e-9)
    assert np.abs(wandering(limited, 60).v).max() <= 2.0 * (1 + 1e-15)


def test_no_step_is_longer_than_the_limit():
    swarm = PSO(SPHERE.lower, SPHERE.upper, size=50, speed=0.03)
    state = swarm.init(stream(1, 0))
    previous, state = swarm.ask(state, stream(1, 1))
    for g in range(2, 30):
        state = swarm.tell(state, previous, SPHERE.cost(previous))
        x, state = swarm.ask(state, stream(1, g))
        assert np.abs(x - previous).max() <= 0.03 * 8.0 * (1 + 1e-12)
        previous = x


def test_a_particle_bounces_off_the_wall():
    swarm = PSO(np.zeros(2), np.ones(2), size=1, inertia=1.0, cognitive=0.0, social=0.0, bounce=0.25)
    x, v = np.array([[0.95, 0.5]]), np.array([[0.125, 0.125]])
    moved, after = swarm.ask(PSOState(1, x, v, x, np.array([1.0])), stream(1))
    assert moved.tolist() == [[1.0, 0.625]]
    assert after.v.tolist() == [[-0.03125, 0.125]]


def test_given_positions_come_first():
    starts = np.arange(10.0).reshape(2, 5) / 10
    swarm = PSO(SPHERE.lower, SPHERE.upper, size=6, x0=starts)
    x, _ = swarm.ask(swarm.init(stream(1, 0)), stream(1, 1))
    assert np.array_equal(x[:2], starts)
    assert len(x) == 6


def test_a_swarm_follows_a_cost_that_changes_only_when_it_is_rescored():
    swarm = PSO(SPHERE.lower, SPHERE.upper, size=20)
    state = minimize(SPHERE.cost, swarm, seed=1, budget=2_000).state

    def harder(x):
        return SPHERE.cost(x - 2.0) + 10.0

    def run(state):
        for g in range(200):
            x, state = swarm.ask(state, stream(2, g))
            state = swarm.tell(state, x, harder(x))
        return swarm.best(state)

    stale_x, stale_cost = run(state)
    x, cost = run(rescore(state, harder(state.best_x)))
    assert cost == pytest.approx(10.0, abs=1e-6)
    assert np.allclose(x, 2.0, atol=1e-3)
    assert stale_cost < 1.0  # a cost that nothing can reach any more
    assert np.allclose(stale_x, 0.0, atol=0.1)


def test_rescoring_leaves_positions_alone_and_lets_nan_never_lead():
    swarm = PSO(SPHERE.lower, SPHERE.upper, size=5)
    state = minimize(SPHERE.cost, swarm, seed=1, budget=50).state
    after = rescore(state, np.array([np.nan, 3.0, 2.0, np.inf, -np.inf]))
    assert after.best_x is state.best_x
    assert swarm.best(after)[1] == 2.0
    with pytest.raises(OptimizerError, match=r"costs must have shape \(5,\)"):
        rescore(state, np.zeros(4))


@pytest.mark.parametrize(
    ("settings", "sentence"),
    [
        ({"size": 0}, "size must be an integer of at least 1, not 0"),
        ({"inertia": 1.5}, r"inertia must lie in \[0.0, 1.0\], not 1.5"),
        ({"inertia": np.nan}, "inertia must lie"),
        ({"cognitive": -1.0}, "cognitive must be at least 0.0, not -1.0"),
        ({"social": -1.0}, "social must be at least 0.0"),
        ({"speed": 0.0}, "speed must be positive, not 0.0"),
        ({"start_speed": 2.0}, "start_speed must lie"),
        ({"bounce": -0.5}, "bounce must lie"),
        ({"x0": np.zeros((2, 3))}, r"x0 must have 2 columns like the box; its shape is \(2, 3\)"),
        ({"x0": np.full((2, 2), 7.0)}, r"x0\[0, 0\] = 7.0 lies outside \[-1.0, 1.0\]"),
        ({"x0": np.array([[0.0, np.nan]])}, r"x0\[0, 1\] = nan lies outside"),
        ({"x0": np.zeros((33, 2))}, "x0 has 33 positions, more than the 32"),
    ],
)
def test_settings_that_contradict_themselves_are_refused(settings, sentence):
    with pytest.raises(OptimizerError, match=sentence):
        PSO(np.full(2, -1.0), np.full(2, 1.0), **settings)


def test_an_equal_cost_does_not_move_a_personal_best():
    swarm = PSO(SPHERE.lower, SPHERE.upper, size=6)
    x, state = swarm.ask(swarm.init(stream(1, 0)), stream(1, 1))
    state = swarm.tell(state, x, np.ones(6))
    y, state = swarm.ask(state, stream(1, 2))
    assert np.array_equal(swarm.tell(state, y, np.ones(6)).best_x, x)


def test_swarms_side_by_side_follow_their_own_leaders():
    swarms = PSO(SPHERE.lower, SPHERE.upper, size=12, swarms=3)
    state = swarms.init(stream(1))
    state = swarms.tell(state, state.x, SPHERE.cost(state.x))
    moved, _ = swarms.ask(state, stream(2))
    r1, r2 = stream(2).random((2, *state.x.shape))
    for number in range(3):
        part = slice(4 * number, 4 * number + 4)
        leader = state.best_x[part][np.argmin(state.best_costs[part])]
        v = 0.7298 * state.v[part] + 1.49618 * (
            r1[part] * (state.best_x[part] - state.x[part]) + r2[part] * (leader - state.x[part])
        )
        limit = 0.2 * (SPHERE.upper - SPHERE.lower)
        stepped = state.x[part] + np.clip(v, -limit, limit)
        assert moved[part] == pytest.approx(np.clip(stepped, SPHERE.lower, SPHERE.upper), abs=1e-15)


def test_particles_must_share_out_evenly():
    with pytest.raises(OptimizerError, match="size must be a multiple of the number of swarms, 3, got 32"):
        PSO(SPHERE.lower, SPHERE.upper, size=32, swarms=3)
