"""Change of basis: every few generations the best formula becomes the basic solution that variations start from."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import inf
from typing import Generic, TypeVar

import numpy as np

from gpsynth.arrays import Floats
from gpsynth.checks import check_kind, check_whole
from gpsynth.encodings.protocol import Rebasable
from gpsynth.errors import OptimizerError
from gpsynth.structure_search import Candidate, Individual, SearchState, StructureSearch, pareto

G = TypeVar("G")


@dataclass(frozen=True, eq=False)
class EpochState(Generic[G]):
    """The search on the present basis and where it stands, and the front of all epochs."""

    search: StructureSearch[G]
    inner: SearchState[G]
    front: tuple[Individual[G], ...] = ()


@dataclass(frozen=True)
class Epochs(Generic[G]):
    """A structure search that moves its basis; satisfies `optimizers.protocol.Search`.

    After `every` generations the lists of variations that the population has are evaluated anew on the basis of its
    best member, which stays as the list that changes nothing, with its numbers. Raises OptimizerError for `every`
    below 1 and for an encoding without a basis.
    """

    search: StructureSearch[G]
    every: int = 10
    seeds: tuple[G, ...] = ()  # formulas to begin with, beside those of the search

    def __post_init__(self) -> None:
        check_kind("search", self.search, StructureSearch, error=OptimizerError)
        check_whole("every", self.every, 1, OptimizerError)
        if not isinstance(self.search.encoding, Rebasable):
            kind = type(self.search.encoding).__name__
            raise OptimizerError(f"epochs need an encoding with a basic solution; {kind} has none")

    def init(self, rng: np.random.Generator) -> EpochState[G]:
        """The first epoch, of which nothing is known yet."""
        search = replace(self.search, seeds=(*self.search.seeds, *self.seeds))
        return EpochState(search, search.init(rng))

    def ask(
        self, state: EpochState[G], rng: np.random.Generator
    ) -> tuple[tuple[Candidate[G], ...], EpochState[G]]:
        """What the search asks for, which after `every` generations is one on a new basis."""
        if state.inner.population and state.inner.generation >= self.every:
            search = _rebased(state.search, state.inner)
            state = replace(state, search=search, inner=search.init(rng))
        batch, inner = state.search.ask(state.inner, rng)
        return batch, replace(state, inner=inner)

    def tell(self, state: EpochState[G], candidates: Sequence[Candidate[G]], costs: Floats) -> EpochState[G]:
        """What the search learns, and the front of this and all former epochs."""
        inner = state.search.tell(state.inner, candidates, costs)
        return replace(state, inner=inner, front=pareto((*state.front, *inner.front)))

    def best(self, state: EpochState[G]) -> tuple[Individual[G] | None, float]:
        """The formula of least cost, of any epoch."""
        return (state.front[-1], state.front[-1].cost) if state.front else (None, inf)

    def stop(self, state: EpochState[G]) -> str:
        """Why the search would go no further."""
        return state.search.stop(state.inner)


def _rebased(search: StructureSearch[G], state: SearchState[G]) -> StructureSearch[G]:
    """The search on the basis of its best member, to begin with the population's own lists of variations."""
    encoding, (best, *others) = search.encoding, state.population
    assert isinstance(encoding, Rebasable)
    moved = encoding.rebased(best.genome)
    lists = [encoding.with_parameters(other.genome, other.values) for other in others]
    return replace(search, encoding=moved, seeds=(*reversed(lists), moved.basic(best.values)))
