"""Expression trees, one per output, generated, cut and joined by DEAP (Koza 1992; Fortin et al. 2012)."""

import random
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import cached_property
from threading import Lock

import numpy as np
import numpy.typing as npt
from deap import gp

from gpsynth.arrays import Floats
from gpsynth.builder import Builder, Reference
from gpsynth.checks import check_kind
from gpsynth.encodings.checks import checked_at_least, checked_names, checked_operations
from gpsynth.encodings.parameters import ParameterSpace, Values
from gpsynth.encodings.rules import Rules
from gpsynth.encodings.tree_changes import changed
from gpsynth.encodings.tree_constraints import Constraints, Meaning, constraints_of
from gpsynth.encodings.tree_of_program import trees_of
from gpsynth.errors import EncodingError
from gpsynth.operations import operation
from gpsynth.program import Program

_TRIES = 20  # at a random tree that is not too large
_NEW = "NEW"  # the terminal whose value is still to be drawn
_deap_lock = (
    Lock()
)  # DEAP draws from the one generator of the process, so one thread at a time may lend it ours


@dataclass(frozen=True)
class TreeGenome:
    """Trees in prefix order: input i is i, a number is n, operation k is n + 1 + k, where n counts the inputs."""

    trees: tuple[tuple[int, ...], ...]
    values: Values  # of the numbers, in the order of the trees


