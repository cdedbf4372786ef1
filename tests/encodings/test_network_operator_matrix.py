import numpy as np
import pytest

from gpsynth.encodings.network_operator_matrix import Matrix, decode_matrix
from gpsynth.encodings.network_operator_text import read_matrix
from gpsynth.errors import EncodingError
from gpsynth.kernels import elementary
from gpsynth.operations import BINARY_BY_NUMBER, OPERATIONS, UNARY_BY_NUMBER
from gpsynth.seeds import stream
from tests.encodings.helpers import evaluate_matrix, plain_chi, plain_rho, wide

TOY = """
[0,0,0,1,1,0,0,12]
[0,0,0,0,1,0,0, 0]
[0,0,0,0,0,3,0, 0]
[0,0,0,1,0,0,0, 1]
[0,0,0,0,2,0,1, 0]
[0,0,0,0,0,1,6, 0]
[0,0,0,0,0,0,2, 1]
[0,0,0,0,0,0,0, 1]
"""  # x1 + sin x1 + q1 x1 e^(-x2)
TOY_VALUES = [
    (0.5, -0.25, 2.0, (0.5, 1.0, 0.25, 1.2840254166877414), 2.2634509552919444),
    (1.2, 0.7, -0.3, (1.2, -0.36, -0.7, -0.1787707093649074), 1.9532683766023187),
    (-2.0, 1.5, 0.9, (-2.0, -1.8, -1.5, -0.4016342882671737), -3.3109317150928557),
]
REGRESSION = """
[0,0,0,0,0,1,1,1,0,2,0,0, 0,0]
[0,0,0,0,0,0,1,0,2,0,0,0, 0,0]
[0,0,0,0,0,1,0,0,0,0,0,0, 0,0]
[0,0,0,0,0,0,0,0,0,0,1,0, 0,0]
[0,0,0,0,0,0,0,3,0,0,0,0, 0,0]
[0,0,0,0,0,2,0,0,0,0,1,0, 0,0]
[0,0,0,0,0,0,2,0,0,0,0,1, 0,0]
[0,0,0,0,0,0,0,2,0,0,0,6, 0,0]
[0,0,0,0,0,0,0,0,1,3,0,0, 0,0]
[0,0,0,0,0,0,0,0,0,1,0,0, 1,0]
[0,0,0,0,0,0,0,0,0,0,1,0,11,0]
[0,0,0,0,0,0,0,0,0,0,0,2, 0,1]
[0,0,0,0,0,0,0,0,0,0,0,0, 2,1]
[0,0,0,0,0,0,0,0,0,0,0,0, 0,1]
"""  # (x0^2 - x1^2) cos(q0 x0 + q1) + x0 x1 e^(-q2 x0)
REGRESSION_VALUES = [
    ((1.5, -0.5), (0.1, 0.1, 0.1), 1.292293861102496),
    ((-2.0, 3.0), (0.1, 0.1, 0.1), -12.303437375351148),
    ((0.7, 0.2), (0.5, -1.0, 2.0), 0.3927612842989),
    ((-94.77123067181776, 0.04656158008345873), (0.1, 0.1, 0.1), -66590.48899298768),
]
SPOTS = {  # rho_n of -2, -0.5, 0, 0.5 and 2, to 12 digits
    1: (-2, -0.5, 0, 0.5, 2),
    2: (4, 0.25, 0, 0.25, 4),
    3: (2, 0.5, 0, -0.5, -2),
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
GUARDS = {  # n: (z, rho_n(z)), where a guard acts
    2: [(20000, 1e8)],
    5: [(-1e-9, -1e8)],
    6: [(18.42, 99931948.77), (18.5, 18.420680744)],
    7: [(3e-4, -18.420680744)],
    8: [(20, 1)],
    14: [(-500, -1e8)],
    15: [(1e-9, 1e-8)],
    16: [(1, 1)],
    18: [(-19, -1e8)],
    19: [(-2e8, -1e-8)],
    22: [(-40, -1)],
    23: [(2e8, -1e8)],
    24: [(-20, 0)],
    26: [(0.009, 0)],
    27: [(1.5, 1)],
    28: [(5, 4.99999995)],
}
PAIRS = [(2, -0.5), (-1.5, 0.25), (-3, -2), (2, -2)]
PAIR_VALUES = {
    1: (1.5, -1.25, -5, 0),
    2: (-1, -0.375, 6, -4),
    3: (2, 0.25, -2, 2),
    4: (-0.5, -1.5, -3, -2),
    5: (2.5, -0.875, -11, 4),
    6: (2.06155281281, -1.52069063257, -3.60555127546, 2.82842712475),
    7: (2.5, -1.75, -5, 4),
    8: (2, -1.5, -3, 2),
}


def unary(number):
    return Matrix(np.array([[0, number], [0, 1]]), (0,), (), (1,))


def binary(number):
    return Matrix(np.array([[0, 0, 1], [0, 0, 1], [0, 0, number]]), (0, 1), (), (2,))


def with_outputs(matrix, outputs):
    return Matrix(matrix.psi, matrix.inputs, matrix.parameters, outputs)


@pytest.mark.parametrize("strict", [True, False])
@pytest.mark.parametrize(("x1", "x2", "q1", "inner", "y"), TOY_VALUES)
def test_the_toy_operator_gives_the_published_values(x1, x2, q1, inner, y, strict):
    matrix = read_matrix(TOY, inputs=(0, 2), parameters=(1,), outputs=(3, 4, 5, 6, 7))
    values = decode_matrix(matrix, strict=strict)(np.array([[x1, x2]]), [q1])
    assert values[0] == pytest.approx((*inner, y), rel=1e-14)


@pytest.mark.parametrize("strict", [True, False])
@pytest.mark.parametrize(("x", "q", "y"), REGRESSION_VALUES)
def test_the_regression_operator_gives_the_published_values(x, q, y, strict):
    matrix = read_matrix(REGRESSION, inputs=(0, 1), parameters=(2, 3, 4), outputs=(13,))
    assert decode_matrix(matrix, strict=strict)(np.array([x]), q)[0, 0] == pytest.approx(y, rel=1e-13)


def test_the_nodes_of_the_regression_operator_have_the_published_values():
    matrix = read_matrix(REGRESSION, inputs=(0, 1), parameters=(2, 3, 4), outputs=tuple(range(5, 13)))
    values = decode_matrix(matrix)(np.array([[1.5, -0.5], [-2.0, 3.0]]), [0.1, 0.1, 0.1])
    first = (0.15000000000000002, -0.75, -0.15000000000000002, 0.25, 2.0, 0.25, -0.6455309823187934)
    second = (-0.2, -6.0, 0.2, 9.0, -5.0, -0.1, -7.32841654896102)
    assert values[0] == pytest.approx((*first, 1.9378248434212895), rel=1e-14)
    assert values[1] == pytest.approx((*second, -4.975020826390129), rel=1e-14)


@pytest.mark.parametrize("number", UNARY_BY_NUMBER)
def test_one_edge_computes_its_unary_function(number):
    cases = [*zip((-2, -0.5, 0, 0.5, 2), SPOTS[number], strict=True), *GUARDS.get(number, [])]
    z, expected = np.array(cases, dtype=float).T
    values = decode_matrix(unary(number))(z[:, None])[:, 0]
    assert values == pytest.approx(expected, rel=1e-10, abs=1e-15)  # the table has 10 to 12 digits
    for point in np.linspace(-25, 25, 1001):
        value = decode_matrix(unary(number))(np.array([[point]]))[0, 0]
        assert value == pytest.approx(plain_rho(number, point), rel=1e-13, abs=1e-14)


@pytest.mark.parametrize("number", BINARY_BY_NUMBER)
def test_one_node_computes_its_binary_function(number):
    program = decode_matrix(binary(number))
    assert program(np.array(PAIRS, dtype=float))[:, 0] == pytest.approx(PAIR_VALUES[number], rel=1e-11)
    for a, b in stream(1).uniform(-3, 3, (200, 2)):
        assert program(np.array([[a, b]]))[0, 0] == pytest.approx(plain_chi(number, a, b), rel=1e-14)


def random_matrix(rng, size=12, n_inputs=2, n_parameters=2, n_outputs=3):
    n_sources = n_inputs + n_parameters
    psi = np.triu(rng.integers(1, 29, (size, size)) * (rng.random((size, size)) < 0.25), 1)
    psi[:, :n_sources] = 0
    for node in range(n_sources, size):
        psi[node, node] = rng.integers(1, 9)
        psi[rng.integers(node), node] = rng.integers(1, 29)
    sources = tuple(range(n_sources))
    return Matrix(
        psi, sources[:n_inputs], sources[n_inputs:], tuple(rng.integers(n_sources, size, n_outputs).tolist())
    )


def by_the_rule(matrix, x, q):
    """The published loop over the package's own functions, so that every bit can be compared."""
    z = evaluate_matrix(
        matrix,
        x.tolist(),
        q.tolist(),
        lambda number, a: elementary.evaluate(UNARY_BY_NUMBER[number].name, a),
        lambda number, a, b: elementary.evaluate(BINARY_BY_NUMBER[number].name, a, b),
    )
    return [z[node] for node in matrix.outputs]


def test_strict_programs_equal_the_published_rule_for_every_input():
    rng = stream(2)
    for _ in range(150):
        matrix = random_matrix(rng)
        special = rng.choice([0.0, -0.0, np.inf, -np.inf, np.nan, 1e8, -1e300, 1e-300], (2, 4))
        points = np.vstack([rng.uniform(-3, 3, (2, 4)), wide(rng, 4, 4), special])
        program = decode_matrix(matrix)
        for point in points:
            values = program(point[None, :2], point[2:])[0]
            # the sign of a zero is the only thing that the unit of a sum may change
            assert np.array_equal(values, by_the_rule(matrix, point[:2], point[2:]), equal_nan=True)


@pytest.mark.parametrize("binary_number", BINARY_BY_NUMBER)
def test_a_unit_is_left_out_only_where_no_value_can_tell(binary_number):
    points = np.array((np.nan, np.inf, 1e300, 2e8, 1e8, 1e4, 70.0, 18.4, 0.3, 1e-9, 1e-300, 0.0))
    points = np.concatenate([points, -points])
    for first in UNARY_BY_NUMBER:
        for second in (1, 3, 7, 17, 20, 21):
            psi = np.array([[0, first, 0], [0, 1, second], [0, 0, binary_number]])
            matrix = Matrix(psi, (0,), (), (2,))
            values = decode_matrix(matrix)(points[:, None])
            expected = [by_the_rule(matrix, point, np.zeros(0)) for point in points[:, None]]
            assert np.array_equal(values, expected, equal_nan=True), (first, second)


def test_short_programs_equal_the_published_rule_for_moderate_values():
    rng = stream(3)
    for _ in range(50):
        matrix = random_matrix(rng, size=8)
        x, q = rng.uniform(-1, 1, (2, 2))
        z = evaluate_matrix(matrix, x.tolist(), q.tolist(), plain_rho, plain_chi)
        if max(map(abs, z)) < 1e8:
            values = decode_matrix(matrix, strict=False)(x[None], q)[0]
            assert np.array_equal(values, by_the_rule(matrix, x, q))


def test_short_programs_differ_where_the_unit_clips_the_first_factor():
    matrix = Matrix(np.array([[0, 0, 1], [0, 0, 1], [0, 0, 2]]), (0, 1), (), (2,))
    x = np.array([[1e12, 1e-6]])
    assert decode_matrix(matrix)(x)[0, 0] == 1e8 * 1e-6
    assert decode_matrix(matrix, strict=False)(x)[0, 0] == 1e12 * 1e-6


def test_units_are_left_out_where_they_change_nothing():
    toy = read_matrix(TOY, inputs=(0, 2), parameters=(1,), outputs=(7,))
    short = ["nop_mul", "neg", "nop_exp", "nop_mul", "sin", "add", "add"]
    assert names(decode_matrix(toy, strict=False)) == short
    assert names(decode_matrix(toy)) == ["nop_mul", *short]  # x1 is clipped before q1 multiplies it
    bounded = np.array([[0, 12, 10], [0, 2, 12], [0, 0, 2]])
    assert names(decode_matrix(Matrix(bounded, (0,), (), (2,)))) == ["sin", "sgn", "sin", "nop_mul"]


def names(program):
    return [OPERATIONS[code].name for code in program.code[:, 0]]


def test_nodes_that_no_output_needs_are_dropped():
    matrix = read_matrix(TOY, inputs=(0, 2), parameters=(1,), outputs=(4,))
    assert names(decode_matrix(matrix, strict=False)) == ["nop_mul"]


def test_programs_have_the_names_asked_for():
    toy = read_matrix(TOY, inputs=(0, 2), parameters=(1,), outputs=(7,))
    program = decode_matrix(toy, ("distance", "angle"), ("v",))
    assert (program.inputs, program.parameters, program.names) == (("distance", "angle"), ("q0",), ("v",))
    assert decode_matrix(toy).inputs == ("x0", "x1")
    with pytest.raises(EncodingError, match="the matrix has 2 inputs, but 1 names were given"):
        decode_matrix(toy, ("distance",))


def test_matrices_are_values():
    first, second = binary(1), binary(1)
    assert first == second
    assert hash(first) == hash(second)
    assert first != binary(2)
    assert first != Matrix(first.psi, (1, 0), (), (2,))
    with pytest.raises(ValueError, match="read-only"):
        first.psi[0, 2] = 3


@pytest.mark.parametrize(
    ("psi", "inputs", "parameters", "outputs", "sentence"),
    [
        ([[0, 1, 1], [0, 1, 1]], (0,), (), (1,), "square matrix, not one of shape"),
        (np.zeros((0, 0), int), (0,), (), (1,), "square matrix"),
        ([[0.0, 1.0], [0.0, 1.0]], (0,), (), (1,), "integer entries, not float64"),
        (np.zeros((600, 600), int), (0,), (), (1,), "600 nodes; at most 512"),
        ([[0, 1], [1, 1]], (0,), (), (1,), r"entry \[1, 0\] is 1; below the diagonal"),
        ([[0, 29], [0, 1]], (0,), (), (1,), r"entry \[0, 1\] is 29; unary functions are 1 to 28"),
        ([[0, -1], [0, 1]], (0,), (), (1,), r"entry \[0, 1\] is -1"),
        ([[0, 1], [0, 9]], (0,), (), (1,), r"entry \[1, 1\] is 9; binary functions are 1 to 8"),
        ([[1, 1], [0, 1]], (0,), (), (1,), "node 0 is a source, so its diagonal entry must be 0, not 1"),
        ([[0, 1], [0, 0]], (0,), (), (1,), "node 1 has 0 on the diagonal but is neither"),
        ([[0, 1, 1], [0, 0, 1], [0, 0, 1]], (0, 1), (), (2,), "node 1 is a source but has an incoming edge"),
        ([[0, 0, 1], [0, 1, 1], [0, 0, 1]], (0,), (), (2,), "node 1 is no source but has no incoming edge"),
        ([[0, 1], [0, 1]], (0,), (), (0,), "output node 0 is a source"),
        ([[0, 1], [0, 1]], (0,), (), (2,), "node 2 does not exist; the matrix has nodes 0 to 1"),
        ([[0, 1], [0, 1]], (0,), (0,), (1,), "share a node"),
        ([[0, 1], [0, 1]], (0,), (), (), "needs an input and an output"),
        ([[0, 1], [0, 1]], (0,), (-1,), (1,), "node -1 does not exist"),
    ],
)
def test_invalid_matrices_are_refused(psi, inputs, parameters, outputs, sentence):
    with pytest.raises(EncodingError, match=sentence):
        Matrix(np.array(psi), inputs, parameters, outputs)
