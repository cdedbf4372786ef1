"""What the trees of an encoding must keep to: rules about operations, symmetries and units."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TypeVar

from gpsynth.encodings.parameters import ParameterSpace
from gpsynth.encodings.rules import Rules
from gpsynth.encodings.symmetry_rules import SymmetryRules
from gpsynth.encodings.unit_rules import UnitRules
from gpsynth.errors import EncodingError

Node = TypeVar("Node")
Meaning = str | int | None  # the name of an operation, the index of an input, a number


@dataclass(frozen=True)
class Constraints:
    """Rules and, where they are to be kept, symmetries and units."""

    rules: Rules
    symmetries: SymmetryRules | None
    units: UnitRules | None

    @property
    def restrict(self) -> bool:
        """Whether there is a tree that does not keep to them."""
        return self.rules.restrict or self.symmetries is not None or self.units is not None

    def obeying(
        self, tree: Sequence[tuple[Node, Meaning]], output: int, factor: Sequence[Node]
    ) -> list[Node]:
        """The nodes of a prefix tree without what breaks a rule or a symmetry, none if nothing is left.

        Then comes `factor` before what has another unit.
        """
        if self.rules.restrict:
            names = [meaning if isinstance(meaning, str) else "" for _, meaning in tree]
            tree = [tree[place] for place in self.rules.kept(names)]
        if self.symmetries is not None:
            tree = self.symmetries.fitted(tree, output)
        if self.units is None or not tree:
            return [node for node, _ in tree]
        return self.units.fitted(tree, output, factor)

    def smallest(self, output: int) -> int | None:
        """The leaf that is always a formula of an output: an input of its signs or unit, or else None, a number."""
        if self.symmetries is not None:
            return self.symmetries.terminal(output)
        return 0 if self.units is None else self.units.terminal(output)


def constraints_of(
    rules: Rules,
    symmetries: Mapping[str, str] | None,
    units: Mapping[str, str] | None,
    names: tuple[Sequence[str], Sequence[str]],
    operations: Sequence[str],
    space: ParameterSpace,
) -> Constraints:
    """The constraints on formulas of inputs and outputs, `names`.

    Raises EncodingError if they contradict the other settings or can never be kept.
    """
    rules.check(operations)
    signs = None if symmetries is None else SymmetryRules.of(symmetries, *names)
    constraints = Constraints(rules, signs, None if units is None else UnitRules.of(units, *names))
    if units is None:
        return constraints
    numbers = max(1, [constraints.smallest(output) for output in range(len(names[1]))].count(None))
    if "mul" not in operations or space.count < numbers:
        raise EncodingError(
            f"to keep units the operations must have mul and the parameter space at least {numbers} numbers, "
            f"which make formulas fit; got {', '.join(operations)} and {space.count}"
        )
    return constraints