@dataclass(frozen=True)
class TreeEncoding:
    """One tree per output; subtrees that occur twice are computed once.

    A child that is higher than `max_height`, larger than `max_size` nodes or has more numbers than `space.count` is
    replaced by its parent; `rules` always hold. Where `symmetries` are given (+ or - for each input and output, one
    sign a symmetry) every formula keeps them; where `units` are, all units fit, numbers having any unit.
    """

    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    operations: tuple[str, ...]
    space: ParameterSpace = ParameterSpace()
    start_heights: tuple[int, int] = (1, 4)  # of random trees, ramped half-and-half
    grown_heights: tuple[int, int] = (0, 2)  # of the subtrees that mutation plants
    max_height: int = 10
    max_size: int = 60  # nodes per tree
    transfer: float = 0.5  # how often a crossover chooses the two outputs independently
    rules: Rules = Rules()
    symmetries: Mapping[str, str] | None = field(default=None, hash=False)  # of inputs and outputs
    units: Mapping[str, str] | None = field(default=None, hash=False)  # of inputs and outputs, to be kept

    def __post_init__(self) -> None:
        checked_names(self.inputs, self.outputs)
        checked_operations(self.operations)
        for name, kind in (("space", ParameterSpace), ("rules", Rules)):
            check_kind(f"{name} of an encoding", getattr(self, name), kind, error=EncodingError)
        for name in ("symmetries", "units"):
            check_kind(
                f"{name} of an encoding", getattr(self, name), Mapping, error=EncodingError, optional=True
            )
        checked_at_least("max_height", self.max_height, 0)
        checked_at_least("max_size", self.max_size, 1)
        _ = self._constraints  # checks rules and units
        for name in ("start_heights", "grown_heights"):
            low, high = getattr(self, name)
            if not 0 <= low <= high <= self.max_height:
                raise EncodingError(
                    f"{name} must rise from 0 or more to max_height {self.max_height}, not ({low}, {high})"
                )

    def random(self, rng: np.random.Generator) -> TreeGenome:
        """Trees grown half-and-half."""
        for _ in range(_TRIES):
            with _lent(rng):
                trees = [self._grown(output) for output in range(len(self.outputs))]
            genome = self._read(trees, rng)
            if len(genome.values) <= self.space.count and self._lawful(genome):
                return genome
        return self._smallest()

    def mutate(self, genome: TreeGenome, rng: np.random.Generator) -> TreeGenome:
        """A subtree replaced, a node replaced, inserted or taken out, or one number moved."""
        if self.space.moves(genome.values, rng):
            return replace(genome, values=self.space.moved(genome.values, rng))
        for _ in range(
            _TRIES if self._constraints.restrict else 1
        ):  # what breaks a constraint is often undone whole
            trees = self.to_deap(genome)
            index = int(rng.integers(len(trees)))
            with _lent(rng):
                number = self._number if self._extends else None
                trees[index] = changed(trees[index], self.primitives, self.grown_heights, number)
            child = self._child(trees, index, genome, rng)
            if child != genome:
                break
        return child

    def crossover(
        self, a: TreeGenome, b: TreeGenome, rng: np.random.Generator
    ) -> tuple[TreeGenome, TreeGenome]:
        """Two subtrees exchanged, mostly of one output; what helps one output may help another."""
        ours, theirs = self.to_deap(a), self.to_deap(b)
        i = j = int(rng.integers(len(ours)))
        if rng.random() < self.transfer:
            j = int(rng.integers(len(ours)))
        with _lent(rng):
            ours[i], theirs[j] = gp.cxOnePoint(ours[i], theirs[j])
        return self._child(ours, i, a, rng), self._child(theirs, j, b, rng)

    def from_program(self, program: Program, parameters: Sequence[float] = ()) -> TreeGenome:
        """The genome of a given formula: its parameters, with these values, and its constants become numbers.

        Raises EncodingError if the formula is not one of this space: other inputs, outputs or operations, too large.
        """
        if not set(program.inputs) <= set(self.inputs) or program.names != self.outputs:
            raise EncodingError(
                f"the formula maps {', '.join(program.inputs)} to {', '.join(program.names)}; "
                f"expected {', '.join(self.inputs)} to {', '.join(self.outputs)}"
            )
        trees = trees_of(program, parameters, self.inputs, self.operations, most=self.max_size)
        codes = tuple(tuple(map(self._code, tree)) for tree in trees)
        genome = TreeGenome(codes, tuple(item for tree in trees for item in tree if isinstance(item, float)))
        self.check(genome)
        return genome

    def decode(self, genome: TreeGenome) -> Program:
        """The trees as one program; each number is a parameter of its own."""
        builder = Builder(self.inputs, self.space.names(len(genome.values)))
        unread = list(builder.parameters)
        roots = [self._root(tree, builder, unread) for tree in reversed(genome.trees)]
        return builder.build(roots[::-1], self.outputs)

    def parameters(self, genome: TreeGenome) -> Floats:
        """The numbers in the trees, (p,)."""
        return np.array(genome.values, dtype=np.float64)

    def with_parameters(self, genome: TreeGenome, values: npt.ArrayLike) -> TreeGenome:
        """The same trees with other numbers."""
        return replace(genome, values=self.space.checked(values, len(genome.values)))

    def check(self, genome: TreeGenome) -> None:
        """Raises EncodingError unless the trees are complete and within the limits."""
        if len(genome.trees) != len(self.outputs):
            raise EncodingError(f"expected {len(self.outputs)} trees, got {len(genome.trees)}")
        known = len(self.inputs) + 1 + len(self.operations)
        for number, tree in enumerate(genome.trees):
            if not all(type(code) is int and 0 <= code < known for code in tree):
                raise EncodingError(f"tree {number} has a code that is not an integer in [0, {known})")
            if not self._complete(tree):
                raise EncodingError(f"tree {number} is not one complete tree")
        numbers = sum(tree.count(len(self.inputs)) for tree in genome.trees)
        if numbers > self.space.count:
            raise EncodingError(f"the trees have {numbers} numbers; at most {self.space.count} are allowed")
        self.space.checked(genome.values, numbers)
        for number, deap_tree in enumerate(self.to_deap(genome)):
            if not self._fits(deap_tree):
                size = self.rules.size(_operations(deap_tree))
                raise EncodingError(
                    f"tree {number} has height {deap_tree.height} and {size} nodes; "
                    f"at most {self.max_height} and {self.max_size} are allowed"
                )
            if len(self.rules.kept(_operations(deap_tree))) < len(deap_tree):
                raise EncodingError(f"tree {number} breaks a rule: {self.rules}")
        if not self._lawful(genome):
            raise EncodingError("the trees do not keep the symmetries or units of inputs and outputs")

    @cached_property
    def primitives(self) -> gp.PrimitiveSet:
        """DEAP's set: operations by name, inputs as ARG0, ARG1, ...; it only writes trees and computes nothing."""
        grammar = gp.PrimitiveSet("gpsynth", len(self.inputs))
        for name in self.operations:
            grammar.addPrimitive(None, operation(name).arity, name=name)
        if self.space.count > 0:
            grammar.addTerminal(None, name=_NEW)
        return grammar

    def to_deap(self, genome: TreeGenome) -> list[gp.PrimitiveTree]:
        """The trees as DEAP has them; numbers are terminals that hold their value."""
        values = iter(genome.values)
        return [
            gp.PrimitiveTree(
                [
                    gp.Terminal(next(values), False, object) if node is None else node
                    for node in (self._nodes[code] for code in tree)
                ]
            )
            for tree in genome.trees
        ]

    @cached_property
    def _nodes(self) -> tuple[gp.Primitive | gp.Terminal | None, ...]:
        """The node of each code; None where a number stands."""
        known = self.primitives.mapping
        inputs = [known[name] for name in self.primitives.arguments]
        return (*inputs, None, *[known[name] for name in self.operations])

    @cached_property
    def _codes(self) -> dict[str, int]:
        return {node.name: code for code, node in enumerate(self._nodes) if node is not None}

    def _arity(self, code: int) -> int:
        node = self._nodes[code]
        return 0 if node is None else int(node.arity)

    def _complete(self, tree: tuple[int, ...]) -> bool:
        missing = 1
        for code in tree:
            if missing == 0:
                return False
            missing += self._arity(code) - 1
        return missing == 0

    def _fits(self, tree: gp.PrimitiveTree) -> bool:
        small = self.rules.size(_operations(tree)) <= self.max_size
        return len(tree) > 0 and small and tree.height <= self.max_height

    def _obeying(self, tree: gp.PrimitiveTree, output: int) -> gp.PrimitiveTree:
        if not self._constraints.restrict:
            return tree
        factor = [self.primitives.mapping["mul"], self._number(1.0)] if self.units else []
        nodes = [(node, self._meaning(node)) for node in tree]
        return gp.PrimitiveTree(self._constraints.obeying(nodes, output, factor))

    def _lawful(self, genome: TreeGenome, only: int | None = None) -> bool:
        """Whether the trees, or that of one output, keep to rules, symmetries and units."""
        if not self._constraints.restrict:
            return True
        trees = [(k, tree) for k, tree in enumerate(self.to_deap(genome)) if only in (None, k)]
        return all(len(self._obeying(tree, output)) == len(tree) for output, tree in trees)

    def _meaning(self, node: gp.Primitive | gp.Terminal) -> Meaning:
        if isinstance(node, gp.Primitive):
            return str(node.name)
        return None if _is_number(node) or node.name == _NEW else self._codes[node.name]

    @cached_property
    def _constraints(self) -> Constraints:
        return constraints_of(
            self.rules, self.symmetries, self.units, (self.inputs, self.outputs), self.operations, self.space
        )

    def _smallest(self) -> TreeGenome:
        """One leaf for each output, with a factor where its unit needs one."""
        trees = []
        for output in range(len(self.outputs)):
            leaf = self._constraints.smallest(output)
            node = self._number(1.0) if leaf is None else self._nodes[leaf]
            meanings = map(self._meaning, self._obeying(gp.PrimitiveTree([node]), output))
            trees.append(tuple(self._code(1.0 if meaning is None else meaning) for meaning in meanings))
        numbers = sum(tree.count(len(self.inputs)) for tree in trees)
        return TreeGenome(tuple(trees), (self.space.nearest(1.0),) * numbers)

    def _code(self, item: str | int | float) -> int:
        """The code of an operation, an input's index or a number."""
        if isinstance(item, str):
            return len(self.inputs) + 1 + self.operations.index(item)
        return item if isinstance(item, int) else len(self.inputs)

    @cached_property
    def _extends(self) -> bool:
        return self.space.count > 0 and {"add", "mul"} <= set(self.operations)

    def _number(self, value: float) -> gp.Terminal:
        return gp.Terminal(self.space.nearest(value), False, object)

    def _grown(self, output: int) -> gp.PrimitiveTree:
        for _ in range(_TRIES):
            tree = gp.PrimitiveTree(gp.genHalfAndHalf(self.primitives, *self.start_heights))
            tree = self._obeying(tree, output)
            if self._fits(tree):
                return tree
        leaf = self._constraints.smallest(output)
        return gp.PrimitiveTree([self._number(1.0) if leaf is None else self._nodes[leaf]])

    def _child(
        self, trees: list[gp.PrimitiveTree], index: int, parent: TreeGenome, rng: np.random.Generator
    ) -> TreeGenome:
        trees[index] = self._obeying(trees[index], index)
        child = self._read(trees, rng)
        if not self._fits(trees[index]) or len(child.values) > self.space.count:
            return parent
        wanted = sum(isinstance(node, gp.Terminal) and self._meaning(node) is None for node in trees[index])
        # an input in place of a number that found no room may break what the tree kept to
        is_obeying = child.trees[index].count(len(self.inputs)) == wanted or self._lawful(child, index)
        return child if is_obeying else parent

    def _read(self, trees: list[gp.PrimitiveTree], rng: np.random.Generator) -> TreeGenome:
        """The genome of DEAP's trees; new numbers are drawn, or become inputs where there are enough of them."""
        room = self.space.count - sum(_is_number(node) for tree in trees for node in tree)
        number = len(self.inputs)
        values: list[float] = []
        coded: list[tuple[int, ...]] = []
        for tree in trees:
            codes: list[int] = []
            for node in tree:
                if _is_number(node):
                    codes.append(number)
                    values.append(node.value)
                elif node.name != _NEW:
                    codes.append(self._codes[node.name])
                elif room > 0:
                    room -= 1
                    codes.append(number)
                    values.extend(self.space.random(rng, 1))
                else:
                    codes.append(int(rng.integers(number)))
            coded.append(tuple(codes))
        return TreeGenome(tuple(coded), tuple(values))

    def _root(self, tree: tuple[int, ...], builder: Builder, unread: list[Reference]) -> Reference:
        """The value of a tree, read from its end; so are the numbers not yet read."""
        stack: list[Reference] = []
        number = len(self.inputs)
        for code in reversed(tree):
            if code < number:
                stack.append(builder.inputs[code])
            elif code == number:
                stack.append(unread.pop())
            else:
                arity = self._arity(code)
                operands = [stack.pop() for _ in range(arity)]
                stack.append(builder.apply(self.operations[code - number - 1], *operands))
        return stack[0]


def _operations(tree: gp.PrimitiveTree) -> list[str]:
    """The name of each node's operation, empty where a leaf stands."""
    return [node.name if isinstance(node, gp.Primitive) else "" for node in tree]


def _is_number(node: gp.Primitive | gp.Terminal) -> bool:
    return isinstance(node, gp.Terminal) and isinstance(node.value, float)


@contextmanager
def _lent(rng: np.random.Generator) -> Iterator[None]:
    """Makes DEAP draw from our generator, and leaves the process's own as it was."""
    with _deap_lock:
        state = random.getstate()
        random.seed(int(rng.integers(2**63)))
        try:
            yield
        finally:
            random.setstate(state)
