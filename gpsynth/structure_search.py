"""Structure and numbers searched together: variation changes formulas, CMA-ES tunes the numbers of the best ones.

A generation holds new formulas and the next samples of a CMA-ES that belongs to each of the best formulas found so
far. Both compete by the same costs in the same batch, so the budget goes where improvement is: a formula stays tuned
only while it stays among the best.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import inf
from typing import Any, Generic, TypeVar

import numpy as np

from gpsynth.arrays import Floats
from gpsynth.checks import check_kind, check_number, check_whole
from gpsynth.encodings.protocol import Encoding
from gpsynth.errors import OptimizerError
from gpsynth.optimizers import CMAES, CMAESState
from gpsynth.program import Program

G = TypeVar("G")

TRIES = 100  # least number of formulas drawn for a generation


@dataclass(frozen=True, eq=False)
class Candidate(Generic[G]):
    """A formula under one parameter vector; candidates that share a program stand side by side in a batch."""

    genome: G
    program: Program
    values: Floats  # (p,)
    bound: float = inf  # a mean cost above it counts like infinity


Cost = Callable[[Sequence[Candidate[Any]]], Floats]  # (batch, S), one row a candidate


@dataclass(frozen=True, eq=False)
class Individual(Generic[G]):
    """A formula with the best numbers known for it."""

    genome: G
    program: Program
    values: Floats  # (p,)
    cases: Floats  # (S,) cost from each start
    born: int  # generation in which its oldest ancestor was drawn at random
    tuner: CMAESState | None = None
    idle: int = 0  # generations of tuning without improvement

    @cached_property
    def cost(self) -> float:
        """Mean cost over the starts."""
        return float(self.cases.mean())

    @property
    def complexity(self) -> int:
        """Instructions of the program."""
        return self.program.complexity


@dataclass(frozen=True, eq=False)
class SearchState(Generic[G]):
    """Population by rising cost, Pareto front over (cost, complexity), and what the waiting batch is made of."""

    population: tuple[Individual[G], ...]
    front: tuple[Individual[G], ...]
    tuned: tuple[
        tuple[Individual[G], CMAESState, int], ...
    ] = ()  # individual, waiting tuner, number of samples
    born: tuple[int, ...] = ()  # of each new formula: generation of its oldest ancestor
    generation: int = 0

    def bound(self, born: int) -> float:
        """The highest cost among those no older than `born`: who costs more does not stay for long."""
        costs = (individual.cost for individual in self.population if individual.born >= born)
        return max(costs, default=inf)

    @cached_property
    def specialists(self) -> "_Specialists":
        """The population as epsilon-lexicase selection sees it."""
        return _Specialists.of(self.population)


@dataclass(frozen=True)
class StructureSearch(Generic[G]):
    """An evolutionary search over the formulas of an encoding; satisfies `optimizers.protocol.Search`.

    Costs are (batch, S), one for each start; complexity is known without evaluation. Raises OptimizerError for
    settings out of their range.
    """

    encoding: Encoding[G]
    population: int = 200
    offspring: int = 200  # new formulas in a generation
    tuned: int = 4  # formulas under CMA-ES
    tournament: int = 4
    simple: float = 0.1  # probability that a parent is one of the front
    lexicase: float = 0.4  # probability that a parent is chosen by epsilon-lexicase
    crossover: float = 0.5  # probability that an offspring has two parents
    fresh: float = 0.1  # probability that an offspring is random
    youth: float = 0.25  # share of the population that is kept for being good for its age
    patience: int = 12  # generations of tuning without improvement before another formula gets the place
    seeds: tuple[G, ...] = ()  # formulas to begin with

    def __post_init__(self) -> None:
        check_kind("encoding", self.encoding, Encoding, error=OptimizerError)
        for name in ("population", "offspring", "tournament", "patience"):
            check_whole(name, getattr(self, name), 1, OptimizerError)
        check_whole("tuned", self.tuned, 0, OptimizerError)
        for name in ("simple", "lexicase", "crossover", "fresh", "youth"):
            value = getattr(self, name)
            check_number(name, value, OptimizerError)
            if not 0.0 <= value <= 1.0:
                raise OptimizerError(f"{name} must be from 0 to 1, not {value}")

    def init(self, rng: np.random.Generator) -> SearchState[G]:
        """Nothing is known yet."""
        return SearchState((), ())

    def ask(
        self, state: SearchState[G], rng: np.random.Generator
    ) -> tuple[tuple[Candidate[G], ...], SearchState[G]]:
        """New formulas, and the samples of the tuners."""
        tuned = []
        new = self._new(state, rng)
        full = len(state.population) == self.population
        bounds = {born: state.bound(born) if full else inf for born in {born for *_, born in new}}
        batch = [
            Candidate(genome, program, self.encoding.parameters(genome), bounds[born])
            for genome, program, born in new
        ]
        for individual in self._to_tune(state):
            tuner = self._tuner(individual)
            begun = tuner.init(rng) if individual.tuner is None else individual.tuner
            samples, waiting = tuner.ask(begun, rng)
            batch += [Candidate(individual.genome, individual.program, values) for values in samples]
            tuned.append((individual, waiting, len(samples)))
        return tuple(batch), replace(state, born=tuple(born for *_, born in new), tuned=tuple(tuned))

    def tell(
        self, state: SearchState[G], candidates: Sequence[Candidate[G]], costs: Floats
    ) -> SearchState[G]:
        """The best of old and new formulas, no two with the same cost; numbers of tuned ones improved."""
        known = {individual.program: individual for individual in state.population}
        means = np.where(np.isfinite(costs).all(axis=1), costs.mean(axis=1), inf)
        for k, born in enumerate(state.born):
            new = candidates[k]
            if np.isfinite(means[k]):
                known[new.program] = Individual(new.genome, new.program, new.values, costs[k], born)
        first = len(state.born)
        for individual, waiting, count in state.tuned:
            asked = slice(first, first + count)
            improved = self._tuned(individual, waiting, candidates[asked], means[asked], costs[asked])
            known[individual.program] = improved
            first += count
        return self._state(known.values(), state.front, state.generation + 1)

    def merged(self, states: Sequence[SearchState[G]]) -> SearchState[G]:
        """One search that goes on with the best of several, between generations."""
        individuals = [individual for state in states for individual in state.population]
        front = [individual for state in states for individual in state.front]
        return self._state(individuals, front, max(state.generation for state in states))

    def best(self, state: SearchState[G]) -> tuple[Individual[G] | None, float]:
        """The formula of least cost."""
        return (state.population[0], state.population[0].cost) if state.population else (None, inf)

    def stop(self, state: SearchState[G]) -> str:
        """Whether formulas run out shows when they are asked for."""
        return ""

    def _state(
        self, individuals: Iterable[Individual[G]], front: Sequence[Individual[G]], generation: int
    ) -> SearchState[G]:
        ordered = sorted(individuals, key=lambda individual: (individual.cost, individual.complexity))
        distinct = _distinct(ordered)
        survivors = _survivors(distinct, self.population, round(self.youth * self.population))
        return SearchState(survivors, pareto((*front, *distinct)), generation=generation)

    def _new(self, state: SearchState[G], rng: np.random.Generator) -> list[tuple[G, Program, int]]:
        """Offspring whose programs are not in the population; a small grammar may have no more."""
        wanted = self.offspring if state.population else self.population
        known = {individual.program for individual in state.population}
        found: list[tuple[G, Program, int]] = []
        waiting = list(self.seeds) if not state.population else []
        for _ in range(max(4 * wanted, TRIES)):
            genome, born = (waiting.pop(), state.generation) if waiting else self._child(state, rng)
            program = self.encoding.decode(genome)
            if program not in known:
                known.add(program)
                found.append((genome, program, born))
            if len(found) == wanted:
                break
        return found

    def _child(self, state: SearchState[G], rng: np.random.Generator) -> tuple[G, int]:
        """A genome and the generation of its oldest ancestor."""
        if not state.population or rng.random() < self.fresh:
            return self.encoding.random(rng), state.generation
        parent = self._parent(state, rng)
        genome = self.encoding.with_parameters(parent.genome, parent.values)
        if rng.random() < self.crossover:
            other = self._parent(state, rng)
            theirs = self.encoding.with_parameters(other.genome, other.values)
            children = self.encoding.crossover(genome, theirs, rng)
            return children[int(rng.integers(2))], min(parent.born, other.born)
        for _ in range(int(rng.integers(1, 4))):
            genome = self.encoding.mutate(genome, rng)
        return genome, parent.born

    def _parent(self, state: SearchState[G], rng: np.random.Generator) -> Individual[G]:
        """One of the front, since small formulas are good material, a winner of a tournament, or a specialist."""
        draw = rng.random()
        if draw < self.simple:
            return state.front[int(rng.integers(len(state.front)))]
        if draw < self.simple + self.lexicase and len(state.population[0].cases) > 1:
            return state.population[state.specialists.draw(rng)]
        return state.population[int(rng.integers(len(state.population), size=self.tournament).min())]

    def _to_tune(self, state: SearchState[G]) -> list[Individual[G]]:
        """The best formulas with numbers that still improve, small ones of the front among them."""
        ranked = (*state.population[: 2 * self.tuned], *state.front)
        unique = {
            individual.program: individual for individual in ranked if _uses_parameters(individual.program)
        }
        lively = [individual for individual in unique.values() if individual.idle < self.patience]
        return lively[: self.tuned]

    def _tuner(self, individual: Individual[G]) -> CMAES:
        space, size = self.encoding.space, len(individual.values)
        lower, upper = np.full(size, space.lower), np.full(size, space.upper)
        return CMAES(lower, upper, x0=individual.values, sigma=0.05, restarts=0)

    def _tuned(
        self,
        individual: Individual[G],
        waiting: CMAESState,
        asked: Sequence[Candidate[G]],
        means: Floats,
        costs: Floats,
    ) -> Individual[G]:
        tuner = self._tuner(individual)
        learned = tuner.tell(waiting, np.array([candidate.values for candidate in asked]), means)
        best = int(np.argmin(means))
        if not means[best] < individual.cost:
            ended = self.patience if tuner.stop(learned) else individual.idle + 1
            return replace(individual, tuner=learned, idle=ended)
        return replace(individual, tuner=learned, idle=0, values=asked[best].values, cases=costs[best])


def _uses_parameters(program: Program) -> bool:
    first = len(program.inputs)
    return bool(
        np.any((program.code[:, 1:] >= first) & (program.code[:, 1:] < first + len(program.parameters)))
    )


@dataclass(frozen=True, eq=False)
class _Specialists:
    """Epsilon-lexicase selection (La Cava et al. 2016), epsilon being the median deviation in the population."""

    cases: Floats  # (individuals, S)
    epsilon: Floats  # (S,)

    @classmethod
    def of(cls, population: Sequence[Individual[G]]) -> "_Specialists":
        cases = np.array([individual.cases for individual in population])
        return cls(cases, np.median(np.abs(cases - np.median(cases, axis=0)), axis=0))

    def draw(self, rng: np.random.Generator) -> int:
        """Starts come up in random order, and who is near the best of those left stays, until one is left."""
        left = np.arange(len(self.cases))
        for case in rng.permutation(self.cases.shape[1]):
            column = self.cases[left, case]
            left = left[column <= column.min() + self.epsilon[case]]
            if len(left) == 1:
                break
        return int(left[int(rng.integers(len(left)))])


def _survivors(ordered: Sequence[Individual[G]], count: int, young: int) -> tuple[Individual[G], ...]:
    """The cheapest, and beside them `young` individuals by age and cost (Schmidt & Lipson 2011).

    Of these an old one must be better than every younger one to stay, so that new starts are not crowded out before
    they have had time to improve.
    """
    kept, left = list(ordered[: count - young]), list(ordered[count - young :])
    while left and len(kept) < count:
        youngest = -1
        front: list[Individual[G]] = []
        rest: list[Individual[G]] = []
        for individual in left:
            (front if individual.born > youngest else rest).append(individual)
            youngest = max(youngest, individual.born)
        kept += front
        left = rest
    return tuple(sorted(kept[:count], key=lambda individual: (individual.cost, individual.complexity)))


def _distinct(ordered: Sequence[Individual[G]]) -> list[Individual[G]]:
    """Without individuals that cost the same as a simpler one: equal behavior written differently."""
    kept: list[Individual[G]] = []
    for individual in ordered:
        if not kept or individual.cost > kept[-1].cost:
            kept.append(individual)
    return kept


def pareto(individuals: Sequence[Individual[G]]) -> tuple[Individual[G], ...]:
    """Those that no simpler or equally simple one undercuts, by rising complexity."""
    front: list[Individual[G]] = []
    for individual in sorted(individuals, key=lambda each: (each.complexity, each.cost)):
        if not front or individual.cost < front[-1].cost:
            front.append(individual)
    return tuple(front)
