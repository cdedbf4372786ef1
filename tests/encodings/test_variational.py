from itertools import pairwise

import numpy as np
import pytest

from gpsynth.encodings.network_operator_basis import basic_operator
from gpsynth.encodings.network_operator_matrix import ROBOT_OPERATIONS, Matrix, decode_matrix
from gpsynth.encodings.parameters import ParameterSpace
from gpsynth.encodings.variational import VariationalEncoding, VariationalGenome
from gpsynth.encodings.variations import (
    ADD_EDGE,
    DELETE_EDGE,
    IDENTITY,
    REPLACE_BINARY,
    REPLACE_UNARY,
    Variation,
    applies,
    random_variation,
    vary,
)
from gpsynth.errors import EncodingError
from gpsynth.kernels import elementary
from gpsynth.operations import BINARY_BY_NUMBER, UNARY_BY_NUMBER
from gpsynth.seeds import stream
from tests.encodings.helpers import ENCODINGS, evaluate_matrix

PSI = np.array(
    [
        [0, 0, 1, 2, 0],
        [0, 0, 3, 0, 0],
        [0, 0, 2, 1, 0],
        [0, 0, 0, 1, 1],
        [0, 0, 0, 0, 1],
    ],
    dtype=np.int32,
)
ROBOT = VariationalEncoding(("dx", "dy", "dtheta"), ("u1", "u2"), space=ParameterSpace(3, 0.0, 16.0))


@pytest.mark.parametrize(
    ("variation", "changed"),
    [
        (Variation(REPLACE_UNARY, 0, 3, 12), {(0, 3): 12}),
        (Variation(REPLACE_UNARY, 0, 4, 12), {}),  # there is no such edge
        (IDENTITY, {}),
        (Variation(REPLACE_UNARY, 0, 0, 28), {}),
        (Variation(REPLACE_BINARY, 2, 2, 1), {(2, 2): 1}),
        (Variation(REPLACE_BINARY, 0, 0, 1), {}),  # a source
        (Variation(ADD_EDGE, 1, 4, 7), {(1, 4): 7}),
        (Variation(ADD_EDGE, 0, 3, 7), {}),  # there is an edge
        (Variation(ADD_EDGE, 0, 1, 7), {}),  # into a source
        (Variation(DELETE_EDGE, 0, 3, 5), {(0, 3): 0}),
        (Variation(DELETE_EDGE, 1, 2, 5), {}),  # node 1 has no other edge
        (Variation(DELETE_EDGE, 2, 3, 5), {}),  # node 2 has no other edge
        (Variation(DELETE_EDGE, 3, 4, 5), {}),  # node 4 has no other edge
        (Variation(DELETE_EDGE, 0, 4, 5), {}),  # there is no such edge
    ],
)
def test_a_variation_changes_one_entry_if_its_guard_allows(variation, changed):
    expected = PSI.copy()
    for place, entry in changed.items():
        expected[place] = entry
    assert np.array_equal(vary(PSI, (variation,)), expected)


def test_variations_act_on_what_those_before_have_left():
    add, delete = Variation(ADD_EDGE, 1, 3, 7), Variation(DELETE_EDGE, 1, 2, 1)
    assert not applies(PSI, delete)
    assert vary(PSI, (add, delete))[1].tolist() == [0, 0, 0, 7, 0]
    assert vary(PSI, (delete, add))[1].tolist() == [0, 0, 3, 7, 0]


def test_random_variations_keep_every_matrix_valid():
    rng = stream(1)
    basis = basic_operator(2, 1, 2)
    for _ in range(100):
        psi = basis.psi
        for _ in range(40):
            psi = vary(psi, (random_variation(psi, (tuple(range(1, 29)), tuple(range(1, 9))), rng),))
        Matrix(psi, basis.inputs, basis.parameters, basis.outputs)  # raises if it is not


def test_random_variations_are_of_every_kind_and_place():
    rng = stream(2)
    drawn = {random_variation(PSI, ((4, 9), (1, 2)), rng) for _ in range(3000)}
    assert {kind for kind, *_ in drawn} == {0, 1, 2, 3}
    assert {(row, column) for kind, row, column, _ in drawn if kind != REPLACE_BINARY} == {
        (row, column) for row in range(5) for column in range(row + 1, 5)
    }
    assert {row for kind, row, _, _ in drawn if kind == REPLACE_BINARY} == {2, 3, 4}
    assert {w.function for w in drawn if w.kind != REPLACE_BINARY} == {4, 9}
    assert {w.function for w in drawn if w.kind == REPLACE_BINARY} == {1, 2}


