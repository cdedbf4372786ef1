"""CMA-ES against the tutorial's formulas written out once more, its boundary handling and its restarts."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import sqrtm

from gpsynth.errors import OptimizerError
from gpsynth.optimizers import CMAES, minimize
from gpsynth.seeds import stream
from tests.optimizers.helpers import RASTRIGIN, SPHERE


def tutorial_step(n, m, sigma, C, p_s, p_c, g, y_sorted):
    """Hansen, arXiv:1604.00772, figure 6 and table 1, in loops and with a dense C^(-1/2)."""
    lam = len(y_sorted)
    mu = lam // 2
    w_raw = [np.log((lam + 1) / 2) - np.log(i) for i in range(1, lam + 1)]
    mu_eff = sum(w_raw[:mu]) ** 2 / sum(w**2 for w in w_raw[:mu])
    mu_eff_minus = sum(w_raw[mu:]) ** 2 / sum(w**2 for w in w_raw[mu:])
    c_c = (4 + mu_eff / n) / (n + 4 + 2 * mu_eff / n)
    c_s = (mu_eff + 2) / (n + mu_eff + 5)
    c_1 = 2 / ((n + 1.3) ** 2 + mu_eff)
    c_mu = min(1 - c_1, 2 * (1 / 4 + mu_eff + 1 / mu_eff - 2) / ((n + 2) ** 2 + 2 * mu_eff / 2))
    d_s = 1 + 2 * max(0, np.sqrt((mu_eff - 1) / (n + 1)) - 1) + c_s
    alpha = min(1 + c_1 / c_mu, 1 + 2 * mu_eff_minus / (mu_eff + 2), (1 - c_1 - c_mu) / (n * c_mu))
    positive = sum(w for w in w_raw if w > 0)
    negative = -sum(w for w in w_raw if w < 0)
    w = [v / positive if v >= 0 else alpha * v / negative for v in w_raw]
    chi = np.sqrt(n) * (1 - 1 / (4 * n) + 1 / (21 * n**2))

    C_half_inverse = np.linalg.inv(np.real(sqrtm(C)))
    y_w = sum(w[i] * y_sorted[i] for i in range(mu))
    m = m + sigma * y_w
    p_s = (1 - c_s) * p_s + np.sqrt(c_s * (2 - c_s) * mu_eff) * (C_half_inverse @ y_w)
    norm = np.linalg.norm(p_s)
    h = 1.0 if norm / np.sqrt(1 - (1 - c_s) ** (2 * (g + 1))) < (1.4 + 2 / (n + 1)) * chi else 0.0
    p_c = (1 - c_c) * p_c + h * np.sqrt(c_c * (2 - c_c) * mu_eff) * y_w
    rank_mu = np.zeros((n, n))
    for i in range(lam):
        v = C_half_inverse @ y_sorted[i]
        rank_mu += w[i] * (1 if w[i] >= 0 else n / (v @ v)) * np.outer(y_sorted[i], y_sorted[i])
    delta = (1 - h) * c_c * (2 - c_c)
    C = (1 + c_1 * delta - c_1 - c_mu * sum(w)) * C + c_1 * np.outer(p_c, p_c) + c_mu * rank_mu
    return m, sigma * np.exp(c_s / d_s * (norm / chi - 1)), C, p_s, p_c, h


@pytest.mark.parametrize(("n", "size"), [(2, 20), (5, 40), (12, 41), (12, 80)])
def test_updates_are_those_of_the_tutorial(n, size):
    optimizer = CMAES(np.zeros(n), np.ones(n), size=size, sigma=1e-4, x0=np.full(n, 0.4))
    state = optimizer.init(stream(1, 0))
    m, sigma, C, p_s, p_c = state.mean, state.sigma, np.eye(n), np.zeros(n), np.zeros(n)
    stalls = []
    for g in range(25):
        x, state = optimizer.ask(state, stream(1, g + 1))
        costs = np.full(size, 1.0) + x @ np.arange(1, n + 1)
        y = state.steps[np.argsort(costs)]
        m, sigma, C, p_s, p_c, h = tutorial_step(n, m, sigma, C, p_s, p_c, g, y)
        stalls.append(h == 0)
        state = optimizer.tell(state, x, costs)
        # 1e-9: two ways to the inverse root of a matrix whose condition stays below 1e4 here
        for ours, theirs in (
            (state.mean, m),
            (state.sigma, sigma),
            (state.covariance, C),
            (state.path_sigma, p_s),
            (state.path_c, p_c),
        ):
            assert np.allclose(ours, theirs, rtol=1e-9, atol=1e-9 * np.abs(theirs).max())
    assert 0 < sum(stalls) < 25  # the path of eq. 45 is held back in some generations and not in others


def test_the_sample_has_the_distribution_of_the_state():
    optimizer = CMAES(np.zeros(3), np.ones(3), size=200_000, sigma=0.01, x0=np.full(3, 0.5))
    start = optimizer.init(stream(1, 0))
    root = np.array([[2.0, 0.0, 0.0], [1.0, 1.0, 0.0], [-0.5, 0.3, 0.7]])
    squares, basis = np.linalg.eigh(root @ root.T)
    x, _ = optimizer.ask(replace(start, basis=basis, scales=np.sqrt(squares)), stream(1, 1))
    assert np.allclose(x.mean(axis=0), 0.5, atol=3e-4)
    assert np.allclose(np.cov(x.T) / 0.01**2, root @ root.T, atol=0.05)  # 5 standard errors of 2e5 samples


def test_a_sample_outside_the_box_is_mirrored_in_its_walls():
    optimizer = CMAES(np.array([-1.0]), np.array([3.0]))
    mirrored = optimizer._in_box(np.array([[0.25], [-0.25], [1.25], [2.25], [-1.75], [1.0]]))
    assert mirrored.ravel().tolist() == [0.0, 0.0, 2.0, 0.0, 0.0, 3.0]


def test_restarts_double_the_population_and_begin_elsewhere():
    optimizer = CMAES(RASTRIGIN.lower, RASTRIGIN.upper)
    sizes, first_means = [], {}

    def watch(now):
        sizes.append(now.state.size)
        first_means.setdefault(now.state.restart, tuple(now.state.mean))

    result = minimize(RASTRIGIN.cost, optimizer, seed=1, budget=60_000, callback=watch)
    assert result.state.restart >= 2
    assert sorted(set(sizes)) == [10 * 2**k for k in range(result.state.restart + 1)]
    assert len(set(first_means.values())) == len(first_means)


def test_the_last_descent_ends_the_run_with_its_reason():
    optimizer = CMAES(SPHERE.lower, SPHERE.upper, restarts=1)
    result = minimize(SPHERE.cost, optimizer, seed=1, budget=100_000)
    assert result.reason == "the costs no longer differ"
    assert result.state.restart == 1
    assert result.cost < 1e-12


def test_steps_that_vanish_or_outgrow_the_box_end_a_descent():
    optimizer = CMAES(SPHERE.lower, SPHERE.upper)
    state = optimizer.init(stream(1, 0))
    for sigma, reason in ((1e-14, "the steps have vanished"), (99.0, "the steps have outgrown the box")):
        x, asked = optimizer.ask(replace(state, sigma=sigma), stream(1, 1))
        assert optimizer.tell(asked, x, SPHERE.cost(x)).ended == reason


def test_a_covariance_that_is_nearly_singular_ends_a_descent_instead_of_failing():
    optimizer = CMAES(np.zeros(2), np.ones(2))
    start = optimizer.init(stream(1, 0))
    x, state = optimizer.ask(replace(start, covariance=np.diag([1.0, 1e-20])), stream(1, 1))
    state = replace(state, steps=state.steps * [1.0, 0.0])
    assert optimizer.tell(state, x, x[:, 0]).ended == "the covariance is ill-conditioned"


def test_a_first_mean_can_be_given():
    start = np.array([0.5, -1.0, 2.0, 0.0, 4.0])
    optimizer = CMAES(SPHERE.lower, SPHERE.upper, x0=start, sigma=1e-6)
    x, _ = optimizer.ask(optimizer.init(stream(1, 0)), stream(1, 1))
    assert np.allclose(x, start, atol=1e-4)


@pytest.mark.parametrize(
    ("settings", "sentence"),
    [
        ({"size": 3}, "size must be an integer of at least 4, not 3"),
        ({"sigma": 0.0}, "sigma must be positive, not 0.0"),
        ({"growth": 0}, "growth must be an integer of at least 1, not 0"),
        ({"restarts": -1}, "restarts must be an integer of at least 0, not -1"),
        ({"tolerance": np.nan}, "tolerance must be at least 0.0, not nan"),
        ({"x0": np.zeros((2, 5))}, r"x0 must be one position \(5,\); its shape is \(2, 5\)"),
        ({"x0": np.full(5, 9.0)}, "lies outside"),
    ],
)
def test_settings_that_contradict_themselves_are_refused(settings, sentence):
    with pytest.raises(OptimizerError, match=sentence):
        CMAES(SPHERE.lower, SPHERE.upper, **settings)
