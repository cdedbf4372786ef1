"""Plant: named states and controls, the limits of the controls, and the dynamics as a Program."""

import keyword
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from gpsynth.arrays import Floats, frozen
from gpsynth.builder import Builder
from gpsynth.errors import PlantError
from gpsynth.program import NAME, Program
from gpsynth.tracing import takes_time, trace

FORMAT = "gpsynth-plant/1"
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


@dataclass(frozen=True, eq=False, init=False)
class Plant:
    """A system x' = f(x, u, t) with saturated controls.

    `dynamics` is a function f(x, u) or f(x, u, t) that returns one derivative for each state in order, or a Program.
    Raises PlantError if the parts do not fit together, TracingError if the function cannot become a Program.
    """

    dynamics: Program  # inputs: states, controls, t; outputs: the derivatives, named like the states
    states: Mapping[str, str]  # name -> unit
    controls: Mapping[str, tuple[str, float, float]]  # name -> unit, lower and upper limit
    angles: tuple[str, ...]  # states that are kept in [-pi, pi)
    name: str

    def __init__(
        self,
        dynamics: Callable[..., Any] | Program,
        states: Mapping[str, str],
        controls: Mapping[str, tuple[str, float, float]],
        *,
        angles: Sequence[str] = (),
        name: str = "plant",
    ) -> None:
        _check_names(name, states, controls, angles)
        object.__setattr__(self, "states", dict(states))
        object.__setattr__(self, "controls", {key: _control(name, key, controls[key]) for key in controls})
        object.__setattr__(self, "angles", tuple(angles))
        object.__setattr__(self, "name", name)
        object.__setattr__(self, "dynamics", _dynamics(self, dynamics))

    @property
    def state_names(self) -> tuple[str, ...]:
        """Names of the n states."""
        return tuple(self.states)

    @property
    def control_names(self) -> tuple[str, ...]:
        """Names of the m controls."""
        return tuple(self.controls)

    @cached_property
    def lower(self) -> Floats:
        """Lower limits of the controls, (m,)."""
        return frozen(np.array([low for _, low, _ in self.controls.values()], dtype=np.float64))

    @cached_property
    def upper(self) -> Floats:
        """Upper limits of the controls, (m,)."""
        return frozen(np.array([high for _, _, high in self.controls.values()], dtype=np.float64))

    @cached_property
    def saturation(self) -> Program:
        """Raw controls to admissible ones; NaN becomes the admissible number nearest 0."""
        builder = Builder(self.control_names)
        limits = zip(builder.inputs, self.lower.tolist(), self.upper.tolist(), strict=True)
        outputs = [
            builder.apply("limit", raw, builder.constant(low), builder.constant(high))
            for raw, low, high in limits
        ]
        return builder.build(outputs, self.control_names)

    def with_limits(self, lower: Sequence[float] | Floats, upper: Sequence[float] | Floats) -> "Plant":
        """The same plant with other limits of its controls, (m,) each."""
        if np.shape(lower) != (len(self.controls),) or np.shape(upper) != (len(self.controls),):
            raise PlantError(
                f"the limits of {self.name} have shapes {np.shape(lower)} and {np.shape(upper)}; "
                f"expected ({len(self.controls)},) each, for {', '.join(self.controls)}"
            )
        rows = zip(self.controls.items(), lower, upper, strict=True)
        controls = {key: (unit, float(low), float(high)) for (key, (unit, _, _)), low, high in rows}
        return replace(self, controls=controls)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Plant) and self.to_dict() == other.to_dict()

    def __hash__(self) -> int:
        return hash(self.dynamics)

    def to_dict(self) -> dict[str, Any]:
        """A JSON-ready description; limits are hexadecimal, the order of states and controls is kept."""
        return {
            "format": FORMAT,
            "name": self.name,
            "states": [list(item) for item in self.states.items()],
            "controls": [
                [key, unit, low.hex(), high.hex()] for key, (unit, low, high) in self.controls.items()
            ],
            "angles": list(self.angles),
            "dynamics": self.dynamics.to_dict(),
        }

    @classmethod
    def from_dict(cls, document: Any) -> "Plant":
        """The plant of a `to_dict` document; raises PlantError or ProgramError if it is not one."""
        if not isinstance(document, dict) or document.get("format") != FORMAT:
            raise PlantError(f"a plant document has format {FORMAT!r}")
        expected = {"format", "name", "states", "controls", "angles", "dynamics"}
        if set(document) != expected:
            raise PlantError(
                f"a plant document has the fields {sorted(expected)}, not {sorted(map(str, document))}"
            )
        controls = {
            key: (unit, _number(low), _number(high))
            for key, unit, low, high in _rows(document, "controls", 4)
        }
        if not isinstance(document["angles"], list):
            raise PlantError("the angles of a plant document are a list of names")
        return cls(
            Program.from_dict(document["dynamics"]),
            states=dict(_rows(document, "states", 2)),
            controls=controls,
            angles=document["angles"],
            name=document["name"],
        )