def test_the_basic_operator_of_the_robot_is_the_published_one():
    expected = np.zeros((24, 24), dtype=int)
    for i in range(3):
        expected[i, 6 + i] = expected[3 + i, 6 + i] = expected[6 + i, 9 + i] = 1
    for i in range(9, 23):
        expected[i, i + 1] = 1
    for i in range(6, 24):
        expected[i, i] = 2 if i < 9 else 1
    matrix = basic_operator(3, 3, 2)
    assert np.array_equal(matrix.psi, expected)
    assert (matrix.inputs, matrix.parameters, matrix.outputs) == ((0, 1, 2), (3, 4, 5), (22, 23))


def test_the_basic_law_is_the_weighted_sum_of_its_inputs():
    genome = ROBOT.basic()
    x = stream(3).uniform(-3, 3, (10, 3))
    values = ROBOT.decode(genome)(x, genome.values)
    assert genome.values == (1.0, 1.0, 1.0)
    assert np.array_equal(values, np.column_stack([x[:, 0] + x[:, 1] + x[:, 2]] * 2))
    weighted = ROBOT.with_parameters(genome, [2.0, 3.0, 5.0])
    assert ROBOT.decode(weighted)(x, weighted.values)[:, 0] == pytest.approx(x @ [2.0, 3.0, 5.0], rel=1e-14)


@pytest.mark.parametrize("counts", [(1, 0, 1), (1, 0, 5), (2, 5, 1), (5, 2, 3), (3, 3, 2)])
def test_the_basic_operator_sums_for_any_numbers_of_nodes(counts):
    n_inputs, n_parameters, n_outputs = counts
    for n_nodes in (None, 2 * n_inputs + n_parameters + n_inputs + n_outputs - 1):
        matrix = basic_operator(*counts, n_nodes=n_nodes)
        x, q = np.arange(1.0, n_inputs + 1), np.arange(2.0, n_parameters + 2)
        weights = np.append(q, np.ones(n_inputs))[: max(n_inputs, 0)]
        weights[min(n_parameters, n_inputs) :] = 1.0
        values = decode_matrix(matrix)(x[None], q)
        assert np.array_equal(values, np.full((1, n_outputs), weights @ x))
    with pytest.raises(EncodingError, match="n_nodes must be an integer of at least"):
        basic_operator(*counts, n_nodes=2 * n_inputs + n_parameters + n_inputs + n_outputs - 2)


@pytest.mark.parametrize("name", [name for name in ENCODINGS if name.startswith("network-operator")])
def test_programs_equal_the_varied_matrix_evaluated_by_the_rule(name):
    encoding = ENCODINGS[name]
    rng = stream(4)
    for _ in range(50):
        genome = encoding.random(rng)
        matrix = encoding.rebased(genome).basis
        x = rng.uniform(-1, 1, len(encoding.inputs))
        z = evaluate_matrix(
            matrix,
            x.tolist(),
            list(genome.values),
            lambda number, a: elementary.evaluate(UNARY_BY_NUMBER[number].name, a),
            lambda number, a, b: elementary.evaluate(BINARY_BY_NUMBER[number].name, a, b),
        )
        if max(map(abs, z)) < 1e8:
            expected = [z[node] for node in matrix.outputs]
            assert np.array_equal(encoding.decode(genome)(x[None], genome.values)[0], expected)


def test_a_new_basis_carries_the_structure_on():
    rng = stream(5)
    genome = ROBOT.random(rng)
    epoch = ROBOT.rebased(genome)
    assert epoch.decode(epoch.basic(genome.values)) == ROBOT.decode(genome)
    assert epoch.basic(genome.values).values == genome.values
    assert ROBOT.decode(ROBOT.basic()) != ROBOT.decode(genome)


def test_each_variation_of_a_random_genome_changes_the_matrix():
    rng = stream(6)
    for _ in range(50):
        genome = ROBOT.random(rng)
        stages = [vary(ROBOT.basis.psi, genome.variations[:count]) for count in range(9)]
        assert not any(np.array_equal(a, b) for a, b in pairwise(stages))


