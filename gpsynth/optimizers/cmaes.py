"""CMA-ES with restarts; equations of Hansen, "The CMA Evolution Strategy: A Tutorial", arXiv:1604.00772.

Restarts with a growing population: IPOP (Auger & Hansen 2005).
"""

from dataclasses import dataclass, replace
from math import ceil, exp, floor, log, sqrt

import numpy as np
import numpy.typing as npt

from gpsynth.arrays import Floats, frozen
from gpsynth.checks import check_whole
from gpsynth.errors import OptimizerError
from gpsynth.optimizers.box import (
    checked_at_least,
    checked_box,
    checked_positive,
    checked_starts,
    finite_or_worst,
    sealed,
)


@dataclass(frozen=True, eq=False)
class Strategy:
    """Weights and learning rates that follow from dimension and population alone."""

    weights: Floats  # (size,), the later ones negative
    parents: int  # mu
    mu_eff: float
    c_sigma: float
    d_sigma: float
    c_c: float
    c_1: float
    c_mu: float
    chi: float  # E||N(0, I)||

    @classmethod
    def of(cls, d: int, size: int) -> "Strategy":
        """The default values of the tutorial's table 1."""
        raw = log((size + 1) / 2) - np.log(np.arange(1, size + 1))  # eq. 49
        mu = size // 2
        mu_eff = float(raw[:mu].sum() ** 2 / (raw[:mu] ** 2).sum())
        mu_eff_minus = float(raw[mu:].sum() ** 2 / (raw[mu:] ** 2).sum())
        c_1 = 2.0 / ((d + 1.3) ** 2 + mu_eff)  # eq. 57
        c_mu = min(1 - c_1, 2.0 * (0.25 + mu_eff + 1 / mu_eff - 2) / ((d + 2) ** 2 + mu_eff))  # eq. 58
        least = min(
            1 + c_1 / c_mu,  # eq. 50
            1 + 2 * mu_eff_minus / (mu_eff + 2),  # eq. 51
            (1 - c_1 - c_mu) / (d * c_mu),  # eq. 52
        )
        scale = np.where(raw >= 0, 1 / raw[raw > 0].sum(), least / -raw[raw < 0].sum())
        c_sigma = (mu_eff + 2) / (d + mu_eff + 5)  # eq. 55
        return cls(
            weights=scale * raw,  # eq. 53
            parents=mu,
            mu_eff=mu_eff,
            c_sigma=c_sigma,
            d_sigma=1 + 2 * max(0.0, sqrt((mu_eff - 1) / (d + 1)) - 1) + c_sigma,  # eq. 55
            c_c=(4 + mu_eff / d) / (d + 4 + 2 * mu_eff / d),  # eq. 56
            c_1=c_1,
            c_mu=c_mu,
            chi=sqrt(d) * (1 - 1 / (4 * d) + 1 / (21 * d * d)),
        )


@dataclass(frozen=True, eq=False)
class CMAESState:
    """One descent: a normal distribution over the unit box and its two evolution paths."""

    restart: int
    size: int  # lambda of this descent
    generation: int  # within this descent
    mean: Floats  # (d,)
    sigma: float
    covariance: Floats  # (d, d) C = basis diag(scales**2) basis'
    basis: Floats  # (d, d) B
    scales: Floats  # (d,) D
    path_sigma: Floats  # (d,)
    path_c: Floats  # (d,)
    steps: Floats  # (size, d) the y of eq. 39 that are out
    recent: Floats  # best costs of the latest generations, a ring
    ended: str  # why this descent is over, or empty
    best_x: Floats  # (d,) in the user's box, over all descents
    best_cost: float


