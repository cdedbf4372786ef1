"""What the nodes of a network operator compute, written down as a program."""

from collections.abc import Mapping, Sequence
from functools import partial, reduce
from itertools import chain

import numpy as np

from gpsynth.arrays import Ints
from gpsynth.builder import Builder, Reference
from gpsynth.operations import BINARY_BY_NUMBER, UNARY_BY_NUMBER

Edge = tuple[int, int]  # tail, number of the unary function

# |value| <= 1e8 or NaN for any operand, so that starting nop_mul, max, min or prob_sum from the unit changes nothing
_BOUNDED = frozenset(
    (
        *("nop_square", "tanh_half", "step", "sgn", "cos", "sin", "atan", "clip_unit", "signed_decay"),
        *("signed_saturation", "sigmoid", "step_open", "sgn_dead_zone", "circle", "nop_mul"),
    )
)
_KEEPS_BOUND = frozenset(("identity", "neg", "half"))
# from their unit these start with the very value of the first edge, save that -0.0 becomes 0.0
_STARTS_FREE = frozenset(("add", "signed_abs_sum", "signed_abs_max"))
_STARTS_FREE_IF_BOUNDED = frozenset(("nop_mul", "max", "min", "prob_sum"))


def node_values(
    builder: Builder, psi: Ints, sources: Mapping[int, Reference], wanted: Sequence[int], *, strict: bool
) -> dict[int, Reference]:
    """The values of the `wanted` nodes of valid entries, and of the nodes they need; `sources` are known."""
    edges = _edges(psi, wanted)
    values = dict(sources)
    bounded: set[int] = set()
    for node in edges:
        function = BINARY_BY_NUMBER[int(psi[node, node])]
        name, first = function.name, edges[node][0]
        free = name in _STARTS_FREE or (name in _STARTS_FREE_IF_BOUNDED and _is_bounded(first, bounded))
        unit = [] if free or not strict or function.unit is None else [builder.constant(function.unit)]
        terms = (_term(builder, UNARY_BY_NUMBER[number].name, values[tail]) for tail, number in edges[node])
        values[node] = reduce(partial(builder.apply, name), chain(unit, terms))
        if name in _BOUNDED or (len(edges[node]) == 1 and _is_bounded(first, bounded)):
            bounded.add(node)
    return values


def _edges(psi: Ints, outputs: Sequence[int]) -> dict[int, list[Edge]]:
    """The incoming edges of every node that outputs need and that is no source; nodes and tails ascend."""
    heads, tails = np.nonzero(psi.T)
    incoming: dict[int, list[Edge]] = {}
    for head, tail, number in zip(heads.tolist(), tails.tolist(), psi[tails, heads].tolist(), strict=True):
        if tail != head:
            incoming.setdefault(head, []).append((tail, number))
    needed = set(outputs)
    for node in reversed(incoming):
        if node in needed:
            needed.update(tail for tail, _ in incoming[node])
    return {node: edges for node, edges in incoming.items() if node in needed}


def _term(builder: Builder, name: str, value: Reference) -> Reference:
    return value if name == "identity" else builder.apply(name, value)


def _is_bounded(edge: Edge, bounded: set[int]) -> bool:
    tail, number = edge
    name = UNARY_BY_NUMBER[number].name
    return name in _BOUNDED or (name in _KEEPS_BOUND and tail in bounded)
