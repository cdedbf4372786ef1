"""Plants: what they compute, how they are stored, and what is refused with a sentence."""

import json
import pickle
from dataclasses import replace

import numpy as np
import pytest

from gpsynth.errors import PlantError, ProgramError, TracingError
from gpsynth.plant import Plant
from gpsynth.tracing import trace

STATES = {"x": "m", "y": "m", "theta": "rad"}
CONTROLS = {"v": ("m/s", -0.5, 0.5), "omega": ("rad/s", -1, 2)}


def unicycle(x, u):
    return u.v * np.cos(x.theta), u.v * np.sin(x.theta), u.omega


def plant(dynamics=unicycle, states=STATES, controls=CONTROLS, angles=("theta",), name="unicycle"):
    return Plant(dynamics, states=states, controls=controls, angles=angles, name=name)


def test_dynamics_become_a_program():
    program = plant().dynamics
    assert program.inputs == ("x", "y", "theta", "v", "omega", "t")
    assert program.names == ("x", "y", "theta")
    np.testing.assert_allclose(
        program(np.array([[1.0, 2.0, 0.3, 0.4, 0.5, 9.0]]))[0],
        [0.4 * np.cos(0.3), 0.4 * np.sin(0.3), 0.5],
        rtol=1e-15,
    )


def test_names_and_limits_are_in_order():
    assert plant().state_names == ("x", "y", "theta")
    assert plant().control_names == ("v", "omega")
    assert plant().lower.tolist() == [-0.5, -1.0]
    assert plant().upper.tolist() == [0.5, 2.0]
    assert not plant().lower.flags.writeable


@pytest.mark.parametrize("result", [tuple, list, np.array])
def test_derivatives_may_come_as_tuple_list_or_array(result):
    assert plant(lambda x, u: result(unicycle(x, u))).dynamics == plant().dynamics


def test_derivatives_in_a_dictionary_are_put_in_order():
    def dynamics(x, u):
        dx, dy, turn = unicycle(x, u)
        return {"theta": turn, "y": dy, "x": dx}

    row = np.array([[1.0, 2.0, 0.3, 0.4, 0.5, 9.0]])
    assert np.array_equal(plant(dynamics).dynamics(row), plant().dynamics(row))


def test_dynamics_may_depend_on_time():
    driven = plant(lambda x, u, t: (u.v, u.omega, np.sin(t)))
    assert driven.dynamics(np.array([[0, 0, 0, 0, 0, 0.5]]))[0, 2] == pytest.approx(np.sin(0.5), rel=1e-15)


def test_an_argument_with_a_default_is_a_parameter_of_the_user():
    scaled = plant(lambda x, u, mass=2.0: (u.v / mass, u.omega, 0.0))
    assert scaled.dynamics(np.array([[0, 0, 0, 3.0, 0, 0.5]]))[0, 0] == 1.5


def test_an_argument_called_t_is_the_time_even_with_a_default():
    driven = plant(lambda x, u, t=0.0: (t, u.omega, 0.0))
    assert driven.dynamics(np.array([[0, 0, 0, 3.0, 0, 0.5]]))[0, 0] == 0.5


def test_dynamics_may_be_a_program():
    assert plant(plant().dynamics) == plant()


def test_with_limits_changes_nothing_else():
    slow = plant().with_limits([-0.1, -0.2], np.array([0.1, 0.2]))
    assert slow.controls == {"v": ("m/s", -0.1, 0.1), "omega": ("rad/s", -0.2, 0.2)}
    assert slow.dynamics == plant().dynamics
    assert slow != plant()


@pytest.mark.parametrize(("lower", "upper"), [([-1.0], [1.0]), ([-1.0, -1.0], [1.0]), (-1.0, 1.0)])
def test_with_limits_needs_one_number_for_each_control(lower, upper):
    with pytest.raises(PlantError, match=r"expected \(2,\) each, for v, omega"):
        plant().with_limits(lower, upper)


def test_with_limits_checks_them():
    with pytest.raises(PlantError, match="limits of omega in unicycle"):
        plant().with_limits([-1.0, 1.0], [1.0, -1.0])


