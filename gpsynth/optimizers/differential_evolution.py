"""Differential evolution that learns from its successes: SHADE (Tanabe & Fukunaga 2013), which builds on JADE
(Zhang & Sanderson 2009).
"""

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from gpsynth.arrays import Floats
from gpsynth.checks import check_whole
from gpsynth.errors import OptimizerError
from gpsynth.optimizers.box import (
    checked_box,
    checked_starts,
    checked_within,
    finite_or_worst,
    scatter,
    sealed,
)


@dataclass(frozen=True, eq=False)
class DifferentialEvolutionState:
    """The population, what it replaced lately, and which scales and crossover rates paid."""

    generation: int
    x: Floats  # (size, d)
    costs: Floats  # (size,)
    archive: Floats  # (at most 2 size, d) parents replaced lately
    memory_scale: Floats  # (memory,) M_F
    memory_rate: Floats  # (memory,) M_CR
    slot: int  # of the memory, the next to be renewed
    scale: Floats  # (size,) F of the trials that are out
    rate: Floats  # (size,) CR of the trials that are out


@dataclass(frozen=True, eq=False)
class DifferentialEvolution:
    """SHADE: current-to-pbest/1/bin with an archive; scale and rate are learned while it runs.

    A coordinate that would leave the box comes to lie half way between its parent and the wall (JADE's rule).
    `x0` (k, d) are the first k members of the population.
    """

    lower: Floats  # (d,)
    upper: Floats  # (d,)
    size: int = 100
    memory: int = 10  # H of SHADE
    greed: float = 0.2  # pbest is one of at most this fraction of the population
    x0: Floats | None = None

    def __post_init__(self) -> None:
        lower, upper = checked_box(self.lower, self.upper)
        check_whole("size", self.size, 4, OptimizerError)
        check_whole("memory", self.memory, 1, OptimizerError)
        checked_within("greed", self.greed, 0.0, 1.0)
        object.__setattr__(self, "lower", lower)
        object.__setattr__(self, "upper", upper)
        object.__setattr__(self, "x0", checked_starts(self.x0, lower, upper, self.size))

    def init(self, rng: np.random.Generator) -> DifferentialEvolutionState:
        """The first population, not yet evaluated."""
        assert self.x0 is not None
        half, zero = sealed(np.full(self.memory, 0.5)), sealed(np.zeros(self.size))
        x = scatter(rng, self.x0, self.lower, self.upper, self.size)
        worst = sealed(np.full(self.size, np.inf))
        return DifferentialEvolutionState(0, x, worst, sealed(x[:0].copy()), half, half, 0, zero, zero)

    def ask(
        self, state: DifferentialEvolutionState, rng: np.random.Generator
    ) -> tuple[Floats, DifferentialEvolutionState]:
        """One trial per member, (size, d); in the first generation the members themselves."""
        if state.generation == 0:
            return state.x.copy(), state
        slot = rng.integers(self.memory, size=self.size)
        rate = np.clip(rng.normal(state.memory_rate[slot], 0.1), 0.0, 1.0)
        scale = np.minimum(_positive_cauchy(rng, state.memory_scale[slot], 0.1), 1.0)
        archive = rng.permutation(state.archive)[: self.size]
        mutant = self._mutant(replace(state, archive=archive), scale[:, None], rng)
        crossed = rng.random(mutant.shape) < rate[:, None]
        crossed[np.arange(self.size), rng.integers(self.lower.size, size=self.size)] = True
        trial = np.where(crossed, mutant, state.x)
        return trial, replace(state, archive=sealed(archive), scale=sealed(scale), rate=sealed(rate))

    def _mutant(self, state: DifferentialEvolutionState, scale: Floats, rng: np.random.Generator) -> Floats:
        """v = x + F (x_pbest - x) + F (x_r1 - x_r2), with r2 from the population and the archive."""
        n, x = self.size, state.x
        elite = np.maximum(2.0, rng.uniform(2.0 / n, max(self.greed, 2.0 / n), n) * n)
        pbest = state.costs.argsort(kind="stable")[(rng.random(n) * elite).astype(np.intp)]
        r1, r2 = _donors(n, n + len(state.archive), rng)
        pool = np.concatenate([x, state.archive])
        mutant = x + scale * (x[pbest] - x) + scale * (x[r1] - pool[r2])
        mutant = np.where(mutant < self.lower, (self.lower + x) / 2.0, mutant)
        return np.where(mutant > self.upper, (self.upper + x) / 2.0, mutant)

    def tell(self, state: DifferentialEvolutionState, x: Floats, costs: Floats) -> DifferentialEvolutionState:
        """A trial that is no worse takes its parent's place; one that is better teaches scale and rate."""
        costs = finite_or_worst(costs, (self.size,))
        better, taken = costs < state.costs, costs <= state.costs
        learned = replace(
            state,
            generation=state.generation + 1,
            x=sealed(np.where(taken[:, None], x, state.x)),
            costs=sealed(np.where(taken, costs, state.costs)),
        )
        if state.generation == 0 or not better.any():
            return learned
        archive = sealed(np.concatenate([state.archive, state.x[better]]))
        with np.errstate(over="ignore"):
            gain = state.costs[better] - costs[better]
        return _remember(replace(learned, archive=archive), better, gain)

    def best(self, state: DifferentialEvolutionState) -> tuple[Floats, float]:
        """The best member."""
        i = state.costs.argmin()
        return state.x[i], float(state.costs[i])

    def stop(self, state: DifferentialEvolutionState) -> str:
        """A population without differences has nothing to mutate with."""
        spread = np.ptp(state.x, axis=0)
        return "the population has collapsed" if (spread <= 1e-15 * (self.upper - self.lower)).all() else ""


def _donors(
    n: int, pool: int, rng: np.random.Generator
) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]:
    """Two indices for each of n members: r1 among them, r2 in the pool; itself, r1 and r2 all differ."""
    i = np.arange(n)
    r1 = (i + 1 + rng.integers(n - 1, size=n)) % n
    r2 = rng.integers(pool - 2, size=n)
    r2 += r2 >= np.minimum(i, r1)  # step over the two that are taken, the smaller one first
    r2 += r2 >= np.maximum(i, r1)
    return r1, r2


def _remember(
    state: DifferentialEvolutionState, better: npt.NDArray[np.bool_], gain: Floats
) -> DifferentialEvolutionState:
    """The memory slot in turn receives the gain-weighted means of what paid in this generation."""
    if np.isinf(gain).any():  # a parent without a finite cost was replaced: infinite gains share the weight
        gain = np.where(np.isinf(gain), 1.0, 0.0)
    weight = gain / gain.max()
    scale, rate = state.scale[better], state.rate[better]
    memory_scale, memory_rate = state.memory_scale.copy(), state.memory_rate.copy()
    memory_scale[state.slot] = (weight * scale * scale).sum() / (weight * scale).sum()  # Lehmer mean
    memory_rate[state.slot] = (weight * rate).sum() / weight.sum()
    slot = (state.slot + 1) % len(memory_scale)
    return replace(state, memory_scale=sealed(memory_scale), memory_rate=sealed(memory_rate), slot=slot)


def _positive_cauchy(rng: np.random.Generator, location: Floats, width: float) -> Floats:
    """Cauchy numbers given that they are positive: the distribution of drawing again until one is."""
    least = 0.5 - np.arctan(location / width) / np.pi
    quantile = 1.0 - (1.0 - least) * rng.random(location.shape)
    return np.maximum(location + width * np.tan(np.pi * (quantile - 0.5)), 1e-12)
