"""Formulas for several costs at once: NSGA-II (Deb et al. 2002) over the genomes of an encoding.

Selection is NSGA-II's; offspring are the encoding's, or a parent with all its numbers moved a little. The size of a
formula is one more cost, unless it is not to count.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf
from typing import Generic, TypeVar

import numpy as np

from gpsynth.arrays import Floats, Ints
from gpsynth.checks import check_kind, check_number, check_whole
from gpsynth.encodings.protocol import Encoding
from gpsynth.errors import OptimizerError
from gpsynth.optimizers.nsga2 import crowded_order
from gpsynth.program import Program
from gpsynth.structure_search import Candidate

G = TypeVar("G")

STEPS = (1e-3, 0.3)  # least and greatest relative step when all numbers move


@dataclass(frozen=True, eq=False)
class Member(Generic[G]):
    """A formula with its numbers and what it costs."""

    genome: G
    program: Program
    values: Floats  # (p,)
    costs: Floats  # (k,)


@dataclass(frozen=True, eq=False)
class ParetoState(Generic[G]):
    """The population, best first, and the rank of each: 0 where none is better in all."""

    population: tuple[Member[G], ...] = ()
    rank: Ints | None = None  # (size,)

    @property
    def front(self) -> tuple[Member[G], ...]:
        """Those that none dominates, by rising first cost."""
        ranks = () if self.rank is None else self.rank.tolist()
        found = [member for member, rank in zip(self.population, ranks, strict=True) if rank == 0]
        return tuple(sorted(found, key=lambda member: tuple(member.costs.tolist())))


@dataclass(frozen=True)
class ParetoSearch(Generic[G]):
    """Satisfies `optimizers.protocol.Search`; costs are (batch, k), all of them to be small.

    Raises OptimizerError for settings that make no sense.
    """

    encoding: Encoding[G]
    population: int = 200
    crossover: float = 0.4  # probability that an offspring has two parents
    moved: float = 0.3  # probability that it is its parent with other numbers
    fresh: float = 0.05  # probability that it is random
    size_counts: bool = True  # the number of instructions is one more cost

    def __post_init__(self) -> None:
        check_kind("encoding", self.encoding, Encoding, error=OptimizerError)
        check_whole("population", self.population, 4, OptimizerError)
        for name in ("crossover", "moved", "fresh"):
            check_number(name, getattr(self, name), OptimizerError)
        shares = (self.crossover, self.moved, self.fresh)
        if not (min(shares) >= 0.0 and sum(shares) <= 1.0):
            raise OptimizerError(f"crossover, moved and fresh are shares of 1, not {shares}")

    def init(self, rng: np.random.Generator) -> ParetoState[G]:
        """Nothing is known yet."""
        return ParetoState()

    def ask(
        self, state: ParetoState[G], rng: np.random.Generator
    ) -> tuple[tuple[Candidate[G], ...], ParetoState[G]]:
        """As many candidates as the population is to have."""
        genomes = [self._child(state, rng) for _ in range(self.population)]
        programs = map(self.encoding.decode, genomes)
        return tuple(
            Candidate(genome, program, self.encoding.parameters(genome))
            for genome, program in zip(genomes, programs, strict=True)
        ), state

    def tell(
        self, state: ParetoState[G], candidates: Sequence[Candidate[G]], costs: Floats
    ) -> ParetoState[G]:
        """The best of old and new by rank and crowding; of those that cost the same, the first."""
        members = list(state.population)
        for candidate, row in zip(candidates, costs, strict=True):
            if np.isfinite(row).all():
                members.append(Member(candidate.genome, candidate.program, candidate.values, row))
        unique = list({self._criteria(member): member for member in reversed(members)}.items())[::-1]
        if not unique:
            return state
        criteria = np.array([key for key, _ in unique])
        chosen, rank, _ = crowded_order(criteria, min(self.population, len(unique)))
        return ParetoState(tuple(unique[index][1] for index in chosen.tolist()), rank)

    def best(self, state: ParetoState[G]) -> tuple[Member[G] | None, float]:
        """The member of least first cost."""
        best = min(state.population, key=lambda member: tuple(member.costs.tolist()), default=None)
        return best, inf if best is None else float(best.costs[0])

    def stop(self, state: ParetoState[G]) -> str:
        """A front is never known to be complete."""
        return ""

    def _criteria(self, member: Member[G]) -> tuple[float, ...]:
        size = (float(member.program.complexity),) if self.size_counts else ()
        return (*member.costs.tolist(), *size)

    def _child(self, state: ParetoState[G], rng: np.random.Generator) -> G:
        draw = rng.random()
        if not state.population or draw < self.fresh:
            return self.encoding.random(rng)
        parent = self._parent(state, rng)
        if draw < self.fresh + self.crossover:
            pair = self.encoding.crossover(parent.genome, self._parent(state, rng).genome, rng)
            return pair[int(rng.integers(2))]
        if draw < self.fresh + self.crossover + self.moved and len(parent.values):
            return self._with_moved_numbers(parent, rng)
        return self.encoding.mutate(parent.genome, rng)

    def _parent(self, state: ParetoState[G], rng: np.random.Generator) -> Member[G]:
        """The better of two, the population being sorted."""
        return state.population[int(rng.integers(len(state.population), size=2).min())]

    def _with_moved_numbers(self, parent: Member[G], rng: np.random.Generator) -> G:
        step = np.exp(rng.uniform(*np.log(STEPS)))
        moved = parent.values * (1.0 + step * rng.standard_normal(len(parent.values)))
        space = self.encoding.space
        return self.encoding.with_parameters(parent.genome, np.clip(moved, space.lower, space.upper))