@dataclass(frozen=True, eq=False)
class CMAES:
    """Covariance matrix adaptation in a box, started anew with a larger population whenever a descent ends.

    Bounds: a sample outside the box is evaluated at its mirror image in the walls (the cost is continued
    periodically), while the update sees the sample itself, so the distribution stays normal. Coordinates are
    scaled to the unit box. The first mean is `x0` (d,), else uniform in the box, as after every restart.
    """

    lower: Floats  # (d,)
    upper: Floats  # (d,)
    size: int = 0  # lambda of the first descent; 0 means 4 + floor(3 ln d), eq. 48
    sigma: float = 0.3  # first step size, as a fraction of the range
    growth: int = 2  # of the population at a restart
    restarts: int = 9
    tolerance: float = 1e-12  # a descent whose costs differ by less is over
    x0: Floats | None = None

    def __post_init__(self) -> None:
        lower, upper = checked_box(self.lower, self.upper)
        size = self.size or 4 + floor(3 * log(lower.size))  # eq. 48
        check_whole("size", size, 4, OptimizerError)
        checked_positive("sigma", self.sigma)
        check_whole("growth", self.growth, 1, OptimizerError)
        check_whole("restarts", self.restarts, 0, OptimizerError)
        checked_at_least("tolerance", self.tolerance, 0.0)
        if self.x0 is not None and np.ndim(self.x0) != 1:
            raise OptimizerError(f"x0 must be one position ({lower.size},); its shape is {np.shape(self.x0)}")
        object.__setattr__(self, "lower", lower)
        object.__setattr__(self, "upper", upper)
        object.__setattr__(self, "size", size)
        object.__setattr__(self, "x0", checked_starts(self.x0, lower, upper, 1))

    def init(self, rng: np.random.Generator) -> CMAESState:
        """The first descent, before its first sample."""
        assert self.x0 is not None
        d = self.lower.size
        mean = (self.x0[0] - self.lower) / (self.upper - self.lower) if len(self.x0) else rng.random(d)
        return self._descent(0, self.size, mean, self._in_box(mean), np.inf)

    def _descent(self, restart: int, size: int, mean: Floats, best_x: Floats, best_cost: float) -> CMAESState:
        d = self.lower.size
        zero, eye = frozen(np.zeros(d)), frozen(np.eye(d))
        recent = sealed(np.full(10 + ceil(30 * d / size), np.inf))
        return CMAESState(
            restart=restart,
            size=size,
            generation=0,
            mean=sealed(mean),
            sigma=self.sigma,
            covariance=eye,
            basis=eye,
            scales=frozen(np.ones(d)),
            path_sigma=zero,
            path_c=zero,
            steps=sealed(np.zeros((size, d))),
            recent=recent,
            ended="",
            best_x=sealed(best_x),
            best_cost=best_cost,
        )

    def _in_box(self, u: Floats) -> Floats:
        """Unit coordinates, mirrored in the walls, as positions in the user's box."""
        mirrored = 1.0 - np.abs(np.mod(u, 2.0) - 1.0)
        return np.clip(self.lower + mirrored * (self.upper - self.lower), self.lower, self.upper)

    def ask(self, state: CMAESState, rng: np.random.Generator) -> tuple[Floats, CMAESState]:
        """A sample of the distribution, (size, d); a descent that is over gives way to the next."""
        if state.ended:
            mean, size = rng.random(self.lower.size), self.growth * state.size
            state = self._descent(state.restart + 1, size, mean, state.best_x, state.best_cost)
        z = rng.standard_normal((state.size, self.lower.size))  # eq. 38
        y = (z * state.scales) @ state.basis.T  # eq. 39
        x = state.mean + state.sigma * y  # eq. 40
        return self._in_box(x), replace(state, steps=sealed(y))

    def tell(self, state: CMAESState, x: Floats, costs: Floats) -> CMAESState:
        """The distribution moved and reshaped toward the better half of the sample."""
        costs = finite_or_worst(costs, (state.size,))
        order = costs.argsort(kind="stable")
        leader, recent = int(order[0]), state.recent.copy()
        recent[state.generation % len(recent)] = costs[leader]
        if costs[leader] < state.best_cost:
            state = replace(state, best_x=frozen(x[leader]), best_cost=float(costs[leader]))
        updated = replace(_updated(state, order), recent=sealed(recent))
        return replace(updated, ended=updated.ended or self._ended(updated, costs))

    def _ended(self, state: CMAESState, costs: Floats) -> str:
        """The tutorial's criteria of section B.3 that tell a finished descent from a slow one."""
        best, worst = float(state.recent.min()), max(float(state.recent.max()), float(costs.max()))
        if state.generation >= len(state.recent) and (best == worst or worst - best <= self.tolerance):
            return "the costs no longer differ"
        spread = np.maximum(np.sqrt(np.diag(state.covariance)), np.abs(state.path_c)).max()
        if state.sigma * spread < 1e-12 * self.sigma:
            return "the steps have vanished"
        if state.sigma * state.scales.max() > 10.0:
            return "the steps have outgrown the box"
        return ""

    def best(self, state: CMAESState) -> tuple[Floats, float]:
        """The best position of all descents."""
        return state.best_x, state.best_cost

    def stop(self, state: CMAESState) -> str:
        """The reason of the last descent, once no restart is left."""
        return state.ended if state.restart >= self.restarts else ""


