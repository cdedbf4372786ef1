"""What a plant may be made of: its names, the limits of its controls, the ranges of its parameters."""

import keyword
import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from gpsynth.errors import PlantError
from gpsynth.program import NAME

TIME = "t"

_C_KEYWORDS = frozenset(
    {
        *("auto", "break", "case", "char", "const", "continue", "default", "do", "double", "else", "enum"),
        *("extern", "float", "for", "goto", "if", "inline", "int", "long", "register", "restrict", "return"),
        *("short", "signed", "sizeof", "static", "struct", "switch", "typedef", "union", "unsigned", "void"),
        *("volatile", "while"),
    }
)
_TAKEN = frozenset({TIME, "running", "measure"})  # names of other inputs and outputs of a problem's programs


def check_names(
    name: str, states: Mapping[str, str], controls: Mapping[str, Any], parameters: Mapping[str, Any]
) -> None:
    """Every name once, none of them reserved, and at least one state and one control."""
    if not isinstance(name, str) or not name:
        raise PlantError(f"the name of a plant is a text, not {name!r}")
    seen: dict[str, str] = {}
    for kind, group in (("state", states), ("control", controls), ("parameter", parameters)):
        if not isinstance(group, Mapping) or not (group or kind == "parameter"):
            raise PlantError(
                f"the {kind}s of {name} are given as a dictionary with at least one name, got {group!r}"
            )
        for key in group:
            _check_name(name, key)
            if key in seen:
                raise PlantError(f"{key} is both a {seen[key]} and a {kind} of {name}")
            seen[key] = kind
    for key, unit in states.items():
        if not isinstance(unit, str):
            raise PlantError(f"the unit of {key} in {name} is a text, not {unit!r}")


def check_angles(name: str, states: Mapping[str, str], angles: Sequence[str]) -> None:
    """Angles are different states."""
    is_list = isinstance(angles, tuple | list)
    wrong = is_list and [angle for angle in angles if not isinstance(angle, str) or angle not in states]
    if not is_list or wrong or len(set(angles)) < len(angles):
        raise PlantError(
            f"the angles of {name} must be different states out of {', '.join(states)}, got {angles!r}"
        )


def _check_name(plant: str, key: Any) -> None:
    if not isinstance(key, str) or not NAME.match(key) or key.startswith("_"):
        raise PlantError(f"{key!r} in {plant} is not a name: a letter, then letters, digits and _")
    if keyword.iskeyword(key) or key in _C_KEYWORDS:
        raise PlantError(f"{key!r} in {plant} is a keyword of Python or C; use another name")
    if key in _TAKEN or key.endswith(("_target", "_goal")):
        raise PlantError(
            f"{key!r} in {plant} is reserved, like {', '.join(sorted(_TAKEN))} and what ends in _target or _goal"
        )


def parameter(plant: str, key: str, given: Any) -> tuple[str, float, float, float]:
    """Unit, lower and upper limit and nominal value of a parameter, the middle unless it is given."""
    if not isinstance(given, list | tuple) or len(given) not in (3, 4) or not isinstance(given[0], str):
        raise PlantError(
            f"the parameter {key} of {plant} is given as (unit, lower, upper, nominal), got {given!r}"
        )
    numbers = _plain_numbers(plant, key, given[1:])
    low, high, nominal = numbers if len(numbers) == 3 else (*numbers, 0.5 * (numbers[0] + numbers[1]))
    if not (math.isfinite(low) and math.isfinite(high) and low <= nominal <= high):
        raise PlantError(
            f"the parameter {key} of {plant} is {nominal} in [{low}, {high}]; "
            "expected finite numbers, lower <= nominal <= upper"
        )
    return given[0], low, high, nominal


def control(plant: str, key: str, given: Any) -> tuple[str, float, float]:
    """Unit, lower and upper limit of a control."""
    if not isinstance(given, list | tuple) or len(given) != 3 or not isinstance(given[0], str):
        raise PlantError(f"the control {key} of {plant} is given as (unit, lower, upper), got {given!r}")
    low, high = _plain_numbers(plant, key, given[1:])
    if not (math.isfinite(low) and math.isfinite(high) and low < high):
        raise PlantError(
            f"the limits of {key} in {plant} are {low} and {high}; expected finite numbers, lower < upper"
        )
    return given[0], low, high


def _plain_numbers(plant: str, key: str, given: Sequence[Any]) -> tuple[float, ...]:
    if any(isinstance(number, bool) or not isinstance(number, int | float | np.number) for number in given):
        raise PlantError(f"the limits of {key} in {plant} are numbers, got {given!r}")
    return tuple(map(float, given))
