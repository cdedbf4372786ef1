"""Particle swarm optimization (Kennedy & Eberhart 1995; Shmalko & Yamshanov, eqs. 15-16)."""

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from gpsynth.arrays import Floats
from gpsynth.checks import check_whole
from gpsynth.errors import OptimizerError
from gpsynth.optimizers.box import (
    checked_at_least,
    checked_box,
    checked_positive,
    checked_starts,
    checked_within,
    finite_or_worst,
    scatter,
    sealed,
)


@dataclass(frozen=True, eq=False)
class PSOState:
    """Where the particles are, how they move, and the best each has seen."""

    generation: int
    x: Floats  # (size, d)
    v: Floats  # (size, d)
    best_x: Floats  # (size, d)
    best_costs: Floats  # (size,)


@dataclass(frozen=True, eq=False)
class PSO:
    """A swarm of `size` particles in a box, all of them led by the best position seen by any.

    A particle that would leave the box stays on the wall, and its velocity across the wall is reversed and
    multiplied by `bounce`. `x0` (k, d) are positions of the first k particles; the others start anywhere. With several
    `swarms` the particles are shared out, as many in a row to each, and are led by the best of their own swarm.
    """

    lower: Floats  # (d,)
    upper: Floats  # (d,)
    size: int = 32
    inertia: float = 0.7298  # omega of eq. 15
    cognitive: float = 1.49618  # c1 of eq. 15
    social: float = 1.49618  # c2 of eq. 15
    speed: float = 0.2  # largest step per generation, as a fraction of the range; inf leaves velocities free
    start_speed: float = 0.05  # largest first step, as a fraction of the range
    bounce: float = 0.3
    x0: Floats | None = None
    swarms: int = 1

    def __post_init__(self) -> None:
        lower, upper = checked_box(self.lower, self.upper)
        check_whole("size", self.size, 1, OptimizerError)
        check_whole("swarms", self.swarms, 1, OptimizerError)
        if self.size % self.swarms:
            raise OptimizerError(
                f"size must be a multiple of the number of swarms, {self.swarms}, got {self.size}"
            )
        checked_within("inertia", self.inertia, 0.0, 1.0)
        checked_at_least("cognitive", self.cognitive, 0.0)
        checked_at_least("social", self.social, 0.0)
        checked_positive("speed", self.speed)
        checked_within("start_speed", self.start_speed, 0.0, 1.0)
        checked_within("bounce", self.bounce, 0.0, 1.0)
        object.__setattr__(self, "lower", lower)
        object.__setattr__(self, "upper", upper)
        object.__setattr__(self, "x0", checked_starts(self.x0, lower, upper, self.size))

    @classmethod
    def clerc(
        cls,
        lower: npt.ArrayLike,
        upper: npt.ArrayLike,
        *,
        size: int = 32,
        x0: Floats | None = None,
        swarms: int = 1,
    ) -> "PSO":
        """The constricted swarm of Clerc & Kennedy (2002), which contracts around what it has found."""
        return cls(np.asarray(lower), np.asarray(upper), size, x0=x0, swarms=swarms)

    @classmethod
    def seed(
        cls,
        lower: npt.ArrayLike,
        upper: npt.ArrayLike,
        *,
        size: int = 32,
        x0: Floats | None = None,
        swarms: int = 1,
    ) -> "PSO":
        """The paper's coefficients; without the limit on speed the velocities grow by 3.3 % a generation (RMS)."""
        return cls(np.asarray(lower), np.asarray(upper), size, 1.0, 0.65, 0.65, x0=x0, swarms=swarms)

    def init(self, rng: np.random.Generator) -> PSOState:
        """Particles at the given and at random positions, not yet evaluated."""
        assert self.x0 is not None
        x = scatter(rng, self.x0, self.lower, self.upper, self.size)
        v = self.start_speed * (self.upper - self.lower) * rng.uniform(-1.0, 1.0, x.shape)
        return PSOState(0, x, sealed(v), x, sealed(np.full(self.size, np.inf)))

    def ask(self, state: PSOState, rng: np.random.Generator) -> tuple[Floats, PSOState]:
        """Next positions, (size, d): the first ones as they are, then one step each."""
        if state.generation == 0:
            return state.x.copy(), state
        leaders = np.repeat(state.best_x[self.leaders(state)], self.size // self.swarms, axis=0)
        r1, r2 = rng.random((2, *state.x.shape))
        v = (
            self.inertia * state.v
            + self.cognitive * r1 * (state.best_x - state.x)
            + self.social * r2 * (leaders - state.x)
        )  # eq. 15
        limit = self.speed * (self.upper - self.lower)
        v = np.minimum(np.maximum(v, -limit), limit)
        x = state.x + v  # eq. 16
        inside = np.minimum(np.maximum(x, self.lower), self.upper)
        v = np.where(x == inside, v, -self.bounce * v)
        return inside.copy(), replace(state, x=sealed(inside), v=sealed(v))

    def tell(self, state: PSOState, x: Floats, costs: Floats) -> PSOState:
        """Personal bests renewed where the cost is lower."""
        costs = finite_or_worst(costs, (self.size,))
        better = costs < state.best_costs
        return replace(
            state,
            generation=state.generation + 1,
            best_x=sealed(np.where(better[:, None], x, state.best_x)),
            best_costs=sealed(np.where(better, costs, state.best_costs)),
        )

    def leaders(self, state: PSOState) -> npt.NDArray[np.intp]:
        """The number of the best particle of each swarm, (swarms,)."""
        costs = state.best_costs.reshape(self.swarms, -1)
        numbers: npt.NDArray[np.intp] = costs.argmin(axis=1) + np.arange(self.swarms) * costs.shape[1]
        return numbers

    def limits(self, state: PSOState) -> Floats:
        """Costs (size,): a candidate that costs more changes nothing, however much more it is."""
        return state.best_costs

    def best(self, state: PSOState) -> tuple[Floats, float]:
        """The best of the personal bests."""
        leader = state.best_costs.argmin()
        return state.best_x[leader], float(state.best_costs[leader])

    def stop(self, state: PSOState) -> str:
        """A swarm that has come to rest finds nothing more."""
        fastest = np.abs(state.v).max(axis=0)
        rests = state.generation > 1 and bool((fastest <= 1e-12 * (self.upper - self.lower)).all())
        return "the swarm has come to rest" if rests else ""


def rescore(state: PSOState, costs: Floats) -> PSOState:
    """The same swarm under another cost function: `costs` (size,) are the new costs of `state.best_x`."""
    return replace(state, best_costs=sealed(finite_or_worst(costs, state.best_costs.shape).copy()))
