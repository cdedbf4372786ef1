import math

import numpy as np
import pytest

from gpsynth import export
from gpsynth.kernels import elementary
from gpsynth.operations import OPERATIONS
from gpsynth.seeds import stream
from tests.export.helpers import random_law, robot_law
from tests.export.test_sympy_form import _operands, _program_of

casadi = pytest.importorskip("casadi", reason="casadi is not installed")


@pytest.mark.parametrize("operation", OPERATIONS, ids=lambda operation: operation.name)
def test_casadi_form_equals_the_kernel(operation):
    function = export.to_casadi(_program_of(operation))
    for operands in _operands(operation):
        padded = [*operands, 0.0, 0.0][:3]
        # libm is within 1 ulp and our functions within 2; the cube root by a power loses a few more
        assert math.isclose(
            float(function(padded, [])),
            elementary.evaluate(operation.name, *operands),
            rel_tol=1e-13,
            # angles near a multiple of pi cancel
            abs_tol=1e-15 * max(1.0, *map(abs, operands)) if operation.name == "wrap" else 1e-15,
        ), operands


@pytest.mark.parametrize("law", [robot_law(), *(random_law(stream(seed)) for seed in range(5))])
def test_a_law_keeps_its_signature_its_numbers_and_its_limits(law):
    function = export.to_casadi(law, "steer")
    assert (function.name(), function.name_in(), function.name_out()) == (
        "steer",
        ["state", "target"],
        ["control"],
    )
    size = len(law.plant.state_names)
    states, targets = stream(1).normal(size=(2, 200, size))
    computed = np.array(function(states.T, targets.T)).T
    # laws that jump amplify what libm rounds otherwise, so not every state agrees
    assert np.median(np.abs(computed - law(states, targets))) < 1e-12
    assert np.all((law.plant.lower <= computed) & (computed <= law.plant.upper))


def test_the_jacobian_is_that_of_the_law():
    law = robot_law()
    function = export.to_casadi(law)
    state, target = np.array([0.3, -0.2, 0.1]), np.array([0.0, 0.1, 0.0])
    symbol = casadi.SX.sym("x", 3)
    jacobian = casadi.Function("j", [symbol], [casadi.jacobian(function(symbol, target), symbol)])
    step = 1e-6
    differences = [
        (law(state + step * e, target) - law(state - step * e, target)) / (2 * step) for e in np.eye(3)
    ]
    assert np.array(jacobian(state)) == pytest.approx(np.transpose(differences), rel=1e-5, abs=1e-8)