def _updated(state: CMAESState, order: npt.NDArray[np.intp]) -> CMAESState:
    """Equations 41 to 47 for the steps of one generation, best first by `order`."""
    d = state.mean.size
    s = Strategy.of(d, state.size)
    y, g = state.steps[order], state.generation + 1
    z = (y @ state.basis) / state.scales  # B' C^(-1/2) y, of the same length as C^(-1/2) y
    y_w = s.weights[: s.parents] @ y[: s.parents]  # eq. 41
    mean = state.mean + state.sigma * y_w  # eq. 42, with c_m = 1 (eq. 54)
    whitened = state.basis @ (s.weights[: s.parents] @ z[: s.parents])  # C^(-1/2) y_w
    path_sigma = (1 - s.c_sigma) * state.path_sigma
    path_sigma = path_sigma + sqrt(s.c_sigma * (2 - s.c_sigma) * s.mu_eff) * whitened  # eq. 43
    length = float(np.linalg.norm(path_sigma))
    sigma = state.sigma * exp(s.c_sigma / s.d_sigma * (length / s.chi - 1))  # eq. 44
    short = length / sqrt(1 - (1 - s.c_sigma) ** (2 * g)) < (1.4 + 2 / (d + 1)) * s.chi  # h_sigma
    path_c = (1 - s.c_c) * state.path_c
    path_c = path_c + short * sqrt(s.c_c * (2 - s.c_c) * s.mu_eff) * y_w  # eq. 45
    lengths = (z * z).sum(axis=1) + 1e-300
    weights = np.where(s.weights >= 0, s.weights, s.weights * d / lengths)  # eq. 46
    kept = 1 + s.c_1 * (1 - short) * s.c_c * (2 - s.c_c) - s.c_1 - s.c_mu * s.weights.sum()
    covariance = (
        kept * state.covariance + s.c_1 * np.outer(path_c, path_c) + s.c_mu * (y.T * weights) @ y
    )  # eq. 47
    return _decomposed(
        replace(
            state,
            generation=g,
            mean=sealed(mean),
            sigma=sigma,
            covariance=sealed((covariance + covariance.T) / 2),
            path_sigma=sealed(path_sigma),
            path_c=sealed(path_c),
        )
    )


def _decomposed(state: CMAESState) -> CMAESState:
    """C = B D^2 B'; a covariance too ill-conditioned to be told from a singular one ends the descent."""
    squares, basis = np.linalg.eigh(state.covariance)
    if not squares[0] > 1e-14 * squares[-1]:
        return replace(state, ended="the covariance is ill-conditioned")
    return replace(state, basis=sealed(np.ascontiguousarray(basis)), scales=sealed(np.sqrt(squares)))
