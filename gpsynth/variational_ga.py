"""The genetic algorithm of the network operator: couples, four children, ranks by domination, epochs (Diveev 2012).

The settings are those of the 2022 robot program. One thing differs: the couples of a generation are all drawn before
its first child replaces a member, so that a generation is one batch.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from math import inf
from typing import Literal

import numpy as np

from gpsynth.arrays import Floats, Ints, frozen
from gpsynth.checks import check_kind, check_number, check_whole
from gpsynth.encodings.variational import VariationalEncoding, VariationalGenome
from gpsynth.errors import OptimizerError
from gpsynth.optimizers.domination import dominates, domination_ranks, nearest_to_utopia
from gpsynth.structure_search import Candidate, Individual, pareto

Member = Individual[VariationalGenome]
Turn = Literal["population", "couples", "elite"]  # what a batch is made of
NEAR = 1e-3  # functionals of members that count as copies of each other


def mean_and_worst(costs: Floats) -> Floats:
    """Costs (n, S) of S starts as two functionals (n, 2)."""
    return np.column_stack([costs.mean(axis=1), costs.max(axis=1)])


@dataclass(frozen=True, eq=False)
class VariationalState:
    """Members on the present basis, and what the waiting batch is made of."""

    encoding: VariationalEncoding  # its basis is that of the present epoch
    population: tuple[Member, ...] = ()  # the first is the basis itself
    functionals: Floats = field(default_factory=lambda: frozen(np.empty((0, 0))))  # (population, k)
    # by how many members each is dominated, (population,)
    ranks: Ints = field(default_factory=lambda: frozen(np.empty(0, np.int32)))
    front: tuple[Member, ...] = ()  # over (complexity, cost), of all epochs
    generation: int = 0  # of couples
    turn: Turn = "population"
    picks: tuple[int, ...] = ()  # members whose variations are being trimmed


@dataclass(frozen=True)
class VariationalGA:
    """A genetic algorithm over variations and parameters; satisfies `optimizers.protocol.Search`.

    Every `epoch` generations the member nearest to the utopia point becomes the basis, all are evaluated anew on it,
    and then `elite` members lose the last variations that do not help. Raises OptimizerError for settings out of range.
    """

    encoding: VariationalEncoding
    population: int = 512
    couples: int = 128  # a generation
    picks: int = 8  # further members from which the first parent is the best
    attraction: float = 0.4  # alpha: how readily parents of any rank are crossed
    mutation: float = 0.7  # probability per child
    epoch: int = 10  # generations; 0 keeps the basis
    elite: int = 10
    functionals: Callable[[Floats], Floats] = mean_and_worst  # of costs (n, S), (n, k)
    seeds: tuple[VariationalGenome, ...] = ()  # formulas to begin with, beside the basis

    def __post_init__(self) -> None:
        least = {"population": 2, "couples": 1, "picks": 0, "epoch": 0, "elite": 0}
        check_kind("encoding", self.encoding, VariationalEncoding, error=OptimizerError)
        for name, value in least.items():
            check_whole(name, getattr(self, name), value, OptimizerError)
        for name in ("attraction", "mutation"):
            check_number(name, getattr(self, name), OptimizerError)
            if not 0.0 <= getattr(self, name) <= 1.0:
                raise OptimizerError(f"{name} must lie in [0, 1], not {getattr(self, name)}")

    def init(self, rng: np.random.Generator) -> VariationalState:
        """Nothing is known yet."""
        return VariationalState(self.encoding)

    def ask(
        self, state: VariationalState, rng: np.random.Generator
    ) -> tuple[tuple[Candidate[VariationalGenome], ...], VariationalState]:
        """The whole population at the start and after a change of basis; else children, or trimmed members."""
        if state.turn == "couples":
            genomes = self._children(state, rng)
        elif state.turn == "elite":
            count = min(self.elite, self.population - 1)
            picks = (1 + rng.choice(self.population - 1, count, replace=False)).tolist()
            state = replace(state, picks=tuple(picks))
            genomes = [genome for pick in picks for genome in self._prefixes(state, pick)]
        elif state.population:
            encoding, genomes = self._next_epoch(state, rng)
            state = replace(state, encoding=encoding)
        else:
            given = self.seeds[: self.population - 1]
            others = (self.encoding.random(rng) for _ in range(self.population - 1 - len(given)))
            genomes = [self.encoding.basic(), *given, *others]
        return tuple(_candidate(state.encoding, genome) for genome in genomes), state

    def tell(
        self, state: VariationalState, candidates: Sequence[Candidate[VariationalGenome]], costs: Floats
    ) -> VariationalState:
        """The state after this batch; costs have one column per start."""
        finite = np.isfinite(costs).all(axis=1, keepdims=True)
        costs = np.where(finite, costs, inf)
        functionals = np.where(finite, self.functionals(np.where(finite, costs, 0.0)), inf)
        members = [
            Individual(each.genome, each.program, each.values, row, 0)
            for each, row in zip(candidates, costs, strict=True)
        ]
        known = (*state.front, *(member for member in members if np.isfinite(member.cost)))
        state = replace(state, front=pareto(known))
        if state.turn == "couples":
            state = _joined(state, members, functionals)
            generation = state.generation + 1
            turn: Turn = "population" if self.epoch and generation % self.epoch == 0 else "couples"
            return replace(state, generation=generation, turn=turn)
        if state.turn == "elite":
            return replace(self._trimmed(state, members, functionals), turn="couples", picks=())
        turn = "elite" if state.population and self.elite else "couples"
        return replace(_ranked(state, members, functionals), turn=turn)

    def best(self, state: VariationalState) -> tuple[Member | None, float]:
        """The formula of least mean cost, of any epoch."""
        return (state.front[-1], state.front[-1].cost) if state.front else (None, inf)

    def stop(self, state: VariationalState) -> str:
        """Formulas never run out."""
        return ""

    def _children(self, state: VariationalState, rng: np.random.Generator) -> list[VariationalGenome]:
        """Four of each couple that is crossed, some of them mutated; of one couple at least."""
        children: list[VariationalGenome] = []
        while not children:  # ends, since a member that none dominates is always crossed
            for _ in range(self.couples):
                picks = rng.integers(self.population, size=1 + self.picks)
                first, second = picks[np.argmin(state.ranks[picks])], rng.integers(self.population)
                if rng.random() < max(self._readiness(int(state.ranks[i])) for i in (first, second)):
                    a, b = state.population[first].genome, state.population[second].genome
                    children += state.encoding.children(a, b, rng)
        return [
            state.encoding.mutate_both(child, rng) if rng.random() < self.mutation else child
            for child in children
        ]

    def _readiness(self, rank: int) -> float:
        return (1.0 + self.attraction * rank) / (1.0 + rank)

    def _next_epoch(
        self, state: VariationalState, rng: np.random.Generator
    ) -> tuple[VariationalEncoding, list[VariationalGenome]]:
        """The members on the basis nearest to the utopia point; where there is none, new ones for those dominated."""
        members = state.population
        chosen = nearest_to_utopia(state.functionals)
        if chosen is None:
            keeps = _distinct_front(state)
            return state.encoding, [
                member.genome if kept else state.encoding.random(rng)
                for member, kept in zip(members, keeps, strict=True)
            ]
        encoding = state.encoding.rebased(members[chosen].genome)
        basic = encoding.basic(members[chosen].values)
        return encoding, [basic, *(member.genome for member in members[1:])]

    def _prefixes(self, state: VariationalState, pick: int) -> list[VariationalGenome]:
        """The member with none of its variations, with the first, and so on, but for all of them."""
        genome = state.population[pick].genome
        return [state.encoding.trimmed(genome, count) for count in range(state.encoding.n_variations)]

    def _trimmed(
        self, state: VariationalState, members: Sequence[Member], functionals: Floats
    ) -> VariationalState:
        """Each picked member up to its last variation with which no functional was worse than the best before."""
        population, known = list(state.population), state.functionals.copy()
        width = state.encoding.n_variations
        for number, pick in enumerate(state.picks):
            steps = slice(number * width, (number + 1) * width)
            rows = np.vstack([functionals[steps], known[pick]])
            prefixes = (*members[steps], population[pick])
            last = 0
            for count in range(1, width + 1):
                if np.all(rows[count] <= rows[last]):
                    last = count
            population[pick], known[pick] = prefixes[last], rows[last]
        return _ranked(state, population, known)


def _candidate(encoding: VariationalEncoding, genome: VariationalGenome) -> Candidate[VariationalGenome]:
    return Candidate(genome, encoding.decode(genome), encoding.parameters(genome))


def _ranked(state: VariationalState, members: Sequence[Member], functionals: Floats) -> VariationalState:
    """The state with these members, all ranked anew."""
    ranks = frozen(domination_ranks(functionals))
    return replace(state, population=tuple(members), functionals=frozen(functionals), ranks=ranks)


def _joined(state: VariationalState, children: Sequence[Member], functionals: Floats) -> VariationalState:
    """Children one after another: each takes the place of the worst member, but never the first, if it ranks better."""
    population, known, ranks = list(state.population), state.functionals.copy(), state.ranks.copy()
    for child, row in zip(children, functionals, strict=True):
        worst = 1 + int(np.argmax(ranks[1:]))
        rank = int(dominates(known, row).sum())
        if rank < ranks[worst]:
            ranks += dominates(row, known).astype(np.int32) - dominates(known[worst], known).astype(np.int32)
            ranks[worst] = rank  # the worst does not dominate the child, or it would have the lower rank
            population[worst], known[worst] = child, row
    return replace(state, population=tuple(population), functionals=frozen(known), ranks=frozen(ranks))


def _distinct_front(state: VariationalState) -> list[bool]:
    """Who is dominated by none and no copy of an earlier such member; the first always."""
    kept: list[int] = []
    for index in np.flatnonzero(state.ranks == 0).tolist():
        row = state.functionals[index]
        if np.isfinite(row).all() and all(
            np.abs(row - state.functionals[other]).max() > NEAR for other in kept
        ):
            kept.append(index)
    return [index == 0 or index in kept for index in range(len(state.population))]
