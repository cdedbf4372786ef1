"""The multilayer network operator: matrices one after another, each fed by those before it (Diveev).

A place is a pair (layer, node), layers counted from 1; layer 0 holds the inputs, then the parameters. The first nodes
of a layer are its sources, and `connections` say from which places they take their values.
"""

from dataclasses import dataclass, replace

import numpy as np

from gpsynth.arrays import Ints, frozen
from gpsynth.builder import Builder, Reference
from gpsynth.encodings.checks import checked_at_least
from gpsynth.encodings.network_operator_basis import basic_operator
from gpsynth.encodings.network_operator_matrix import Matrix, numbered
from gpsynth.encodings.network_operator_values import node_values
from gpsynth.encodings.parameters import ParameterSpace
from gpsynth.encodings.solution import Functions, Variation
from gpsynth.encodings.variations import is_variation, random_variation, vary
from gpsynth.errors import EncodingError
from gpsynth.program import Program

Place = tuple[int, int]  # layer, node


@dataclass(frozen=True, eq=False)
class Layers:
    """A `Solution`: k network operators of one size; raises EncodingError if one, or a connection, is not valid."""

    entries: Ints  # (k, L, L)
    connections: tuple[tuple[Place, ...], ...]  # of each layer, one place for each of its sources
    n_inputs: int
    n_parameters: int
    outputs: tuple[Place, ...]

    def __post_init__(self) -> None:
        object.__setattr__(self, "entries", frozen(np.array(self.entries, dtype=np.int32)))
        if self.entries.ndim != 3 or len(self.entries) != len(self.connections):
            raise EncodingError(
                f"layers are an array (k, L, L) with k groups of connections, not the shape {self.entries.shape} "
                f"with {len(self.connections)} groups"
            )
        for layer, (psi, places) in enumerate(zip(self.entries, self.connections, strict=True), 1):
            try:
                Matrix(psi, tuple(range(len(places))), (), (len(psi) - 1,))
            except EncodingError as error:
                raise EncodingError(f"layer {layer}: {error}") from None
            for place in places:
                self._check(place, layer)
        for place in self.outputs:
            self._check(place, len(self.entries) + 1)
            if place[0] == 0 or place[1] < len(self.connections[place[0] - 1]):
                raise EncodingError(f"output {place} is a source; an output must have incoming edges")

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Layers) and self._content() == other._content()

    def __hash__(self) -> int:
        return hash(self._content())

    @property
    def counts(self) -> tuple[int, int, int]:
        """How many inputs, parameters and outputs the formula has."""
        return self.n_inputs, self.n_parameters, len(self.outputs)

    @property
    def identity(self) -> Variation:
        """(0, 0, 0, 0, 0)."""
        return 0, 0, 0, 0, 0

    def functions(self, operations: tuple[str, ...]) -> Functions:
        """As those of a single matrix."""
        return numbered(operations)

    def draw(self, entries: Ints, functions: Functions, rng: np.random.Generator) -> Variation:
        """Any layer (from 0), and a variation of its matrix."""
        layer = int(rng.integers(len(entries)))
        return layer, *random_variation(entries[layer], functions, rng)

    def varied(self, entries: Ints, variations: tuple[Variation, ...]) -> Ints:
        """A copy of the entries after these variations; those whose guard fails are passed over."""
        changed = entries.copy()
        for layer, *variation in variations:
            changed[layer] = vary(changed[layer], (tuple(variation),))
        return changed

    def contains(self, variation: Variation, functions: Functions) -> bool:
        """Whether `draw` could have given this variation, or it is the identity."""
        if len(variation) != 5 or type(variation[0]) is not int or not 0 <= variation[0] < len(self.entries):
            return False
        return is_variation(variation[1:], self.entries.shape[1], functions)

    def with_entries(self, entries: Ints) -> "Layers":
        """The same connections of other matrices; raises EncodingError if one is not valid."""
        return replace(self, entries=entries)

    def program(self, entries: Ints, inputs: tuple[str, ...], outputs: tuple[str, ...]) -> Program:
        """The formula of valid entries; nodes start with their first edge, not with their unit."""
        builder = Builder(inputs, ParameterSpace.names(self.n_parameters))
        values: dict[Place, Reference] = {
            (0, node): value for node, value in enumerate([*builder.inputs, *builder.parameters])
        }
        read = {place for places in (*self.connections, self.outputs) for place in places}
        for layer, (psi, places) in enumerate(zip(entries, self.connections, strict=True), 1):
            sources = {node: values[place] for node, place in enumerate(places)}
            wanted = [node for number, node in read if number == layer]
            nodes = node_values(builder, psi, sources, wanted, strict=False)
            values.update({(layer, node): value for node, value in nodes.items()})
        return builder.build([values[place] for place in self.outputs], outputs)

    def _check(self, place: Place, before: int) -> None:
        """Raises EncodingError unless the place exists in a layer before this one."""
        layer, node = place
        external = self.n_inputs + self.n_parameters
        if not (0 <= layer < before and 0 <= node < (external if layer == 0 else self.entries.shape[1])):
            raise EncodingError(f"place {place} does not exist before layer {before}")

    def _content(self) -> tuple[object, ...]:
        shape = self.entries.shape
        return shape, self.entries.tobytes(), self.connections, self.counts, self.outputs


def basic_layers(n_inputs: int, n_parameters: int, n_outputs: int, per_layer: int = 3) -> Layers:
    """The usual start: layers that weight and sum `per_layer` inputs each, and a last one that adds their sums."""
    checked_at_least("n_inputs", n_inputs, 1)
    checked_at_least("n_parameters", n_parameters, 0)
    checked_at_least("per_layer", per_layer, 1)
    groups = [range(k, min(k + per_layer, n_inputs)) for k in range(0, n_inputs, per_layer)]
    weights = [[n_inputs + k for k in group if k < n_parameters] for group in groups]
    weights[-1] += range(2 * n_inputs, n_inputs + n_parameters)  # without an input, for variations to take up
    sizes = [3 * len(group) + len(own) for group, own in zip(groups, weights, strict=True)]
    size = max(*sizes, 3 * len(groups) + n_outputs - 1) + 4  # four nodes of the chain are left for variations
    operators = [
        basic_operator(len(group), len(own), 1, size) for group, own in zip(groups, weights, strict=True)
    ]
    last = basic_operator(len(groups), 0, n_outputs, size)
    return Layers(
        np.array([each.psi for each in (*operators, last)]),
        (
            *(tuple((0, k) for k in (*group, *own)) for group, own in zip(groups, weights, strict=True)),
            tuple((layer, size - 1) for layer in range(1, len(groups) + 1)),
        ),
        n_inputs,
        n_parameters,
        tuple((len(groups) + 1, node) for node in last.outputs),
    )
