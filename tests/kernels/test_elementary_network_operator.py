"""The published values of the network operator's functions, typed in from the description of its library."""

import numpy as np
import pytest

from gpsynth.kernels.elementary import evaluate
from gpsynth.operations import BINARY_BY_NUMBER, UNARY_BY_NUMBER

ARGUMENTS = (-2.0, -0.5, 0.0, 0.5, 2.0)
UNARY = {  # rho_n at ARGUMENTS, 12 digits
    1: (-2, -0.5, 0, 0.5, 2),
    2: (4, 0.25, 0, 0.25, 4),
    3: (2, 0.5, -0.0, -0.5, -2),
    4: (-1.41421356237, -0.707106781187, 0, 0.707106781187, 1.41421356237),
    5: (-0.5, -2, 1e8, 2, 0.5),
    6: (0.135335283237, 0.606530659713, 1, 1.6487212707, 7.38905609893),
    7: (0.69314718056, -0.69314718056, -18.420680744, -0.69314718056, 0.69314718056),
    8: (-0.761594155956, -0.244918662404, 0, 0.244918662404, 0.761594155956),
    9: (0, 0, 1, 1, 1),
    10: (-1, -1, 1, 1, 1),
    11: (-0.416146836547, 0.87758256189, 1, 0.87758256189, -0.416146836547),
    12: (-0.909297426826, -0.479425538604, 0, 0.479425538604, 0.909297426826),
    13: (-1.10714871779, -0.463647609001, 0, 0.463647609001, 1.10714871779),
    14: (-8, -0.125, 0, 0.125, 8),
    15: (-1.25992104989, -0.793700525984, 1e-8, 0.793700525984, 1.25992104989),
    16: (-1, -0.5, 0, 0.5, 1),
    17: (-1.09861228867, -0.405465108108, 0, 0.405465108108, 1.09861228867),
    18: (-6.38905609893, -0.6487212707, 0, 0.6487212707, 6.38905609893),
    19: (-0.135335283237, -0.606530659713, 1, 0.606530659713, 0.135335283237),
    20: (-1, -0.25, 0, 0.25, 1),
    21: (-4, -1, 0, 1, 4),
    22: (-0.864664716763, -0.393469340287, 0, 0.393469340287, 0.864664716763),
    23: (6, -0.375, 0, 0.375, -6),
    24: (0.119202922022, 0.377540668798, 0.5, 0.622459331202, 0.880797077978),
    25: (0, 0, 0, 1, 1),
    26: (-1, -1, 0, 1, 1),
    27: (-1, -0.133974596216, 0, 0.133974596216, 1),
    28: (-1.96336872222, -0.110599608464, 0, 0.110599608464, 1.96336872222),
}
GUARDED = (  # number, argument, value
    *(
        (2, 20000, 1e8),
        (5, -1e-9, -1e8),
        (6, 18.42, 99931948.77),
        (6, 18.5, 18.420680744),
        (7, 3e-4, -18.420680744),
    ),
    *(
        (8, 20, 1),
        (14, -500, -1e8),
        (15, 1e-9, 1e-8),
        (16, 1, 1),
        (18, -19, -1e8),
        (19, -2e8, -1e-8),
        (22, -40, -1),
    ),
    *((23, 2e8, -1e8), (24, -20, 0), (26, 0.009, 0), (27, 1.5, 1), (28, 5, 4.99999995)),
)
PAIRS = ((2.0, -0.5), (-1.5, 0.25), (-3.0, -2.0), (2.0, -2.0))
BINARY = {  # chi_n at PAIRS
    1: (1.5, -1.25, -5, 0),
    2: (-1, -0.375, 6, -4),
    3: (2, 0.25, -2, 2),
    4: (-0.5, -1.5, -3, -2),
    5: (2.5, -0.875, -11, 4),
    6: (2.06155281281, -1.52069063257, -3.60555127546, 2.82842712475),
    7: (2.5, -1.75, -5, 4),
    8: (2, -1.5, -3, 2),
}
TWELVE_DIGITS = 1e-11  # relative; the tables are printed with 12 digits


@pytest.mark.parametrize("number", UNARY)
def test_unary_values(number):
    values = [evaluate(UNARY_BY_NUMBER[number].name, z) for z in ARGUMENTS]
    np.testing.assert_allclose(values, UNARY[number], rtol=TWELVE_DIGITS)
    assert np.signbit(values[2]) == np.signbit(UNARY[number][2])


@pytest.mark.parametrize(("number", "argument", "value"), GUARDED)
def test_guards(number, argument, value):
    result = evaluate(UNARY_BY_NUMBER[number].name, argument)
    assert result == pytest.approx(value, rel=1e-10, abs=0.0)  # 10 digits are printed for two of them


@pytest.mark.parametrize("number", BINARY)
def test_binary_values(number):
    values = [evaluate(BINARY_BY_NUMBER[number].name, a, b) for a, b in PAIRS]
    np.testing.assert_allclose(values, BINARY[number], rtol=TWELVE_DIGITS)


@pytest.mark.parametrize("number", BINARY)
def test_unit_elements(number):
    row = BINARY_BY_NUMBER[number]
    assert [evaluate(row.name, z, row.unit) for z in ARGUMENTS] == list(ARGUMENTS)


def test_sgn_of_both_zeros_is_plus_one():
    assert [evaluate("sgn", zero) for zero in (0.0, -0.0)] == [1.0, 1.0]
