"""The variational network operator: small variations of one basic solution, and numbers beside them (Diveev 2012)."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import numpy.typing as npt

from gpsynth.arrays import Floats, Ints
from gpsynth.encodings.checks import checked_at_least, checked_names, checked_operations
from gpsynth.encodings.gray import crossed, moved
from gpsynth.encodings.network_operator_basis import ADD, IDENTITY_EDGE, basic_operator
from gpsynth.encodings.network_operator_matrix import Matrix, decode_entries
from gpsynth.encodings.parameters import ParameterSpace, Values
from gpsynth.encodings.variations import (
    DELETE_EDGE,
    IDENTITY,
    REPLACE_BINARY,
    Variation,
    random_variation,
    vary,
)
from gpsynth.errors import EncodingError
from gpsynth.operations import BINARY_BY_NUMBER, UNARY_BY_NUMBER, operation
from gpsynth.program import Program

ROBOT_OPERATIONS: tuple[str, ...] = (
    *(UNARY_BY_NUMBER[number].name for number in (*range(1, 20), 23)),
    *(BINARY_BY_NUMBER[number].name for number in (1, 2)),
)  # those of the mobile robots, 2016 and 2022
_TRIES = 20  # at a variation that changes the matrix


@dataclass(frozen=True)
class NetworkOperatorGenome:
    """What to change in the basic matrix, in this order, and the parameters."""

    variations: tuple[Variation, ...]
    values: Values


@dataclass(frozen=True)
class NetworkOperatorEncoding:
    """Lists of `n_variations` small variations of the matrix `basis`, by default `basic_operator`.

    Operations are those that variations may bring in; the matrix they start from may have others. Parameters are real
    numbers, or, with `gray_bits`, numbers of that many bits in Gray code, which crossover cuts and mutation flips.
    """

    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    operations: tuple[str, ...] = ROBOT_OPERATIONS
    space: ParameterSpace = ParameterSpace()
    basis: Matrix | None = None
    n_variations: int = 8
    gray_bits: int = 0

    def __post_init__(self) -> None:
        checked_names(self.inputs, self.outputs)
        checked_operations(self.operations)
        checked_at_least("n_variations", self.n_variations, 1)
        checked_at_least("gray_bits", self.gray_bits, 0)
        for name in self.operations:
            row = operation(name)
            if row.unary_number is None and row.binary_number is None:
                raise EncodingError(f"{name} is not a function of the network operator")
        n_inputs, n_outputs = len(self.inputs), len(self.outputs)
        if self.basis is None:
            object.__setattr__(self, "basis", basic_operator(n_inputs, self.space.count, n_outputs))
        counts = tuple(map(len, (self._basis.inputs, self._basis.parameters, self._basis.outputs)))
        if counts != (n_inputs, self.space.count, n_outputs):
            raise EncodingError(
                f"the basic matrix has {counts[0]} inputs, {counts[1]} parameters and {counts[2]} outputs; "
                f"expected {n_inputs}, {self.space.count} and {n_outputs}"
            )

    def basic(self, values: npt.ArrayLike | None = None) -> NetworkOperatorGenome:
        """The basic matrix itself, with parameters of 1, or as near to it as the bounds allow, or those given."""
        ones = np.full(self.space.count, self.space.nearest(1.0))
        parameters = self.space.checked(ones if values is None else values, self.space.count)
        return NetworkOperatorGenome((IDENTITY,) * self.n_variations, parameters)

    def random(self, rng: np.random.Generator) -> NetworkOperatorGenome:
        """Variations each of which changes the matrix that those before it have left."""
        psi, variations = self._basis.psi, []
        for _ in range(self.n_variations):
            variation, psi = self._effective(psi, rng)
            variations.append(variation)
        return NetworkOperatorGenome(tuple(variations), self.space.random(rng, self.space.count))

    def mutate(self, genome: NetworkOperatorGenome, rng: np.random.Generator) -> NetworkOperatorGenome:
        """One variation replaced by another that changes the matrix, or one parameter moved."""
        if self.space.moves(genome.values, rng):
            return replace(genome, values=moved(genome.values, self.gray_bits, self.space, rng))
        place = int(rng.integers(self.n_variations))
        before, after = genome.variations[:place], genome.variations[place + 1 :]
        variation, _ = self._effective(vary(self._basis.psi, before), rng)
        return replace(genome, variations=(*before, variation, *after))

    def crossover(
        self, a: NetworkOperatorGenome, b: NetworkOperatorGenome, rng: np.random.Generator
    ) -> tuple[NetworkOperatorGenome, NetworkOperatorGenome]:
        """One of the two pairs of `children`: with the parents' structures, or with crossed ones."""
        family = self.children(a, b, rng)
        return family[:2] if rng.random() < 0.5 else family[2:]

    def children(
        self, a: NetworkOperatorGenome, b: NetworkOperatorGenome, rng: np.random.Generator
    ) -> tuple[NetworkOperatorGenome, NetworkOperatorGenome, NetworkOperatorGenome, NetworkOperatorGenome]:
        """The four children of one cut through the variations and one through the parameters."""
        cut = int(rng.integers(self.n_variations + 1))
        ours, theirs = crossed(a.values, b.values, self.gray_bits, self.space, rng)
        return (
            replace(a, values=ours),
            replace(b, values=theirs),
            NetworkOperatorGenome(a.variations[:cut] + b.variations[cut:], ours),
            NetworkOperatorGenome(b.variations[:cut] + a.variations[cut:], theirs),
        )

    def decode(self, genome: NetworkOperatorGenome) -> Program:
        """The varied matrix as a program; nodes start with their first edge, not with their unit."""
        psi = vary(self._basis.psi, genome.variations)
        return decode_entries(psi, self._basis, self.inputs, self.outputs, strict=False)

    def parameters(self, genome: NetworkOperatorGenome) -> Floats:
        """The parameters, (count,)."""
        return np.array(genome.values, dtype=np.float64)

    def with_parameters(self, genome: NetworkOperatorGenome, values: npt.ArrayLike) -> NetworkOperatorGenome:
        """The same variations with other parameters."""
        return replace(genome, values=self.space.checked(values, self.space.count))

    def check(self, genome: NetworkOperatorGenome) -> None:
        """Raises EncodingError unless every variation is one that this encoding could have drawn."""
        if len(genome.variations) != self.n_variations:
            raise EncodingError(f"expected {self.n_variations} variations, got {len(genome.variations)}")
        for index, variation in enumerate(genome.variations):
            if not self._contains(variation):
                raise EncodingError(
                    f"variation {index} is {tuple(variation)}, which is none of this encoding"
                )
        self.space.checked(genome.values, self.space.count)

    @property
    def _basis(self) -> Matrix:
        assert self.basis is not None
        return self.basis

    @cached_property
    def _unary(self) -> tuple[int, ...]:
        """Numbers of the offered unary functions; edges need one, so the identity where none is offered."""
        numbers = (operation(name).unary_number for name in self.operations)
        return tuple(number for number in numbers if number is not None) or (IDENTITY_EDGE,)

    @cached_property
    def _binary(self) -> tuple[int, ...]:
        """Numbers of the offered binary functions; addition where none is offered."""
        numbers = (operation(name).binary_number for name in self.operations)
        return tuple(number for number in numbers if number is not None) or (ADD,)

    def _effective(self, psi: Ints, rng: np.random.Generator) -> tuple[Variation, Ints]:
        """A random variation that changes the matrix, where one is found, and the changed matrix."""
        for _ in range(_TRIES):
            variation = random_variation(psi, rng, self._unary, self._binary)
            varied = vary(psi, (variation,))
            if not np.array_equal(varied, psi):
                return variation, varied
        return IDENTITY, psi

    def _contains(self, variation: Variation) -> bool:
        if not all(type(entry) is int for entry in variation):
            return False
        if variation == IDENTITY:
            return True
        kind, row, column, function = variation
        size = len(self._basis.psi)
        if kind == REPLACE_BINARY:
            return 0 <= row == column < size and function in self._binary
        return 0 <= kind <= DELETE_EDGE and 0 <= row < column < size and function in self._unary


def rebase(basis: Matrix, genome: NetworkOperatorGenome) -> Matrix:
    """The basic matrix of the next epoch: this genome's; variations start again from none."""
    return replace(basis, psi=vary(basis.psi, genome.variations))
