import numpy as np
import pytest

from gpsynth.builder import Builder
from gpsynth.errors import UnitError
from gpsynth.law import Law
from gpsynth.plant import Plant
from gpsynth.problem import Problem
from gpsynth.tracing import trace
from gpsynth.units import check_units

CART = Plant(
    lambda x, u: (x.speed, (u.force - 0.4 * x.speed) / 0.5),
    states={"place": "m", "speed": "m/s"},
    controls={"force": ("N", -2.0, 2.0)},
)
NAMES = ("error_place", "error_speed")


def law(build, parameters=("k1", "k2"), plant=CART):
    problem = Problem(plant, [(0.0, 0.0)], (0.0, 0.0), tolerance=0.1)
    builder = Builder(NAMES, parameters)
    output = build(builder.apply, *builder.inputs, *builder.parameters)
    program = builder.build([output], plant.control_names)
    return Law(plant, problem.features, program, np.ones(len(parameters)))


def test_the_units_of_gains_follow_from_those_of_the_plant():
    report = check_units(
        law(lambda apply, e, v, k1, k2: apply("add", apply("mul", k1, e), apply("mul", k2, v)))
    )
    assert report.consistent
    assert report.parameters == {"k1": "kg/s^2", "k2": "kg/s"}
    assert str(report) == "the units fit\nwith k1 in kg/s^2, k2 in kg/s"


def test_a_gain_may_be_known_through_another():
    # tanh(k1 e) k2: k1 makes e pure, k2 is the force
    report = check_units(
        law(lambda apply, e, v, k1, k2: apply("mul", apply("tanh", apply("mul", k1, e)), k2))
    )
    assert report.parameters == {"k1": "1/m", "k2": "kg m/s^2"}
    # k1 k2 e: only the product is known
    report = check_units(law(lambda apply, e, v, k1, k2: apply("mul", apply("mul", k1, k2), e)))
    assert report.consistent
    assert "any" in report.parameters.values()
    # k1 e + k1 v cannot be: one gain has one unit
    report = check_units(
        law(lambda apply, e, v, k1, k2: apply("add", apply("mul", k1, e), apply("mul", k1, v)))
    )
    assert report.conflicts == ("error_place * k1 + error_speed * k1: the units differ by 1/s",)


@pytest.mark.parametrize(
    ("build", "conflict"),
    [
        (lambda apply, e, v: apply("add", e, v), "error_place + error_speed: m/s does not fit m"),
        (lambda apply, e, v: apply("sin", e), "sin(error_place): m does not fit 1"),
        (lambda apply, e, v: apply("max", e, v), "max(error_place, error_speed): m/s does not fit m"),
        (lambda apply, e, v: e, "force: m does not fit kg m/s^2"),
        (lambda apply, e, v: apply("lt", e, v), "(error_place < error_speed): m/s does not fit m"),
        (lambda apply, e, v: apply("atan2", e, v), "atan2(error_place, error_speed): m/s does not fit m"),
    ],
)
def test_what_does_not_belong_together_is_named(build, conflict):
    report = check_units(law(build, ()))
    assert not report.consistent
    assert report.conflicts[0] == conflict


def test_numbers_in_formulas_may_have_any_unit():
    def build(apply, e, v):
        return apply("add", e, v)

    weighted = trace(lambda f: 3.0 * f.error_place + 3.0 * f.error_speed, [("f", NAMES)], ("force",))
    problem = Problem(CART, [(0.0, 0.0)], (0.0, 0.0), tolerance=0.1)
    assert check_units(Law(CART, problem.features, weighted, ())).consistent
    assert not check_units(law(build, ())).consistent


def test_features_are_checked_too():
    problem = Problem(
        CART,
        [(0.0, 0.0)],
        (0.0, 0.0),
        tolerance=0.1,
        features=lambda x, target: {"mix": x.place - target.speed},
    )
    program = trace(lambda f: 2.0 * f.mix, [("f", ("mix",))], ("force",))
    report = check_units(Law(CART, problem.features, program, ()))
    assert report.conflicts == ("place - speed_target: m/s does not fit m",)


def test_a_plant_is_checked_by_its_rates():
    assert check_units(CART).consistent
    wrong = Plant(
        lambda x, u: (x.place, u.force), {"place": "m", "speed": "m/s"}, {"force": ("N", -1.0, 1.0)}
    )
    assert check_units(wrong).conflicts == (
        "place: m does not fit m/s",
        "speed: kg m/s^2 does not fit m/s^2",
    )
    named = Plant(
        lambda x, u, p: (x.speed, u.force / p.mass),
        {"place": "m", "speed": "m/s"},
        {"force": ("N", -1.0, 1.0)},
        parameters={"mass": ("g", 1.0, 2.0)},
    )
    assert check_units(named).conflicts == ("speed: 10^3 m/s^2 does not fit m/s^2",)


def test_a_unit_that_cannot_be_read_is_one_sentence():
    plant = Plant(lambda x, u: (u.f,), {"x": "cubit"}, {"f": ("m/s", -1.0, 1.0)})
    with pytest.raises(UnitError, match="has the unknown part 'cubit'"):
        check_units(plant)
