"""Law: a feedback u = g(x, x*) that is complete: features, formula, numbers and the plant's limits.

Its `to_...` and `plot` hand it to the modules of the same names, which load when they are called.
"""

import hashlib
import json
import os
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from gpsynth import formula
from gpsynth.arrays import Floats, frozen
from gpsynth.builder import Builder, bind
from gpsynth.checks import check_kind
from gpsynth.errors import FileError, GpsynthError, LawError
from gpsynth.files import read_json, write_json
from gpsynth.plant import Plant
from gpsynth.program import Program

if TYPE_CHECKING:
    from gpsynth.export import SympyForm
    from gpsynth.plotting import Axes

FORMAT = "gpsynth-law/1"


@dataclass(frozen=True, eq=False)
class Law:
    """A stabilizer of `plant`: `program` computes the controls from `features`, and the plant's limits hold always.

    Equality and hash go by content. Raises LawError if the parts do not fit together.
    """

    plant: Plant
    features: Program  # inputs: the states, then <state>_target for each
    program: Program  # inputs: the features; outputs: the controls
    parameters: Floats  # (p,) of program

    def __post_init__(self) -> None:
        for name, kind in (("plant", Plant), ("features", Program), ("program", Program)):
            check_kind(f"the {name} of a law", getattr(self, name), kind, error=LawError)
        try:
            object.__setattr__(self, "parameters", frozen(np.asarray(self.parameters, dtype=np.float64)))
        except (TypeError, ValueError):
            raise LawError(f"the parameters of a law are numbers, got {self.parameters!r}") from None
        _check(self)

    @cached_property
    def bounded(self) -> Program:
        """The features' values to the saturated controls, parameters replaced by their numbers."""
        builder = Builder(self.program.inputs)
        controls = builder.inline(bind(self.program, self.parameters.tolist()), builder.inputs)
        return builder.build(builder.inline(self.plant.saturation, controls), self.plant.control_names)

    @cached_property
    def complete(self) -> Program:
        """States and targets to the saturated controls; the parameters are those of `program`.

        Saturation turns NaN into the admissible number nearest 0.
        """
        builder = Builder(self.features.inputs, self.program.parameters)
        features = builder.inline(self.features, builder.inputs)
        controls = builder.inline(self.program, features, builder.parameters)
        return builder.build(builder.inline(self.plant.saturation, controls), self.plant.control_names)

    @property
    def complexity(self) -> int:
        """The number of instructions of `program`."""
        return self.program.complexity

    @cached_property
    def hash(self) -> str:
        """SHA-256 of the content; equal for equal laws on every machine."""
        return hashlib.sha256(json.dumps(self._content(), sort_keys=True).encode()).hexdigest()

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Law) and self.hash == other.hash

    def __hash__(self) -> int:
        return hash(self.hash)

    def __str__(self) -> str:
        return "\n".join(self.formulas())

    def __call__(self, x: npt.ArrayLike, target: npt.ArrayLike) -> Floats:
        """The controls (m,) at state x (n,) and target (n,), or (N, m) if one of them or both are (N, n).

        Raises LawError if a shape does not fit.
        """
        try:
            states, targets = np.asarray(x, dtype=np.float64), np.asarray(target, dtype=np.float64)
        except (TypeError, ValueError):
            raise LawError(f"x and target must hold numbers, got {x!r} and {target!r}") from None
        size = len(self.plant.state_names)
        for name, array in (("x", states), ("target", targets)):
            if array.ndim not in (1, 2) or array.shape[-1] != size:
                raise LawError(f"{name} has shape {array.shape}; expected ({size},) or (N, {size})")
        if states.ndim == targets.ndim == 2 and len(states) != len(targets):
            raise LawError(f"x has {len(states)} rows and target has {len(targets)}")
        rows = np.concatenate(np.broadcast_arrays(np.atleast_2d(states), np.atleast_2d(targets)), axis=1)
        controls = self.complete(rows, self.parameters)
        return controls[0] if states.ndim == targets.ndim == 1 else controls

    def formulas(self) -> tuple[str, ...]:
        """Readable lines: intermediate values, then one line for each control, in terms of the features."""
        return formula.lines(self.bounded)

    def to_sympy(self, *, expanded: bool = False) -> "SympyForm":
        """States and targets to saturated controls as sympy expressions (`gpsynth.export.to_sympy`)."""
        from gpsynth import export

        return export.to_sympy(self, expanded=expanded)

    def to_latex(self) -> str:
        """An align* environment (`gpsynth.export.to_latex`)."""
        from gpsynth import export

        return export.to_latex(self)

    def to_c(self, name: str = "law") -> tuple[str, str]:
        """C99 source and header that compute the same bits (`gpsynth.export.to_c`)."""
        from gpsynth import export

        return export.to_c(self, name)

    def to_python(self, name: str = "law") -> str:
        """A module of plain Python that computes the same bits (`gpsynth.export.to_python`)."""
        from gpsynth import export

        return export.to_python(self, name)

    def to_casadi(self, name: str = "law") -> Any:
        """A casadi.Function (state, target) -> control (`gpsynth.export.to_casadi`)."""
        from gpsynth import export

        return export.to_casadi(self, name)

    def to_control(self) -> Any:
        """Plant and law as one nonlinear system of python-control (`gpsynth.export.to_control`)."""
        from gpsynth import export

        return export.to_control(self)

    def plot(
        self, feature: str, span: tuple[float, float] = (-1.0, 1.0), *, ax: "Axes | None" = None
    ) -> "Axes":
        """The saturated controls over one feature, the others being 0 (`gpsynth.plotting.plot_response`)."""
        from gpsynth.plotting import plot_response

        units = {name: unit for name, (unit, _, _) in self.plant.controls.items()}
        return plot_response(self.bounded, feature, span, units=units, ax=ax)

    def with_limits(self, lower: Sequence[float] | Floats, upper: Sequence[float] | Floats) -> "Law":
        """The same law for the plant with other limits of its controls, (m,) each."""
        return replace(self, plant=self.plant.with_limits(lower, upper))

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the law as JSON; raises FileError if that is not possible."""
        write_json(path, self.to_dict())

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> "Law":
        """The law in a file that `save` wrote; raises FileError or LawError, naming the file."""
        document = read_json(path)
        try:
            return cls.from_dict(document)
        except FileError:
            raise
        except GpsynthError as error:
            raise LawError(f"{path}: {error}") from None

    def to_dict(self) -> dict[str, Any]:
        """A JSON-ready description; parameters are hexadecimal."""
        return {**self._content(), "hash": self.hash}

    @classmethod
    def from_dict(cls, document: Any) -> "Law":
        """The law of a `to_dict` document; raises LawError, PlantError or ProgramError if it is not one."""
        if not isinstance(document, dict) or document.get("format") != FORMAT:
            raise LawError(f"a law document has format {FORMAT!r}")
        expected = {"format", "plant", "features", "program", "parameters", "hash"}
        if set(document) != expected:
            raise LawError(f"a law document has the fields {sorted(expected)}, not {sorted(document)}")
        law = cls(
            plant=Plant.from_dict(document["plant"]),
            features=Program.from_dict(document["features"]),
            program=Program.from_dict(document["program"]),
            parameters=_numbers(document["parameters"]),
        )
        if law.hash != document["hash"]:
            raise LawError("the law document does not match its hash; it was changed or damaged")
        return law

    def _content(self) -> dict[str, Any]:
        return {
            "format": FORMAT,
            "plant": self.plant.to_dict(),
            "features": self.features.to_dict(),
            "program": self.program.to_dict(),
            "parameters": [float(value).hex() for value in self.parameters],
        }


def _numbers(texts: Any) -> Floats:
    if not isinstance(texts, list) or not all(isinstance(text, str) for text in texts):
        raise LawError("the parameters of a law document are a list of hexadecimal texts")
    try:
        return np.array([float.fromhex(text) for text in texts], dtype=np.float64)
    except (ValueError, OverflowError) as error:
        raise LawError(f"a parameter of the law document is not a hexadecimal number: {error}") from None


def _check(law: Law) -> None:
    states = tuple(law.plant.state_names)
    targets = tuple(f"{name}_target" for name in states)
    if law.features.inputs != states + targets or law.features.parameters:
        raise LawError(
            f"the features take {_listed(law.features.inputs + law.features.parameters)}; "
            f"expected the states and their targets, {_listed(states + targets)}"
        )
    if law.program.inputs != law.features.names:
        raise LawError(
            f"the program takes {_listed(law.program.inputs)}; the features are {_listed(law.features.names)}"
        )
    if law.program.names != tuple(law.plant.control_names):
        raise LawError(
            f"the program computes {_listed(law.program.names)}; "
            f"the controls are {_listed(law.plant.control_names)}"
        )
    if law.parameters.shape != (len(law.program.parameters),):
        raise LawError(
            f"the parameters have shape {law.parameters.shape}; expected ({len(law.program.parameters)},)"
        )
    if not np.all(np.isfinite(law.parameters)):
        raise LawError(f"the parameters must be finite, got {law.parameters.tolist()}")
    _check_feature_names(law)


def _check_feature_names(law: Law) -> None:
    """A formula must not call two values by one name."""
    for name, output in zip(law.features.names, law.features.outputs.tolist(), strict=True):
        is_that_input = name in law.features.inputs and law.features.inputs.index(name) == output
        if not is_that_input and name in (*law.features.inputs, *law.program.names):
            raise LawError(f"the feature {name!r} has the name of another state, target or control")


def _listed(names: Sequence[str]) -> str:
    return ", ".join(names) if names else "nothing"
