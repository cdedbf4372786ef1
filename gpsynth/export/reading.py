"""What every form of a law that people read says about it: header, meanings, features and formulas."""

import re
from dataclasses import replace
from typing import TypeVar

from gpsynth.checks import check_kind
from gpsynth.errors import LawError
from gpsynth.law import Law
from gpsynth.notation import Notation, fresh_names, spell
from gpsynth.operations import OPERATIONS

Value = TypeVar("Value")

COMMON = (
    "add sub mul div neg abs half double square cube sqrt floor sin cos tan atan atan2 asin acos exp log tanh cbrt "
    "hypot max min lt le eq not where identity"
)
_UNPRINTABLE = re.compile(r"[^\w \-+./*^()%:,]", re.ASCII)


def printable(text: str) -> str:
    """Text that is safe in a comment of any language: one line, ASCII, no comment delimiters."""
    return _UNPRINTABLE.sub(".", text).replace("*/", "* /").replace("/*", "/ *")


def header_lines(law: Law, name: str) -> list[str]:
    """What a reader of an exported file must know: plant, content hash, states, controls, units, limits."""
    check_kind("law", law, Law, error=LawError)
    plant = law.plant
    states = [
        f"  state[{index}], target[{index}]: {_with_unit(state, unit)}"
        for index, (state, unit) in enumerate(plant.states.items())
    ]
    controls = [
        f"  control[{index}]: {_with_unit(control, unit)}, from {low!r} to {high!r}"
        for index, (control, (unit, low, high)) in enumerate(plant.controls.items())
    ]
    return [
        f"{printable(name)}: feedback law of the plant '{printable(plant.name)}'",
        f"  sha256 {law.hash}",
        *states,
        *controls,
    ]


def meanings(law: Law) -> list[str]:
    """What the operations of the law mean that are not common arithmetic, one line each."""
    used = {row.name for row, _ in (*law.features.instructions, *law.bounded.instructions)}
    return [f"{row.name}: {row.formula}" for row in OPERATIONS if row.name in used.difference(COMMON.split())]


def spell_law(
    law: Law, notation: Notation[Value], *, trivial: int = 1, largest: int = 12
) -> list[tuple[str, Value]]:
    """The features that are needed, intermediate values, then the controls, as (name, value).

    A feature that is nothing but the state or target of its name is left out.
    """
    check_kind("law", law, Law, error=LawError)
    names = fresh_names("z", law.features, law.bounded)
    used = {operand for _, operands in law.bounded.instructions for operand in operands}
    used.update(law.bounded.outputs.tolist())
    needed = [
        index
        for index, name in enumerate(law.features.names)
        if index in used and name not in law.features.inputs
    ]
    features = replace(
        law.features,
        outputs=law.features.outputs[needed],
        names=tuple(law.features.names[index] for index in needed),
    )
    return [
        *spell(features, notation, names, trivial=trivial, largest=largest),
        *spell(law.bounded, notation, names, trivial=trivial, largest=largest),
    ]


def _with_unit(name: str, unit: str) -> str:
    return f"{name} in {printable(unit)}" if unit else name
