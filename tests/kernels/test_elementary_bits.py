"""The interpreter, the numba kernel and the compiled C give the same bits on every operand."""

import itertools

import numpy as np
import pytest

from gpsynth.errors import OperationError
from gpsynth.export.elementary_c import functions
from gpsynth.kernels.bits import bits_of, float_of
from gpsynth.kernels.elementary import evaluate, function_of
from gpsynth.operations import operation
from gpsynth.seeds import stream
from tests.kernels.elementary_loops import (
    COMPILER,
    NAMES,
    bits,
    by_interpreter,
    by_numba,
    c_library,
)

OPTIMIZATIONS = {"O0": ("-O0",), "O2": ("-O2",), "O3-native": ("-O3", "-march=native")}
GUARDS = (
    *(1e-8, 1e-2, 0.5, 0.55, 1.0, 2.0, 1e4, 1e8, 1e300, 18.420680743952367, 464.1588833612782, 746.0, 710.0),
    *(
        np.exp(-8.0),
        np.sqrt(0.5),
        np.pi / 4,
        np.pi / 2,
        np.pi,
        2 * np.pi,
        709.782712893384,
        745.1332191019412,
    ),
)
PLAIN = (0.0, 5e-324, 2.2250738585072014e-308, 2.225073858507201e-308, 1e22, 1e308, 1.7976931348623157e308)
OTHERS = (2.0**52 - 0.5, 2.0**52, 2.0**53, 1.5, 2.5, 3.0, 8.0, 0.1, np.inf, np.nan)


def specials() -> np.ndarray:
    """Zeros, subnormals, extremes, and the guards with their neighbors, of both signs."""
    guards = np.array(GUARDS)
    around = [guards, np.nextafter(guards, 0.0), np.nextafter(guards, np.inf)]
    positive = np.concatenate([*around, np.array(PLAIN), np.array(OTHERS)])
    return np.concatenate([positive, -positive])


def grid(arity: int) -> list[np.ndarray]:
    """The cross product of the specials; of a few of them for three operands."""
    values = specials() if arity < 3 else specials()[::5]
    return list(np.array(list(itertools.product(values, repeat=arity))).T.copy())


def random_patterns(name: str, size: int) -> list[np.ndarray]:
    """Random bits, one third of them, normal numbers of every day, and the two mixed with specials."""
    rng = stream(11, NAMES.index(name))
    operands = []
    for _ in range(operation(name).arity):
        wild = rng.integers(-(2**63), 2**63, size, dtype=np.int64).view(np.float64)
        tame = rng.normal(size=size) * 10.0 ** rng.uniform(-9, 9, size)
        salted = rng.choice(specials(), size)
        operands.append(np.choose(rng.integers(0, 3, size), [wild, tame, salted]))
    return operands


@pytest.fixture(scope="module", params=OPTIMIZATIONS)
def by_c(request, tmp_path_factory):
    if COMPILER is None:
        pytest.skip("no C compiler on this machine")
    return c_library(tmp_path_factory.mktemp(request.param), *OPTIMIZATIONS[request.param])


@pytest.mark.parametrize("name", NAMES)
def test_c_equals_numba(name, by_c):
    for operands in (grid(operation(name).arity), random_patterns(name, 120_000)):
        assert np.array_equal(bits(by_c(name, operands)), bits(by_numba(name, operands)))


@pytest.mark.parametrize("name", NAMES)
def test_interpreter_equals_numba(name):
    cross = [column[:: max(1, column.size // 400)] for column in grid(operation(name).arity)]
    for operands in ([column.copy() for column in cross], random_patterns(name, 400)):
        assert np.array_equal(bits(by_interpreter(name, operands)), bits(by_numba(name, operands)))


def test_lanes_do_not_depend_on_their_neighbors():
    values = random_patterns("sin", 1001)[0]
    for name in ("sin", "exp", "tanh"):
        whole = bits(by_numba(name, [values]))
        parts = [bits(by_numba(name, [part])) for part in np.split(values, [1, 4, 11, 64, 700])]
        assert np.array_equal(whole, np.concatenate(parts))


def test_square_root_without_libm_is_correctly_rounded(by_c):
    mantissas = 1.0 + np.arange(0, 200_000) * 2.0**-52
    below_four = np.float64(4.0) - np.arange(1, 200_000) * 2.0**-51
    squares = np.square(stream(12).uniform(1.0, 2.0, 200_000))
    for values in (mantissas, 2.0 * mantissas, below_four, squares, squares * 2.0**-1060):
        assert np.array_equal(by_c("sqrt", [values]), np.sqrt(values))


def test_bits_and_floats_are_inverse():
    for value in (0.0, -0.0, 1.5, -5e-324, np.inf):
        assert bits(np.array(float_of(bits_of(value)))) == bits(np.array(value))


def test_a_subset_of_rows_brings_exactly_what_it_calls():
    text = functions(["log", "max"])
    assert text.count("\nstatic ") == len(["bits_of", "float_of", "integer_of", "log", "max"])
    assert text.index("gp_integer_of(uint64_t") < text.index("gp_log(double") < text.index("gp_max(double")


def test_an_unknown_row_is_named():
    with pytest.raises(OperationError, match="'sine'"):
        function_of("sine")


def test_division_by_zero_is_a_value_in_the_interpreter():
    assert evaluate("div", 1.0, 0.0) == np.inf
    assert np.isnan(evaluate("sqrt", -1.0))