@pytest.mark.parametrize(
    "copied",
    [
        lambda p: pickle.loads(pickle.dumps(p)),
        replace,
        lambda p: Plant.from_dict(json.loads(json.dumps(p.to_dict()))),
    ],
)
def test_copies_are_equal(copied):
    assert copied(plant()) == plant()
    assert hash(copied(plant())) == hash(plant())


def test_stored_plant_keeps_the_order_of_its_names():
    states = {"theta": "rad", "y": "m", "x": "m"}
    document = json.loads(json.dumps(plant(states=states).to_dict(), sort_keys=True))
    assert Plant.from_dict(document).state_names == ("theta", "y", "x")


def test_the_users_dictionaries_are_not_kept():
    states = dict(STATES)
    made = plant(states=states)
    states["z"] = "m"
    assert made.state_names == ("x", "y", "theta")


NAN, INF = float("nan"), float("inf")
WRONG = {
    "few_derivatives": (
        {
            "dynamics": trace(
                lambda x, u: (u.v, u.omega), [("x", tuple(STATES)), ("u", tuple(CONTROLS))], unread=("t",)
            )
        },
        "unicycle return 2 derivatives; expected 3, one for each of x, y, theta",
    ),
    "no_function": ({"dynamics": 5}, "a function or a Program, got 5"),
    "other_program": (
        {"dynamics": trace(lambda x: x, [("x", ("x", "y", "theta"))])},
        "take x, y, theta; expected x, y, theta, v, omega, t",
    ),
    "nan_limit": (
        {"controls": {"v": ("m/s", NAN, 0.5)}},
        "limits of v in unicycle are nan and 0.5; expected finite",
    ),
    "infinite_limit": ({"controls": {"v": ("m/s", -1.0, INF)}}, "limits of v in unicycle are -1.0 and inf"),
    "reversed_limits": ({"controls": {"v": ("m/s", 0.5, -0.5)}}, "limits of v in unicycle are 0.5 and -0.5"),
    "equal_limits": ({"controls": {"v": ("m/s", 0.5, 0.5)}}, "lower < upper"),
    "missing_limits": (
        {"controls": {"v": "m/s"}},
        r"control v of unicycle is given as \(unit, lower, upper\), got 'm/s'",
    ),
    "missing_unit": ({"controls": {"v": (-0.5, 0.5)}}, "unit, lower, upper"),
    "none_limit": ({"controls": {"v": ("m/s", None, 0.5)}}, "limits of v in unicycle are numbers"),
    "text_limit": ({"controls": {"v": ("m/s", "-1", "1")}}, "limits of v in unicycle are numbers"),
    "no_controls": ({"controls": {}}, "controls of unicycle"),
    "no_states": ({"states": {}}, "states of unicycle"),
    "states_list": ({"states": ["x", "y"]}, "states of unicycle are given as a dictionary"),
    "unit_number": ({"states": {**STATES, "x": 1}}, "unit of x in unicycle is a text"),
    "angle_no_state": (
        {"angles": ("phi",)},
        r"angles of unicycle must be different states out of x, y, theta, got \('phi',\)",
    ),
    "angle_twice": ({"angles": ("theta", "theta")}, "different states"),
    "angle_text": ({"angles": "theta"}, "got 'theta'"),
    "state_and_control": ({"states": {**STATES, "v": "m/s"}}, "v is both a state and a control of unicycle"),
    "c_keyword": ({"states": {**STATES, "double": "m"}}, "'double' in unicycle is a keyword"),
    "python_keyword": ({"states": {**STATES, "lambda": "1"}}, "'lambda' in unicycle is a keyword"),
    "time": ({"states": {**STATES, "t": "s"}}, "'t' in unicycle is reserved"),
    "running": ({"states": {**STATES, "running": "s"}}, "'running' in unicycle is reserved"),
    "target": ({"controls": {"x_target": ("m", -1, 1)}}, "'x_target' in unicycle is reserved"),
    "goal": ({"states": {**STATES, "x_goal": "m"}}, "'x_goal' in unicycle is reserved"),
    "spaces": ({"states": {**STATES, "two words": "m"}}, "'two words' in unicycle is not a name"),
    "injection": ({"states": {**STATES, "z; system()": "m"}}, "is not a name"),
    "line_break": ({"states": {**STATES, "z\n": "m"}}, "is not a name"),
    "underscore": ({"states": {**STATES, "_z": "m"}}, "is not a name"),
    "number": ({"states": {**STATES, 5: "m"}}, "5 in unicycle is not a name"),
    "greek": ({"states": {**STATES, "θ": "rad"}}, "is not a name"),
    "plant_name": ({"name": ""}, "name of a plant"),
}