def test_trimming_keeps_the_first_variations():
    genome = ROBOT.random(stream(11))
    for count in range(9):
        trimmed = ROBOT.trimmed(genome, count)
        ROBOT.check(trimmed)
        assert np.array_equal(
            ROBOT.rebased(trimmed).basis.psi, vary(ROBOT.basis.psi, genome.variations[:count])
        )
        assert trimmed.values == genome.values


@pytest.mark.parametrize("name", ["network-operator", "network-operator-gray", "network-operator-no-numbers"])
def test_a_double_mutation_changes_one_variation_and_one_number(name):
    encoding, rng = ENCODINGS[name], stream(12)
    for _ in range(50):
        genome = encoding.random(rng)
        child = encoding.mutate_both(genome, rng)
        encoding.check(child)
        pairs = zip(genome.variations, child.variations, strict=True)
        assert sum(a != b for a, b in pairs) <= 1
        moved = sum(a != b for a, b in zip(genome.values, child.values, strict=True))
        assert moved == min(1, len(genome.values))


def test_four_children_share_out_structure_and_numbers():
    rng = stream(7)
    a, b = ROBOT.random(rng), ROBOT.random(rng)
    for _ in range(50):
        one, two, three, four = ROBOT.children(a, b, rng)
        assert (one.variations, two.variations) == (a.variations, b.variations)
        assert (one.values, two.values) == (three.values, four.values)
        cuts = [
            cut
            for cut in range(9)
            if three.variations == a.variations[:cut] + b.variations[cut:]
            and four.variations == b.variations[:cut] + a.variations[cut:]
        ]
        assert cuts


def test_crossover_gives_either_pair_of_children():
    a, b = ROBOT.random(stream(8)), ROBOT.random(stream(9))
    kept = [ROBOT.crossover(a, b, stream(10, k))[0].variations == a.variations for k in range(40)]
    assert 5 < sum(kept) < 35


def test_the_robot_set_is_the_published_one():
    assert len(ROBOT_OPERATIONS) == 22
    assert {UNARY_BY_NUMBER[n].name for n in (20, 21, 22, 24, 25, 26, 27, 28)}.isdisjoint(ROBOT_OPERATIONS)
    assert {"add", "nop_mul", "minus_cube", "identity"} <= set(ROBOT_OPERATIONS)


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"operations": ("sin", "tan")}, "tan is not a function of the network operator"),
        ({"n_variations": 0}, "n_variations must be an integer of at least 1"),
        ({"gray_bits": -1}, "gray_bits must be an integer of at least 0"),
        ({"basis": basic_operator(2, 0, 1)}, "2 inputs, 0 parameters and 1 outputs; expected 1, 0 and 1"),
        ({"space": ParameterSpace(2), "basis": basic_operator(1, 0, 1)}, "expected 1, 2 and 1"),
    ],
)
def test_wrong_settings_are_named(changes, sentence):
    with pytest.raises(EncodingError, match=sentence):
        VariationalEncoding(("x",), ("u",), **changes)


@pytest.mark.parametrize(
    "variation",
    [
        Variation(4, 0, 6, 1),
        Variation(-1, 0, 6, 1),
        Variation(REPLACE_UNARY, 6, 0, 1),
        Variation(REPLACE_UNARY, 0, 24, 1),
        Variation(REPLACE_UNARY, -1, 6, 1),
        Variation(REPLACE_UNARY, 0, 6, 20),
        Variation(REPLACE_BINARY, 6, 7, 1),
        Variation(REPLACE_BINARY, 6, 6, 3),
        Variation(ADD_EDGE, 0, 6.0, 1),
    ],
)
def test_foreign_variations_are_refused(variation):
    genome = VariationalGenome((variation, *ROBOT.basic().variations[1:]), (1.0, 1.0, 1.0))
    with pytest.raises(EncodingError, match="variation 0 is"):
        ROBOT.check(genome)


def test_foreign_genomes_are_refused():
    with pytest.raises(EncodingError, match="expected 8 variations, got 1"):
        ROBOT.check(VariationalGenome((IDENTITY,), (1.0, 1.0, 1.0)))
    with pytest.raises(EncodingError, match="expected 3 parameters"):
        ROBOT.check(VariationalGenome(ROBOT.basic().variations, (1.0,)))
