"""Cartesian genetic programming (Miller & Thomson 2000): a row of nodes, each taking what stands left of it."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal, TypeVar

import numpy as np
import numpy.typing as npt

from gpsynth.arrays import Floats, Ints
from gpsynth.builder import Builder
from gpsynth.checks import check_kind
from gpsynth.encodings.checks import checked_at_least, checked_names, checked_operations
from gpsynth.encodings.parameters import ParameterSpace, Values
from gpsynth.errors import EncodingError
from gpsynth.operations import operation
from gpsynth.program import Program

T = TypeVar("T")


@dataclass(frozen=True)
class CartesianGenome:
    """Per column a function gene and its connection genes, then one gene per output; and the numbers."""

    genes: tuple[int, ...]
    values: Values


@dataclass(frozen=True)
class CartesianEncoding:
    """One row of `columns` nodes, each of which may take any input, any parameter or any node left of it.

    A mutation without `gene_rate` redraws genes until one that matters has changed ("single" of Goldman & Punch 2013);
    with it, each gene is redrawn with that probability.
    """

    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    operations: tuple[str, ...]
    space: ParameterSpace = ParameterSpace()
    columns: int = 50
    gene_rate: float | None = None
    cut: Literal["uniform", "one_point"] = "uniform"  # which crossover

    def __post_init__(self) -> None:
        checked_names(self.inputs, self.outputs)
        checked_operations(self.operations)
        check_kind("space of an encoding", self.space, ParameterSpace, error=EncodingError)
        checked_at_least("columns", self.columns, 1)
        if self.gene_rate is not None and not 0 < self.gene_rate <= 1:
            raise EncodingError(f"gene_rate must lie in (0, 1], not {self.gene_rate}")
        if self.cut not in ("uniform", "one_point"):
            raise EncodingError(f"cut must be 'uniform' or 'one_point', not {self.cut!r}")

    def random(self, rng: np.random.Generator) -> CartesianGenome:
        """Every gene from its range."""
        genes = rng.integers(0, self._ranges)
        return CartesianGenome(tuple(genes.tolist()), self.space.random(rng, self.space.count))

    def mutate(self, genome: CartesianGenome, rng: np.random.Generator) -> CartesianGenome:
        """Some genes redrawn, or one number moved."""
        if self.space.moves(genome.values, rng):
            return replace(genome, values=self.space.moved(genome.values, rng))
        if self.gene_rate is None:
            return replace(genome, genes=self._until_active(genome, rng))
        redrawn = rng.random(len(genome.genes)) < self.gene_rate
        genes = np.where(redrawn, rng.integers(0, self._ranges), genome.genes)
        return replace(genome, genes=tuple(genes.tolist()))

    def crossover(
        self, a: CartesianGenome, b: CartesianGenome, rng: np.random.Generator
    ) -> tuple[CartesianGenome, CartesianGenome]:
        """Genes and numbers exchanged one by one, or behind one cut each."""
        genes = self._exchanged(a.genes, b.genes, rng)
        values = self._exchanged(a.values, b.values, rng)
        return CartesianGenome(genes[0], values[0]), CartesianGenome(genes[1], values[1])

    def decode(self, genome: CartesianGenome) -> Program:
        """The nodes that the outputs need, from left to right."""
        builder = Builder(self.inputs, self.space.names(self.space.count))
        values = [*builder.inputs, *builder.parameters] + [0] * self.columns
        genes, leaves, width = genome.genes, self._leaves, self._width
        for node in self._active(genome.genes):
            start = (node - leaves) * width
            name, arity = self._functions[genes[start]]
            operands = genes[start + 1 : start + 1 + arity]
            values[node] = builder.apply(name, *[values[operand] for operand in operands])
        return builder.build([values[node] for node in genes[self.columns * width :]], self.outputs)

    def parameters(self, genome: CartesianGenome) -> Floats:
        """The numbers, (count,)."""
        return np.array(genome.values, dtype=np.float64)

    def with_parameters(self, genome: CartesianGenome, values: npt.ArrayLike) -> CartesianGenome:
        """The same graph with other numbers."""
        return replace(genome, values=self.space.checked(values, self.space.count))

    def check(self, genome: CartesianGenome) -> None:
        """Raises EncodingError unless each gene is within its range."""
        if len(genome.genes) != len(self._ranges):
            raise EncodingError(f"expected {len(self._ranges)} genes, got {len(genome.genes)}")
        for index, (gene, most) in enumerate(zip(genome.genes, self._ranges.tolist(), strict=True)):
            if type(gene) is not int or not 0 <= gene < most:
                raise EncodingError(f"gene {index} is {gene!r}; expected an integer in [0, {most})")
        self.space.checked(genome.values, self.space.count)

    @cached_property
    def _functions(self) -> tuple[tuple[str, int], ...]:
        return tuple((name, operation(name).arity) for name in self.operations)

    @cached_property
    def _width(self) -> int:
        return 1 + max(arity for _, arity in self._functions)

    @cached_property
    def _leaves(self) -> int:
        return len(self.inputs) + self.space.count

    @cached_property
    def _ranges(self) -> Ints:
        nodes = self._leaves + np.arange(self.columns)
        columns = np.repeat(nodes[:, None], self._width, axis=1)
        columns[:, 0] = len(self.operations)
        outputs = np.full(len(self.outputs), self._leaves + self.columns)
        return np.concatenate([columns.ravel(), outputs]).astype(np.int32)

    def _active(self, genes: tuple[int, ...]) -> list[int]:
        """The nodes some output needs, left to right."""
        leaves, width = self._leaves, self._width
        needed = set(genes[self.columns * width :])
        for node in range(leaves + self.columns - 1, leaves - 1, -1):
            if node in needed:
                start = (node - leaves) * width
                needed.update(genes[start + 1 : start + 1 + self._functions[genes[start]][1]])
        return sorted(node for node in needed if node >= leaves)

    def _until_active(self, genome: CartesianGenome, rng: np.random.Generator) -> tuple[int, ...]:
        genes, first_output = list(genome.genes), self.columns * self._width
        nodes = set(self._active(genome.genes))
        while True:
            index = int(rng.integers(len(genes)))
            most = int(self._ranges[index])
            if most == 1:
                continue
            column, place = divmod(index, self._width)
            active = index >= first_output or (
                self._leaves + column in nodes and place <= self._functions[genome.genes[index - place]][1]
            )
            genes[index] = (genes[index] + int(rng.integers(1, most))) % most
            if active:
                return tuple(genes)

    def _exchanged(
        self, a: tuple[T, ...], b: tuple[T, ...], rng: np.random.Generator
    ) -> tuple[tuple[T, ...], tuple[T, ...]]:
        if self.cut == "one_point":
            place = int(rng.integers(len(a) + 1))
            return a[:place] + b[place:], b[:place] + a[place:]
        own = (rng.random(len(a)) < 0.5).tolist()
        pairs = [(x, y) if keep else (y, x) for keep, x, y in zip(own, a, b, strict=True)]
        return tuple(x for x, _ in pairs), tuple(y for _, y in pairs)