def _check_names(
    name: str, states: Mapping[str, str], controls: Mapping[str, Any], angles: Sequence[str]
) -> None:
    if not isinstance(name, str) or not name:
        raise PlantError(f"the name of a plant is a text, not {name!r}")
    for kind, group in (("states", states), ("controls", controls)):
        if not isinstance(group, Mapping) or not group:
            raise PlantError(
                f"the {kind} of {name} are given as a dictionary with at least one name, got {group!r}"
            )
        for key in group:
            _check_name(name, key)
    for key, unit in states.items():
        if not isinstance(unit, str):
            raise PlantError(f"the unit of {key} in {name} is a text, not {unit!r}")
    both = [key for key in states if key in controls]
    if both:
        raise PlantError(f"{both[0]} is both a state and a control of {name}")
    wrong = [angle for angle in angles if not isinstance(angle, str) or angle not in states]
    if isinstance(angles, str) or wrong or len(set(angles)) < len(angles):
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


def _control(plant: str, key: str, given: Any) -> tuple[str, float, float]:
    if not isinstance(given, list | tuple) or len(given) != 3 or not isinstance(given[0], str):
        raise PlantError(f"the control {key} of {plant} is given as (unit, lower, upper), got {given!r}")
    numbers = given[1:]
    if any(isinstance(number, bool) or not isinstance(number, int | float | np.number) for number in numbers):
        raise PlantError(f"the limits of {key} in {plant} are two numbers, got {numbers!r}")
    low, high = float(numbers[0]), float(numbers[1])
    if not (math.isfinite(low) and math.isfinite(high) and low < high):
        raise PlantError(
            f"the limits of {key} in {plant} are {low} and {high}; expected finite numbers, lower < upper"
        )
    return given[0], low, high


def _dynamics(plant: Plant, given: Callable[..., Any] | Program) -> Program:
    program = given if isinstance(given, Program) else _traced(plant, given)
    inputs = (*plant.states, *plant.controls, TIME)
    if program.inputs != inputs or program.parameters:
        raise PlantError(
            f"the dynamics of {plant.name} take {', '.join(program.inputs + program.parameters)}; "
            f"expected {', '.join(inputs)}"
        )
    if len(program.outputs) != len(plant.states):
        raise PlantError(
            f"the dynamics of {plant.name} return {len(program.outputs)} derivatives; "
            f"expected {len(plant.states)}, one for each of {', '.join(plant.states)}"
        )
    outputs = program.outputs
    if set(program.names) == set(plant.states):  # a dictionary may come in another order
        outputs = outputs[[program.names.index(state) for state in plant.states]]
    return replace(program, outputs=outputs, names=plant.state_names)


def _traced(plant: Plant, given: Any) -> Program:
    if not callable(given):
        raise PlantError(f"the dynamics of {plant.name} are a function or a Program, got {given!r}")
    arguments = (("x", plant.state_names), ("u", plant.control_names))
    if takes_time(given, 2):
        return trace(given, (*arguments, (TIME, TIME)))
    return trace(given, arguments, unread=(TIME,))


def _rows(document: dict[str, Any], field: str, size: int) -> list[list[Any]]:
    rows = document[field]
    if not isinstance(rows, list) or not all(isinstance(row, list) and len(row) == size for row in rows):
        raise PlantError(f"the {field} of a plant document are a list of lists with {size} items")
    names = [row[0] for row in rows]
    if not all(isinstance(name, str) for name in names) or len(set(names)) < len(names):
        raise PlantError(f"the {field} of a plant document need different names, got {names!r}")
    return rows


def _number(text: Any) -> float:
    try:
        return float.fromhex(text)
    except (TypeError, ValueError, OverflowError):
        raise PlantError(f"the limits in a plant document are hexadecimal numbers, got {text!r}") from None