@pytest.mark.parametrize(("change", "message"), WRONG.values(), ids=WRONG)
def test_a_wrong_plant_is_an_error(change, message):
    with pytest.raises(PlantError, match=message) as caught:
        plant(**change)
    assert "\n" not in str(caught.value)


def test_dynamics_that_cannot_be_traced_are_an_error_with_the_line():
    with pytest.raises(
        TracingError, match=r"test_plant.py, line \d+: x has no 'heading'; its names are x, y, theta"
    ):
        plant(lambda x, u: (x.heading, 0.0, 0.0))


MISSING = {
    "few": (lambda x, u: (u.v, u.omega), "returns 2 values; expected 3: x, y, theta"),
    "many": (lambda x, u: (0, 0, 0, 0), "returns 4 values; expected 3: x, y, theta"),
    "one": (lambda x, u: u.v, "returns 1 values; expected 3: x, y, theta"),
    "other_name": (lambda x, u: {"y": 0, "x": 0, "z": 0}, "returns y, x, z; expected x, y, theta"),
    "name_left_out": (lambda x, u: {"x": 0, "y": 0}, "returns x, y; expected x, y, theta"),
}


@pytest.mark.parametrize(("dynamics", "message"), MISSING.values(), ids=MISSING)
def test_other_derivatives_than_those_of_the_states_are_an_error_with_the_line(dynamics, message):
    with pytest.raises(TracingError, match=rf"test_plant.py, line \d+\) {message}"):
        plant(dynamics)


def test_dynamics_with_another_number_of_arguments_are_an_error():
    with pytest.raises(TracingError, match="must take 2 arguments: x, u"):
        plant(lambda x: (x.x, x.y, x.theta))


HOSTILE = {
    "format": {"format": "gpsynth-plant/0"},
    "unknown_field": {"comment": "hello"},
    "states_dictionary": {"states": {"x": "m"}},
    "states_of_texts": {"states": ["xm", "ym", "ht"]},
    "states_twice": {"states": [["x", "m"], ["x", "m"], ["theta", "rad"]]},
    "state_list": {"states": [[["x"], "m"], ["y", "m"], ["theta", "rad"]]},
    "controls_null": {"controls": None},
    "limit_number": {"controls": [["v", "m/s", -0.5, 0.5], ["omega", "rad/s", -1.0, 2.0]]},
    "limit_nan": {"controls": [["v", "m/s", "nan", "0x1p0"], ["omega", "rad/s", "-0x1p0", "0x1p0"]]},
    "limit_enormous": {
        "controls": [["v", "m/s", "-0x1p9999", "0x1p0"], ["omega", "rad/s", "-0x1p0", "0x1p0"]]
    },
    "angles_text": {"angles": "theta"},
    "angles_nested": {"angles": [["theta"]]},
    "angle_unknown": {"angles": ["phi"]},
    "name_number": {"name": 5},
    "name_null": {"name": None},
}


@pytest.mark.parametrize("change", HOSTILE.values(), ids=HOSTILE)
def test_hostile_document_is_refused(change):
    with pytest.raises(PlantError):
        Plant.from_dict({**plant().to_dict(), **change})


@pytest.mark.parametrize("field", plant().to_dict())
def test_document_without_a_field_is_refused(field):
    document = plant().to_dict()
    del document[field]
    with pytest.raises(PlantError):
        Plant.from_dict(document)


@pytest.mark.parametrize("document", [None, [], "plant", 5, {}, {1: 2}])
def test_what_is_no_document_is_refused(document):
    with pytest.raises(PlantError, match="format"):
        Plant.from_dict(document)


def test_changed_dynamics_are_refused():
    document = plant().to_dict()
    document["dynamics"]["code"][0][0] = "sin"
    with pytest.raises(ProgramError, match="hash"):
        Plant.from_dict(document)
