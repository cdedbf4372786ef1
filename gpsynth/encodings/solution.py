"""What a basic solution is: integers that say a formula, changed by small variations one at a time (Diveev 2012)."""

from typing import Protocol, Self

import numpy as np

from gpsynth.arrays import Ints
from gpsynth.program import Program

Variation = tuple[int, ...]
Functions = tuple[tuple[int, ...], ...]  # numbers of the functions on offer of one operand, of two, of three


class Solution(Protocol):
    """A structure of any kind whose every variation is a valid structure again.

    Entries come in and go out beside the solution, so that a search may vary them without validating each copy.
    """

    @property
    def entries(self) -> Ints:
        """The numbers that variations change."""
        ...

    @property
    def counts(self) -> tuple[int, int, int]:
        """How many inputs, parameters and outputs the formula has."""
        ...

    @property
    def identity(self) -> Variation:
        """The variation that changes nothing."""
        ...

    def functions(self, operations: tuple[str, ...]) -> Functions:
        """The numbers of these operations; raises EncodingError if this kind of structure cannot have one."""
        ...

    def draw(self, entries: Ints, functions: Functions, rng: np.random.Generator) -> Variation:
        """A random variation; it may be one that changes nothing."""
        ...

    def varied(self, entries: Ints, variations: tuple[Variation, ...]) -> Ints:
        """A copy of the entries after these variations in their order."""
        ...

    def contains(self, variation: Variation, functions: Functions) -> bool:
        """Whether `draw` could have given this variation, or it is the identity."""
        ...

    def with_entries(self, entries: Ints) -> Self:
        """The solution with these entries; raises EncodingError if it is not a valid one."""
        ...

    def program(self, entries: Ints, inputs: tuple[str, ...], outputs: tuple[str, ...]) -> Program:
        """The formula of entries known to be valid."""
        ...
