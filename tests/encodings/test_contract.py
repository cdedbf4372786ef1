"""What every encoding promises, whatever its genomes look like."""

import pickle
import random
from dataclasses import FrozenInstanceError

import numpy as np
import pytest

from gpsynth.encodings.cartesian import CartesianEncoding
from gpsynth.encodings.layers import basic_layers
from gpsynth.encodings.parameters import ParameterSpace
from gpsynth.encodings.tree import TreeEncoding
from gpsynth.encodings.variational import VariationalEncoding
from gpsynth.errors import EncodingError
from gpsynth.operations import GP_NAMES, OPERATIONS
from gpsynth.seeds import stream
from tests.encodings.helpers import ENCODINGS, NETWORK, PLAIN


@pytest.fixture(params=ENCODINGS, name="encoding")
def _encoding(request):
    return ENCODINGS[request.param]


def searched(encoding):
    """The encoding that draws the genomes: that of the holes in a template."""
    return getattr(encoding, "holes", encoding)


def walk(encoding, steps, seed):
    """Genomes of a random walk by all three operators."""
    rng = stream(seed)
    genome = encoding.random(rng)
    for _ in range(steps):
        first, second = encoding.crossover(encoding.mutate(genome, rng), encoding.random(rng), rng)
        yield genome, first, second
        genome = first if rng.random() < 0.5 else second


def test_a_thousand_steps_stay_in_the_domain(encoding):
    for family in walk(encoding, 1000, seed=1):
        for genome in family:
            encoding.check(genome)


def test_decoded_programs_have_the_names_and_numbers_that_were_set(encoding):
    for family in walk(encoding, 50, seed=2):
        for genome in family:
            program = encoding.decode(genome)
            assert program.inputs == encoding.inputs
            assert program.names == encoding.outputs
            assert len(program.parameters) == len(encoding.parameters(genome)) <= encoding.space.count


def test_decoding_is_deterministic_and_survives_pickling(encoding):
    for genome, *_ in walk(encoding, 20, seed=3):
        copies = pickle.loads(pickle.dumps((encoding, genome)))
        assert copies == (encoding, genome)
        assert hash(copies[1]) == hash(genome)
        assert copies[0].decode(copies[1]) == encoding.decode(genome)


def test_the_same_generator_gives_the_same_genomes(encoding):
    assert list(walk(encoding, 50, seed=4)) == list(walk(encoding, 50, seed=4))
    assert list(walk(encoding, 50, seed=4)) != list(walk(encoding, 50, seed=5))


def test_operators_leave_their_arguments_and_the_global_generators_alone(encoding):
    python, numpy = random.getstate(), np.random.get_state()[1].tolist()  # noqa: NPY002
    rng = stream(6)
    for a, b, _ in walk(encoding, 50, seed=7):
        before = pickle.dumps((a, b))
        encoding.mutate(a, rng)
        encoding.crossover(a, b, rng)
        encoding.decode(a)
        assert pickle.dumps((a, b)) == before
    assert random.getstate() == python
    assert np.random.get_state()[1].tolist() == numpy  # noqa: NPY002


def test_genomes_cannot_be_changed_in_place(encoding):
    genome = encoding.random(stream(8))
    with pytest.raises(FrozenInstanceError):
        genome.values = ()


def test_parameters_can_be_read_and_replaced(encoding):
    rng = stream(9)
    for genome, *_ in walk(encoding, 20, seed=10):
        count = len(encoding.parameters(genome))
        values = rng.uniform(encoding.space.lower, encoding.space.upper, count)
        changed = encoding.with_parameters(genome, values)
        encoding.check(changed)
        assert np.array_equal(encoding.parameters(changed), values)
        assert encoding.with_parameters(changed, encoding.parameters(genome)) == genome
        assert encoding.decode(changed) == encoding.decode(genome)


def test_wrong_parameters_are_named(encoding):
    genome = encoding.random(stream(11))
    count = len(encoding.parameters(genome))
    with pytest.raises(EncodingError, match=f"expected {count} parameters"):
        encoding.with_parameters(genome, np.zeros(count + 1))
    for value in (np.nan, np.inf, 4.5 if encoding.space.upper == 4.0 else 11.0):
        if count > 0:
            with pytest.raises(EncodingError, match="parameter 0 is"):
                encoding.with_parameters(genome, np.full(count, value))


def test_every_operation_offered_appears(encoding):
    offered = set(searched(encoding).operations) - {"identity"}
    seen = set()
    for family in walk(encoding, 400, seed=12):
        for genome in family:
            seen |= {OPERATIONS[code].name for code in encoding.decode(genome).code[:, 0]}
        if offered <= seen:
            return
    assert offered <= seen


WITH_A_BASIS = (
    "network-operator",
    "layers",
    "complete-tree",
    "columns",
)  # which may have operations not offered


@pytest.mark.parametrize("name", [name for name in ENCODINGS if not name.startswith(WITH_A_BASIS)])
def test_nothing_appears_that_was_not_offered(name):
    encoding = ENCODINGS[name]
    for genome, *_ in walk(encoding, 100, seed=13):
        names = {OPERATIONS[code].name for code in encoding.decode(genome).code[:, 0]}
        assert names <= set(searched(encoding).operations)


