"""NSGA-II (Deb, Pratap, Agarwal & Meyarivan 2002): several costs at once, in a box.

Sorting and crowding are DEAP's; crossover and mutation are not, since DEAP's draw from the global `random`.
"""

from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np

from gpsynth.arrays import Floats, Ints
from gpsynth.checks import check_whole
from gpsynth.errors import OptimizerError
from gpsynth.optimizers.box import (
    checked_box,
    checked_positive,
    checked_starts,
    checked_within,
    finite_or_worst,
    scatter,
    sealed,
)


@dataclass(frozen=True, eq=False)
class NSGA2State:
    """The population with its costs, ranks and crowding distances."""

    generation: int
    x: Floats  # (size, d)
    costs: Floats  # (size, objectives)
    rank: Ints  # (size,), 0 is the first front
    crowding: Floats  # (size,)


@dataclass(frozen=True, eq=False)
class NSGA2:
    """A population that approaches the Pareto front of several costs; `front(state)` is what it has found.

    Simulated binary crossover and polynomial mutation in their bounded forms; parents win crowded tournaments.
    """

    lower: Floats  # (d,)
    upper: Floats  # (d,)
    objectives: int = 2
    size: int = 100
    crossover: float = 0.9  # probability that two parents are crossed
    crossover_index: float = 15.0  # eta_c; larger means children nearer to their parents
    mutation: float = 0.0  # probability per coordinate; 0 means 1 / d
    mutation_index: float = 20.0  # eta_m
    x0: Floats | None = None

    def __post_init__(self) -> None:
        lower, upper = checked_box(self.lower, self.upper)
        check_whole("objectives", self.objectives, 2, OptimizerError)
        check_whole("size", self.size, 4, OptimizerError)
        if self.size % 2:
            raise OptimizerError(f"size must be even, since children come in pairs, not {self.size}")
        checked_within("crossover", self.crossover, 0.0, 1.0)
        checked_positive("crossover_index", self.crossover_index)
        checked_within("mutation", self.mutation, 0.0, 1.0)
        checked_positive("mutation_index", self.mutation_index)
        object.__setattr__(self, "lower", lower)
        object.__setattr__(self, "upper", upper)
        object.__setattr__(self, "mutation", self.mutation or 1.0 / lower.size)
        object.__setattr__(self, "x0", checked_starts(self.x0, lower, upper, self.size))

    def init(self, rng: np.random.Generator) -> NSGA2State:
        """The first population, not yet evaluated."""
        assert self.x0 is not None
        x = scatter(rng, self.x0, self.lower, self.upper, self.size)
        worst = sealed(np.full((self.size, self.objectives), np.inf))
        return NSGA2State(0, x, worst, sealed(np.zeros(self.size, np.int32)), sealed(np.zeros(self.size)))

    def ask(self, state: NSGA2State, rng: np.random.Generator) -> tuple[Floats, NSGA2State]:
        """Children, (size, d); in the first generation the population itself."""
        if state.generation == 0:
            return state.x.copy(), state
        parents = state.x[_tournaments(state, rng)]
        children = self._crossed(parents[0::2], parents[1::2], rng)
        return self._mutated(children, rng), state

    def _crossed(self, a: Floats, b: Floats, rng: np.random.Generator) -> Floats:
        """Bounded simulated binary crossover: half the coordinates of a crossed pair take part."""
        low, high, u = np.minimum(a, b), np.maximum(a, b), rng.random(a.shape)
        taking_part = (rng.random((len(a), 1)) < self.crossover) & (rng.random(a.shape) < 0.5)
        gap = np.maximum(high - low, 1e-300)
        middle = 0.5 * (low + high)
        below = middle - 0.5 * gap * _spread(u, (low - self.lower) / gap, self.crossover_index)
        above = middle + 0.5 * gap * _spread(u, (self.upper - high) / gap, self.crossover_index)
        swapped = rng.random(a.shape) < 0.5
        crossed = taking_part & (high - low > 1e-14 * (self.upper - self.lower))
        first = np.where(crossed, np.where(swapped, above, below), a)
        second = np.where(crossed, np.where(swapped, below, above), b)
        children: Floats = np.concatenate([first, second]).clip(self.lower, self.upper)
        return children

    def _mutated(self, x: Floats, rng: np.random.Generator) -> Floats:
        """Bounded polynomial mutation of a few coordinates."""
        span, u = self.upper - self.lower, rng.random(x.shape)
        power = self.mutation_index + 1.0
        to_lower, to_upper = (x - self.lower) / span, (self.upper - x) / span
        down = (2.0 * u + (1.0 - 2.0 * u) * (1.0 - to_lower) ** power).clip(0.0) ** (1.0 / power) - 1.0
        up = 1.0 - (2.0 * (1.0 - u) + (2.0 * u - 1.0) * (1.0 - to_upper) ** power).clip(0.0) ** (1.0 / power)
        moved = x + span * np.where(u < 0.5, down, up)
        return np.clip(np.where(rng.random(x.shape) < self.mutation, moved, x), self.lower, self.upper)

    def tell(self, state: NSGA2State, x: Floats, costs: Floats) -> NSGA2State:
        """The best `size` of parents and children, by rank and then by crowding."""
        costs = finite_or_worst(costs, (self.size, self.objectives))
        if state.generation:
            x, costs = np.concatenate([state.x, x]), np.concatenate([state.costs, costs])
        chosen, rank, crowding = crowded_order(costs, self.size)
        return NSGA2State(
            state.generation + 1, sealed(x[chosen]), sealed(costs[chosen]), sealed(rank), sealed(crowding)
        )

    def best(self, state: NSGA2State) -> tuple[Floats, float]:
        """The member with the least first cost, ties broken by the next costs."""
        i = int(np.lexsort(state.costs.T[::-1])[0])
        return state.x[i], float(state.costs[i, 0])

    def front(self, state: NSGA2State) -> tuple[Floats, Floats]:
        """The members that none dominates, (k, d), and their costs, (k, objectives), by rising first cost."""
        found = np.flatnonzero((state.rank == 0) & np.isfinite(state.costs[:, 0]))
        found = found[np.lexsort(state.costs[found].T[::-1])]
        return state.x[found], state.costs[found]

    def stop(self, state: NSGA2State) -> str:
        """A front is never known to be complete."""
        return ""


