"""Variational genetic programming: small variations of one basic solution, and numbers beside them (Diveev 2012)."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import numpy.typing as npt

from gpsynth.arrays import Floats, Ints
from gpsynth.checks import check_kind
from gpsynth.encodings.checks import checked_at_least, checked_names, checked_operations
from gpsynth.encodings.gray import crossed, moved
from gpsynth.encodings.network_operator_basis import basic_operator
from gpsynth.encodings.network_operator_matrix import ROBOT_OPERATIONS
from gpsynth.encodings.parameters import ParameterSpace, Values
from gpsynth.encodings.solution import Functions, Solution, Variation
from gpsynth.errors import EncodingError
from gpsynth.program import Program

_TRIES = 20  # at a variation that changes the solution


@dataclass(frozen=True)
class VariationalGenome:
    """What to change in the basic solution, in this order, and the parameters."""

    variations: tuple[Variation, ...]
    values: Values


@dataclass(frozen=True)
class VariationalEncoding:
    """Lists of `n_variations` small variations of `basis`, a network operator if none is given (`basic_operator`).

    Operations are those that variations may bring in; the basis may have others. Parameters are real numbers, or, with
    `gray_bits`, numbers of that many bits in Gray code, which crossover cuts and mutation flips.
    """

    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    operations: tuple[str, ...] = ROBOT_OPERATIONS
    space: ParameterSpace = ParameterSpace()
    basis: Solution | None = None
    n_variations: int = 8
    gray_bits: int = 0

    def __post_init__(self) -> None:
        checked_names(self.inputs, self.outputs)
        checked_operations(self.operations)
        check_kind("space of an encoding", self.space, ParameterSpace, error=EncodingError)
        checked_at_least("n_variations", self.n_variations, 1)
        checked_at_least("gray_bits", self.gray_bits, 0)
        expected = len(self.inputs), self.space.count, len(self.outputs)
        if self.basis is None:
            object.__setattr__(self, "basis", basic_operator(*expected))
        if not hasattr(self.basis, "counts"):
            raise EncodingError(f"basis must be a basic solution or None, got {self.basis!r}")
        if self._basis.counts != expected:
            came = self._basis.counts
            raise EncodingError(
                f"the basic solution has {came[0]} inputs, {came[1]} parameters and {came[2]} outputs; "
                f"expected {expected[0]}, {expected[1]} and {expected[2]}"
            )
        self._basis.functions(self.operations)  # raises if the basis cannot have one of them

    def basic(self, values: npt.ArrayLike | None = None) -> VariationalGenome:
        """The basic solution itself, with parameters of 1, or as near to it as the bounds allow, or those given."""
        ones = np.full(self.space.count, self.space.nearest(1.0))
        parameters = self.space.checked(ones if values is None else values, self.space.count)
        return VariationalGenome((self._basis.identity,) * self.n_variations, parameters)

    def rebased(self, genome: VariationalGenome) -> "VariationalEncoding":
        """The encoding of the next epoch, whose basic solution is this genome's."""
        return replace(self, basis=self._basis.with_entries(self._entries(genome.variations)))

    def random(self, rng: np.random.Generator) -> VariationalGenome:
        """Variations each of which changes what those before it have left."""
        entries, variations = self._basis.entries, []
        for _ in range(self.n_variations):
            variation, entries = self._effective(entries, rng)
            variations.append(variation)
        return VariationalGenome(tuple(variations), self.space.random(rng, self.space.count))

    def mutate(self, genome: VariationalGenome, rng: np.random.Generator) -> VariationalGenome:
        """One variation replaced by another that changes the solution, or one parameter moved."""
        if self.space.moves(genome.values, rng):
            return replace(genome, values=moved(genome.values, self.gray_bits, self.space, rng))
        return replace(genome, variations=self._replaced(genome.variations, rng))

    def mutate_both(self, genome: VariationalGenome, rng: np.random.Generator) -> VariationalGenome:
        """One variation replaced and one parameter, if there is any, moved: the mutation of the robot programs."""
        values = moved(genome.values, self.gray_bits, self.space, rng) if genome.values else ()
        return VariationalGenome(self._replaced(genome.variations, rng), values)

    def crossover(
        self, a: VariationalGenome, b: VariationalGenome, rng: np.random.Generator
    ) -> tuple[VariationalGenome, VariationalGenome]:
        """One of the two pairs of `children`: with the parents' structures, or with crossed ones."""
        family = self.children(a, b, rng)
        return family[:2] if rng.random() < 0.5 else family[2:]

    def children(
        self, a: VariationalGenome, b: VariationalGenome, rng: np.random.Generator
    ) -> tuple[VariationalGenome, VariationalGenome, VariationalGenome, VariationalGenome]:
        """The four children of one cut through the variations and one through the parameters."""
        cut = int(rng.integers(self.n_variations + 1))
        ours, theirs = crossed(a.values, b.values, self.gray_bits, self.space, rng)
        return (
            replace(a, values=ours),
            replace(b, values=theirs),
            VariationalGenome(a.variations[:cut] + b.variations[cut:], ours),
            VariationalGenome(b.variations[:cut] + a.variations[cut:], theirs),
        )

    def trimmed(self, genome: VariationalGenome, count: int) -> VariationalGenome:
        """The first `count` variations; nothing is changed after them."""
        rest = (self._basis.identity,) * (self.n_variations - count)
        return replace(genome, variations=genome.variations[:count] + rest)

    def decode(self, genome: VariationalGenome) -> Program:
        """The varied solution as a program; nodes start with their first operand, not with their unit."""
        return self._basis.program(self._entries(genome.variations), self.inputs, self.outputs)

    def parameters(self, genome: VariationalGenome) -> Floats:
        """The parameters, (count,)."""
        return np.array(genome.values, dtype=np.float64)

    def with_parameters(self, genome: VariationalGenome, values: npt.ArrayLike) -> VariationalGenome:
        """The same variations with other parameters."""
        return replace(genome, values=self.space.checked(values, self.space.count))

    def check(self, genome: VariationalGenome) -> None:
        """Raises EncodingError unless every variation is one that this encoding could have drawn."""
        if len(genome.variations) != self.n_variations:
            raise EncodingError(f"expected {self.n_variations} variations, got {len(genome.variations)}")
        for index, variation in enumerate(genome.variations):
            if not self._basis.contains(variation, self._functions):
                raise EncodingError(
                    f"variation {index} is {tuple(variation)}, which is none of this encoding"
                )
        self.space.checked(genome.values, self.space.count)

    @property
    def _basis(self) -> Solution:
        assert self.basis is not None
        return self.basis

    @cached_property
    def _functions(self) -> Functions:
        return self._basis.functions(self.operations)

    def _entries(self, variations: tuple[Variation, ...]) -> Ints:
        return self._basis.varied(self._basis.entries, variations)

    def _replaced(self, variations: tuple[Variation, ...], rng: np.random.Generator) -> tuple[Variation, ...]:
        place = int(rng.integers(self.n_variations))
        before, after = variations[:place], variations[place + 1 :]
        variation, _ = self._effective(self._entries(before), rng)
        return (*before, variation, *after)

    def _effective(self, entries: Ints, rng: np.random.Generator) -> tuple[Variation, Ints]:
        """A random variation that changes the entries, where one is found, and the changed entries."""
        for _ in range(_TRIES):
            variation = self._basis.draw(entries, self._functions, rng)
            varied = self._basis.varied(entries, (variation,))
            if not np.array_equal(varied, entries):
                return variation, varied
        return self._basis.identity, entries
