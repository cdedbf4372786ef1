"""Plant: named states and controls, the limits of the controls, uncertain parameters, the dynamics as a Program."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from types import MappingProxyType
from typing import Any

import numpy as np

from gpsynth.arrays import Floats, frozen
from gpsynth.builder import Builder
from gpsynth.errors import PlantError
from gpsynth.plant_parts import TIME, check_angles, check_names, control, parameter
from gpsynth.program import Program
from gpsynth.tracing import takes_time, trace

FORMAT = "gpsynth-plant/1"
_NONE: Mapping[str, Any] = MappingProxyType({})


@dataclass(frozen=True, eq=False, init=False)
class Plant:
    """A system x' = f(x, u, p, t) with saturated controls and parameters p that are known within limits.

    `dynamics` is a function f(x, u) or f(x, u, t), with parameters f(x, u, p) or f(x, u, p, t), that returns one
    derivative for each state in order, or a Program. Raises PlantError if the parts do not fit together, TracingError
    if the function cannot become a Program.
    """

    dynamics: Program  # inputs: states, controls, t; parameters: the plant's; outputs: the derivatives of the states
    states: Mapping[str, str]  # name -> unit
    controls: Mapping[str, tuple[str, float, float]]  # name -> unit, lower and upper limit
    parameters: Mapping[str, tuple[str, float, float, float]]  # name -> unit, lower, upper, nominal value
    angles: tuple[str, ...]  # states that are kept in [-pi, pi)
    name: str

    def __init__(
        self,
        dynamics: Callable[..., Any] | Program,
        states: Mapping[str, str],
        controls: Mapping[str, tuple[str, float, float]],
        *,
        parameters: Mapping[str, tuple[str, float, float] | tuple[str, float, float, float]] = _NONE,
        angles: Sequence[str] = (),
        name: str = "plant",
    ) -> None:
        """A parameter is (unit, lower, upper, nominal); left out, its nominal value is the middle."""
        check_names(name, states, controls, parameters)
        check_angles(name, states, angles)
        object.__setattr__(self, "states", dict(states))
        object.__setattr__(self, "controls", {key: control(name, key, controls[key]) for key in controls})
        uncertain = {key: parameter(name, key, parameters[key]) for key in parameters}
        object.__setattr__(self, "parameters", uncertain)
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

    @property
    def parameter_names(self) -> tuple[str, ...]:
        """Names of the q parameters."""
        return tuple(self.parameters)

    @cached_property
    def nominal(self) -> Floats:
        """Nominal values of the parameters, (q,)."""
        return frozen(np.array([value for *_, value in self.parameters.values()], dtype=np.float64))

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
        controls = {key: (unit, low, high) for (key, (unit, _, _)), low, high in rows}
        return replace(self, controls=controls)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Plant) and self.to_dict() == other.to_dict()

    def __hash__(self) -> int:
        return hash(self.dynamics)

    def to_dict(self) -> dict[str, Any]:
        """A JSON-ready description; limits are hexadecimal, orders are kept; no parameters, no field for them."""
        parameters = [
            [key, unit, *(number.hex() for number in numbers)]
            for key, (unit, *numbers) in self.parameters.items()
        ]
        return {
            "format": FORMAT,
            "name": self.name,
            "states": [list(item) for item in self.states.items()],
            "controls": [
                [key, unit, low.hex(), high.hex()] for key, (unit, low, high) in self.controls.items()
            ],
            **({"parameters": parameters} if parameters else {}),
            "angles": list(self.angles),
            "dynamics": self.dynamics.to_dict(),
        }

    @classmethod
    def from_dict(cls, document: Any) -> "Plant":
        """The plant of a `to_dict` document; raises PlantError or ProgramError if it is not one."""
        if not isinstance(document, dict) or document.get("format") != FORMAT:
            raise PlantError(f"a plant document has format {FORMAT!r}")
        expected = {"format", "name", "states", "controls", "angles", "dynamics"}
        if set(document) not in (expected, expected | {"parameters"}):
            raise PlantError(
                f"a plant document has the fields {sorted(expected)}, not {sorted(map(str, document))}"
            )
        controls = {
            key: (unit, _number(low), _number(high))
            for key, unit, low, high in _rows(document, "controls", 4)
        }
        parameters = {
            key: (unit, _number(low), _number(high), _number(nominal))
            for key, unit, low, high, nominal in _rows({"parameters": [], **document}, "parameters", 5)
        }
        if not isinstance(document["angles"], list):
            raise PlantError("the angles of a plant document are a list of names")
        return cls(
            Program.from_dict(document["dynamics"]),
            states=dict(_rows(document, "states", 2)),
            controls=controls,
            parameters=parameters,
            angles=document["angles"],
            name=document["name"],
        )


def _dynamics(plant: Plant, given: Callable[..., Any] | Program) -> Program:
    program = given if isinstance(given, Program) else _traced(plant, given)
    inputs = (*plant.states, *plant.controls, TIME)
    if program.inputs != inputs or program.parameters != plant.parameter_names:
        raise PlantError(
            f"the dynamics of {plant.name} take {', '.join(program.inputs + program.parameters)}; "
            f"expected {', '.join(inputs + plant.parameter_names)}"
        )
    if len(program.outputs) != len(plant.states):
        raise PlantError(
            f"the dynamics of {plant.name} return {len(program.outputs)} derivatives; "
            f"expected {len(plant.states)}, one for each of {', '.join(plant.states)}"
        )
    outputs = program.outputs
    if set(program.names) == set(plant.states):  # a Program may have another order
        outputs = outputs[[program.names.index(state) for state in plant.states]]
    return replace(program, outputs=outputs, names=plant.state_names)


def _traced(plant: Plant, given: Any) -> Program:
    if not callable(given):
        raise PlantError(f"the dynamics of {plant.name} are a function or a Program, got {given!r}")
    arguments = [("x", plant.state_names), ("u", plant.control_names)]
    if plant.parameters:
        arguments.append(("p", plant.parameter_names))
    if takes_time(given, len(arguments)):
        return _parametrized(plant, trace(given, (*arguments, (TIME, TIME)), plant.state_names))
    return _parametrized(plant, trace(given, arguments, plant.state_names, unread=(TIME,)))


def _parametrized(plant: Plant, traced: Program) -> Program:
    """The same program with the plant's parameters as its parameters."""
    if not plant.parameters:
        return traced
    builder = Builder((*plant.states, *plant.controls, TIME), plant.parameter_names)
    leaves = (*builder.inputs, *builder.parameters)
    of = dict(zip((*plant.states, *plant.controls, TIME, *plant.parameters), leaves, strict=True))
    return builder.build(builder.inline(traced, [of[name] for name in traced.inputs]), traced.names)


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