def crowded_order(costs: Floats, size: int) -> tuple[Ints, Ints, Floats]:
    """The `size` best rows by (rank, crowding distance): indices, ranks and distances, best first."""
    from deap.base import Fitness
    from deap.tools import emo

    minimized = type("Minimized", (Fitness,), {"weights": (-1.0,) * costs.shape[1]})
    rows = [SimpleNamespace(index=i, fitness=minimized(row)) for i, row in enumerate(costs.tolist())]
    order: list[tuple[int, int, float]] = []
    for rank, front in enumerate(emo.sortLogNondominated(rows, size)):
        emo.assignCrowdingDist(front)
        front.sort(key=lambda row: (-row.fitness.crowding_dist, row.index))
        order += [(row.index, rank, row.fitness.crowding_dist) for row in front]
    indices, ranks, distances = zip(*order[:size], strict=True)
    return np.array(indices, np.int32), np.array(ranks, np.int32), np.array(distances, np.float64)


def _tournaments(state: NSGA2State, rng: np.random.Generator) -> Ints:
    """Winners of `size` tournaments of two: lower rank, then the less crowded."""
    a, b = rng.integers(len(state.x), size=(2, len(state.x)), dtype=np.int32)
    tie = state.rank[a] == state.rank[b]
    a_wins = (state.rank[a] < state.rank[b]) | (tie & (state.crowding[a] >= state.crowding[b]))
    winners: Ints = np.where(a_wins, a, b)
    return winners


def _spread(u: Floats, room: Floats, index: float) -> Floats:
    """Deb's bounded spread factor beta_q of uniform u; `room` is the way to the wall over the parents' distance."""
    alpha = 2.0 - (1.0 + 2.0 * room) ** -(index + 1.0)
    base = np.where(u <= 1.0 / alpha, u * alpha, 1.0 / (2.0 - u * alpha))
    return base ** (1.0 / (index + 1.0))
