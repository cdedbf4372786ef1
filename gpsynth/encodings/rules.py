"""What trees may not hold: operations inside others, operations too often; and what each operation weighs."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from math import inf
from types import MappingProxyType

from gpsynth.checks import check_kind, check_names
from gpsynth.encodings.checks import checked_at_least
from gpsynth.errors import EncodingError
from gpsynth.operations import operation

_NONE: Mapping[str, int] = MappingProxyType({})


@dataclass(frozen=True)
class Rules:
    """Rules for the tree of one output; operations are named as in the table.

    They hold for every tree that is drawn, mutated or crossed: a node that breaks one gives way to its first operand.
    Raises EncodingError for values that make no sense.
    """

    forbid: Mapping[str, Sequence[str]] = field(
        default_factory=dict, hash=False
    )  # what may not stand within it
    limits: Mapping[str, int] = field(default_factory=dict, hash=False)  # how often it may stand in a tree
    weights: Mapping[str, int] = field(default_factory=dict, hash=False)  # nodes it counts as, if not 1

    def __post_init__(self) -> None:
        for field_name in ("forbid", "limits", "weights"):
            check_kind(f"{field_name} of Rules", getattr(self, field_name), Mapping, error=EncodingError)
        for name, inner in self.forbid.items():
            check_names(f"what may not stand within {name}", inner, EncodingError)
        for name, most in self.limits.items():
            checked_at_least(f"the limit of {name}", most, 0)
        for name, weight in self.weights.items():
            checked_at_least(f"the weight of {name}", weight, 1)

    def check(self, operations: Sequence[str]) -> None:
        """Raises EncodingError unless the rules speak of these operations, and leave at least one of them."""
        named = {
            *self.forbid,
            *self.limits,
            *self.weights,
            *(name for inner in self.forbid.values() for name in inner),
        }
        for name in sorted(named - set(operations)):
            raise EncodingError(f"a rule is about {name!r}, which is not one of {', '.join(operations)}")
        if all(self.limits.get(name) == 0 for name in operations):
            raise EncodingError("the limits allow none of the operations")

    def kept(self, tree: Sequence[str]) -> list[int]:
        """Which nodes of a prefix tree stay; leaves are empty texts. All stay where no rule is broken."""
        stay: list[int] = []
        count: Counter[str] = Counter()

        def visit(place: int, banned: frozenset[str]) -> int:
            """The place behind the subtree that begins at `place`."""
            name = tree[place]
            breaks = name in banned or count[name] >= self.limits.get(name, inf)
            if not breaks:
                stay.append(place)
                count[name] += 1
                banned = banned.union(self.forbid.get(name, ()))
            behind = place + 1
            for operand in range(operation(name).arity if name else 0):
                behind = _behind(tree, behind) if breaks and operand else visit(behind, banned)
            return behind

        visit(0, frozenset())
        return stay

    def size(self, tree: Sequence[str]) -> int:
        """The nodes of a prefix tree, each counted by its weight."""
        return sum(self.weights.get(name, 1) for name in tree)

    @property
    def restrict(self) -> bool:
        """Whether there is a tree that breaks a rule."""
        return bool(self.forbid or self.limits)


def _behind(tree: Sequence[str], place: int) -> int:
    """The place behind the subtree that begins at `place`."""
    missing = 1
    while missing:
        missing += (operation(tree[place]).arity if tree[place] else 0) - 1
        place += 1
    return place
