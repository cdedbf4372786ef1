"""What an encoding is: a space of structures with numbers beside them, each of which decodes to a program."""

from typing import Protocol, Self, TypeVar, runtime_checkable

import numpy as np
import numpy.typing as npt

from gpsynth.arrays import Floats
from gpsynth.encodings.parameters import ParameterSpace
from gpsynth.program import Program

G = TypeVar("G")


@runtime_checkable
class Encoding(Protocol[G]):
    """Settings of a space of formulas; genomes are values and are never changed in place.

    A genome is a frozen dataclass of tuples of numbers, so it has equality and a hash, and can be pickled or written
    field by field. The same generator state always gives the same genome.
    """

    @property
    def inputs(self) -> tuple[str, ...]:
        """Names of what the formulas are computed from."""
        ...

    @property
    def outputs(self) -> tuple[str, ...]:
        """Names of the formulas, one each."""
        ...

    @property
    def space(self) -> ParameterSpace:
        """How many numbers a genome may have, and between which bounds."""
        ...

    def random(self, rng: np.random.Generator) -> G:
        """A genome from anywhere in the space."""
        ...

    def mutate(self, genome: G, rng: np.random.Generator) -> G:
        """A neighbor: one change of the structure or of the numbers."""
        ...

    def crossover(self, a: G, b: G, rng: np.random.Generator) -> tuple[G, G]:
        """Two genomes made of pieces of both."""
        ...

    def decode(self, genome: G) -> Program:
        """The program of a genome that passes `check`; its parameters are the genome's numbers, in order."""
        ...

    def parameters(self, genome: G) -> Floats:
        """The numbers, (p,); p may differ between genomes."""
        ...

    def with_parameters(self, genome: G, values: npt.ArrayLike) -> G:
        """The same structure with other numbers; raises EncodingError unless there are p, all within bounds."""
        ...

    def check(self, genome: G) -> None:
        """Raises EncodingError unless the genome belongs to this space, as one read from a file may not."""
        ...


@runtime_checkable
class Rebasable(Encoding[G], Protocol[G]):
    """An encoding whose genomes are changes to a basic solution, which a search may move."""

    def basic(self, values: npt.ArrayLike | None = None) -> G:
        """The genome that changes nothing, with these numbers."""
        ...

    def rebased(self, genome: G) -> Self:
        """The encoding whose basic solution is that of this genome."""
        ...
