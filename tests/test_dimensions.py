from fractions import Fraction

import pytest

from gpsynth.dimensions import TEN, alike, dimension, powers, product, pure, text
from gpsynth.errors import UnitError
from gpsynth.operations import OPERATIONS


def same(first, second):
    return dimension(first) == dimension(second)


@pytest.mark.parametrize(
    ("first", "second"),
    [
        ("N", "kg m/s^2"),
        ("N", "kg*m·s^-2"),
        ("J", "N m"),
        ("W", "J/s"),
        ("V", "W/A"),
        ("Ohm", "V/A"),
        ("F", "C/V"),
        ("H", "Wb/A"),
        ("T", "Wb/m^2"),
        ("Pa", "N/m^2"),
        ("bar", "Pa %^-2.5"),
        ("rad/s", "1/s"),
        ("Hz", "s^-1"),
        ("", "1"),
        ("kg/(m s)", "kg/m/s"),
        ("km mm", "m^2"),
        ("mg", "g^1 %^1.5"),
        ("L", "dm^3"),
        ("t", "Mg"),
        ("m/s/s", "m/s^2"),
        ("m^1/2", "m^0.5"),
    ],
)
def test_units_that_are_the_same_have_one_dimension(first, second):
    assert same(first, second)


@pytest.mark.parametrize(
    ("first", "second"),
    [("m", "km"), ("deg", "rad"), ("min", "s"), ("h", "min"), ("Nm", "N/m"), ("m s", "m/s")],
)
def test_units_that_differ_by_a_factor_differ(first, second):
    first = first.replace("Nm", "N m")
    assert not same(first, second)


@pytest.mark.parametrize("unit", ["m", "m/s^2", "kg m/s^2", "1/s", "1", "m^1/2", "kg/(m s)", "deg"])
def test_a_dimension_is_written_as_a_unit_that_reads_as_the_same(unit):
    assert same(text(dimension(unit)), unit)


def test_powers_of_ten_add_up():
    assert dimension("km") == {"m": 1, TEN: 3}
    assert product((dimension("km"), 2), (dimension("m"), -1)) == {"m": 1, TEN: 6}


@pytest.mark.parametrize(
    ("unit", "sentence"),
    [
        ("furlong", "has the unknown part 'furlong'"),
        ("m/s2", "cannot be read at '2'"),
        ("kg/(m s", "lacks a closing parenthesis"),
        ("kg m)", "closing parenthesis"),
        ("m^x", r"cannot be read at '\^x'"),
        ("mbar", "has the unknown part 'mbar'"),
    ],
)
def test_what_is_no_unit_is_one_sentence(unit, sentence):
    with pytest.raises(UnitError, match=sentence):
        dimension(unit)


@pytest.mark.parametrize("row", OPERATIONS, ids=lambda row: row.name)
def test_every_operation_says_what_it_does_to_dimensions(row):
    assert len(powers(row.name)) == row.arity
    assert set(alike(row.name)) | set(pure(row.name)) <= set(range(row.arity))


def test_scaling_all_lengths_scales_a_result_of_dimension_m():
    """Independent of the table: a formula that is homogeneous of the degree that the table says."""
    from gpsynth.kernels.elementary import evaluate

    length = {"m": Fraction(1)}
    for row in OPERATIONS:
        if pure(row.name) or row.name.startswith("nop_") or row.name == "div_protected":
            continue  # guards of the nop operations break homogeneity far out
        operands = [0.3, 0.7, 0.9][: row.arity]
        degree = product(*((length, power) for power in powers(row.name))).get("m", 0)
        scaled = evaluate(row.name, *(2.0 * operand for operand in operands))
        assert scaled == pytest.approx(2.0 ** float(degree) * evaluate(row.name, *operands)), row.name
