from dataclasses import replace

import numpy as np
import pytest

from gpsynth.encodings.layers import Layers, basic_layers
from gpsynth.encodings.network_operator_matrix import Matrix, decode_matrix
from gpsynth.encodings.parameters import ParameterSpace
from gpsynth.encodings.variational import VariationalEncoding
from gpsynth.errors import EncodingError
from gpsynth.kernels import elementary
from gpsynth.operations import BINARY_BY_NUMBER, UNARY_BY_NUMBER
from gpsynth.seeds import stream
from tests.encodings.helpers import ENCODINGS, evaluate_matrix
from tests.encodings.three_cars import LEFT, PARAMETERS, RIGHT, basic_network, driven

NAMES = tuple(f"x{k}" for k in range(9)), tuple(f"u{k}" for k in range(9))
CARS = VariationalEncoding(*NAMES, space=ParameterSpace(9), basis=basic_network())
SOLUTION_148 = ((3, 2, 0, 15, 18), (3, 2, 7, 11, 4), (3, 1, 11, 11, 2))  # all else is the basic network


def network(variations, values):
    genome = replace(
        CARS.basic(values), variations=(*variations, *[CARS.basis.identity] * (8 - len(variations)))
    )
    CARS.check(genome)
    program = CARS.decode(genome)
    return lambda points: program(points, genome.values)


@pytest.mark.slow
def test_the_published_solution_of_three_cars_is_reproduced():
    times, penalties, misses = driven(
        network(SOLUTION_148, PARAMETERS), (LEFT,)
    )  # the port tests one obstacle
    assert penalties == pytest.approx(
        [1.221645, 0.939687, 0.626679, 1.352729, 0.298194, 0.0, 0.299922, 1.070710], abs=5e-7
    )
    assert times.sum() + penalties.sum() == pytest.approx(69.88956456978948, rel=1e-13)
    assert penalties.sum() == pytest.approx(5.809564569790496, rel=1e-12)
    assert times.sum() == pytest.approx(8 * 8.01)
    assert misses.min() > 20.0  # no case comes near a goal, which the published second functional leaves out


@pytest.mark.slow
def test_both_obstacles_and_the_misses_are_counted():
    times, penalties, misses = driven(network(SOLUTION_148, PARAMETERS), (LEFT, RIGHT))
    assert times.sum() + penalties.sum() == pytest.approx(89.1028, abs=5e-5)
    assert penalties.sum() == pytest.approx(25.0228, abs=5e-5)
    assert misses.sum() == pytest.approx(214.3, abs=0.05)


@pytest.mark.slow
def test_the_basic_network_of_three_cars_is_reproduced():
    times, penalties, _ = driven(network((), np.ones(9)), (LEFT,))
    assert times.sum() + penalties.sum() == pytest.approx(121.97329, abs=5e-6)
    assert penalties.sum() == pytest.approx(57.89329, abs=5e-6)


@pytest.mark.parametrize("name", [name for name in ENCODINGS if name.startswith("layers")])
def test_programs_equal_the_layers_evaluated_one_by_one(name):
    encoding = ENCODINGS[name]
    rng = stream(1)
    for _ in range(50):
        genome = encoding.random(rng)
        layers = encoding.rebased(genome).basis
        x = rng.uniform(-1, 1, len(encoding.inputs))
        values = [[*x.tolist(), *genome.values]]
        for psi, places in zip(layers.entries, layers.connections, strict=True):
            matrix = Matrix(psi, tuple(range(len(places))), (), (len(psi) - 1,))
            values.append(
                evaluate_matrix(
                    matrix,
                    [values[layer][node] for layer, node in places],
                    [],
                    lambda number, a: elementary.evaluate(UNARY_BY_NUMBER[number].name, a),
                    lambda number, a, b: elementary.evaluate(BINARY_BY_NUMBER[number].name, a, b),
                )
            )
        expected = [values[layer][node] for layer, node in layers.outputs]
        if max(abs(value) for layer in values for value in layer) < 1e8:
            assert np.array_equal(encoding.decode(genome)(x[None], genome.values)[0], expected)


def test_one_layer_is_a_network_operator():
    psi = np.array([[0, 0, 1, 12], [0, 0, 5, 0], [0, 0, 2, 1], [0, 0, 0, 1]], dtype=np.int32)
    layers = Layers(psi[None], (((0, 0), (0, 1)),), 1, 1, ((1, 3),))
    matrix = decode_matrix(Matrix(psi, (0,), (1,), (3,)), strict=False)
    assert layers.program(layers.entries, ("x0",), ("u0",)) == matrix


@pytest.mark.parametrize("counts", [(1, 0, 1), (1, 3, 2), (3, 3, 2), (7, 5, 1), (9, 12, 9)])
def test_the_basic_layers_weight_and_sum(counts):
    n_inputs, n_parameters, n_outputs = counts
    layers = basic_layers(*counts)
    x, q = np.arange(1.0, n_inputs + 1), np.arange(2.0, n_parameters + 2)
    weights = np.append(q, np.ones(n_inputs))[:n_inputs]
    weights[n_parameters:] = 1.0
    inputs, outputs = [f"x{k}" for k in range(n_inputs)], [f"u{k}" for k in range(n_outputs)]
    values = layers.program(layers.entries, tuple(inputs), tuple(outputs))(x[None], q)
    assert np.array_equal(values, np.full((1, n_outputs), weights @ x))


@pytest.mark.parametrize(
    ("variation", "sentence"),
    [((4, 0, 0, 6, 1), "variation 0"), ((0, 0, 0, 6), "variation 0"), ((0, 0, 6, 0, 1), "variation 0")],
)
def test_foreign_variations_are_refused(variation, sentence):
    genome = CARS.basic()
    with pytest.raises(EncodingError, match=sentence):
        CARS.check(replace(genome, variations=(variation, *genome.variations[1:])))


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"connections": (((0, 0),),)}, r"layer 1: node 1 has 0 on the diagonal"),
        ({"connections": (((0, 0), (1, 3)),)}, r"place \(1, 3\) does not exist before layer 1"),
        ({"connections": (((0, 0), (0, 2)),)}, r"place \(0, 2\) does not exist before layer 1"),
        ({"connections": ()}, "0 groups"),
        ({"outputs": ((2, 3),)}, r"place \(2, 3\) does not exist before layer 2"),
        ({"outputs": ((1, 1),)}, r"output \(1, 1\) is a source"),
    ],
)
def test_layers_that_do_not_fit_are_refused(changes, sentence):
    psi = np.array([[0, 0, 1, 0], [0, 0, 1, 0], [0, 0, 2, 1], [0, 0, 0, 1]], dtype=np.int32)
    settings = {"connections": (((0, 0), (0, 1)),), "outputs": ((1, 3),), **changes}
    with pytest.raises(EncodingError, match=sentence):
        Layers(entries=psi[None], n_inputs=1, n_parameters=1, **settings)
