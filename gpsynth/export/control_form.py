"""A law and its plant as one nonlinear system of python-control (Fuller et al. 2021), signals under their names."""

from typing import Any

import numpy as np

from gpsynth.arrays import Floats
from gpsynth.checks import check_kind
from gpsynth.errors import LawError, MissingPackageError
from gpsynth.law import Law

try:
    import control
except ImportError:
    raise MissingPackageError(
        "to_control needs python-control; install it with pip install gpsynth[control]"
    ) from None


def to_control(law: Law) -> control.NonlinearIOSystem:
    """The closed loop in continuous time: inputs are the targets, outputs the states and the controls.

    The law acts at every instant and not once a period, as `simulate` does for a problem with hold=False; angles are
    not wrapped. Raises MissingPackageError without python-control.
    """
    check_kind("law", law, Law, error=LawError)
    plant = law.plant
    size = len(plant.state_names)

    def update(t: float, x: Floats, u: Floats, params: dict[str, Any]) -> Floats:
        derivatives: Floats = plant.dynamics(np.concatenate([x, law(x, u), [t]])[np.newaxis], plant.nominal)[
            0
        ]
        return derivatives

    def output(t: float, x: Floats, u: Floats, params: dict[str, Any]) -> Floats:
        return np.concatenate([x, law(x, u)])

    return control.nlsys(
        update,
        output,
        name=plant.name,
        states=list(plant.state_names),
        inputs=list(law.features.inputs[size:]),
        outputs=[*plant.state_names, *plant.control_names],
    )
