import numpy as np
import pytest

import gpsynth as gs
from gpsynth import export

control = pytest.importorskip("control", reason="python-control is not installed")

PLANT = gs.Plant(
    lambda x, u, t: (x.speed, u.force - 0.3 * np.sin(x.place) * np.cos(0.5 * t)),
    states={"place": "m", "speed": "m/s"},
    controls={"force": ("N", -0.8, 0.8)},
    name="rail",
)
PROBLEM = gs.Problem(
    PLANT, [(1.0, 0.0)], goal=(0.2, 0.0), tolerance=0.01, horizon=6.0, period=0.01, hold=False, stop=False
)


def rail_law() -> gs.Law:
    names = PROBLEM.features.names
    program = gs.trace(
        lambda f: 2.0 * np.tanh(f.error_place) + 1.5 * f.error_speed, [("f", names)], ("force",)
    )
    return gs.Law(PLANT, PROBLEM.features, program, np.empty(0))


def test_signals_have_the_names_of_the_plant():
    system = export.to_control(rail_law())
    assert system.name == "rail"
    assert system.state_labels == ["place", "speed"]
    assert system.input_labels == ["place_target", "speed_target"]
    assert system.output_labels == ["place", "speed", "force"]


def test_the_response_equals_the_simulation():
    law = rail_law()
    path = gs.simulate(PROBLEM, law)
    response = control.input_output_response(
        export.to_control(law),
        path.t,
        path.target.T,
        X0=PROBLEM.starts[0],
        solve_ivp_kwargs={"rtol": 1e-9, "atol": 1e-11},
    )
    # scipy's adaptive steps find the kink where the force leaves its limit, steps of 0.01 s do not
    assert np.asarray(response.states.T) == pytest.approx(path.x, abs=1e-5)
    assert np.asarray(response.outputs[2, :-1]) == pytest.approx(path.u[:, 0], abs=1e-5)
