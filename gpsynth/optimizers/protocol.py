"""What a search is: settings are frozen, state is a value, randomness comes in as an argument."""

from collections.abc import Sized
from typing import Protocol, TypeVar

import numpy as np

from gpsynth.arrays import Floats

S = TypeVar("S")
Batch = TypeVar("Batch", bound=Sized)
Candidate_co = TypeVar("Candidate_co", covariant=True)


class Search(Protocol[S, Batch, Candidate_co]):
    """A search over anything, numbers or structures: all that `minimize` needs to know.

    A state holds arrays, numbers and texts only, so that a checkpoint can be written field by field. Costs have
    one row per candidate; a row that is not finite counts as the worst cost there is.
    """

    def init(self, rng: np.random.Generator) -> S:
        """The state before the first generation."""
        ...

    def ask(self, state: S, rng: np.random.Generator) -> tuple[Batch, S]:
        """The next candidates to evaluate, and the state that waits for their costs; none end the run."""
        ...

    def tell(self, state: S, candidates: Batch, costs: Floats) -> S:
        """The state that has learned the costs of the candidates just asked for."""
        ...

    def best(self, state: S) -> tuple[Candidate_co, float]:
        """The best candidate so far and its cost; +inf while no cost was finite."""
        ...

    def stop(self, state: S) -> str:
        """Why to go no further, or an empty text."""
        ...


class Optimizer(Search[S, Floats, Floats], Protocol[S]):
    """A search over the vectors of a box: candidates are (batch, d), every one inside."""

    @property
    def lower(self) -> Floats:
        """The least coordinates, (d,)."""
        ...

    @property
    def upper(self) -> Floats:
        """The greatest coordinates, (d,)."""
        ...