def test_crossover_mixes_both_parents(encoding):
    rng = stream(14)
    a, b = encoding.random(rng), encoding.random(rng)
    children = [child for _ in range(20) for child in encoding.crossover(a, b, rng)]
    assert any(child not in (a, b) for child in children) or encoding is ENCODINGS["cartesian-unary"]


@pytest.mark.parametrize("name", [*WITH_A_BASIS, "cartesian", "cartesian-rate"])
def test_equal_parents_have_equal_children(name):
    rng = stream(15)
    genome = ENCODINGS[name].random(rng)
    assert all(child == genome for _ in range(20) for child in ENCODINGS[name].crossover(genome, genome, rng))


def test_mutation_changes_the_genome(encoding):
    rng = stream(16)
    genomes = [encoding.random(rng) for _ in range(100)]
    assert sum(encoding.mutate(genome, rng) != genome for genome in genomes) > 50


def test_mutation_moves_numbers_and_structure_apart(encoding):
    rng = stream(17)
    for genome, *_ in walk(encoding, 50, seed=18):
        changed = encoding.mutate(genome, rng)
        same = encoding.decode(changed) == encoding.decode(genome)
        assert same or changed.values == genome.values or isinstance(searched(encoding), TreeEncoding)


SEARCHERS = {
    "network-operator": VariationalEncoding(("x",), ("u",), NETWORK, ParameterSpace(2, -4, 4)),
    "layers": VariationalEncoding(("x",), ("u",), NETWORK, ParameterSpace(2, -4, 4), basic_layers(1, 2, 1)),
    "cartesian": CartesianEncoding(("x",), ("u",), PLAIN, ParameterSpace(2, -4, 4), columns=20),
    "tree": TreeEncoding(("x",), ("u",), PLAIN, ParameterSpace(4, -4, 4)),
}


@pytest.mark.parametrize("name", SEARCHERS)
def test_a_hill_climb_finds_a_small_formula(name):
    encoding = SEARCHERS[name]
    x = np.linspace(-1.5, 1.5, 21)[:, None]
    target = x**3 - 2.0 * x
    line = np.mean((target - np.polyval(np.polyfit(x[:, 0], target[:, 0], 1), x)) ** 2)

    def error(genome):
        y = encoding.decode(genome)(x, encoding.parameters(genome))
        cost = np.mean((y - target) ** 2)
        return cost if np.isfinite(cost) else np.inf

    starts, ends = [], []
    for seed in range(5):
        rng = stream(19, seed)
        best = encoding.random(rng)
        cost = error(best)
        starts.append(cost)
        for _ in range(1500):
            other = encoding.mutate(best, rng)
            if (trial := error(other)) <= cost:
                best, cost = other, trial
        ends.append(cost)
    assert np.median(ends) < 0.1 * np.median(starts)
    assert np.median(ends) < line / 5  # so the curve is found, not just its slope


def wrong(**changes):
    return {"inputs": ("x",), "outputs": ("u",), "operations": ("sin", "add"), **changes}


@pytest.mark.parametrize("kind", [VariationalEncoding, CartesianEncoding, TreeEncoding])
@pytest.mark.parametrize(
    ("settings", "sentence"),
    [
        (wrong(inputs=()), "inputs must be one name or more"),
        (wrong(inputs="xy"), "inputs must be one name or more"),
        (wrong(inputs=("x", "x")), "inputs need different names"),
        (wrong(inputs=("x.y",)), "is not a name"),
        (wrong(inputs=("q1",)), "called like a parameter"),
        (wrong(outputs=()), "outputs must be one name or more"),
        (wrong(outputs=("u", "u")), "outputs need different names"),
        (wrong(operations=()), "operations must be one name or more"),
        (wrong(operations=("sine",)), "there is no operation 'sine'"),
        (wrong(operations=("sin", "sin")), "each operation may be named once"),
    ],
)
def test_wrong_settings_are_named(kind, settings, sentence):
    with pytest.raises(EncodingError, match=sentence):
        kind(**settings)


@pytest.mark.parametrize(
    ("space", "sentence"),
    [
        ({"count": -1}, "count of parameters"),
        ({"lower": 1.0, "upper": 1.0}, "lower < upper"),
        ({"upper": np.nan}, "lower < upper"),
        ({"upper": np.inf}, "both finite"),
        ({"step": 0.0}, "step of a parameter"),
        ({"rate": 1.5}, "rate of parameter mutations"),
    ],
)
def test_wrong_parameter_spaces_are_named(space, sentence):
    with pytest.raises(EncodingError, match=sentence):
        ParameterSpace(**space)


@pytest.mark.parametrize("kind", [CartesianEncoding, TreeEncoding])
def test_the_usual_set_is_all_offered(kind):
    encoding = kind(("x",), ("u",), GP_NAMES)
    assert encoding.operations == GP_NAMES
