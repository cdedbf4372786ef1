"""The network operator: a formula as an upper triangular matrix of function numbers (Diveev & Sofronova 2008).

Off the diagonal stands the unary function on the edge from row to column, on it the binary function with which the node
gathers its edges; 0 is no edge, or a source. Numbers are those of the 2022 library, binary functions from 1.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from gpsynth.arrays import Ints, frozen
from gpsynth.builder import Builder
from gpsynth.encodings.network_operator_values import node_values
from gpsynth.encodings.parameters import ParameterSpace
from gpsynth.encodings.solution import Functions, Variation
from gpsynth.encodings.variations import IDENTITY, is_variation, random_variation, vary
from gpsynth.errors import EncodingError
from gpsynth.operations import BINARY_BY_NUMBER, UNARY_BY_NUMBER, operation
from gpsynth.program import Program

MOST_NODES = 512
ADD, IDENTITY_EDGE = 1, 1  # numbers of a binary and a unary function
ROBOT_OPERATIONS: tuple[str, ...] = (
    *(UNARY_BY_NUMBER[number].name for number in (*range(1, 20), 23)),
    *(BINARY_BY_NUMBER[number].name for number in (1, 2)),
)  # those of the mobile robots, 2016 and 2022


@dataclass(frozen=True, eq=False)
class Matrix:
    """A network operator and which of its nodes are what, a `Solution`; raises EncodingError if it is not valid."""

    psi: Ints  # (L, L)
    inputs: tuple[int, ...]  # source nodes, in the order of the formula's inputs
    parameters: tuple[int, ...]  # source nodes
    outputs: tuple[int, ...]  # nodes that are no sources

    def __post_init__(self) -> None:
        given = np.asarray(self.psi)
        if given.ndim != 2 or given.shape[0] != given.shape[1] or given.size == 0:
            raise EncodingError(f"a network operator is a square matrix, not one of shape {given.shape}")
        if not np.issubdtype(given.dtype, np.integer):
            raise EncodingError(f"a network operator has integer entries, not {given.dtype}")
        if len(given) > MOST_NODES:
            raise EncodingError(f"{len(given)} nodes; at most {MOST_NODES} are allowed")
        object.__setattr__(self, "psi", frozen(given.astype(np.int32)))
        for name in ("inputs", "parameters", "outputs"):
            object.__setattr__(self, name, tuple(int(node) for node in getattr(self, name)))
        _check_nodes(self)
        _check_entries(self)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Matrix) and self._content() == other._content()

    def __hash__(self) -> int:
        return hash(self._content())

    @property
    def entries(self) -> Ints:
        """The matrix, (L, L)."""
        return self.psi

    @property
    def counts(self) -> tuple[int, int, int]:
        """How many inputs, parameters and outputs the formula has."""
        return len(self.inputs), len(self.parameters), len(self.outputs)

    @property
    def identity(self) -> Variation:
        """(0, 0, 0, 0)."""
        return IDENTITY

    def functions(self, operations: tuple[str, ...]) -> Functions:
        """Numbers of the unary and of the binary functions; raises EncodingError for one without a number."""
        return numbered(operations)

    def draw(self, entries: Ints, functions: Functions, rng: np.random.Generator) -> Variation:
        """One of four kinds of change: a unary or a binary function, an edge more, an edge less."""
        return random_variation(entries, functions, rng)

    def varied(self, entries: Ints, variations: tuple[Variation, ...]) -> Ints:
        """A copy of the entries after these variations; those whose guard fails are passed over."""
        return vary(entries, variations)

    def contains(self, variation: Variation, functions: Functions) -> bool:
        """Whether `draw` could have given this variation, or it is the identity."""
        return is_variation(variation, len(self.psi), functions)

    def with_entries(self, entries: Ints) -> "Matrix":
        """The same nodes under other functions; raises EncodingError if it is not a valid operator."""
        return replace(self, psi=entries)

    def program(self, entries: Ints, inputs: tuple[str, ...], outputs: tuple[str, ...]) -> Program:
        """The formula of valid entries; nodes start with their first edge, not with their unit."""
        return _program(entries, self, inputs, outputs, strict=False)

    def _content(self) -> tuple[object, ...]:
        return self.psi.shape, self.psi.tobytes(), self.inputs, self.parameters, self.outputs


def numbered(operations: tuple[str, ...]) -> Functions:
    """Network-operator numbers of the unary and of the binary functions among these operations.

    Edges and nodes need one each, so the identity and addition stand in where none is offered. Raises EncodingError
    for an operation without a number.
    """
    rows = [operation(name) for name in operations]
    for row in rows:
        if row.unary_number is None and row.binary_number is None:
            raise EncodingError(f"{row.name} is not a function of the network operator")
    unary = tuple(row.unary_number for row in rows if row.unary_number is not None)
    binary = tuple(row.binary_number for row in rows if row.binary_number is not None)
    return unary or (IDENTITY_EDGE,), binary or (ADD,)


def decode_matrix(
    matrix: Matrix,
    inputs: Sequence[str] | None = None,
    outputs: Sequence[str] | None = None,
    *,
    strict: bool = True,
) -> Program:
    """The formula of a matrix, without identity edges, nodes that no output needs, and repetitions.

    Strictly, every node starts from the unit of its function, as published; where that cannot be seen in the value (the
    sign of a zero apart) it is left out. Otherwise a node starts with its first edge: shorter, and the same unless a
    value exceeds 1e8 or the square of one underflows. Names default to x0, ... and u0, ...
    """
    names = tuple(inputs) if inputs is not None else tuple(f"x{k}" for k in range(len(matrix.inputs)))
    results = tuple(outputs) if outputs is not None else tuple(f"u{k}" for k in range(len(matrix.outputs)))
    for kind, given, nodes in (("inputs", names, matrix.inputs), ("outputs", results, matrix.outputs)):
        if len(given) != len(nodes):
            raise EncodingError(f"the matrix has {len(nodes)} {kind}, but {len(given)} names were given")
    return _program(matrix.psi, matrix, names, results, strict=strict)


def _program(
    psi: Ints, nodes: Matrix, inputs: tuple[str, ...], outputs: tuple[str, ...], *, strict: bool
) -> Program:
    """As `decode_matrix`, of entries known to be valid; `nodes` says which node is what."""
    builder = Builder(inputs, ParameterSpace.names(len(nodes.parameters)))
    sources = zip(nodes.inputs + nodes.parameters, builder.inputs + builder.parameters, strict=True)
    values = node_values(builder, psi, dict(sources), nodes.outputs, strict=strict)
    return builder.build([values[node] for node in nodes.outputs], outputs)


def _check_nodes(matrix: Matrix) -> None:
    size = len(matrix.psi)
    sources = matrix.inputs + matrix.parameters
    for node in sources + matrix.outputs:
        if not 0 <= node < size:
            raise EncodingError(f"node {node} does not exist; the matrix has nodes 0 to {size - 1}")
    if len(set(sources)) < len(sources):
        raise EncodingError(f"inputs {matrix.inputs} and parameters {matrix.parameters} share a node")
    if not matrix.inputs or not matrix.outputs:
        raise EncodingError("a network operator needs an input and an output")
    for node in matrix.outputs:
        if node in sources:
            raise EncodingError(f"output node {node} is a source; an output must have incoming edges")
    for node, function in enumerate(np.diagonal(matrix.psi).tolist()):
        if node in sources and function != 0:
            raise EncodingError(f"node {node} is a source, so its diagonal entry must be 0, not {function}")
        if node not in sources and function == 0:
            raise EncodingError(f"node {node} has 0 on the diagonal but is neither an input nor a parameter")


def _check_entries(matrix: Matrix) -> None:
    psi = matrix.psi
    diagonal = np.diagonal(psi)
    for row, column in np.argwhere(np.tril(psi, -1)):
        raise EncodingError(
            f"entry [{row}, {column}] is {psi[row, column]}; below the diagonal all must be 0"
        )
    for row, column in np.argwhere((psi < 0) | (psi > len(UNARY_BY_NUMBER))):
        raise EncodingError(f"entry [{row}, {column}] is {psi[row, column]}; unary functions are 1 to 28")
    for node in np.flatnonzero(diagonal > len(BINARY_BY_NUMBER)):
        raise EncodingError(f"entry [{node}, {node}] is {diagonal[node]}; binary functions are 1 to 8")
    incoming = np.count_nonzero(np.triu(psi, 1), axis=0)
    for node in np.flatnonzero((diagonal == 0) & (incoming > 0)):
        raise EncodingError(f"node {node} is a source but has an incoming edge")
    for node in np.flatnonzero((diagonal != 0) & (incoming == 0)):
        raise EncodingError(f"node {node} is no source but has no incoming edge")
