"""The contract of the table of operations, row by row."""

import itertools

import numpy as np
import pytest

from gpsynth.errors import OperationError
from gpsynth.kernels import elementary
from gpsynth.operations import BINARY_BY_NUMBER, CODES, GP_NAMES, OPERATIONS, UNARY_BY_NUMBER, operation
from gpsynth.seeds import stream

SPECIAL = (0.0, -0.0, 1.0, -1.0, 0.01, 1e-8, 1e8, -1e8, 5e-324, 1e308, -1e308, np.inf, -np.inf, np.nan)
EVERY = pytest.mark.parametrize("row", OPERATIONS, ids=lambda row: row.name)


def bits(value):
    """Of a number; all NaN are one."""
    return "nan" if np.isnan(value) else float(value).hex()


def within_the_library_bounds(count=500):
    """Numbers of all magnitudes whose squares are neither subnormal nor above 1e16, and both zeros."""
    rng = stream(11)
    magnitudes = 10.0 ** rng.uniform(-150.0, 8.0, count)
    return [0.0, -0.0, 1e8, -1e8, *(magnitudes * rng.choice([-1.0, 1.0], count))]


@EVERY
def test_name_is_an_identifier_found_by_its_code(row):
    assert row.name.isidentifier()
    assert row.name == row.name.lower()
    assert OPERATIONS[CODES[row.name]] is row
    assert operation(row.name) is row


def test_names_are_different():
    assert len(CODES) == len(OPERATIONS)


@EVERY
def test_arity_is_that_of_the_scalar_function(row):
    function = elementary.function_of(row.name)
    assert row.arity in (1, 2, 3)
    assert function.__code__.co_argcount == row.arity


@EVERY
def test_latex_shows_every_operand_with_balanced_braces(row):
    operands = ("FIRST", "SECOND", "THIRD")[: row.arity]
    text = row.latex.format(*operands)
    assert all(operand in text for operand in operands)
    assert text.count("{") == text.count("}")
    assert text.count("\\left") == text.count("\\right")


@EVERY
def test_value_is_a_float_whatever_the_operands(row):
    for operands in itertools.product(SPECIAL, repeat=row.arity):
        assert type(elementary.evaluate(row.name, *operands)) is float


@pytest.mark.parametrize("row", [row for row in OPERATIONS if row.unit is not None], ids=lambda row: row.name)
def test_unit_changes_nothing(row):
    for z in within_the_library_bounds():
        assert elementary.evaluate(row.name, z, row.unit) == z


@pytest.mark.parametrize("row", [row for row in OPERATIONS if row.commutative], ids=lambda row: row.name)
def test_commutative_in_every_bit(row):
    numbers = [*SPECIAL, *stream(12).normal(0.0, 10.0, 40)]
    for a, b in itertools.product(numbers, repeat=2):
        assert bits(elementary.evaluate(row.name, a, b)) == bits(elementary.evaluate(row.name, b, a))


@pytest.mark.parametrize("name", ["max", "min", "signed_abs_max", "atan2", "sub", "div"])
def test_not_called_commutative_where_order_matters(name):
    assert not operation(name).commutative


def test_network_operator_numbers_are_complete():
    assert sorted(UNARY_BY_NUMBER) == list(range(1, 29))
    assert sorted(BINARY_BY_NUMBER) == list(range(1, 9))


def test_network_operator_functions_have_one_and_two_operands():
    assert all(row.arity == 1 for row in UNARY_BY_NUMBER.values())
    assert all(row.arity == 2 and row.unit is not None for row in BINARY_BY_NUMBER.values())


# rho_n(-2), rho_n(0.5) and chi_n(2, -1/2): the published library's values, to 12 digits.
UNARY_VALUES = {
    **{1: (-2, 0.5), 2: (4, 0.25), 3: (2, -0.5), 4: (-1.41421356237, 0.707106781187), 5: (-0.5, 2)},
    **{6: (0.135335283237, 1.6487212707), 7: (0.69314718056, -0.69314718056), 9: (0, 1), 10: (-1, 1)},
    **{8: (-0.761594155956, 0.244918662404), 11: (-0.416146836547, 0.87758256189), 14: (-8, 0.125)},
    **{12: (-0.909297426826, 0.479425538604), 13: (-1.10714871779, 0.463647609001), 16: (-1, 0.5)},
    **{15: (-1.25992104989, 0.793700525984), 17: (-1.09861228867, 0.405465108108), 20: (-1, 0.25)},
    **{18: (-6.38905609893, 0.6487212707), 19: (-0.135335283237, 0.606530659713), 21: (-4, 1)},
    **{22: (-0.864664716763, 0.393469340287), 23: (6, 0.375), 24: (0.119202922022, 0.622459331202)},
    **{25: (0, 1), 26: (-1, 1), 27: (-1, 0.133974596216), 28: (-1.96336872222, 0.110599608464)},
}
BINARY_VALUES = {1: 1.5, 2: -1.0, 3: 2.0, 4: -0.5, 5: 2.5, 6: 2.06155281281, 7: 2.5, 8: 2.0}


@pytest.mark.parametrize("number", range(1, 29))
def test_unary_number_names_the_published_function(number):
    values = [elementary.evaluate(UNARY_BY_NUMBER[number].name, z) for z in (-2.0, 0.5)]
    assert values == pytest.approx(UNARY_VALUES[number], rel=1e-11)


@pytest.mark.parametrize("number", range(1, 9))
def test_binary_number_names_the_published_function(number):
    value = elementary.evaluate(BINARY_BY_NUMBER[number].name, 2.0, -0.5)
    assert value == pytest.approx(BINARY_VALUES[number], rel=1e-11)


def test_usual_set_is_in_the_table_and_total():
    for name in GP_NAMES:
        for operands in itertools.product((0.0, -0.0, 1.0, -3.5, 1e8, -1e8), repeat=operation(name).arity):
            assert np.isfinite(elementary.evaluate(name, *operands)), (name, operands)


def test_unknown_name_is_an_error_that_lists_the_table():
    with pytest.raises(OperationError, match=r"no operation 'sine'.*add.*signed_abs_max"):
        operation("sine")
