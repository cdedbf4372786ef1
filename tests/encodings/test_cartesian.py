from itertools import pairwise

import numpy as np
import pytest

from gpsynth.encodings.cartesian import CartesianEncoding, CartesianGenome
from gpsynth.encodings.parameters import ParameterSpace
from gpsynth.errors import EncodingError
from gpsynth.kernels import elementary
from gpsynth.operations import operation
from gpsynth.seeds import stream
from tests.encodings.helpers import ENCODINGS, evaluate_cartesian

SMALL = CartesianEncoding(("x",), ("u",), ("add", "sin"), ParameterSpace(1), columns=2)
GENOME = CartesianGenome((1, 0, 0, 0, 2, 1, 3), (0.5,))  # sin(x), then that plus q0


def test_a_graph_reads_as_its_formula():
    assert SMALL.decode(GENOME)(np.array([[0.3]]), GENOME.values)[0, 0] == pytest.approx(np.sin(0.3) + 0.5)


@pytest.mark.parametrize("name", [name for name in ENCODINGS if name.startswith("cartesian")])
def test_programs_equal_the_graph_evaluated_by_recursion(name):
    encoding = ENCODINGS[name]
    rng = stream(1)
    for _ in range(100):
        genome = encoding.random(rng)
        x = rng.uniform(-2, 2, (3, len(encoding.inputs)))
        expected = [evaluate_cartesian(encoding, genome, row, elementary.evaluate) for row in x.tolist()]
        assert np.array_equal(encoding.decode(genome)(x, genome.values), expected, equal_nan=True)


def test_nodes_that_no_output_needs_are_dropped():
    shorter = CartesianGenome((*GENOME.genes[:-1], 2), GENOME.values)
    assert SMALL.decode(GENOME).complexity == 2
    assert SMALL.decode(shorter).complexity == 1


def test_equal_nodes_are_one():
    encoding = CartesianEncoding(("x",), ("u",), ("add", "sin"), columns=3)
    twice = CartesianGenome((1, 0, 0, 1, 0, 0, 0, 1, 2, 3), ())
    assert encoding.decode(twice).complexity == 2


def test_a_mutation_without_a_rate_changes_one_active_gene_and_perhaps_others():
    encoding = ENCODINGS["cartesian-no-numbers"]
    rng = stream(2)
    others = 0
    for _ in range(300):
        genome = encoding.random(rng)
        changed = encoding.mutate(genome, rng)
        differ = {place for place in range(len(genome.genes)) if genome.genes[place] != changed.genes[place]}
        active = active_places(encoding, genome)
        assert len(differ & active) == 1
        others += len(differ - active)
    assert others > 300


def active_places(encoding, genome):
    """The places of the genes that the formula depends on, by recursion from the outputs."""
    first_output = 3 * encoding.columns
    found = set(range(first_output, len(genome.genes)))

    def visit(node):
        place = 3 * (node - len(encoding.inputs))
        if place >= 0:
            arity = operation(encoding.operations[genome.genes[place]]).arity
            found.update(range(place, place + 1 + arity))
            for connection in genome.genes[place + 1 : place + 1 + arity]:
                visit(connection)

    for root in genome.genes[first_output:]:
        visit(root)
    return found


def test_a_rate_redraws_that_share_of_genes():
    encoding = CartesianEncoding(("x", "y"), ("u",), ("add", "sub", "mul"), columns=300, gene_rate=0.1)
    rng = stream(3)
    genome = encoding.random(rng)
    changed = np.mean(np.array(genome.genes) != encoding.mutate(genome, rng).genes)
    assert 0.04 < changed < 0.14  # a redrawn gene may get its old value


@pytest.mark.parametrize("cut", ["uniform", "one_point"])
def test_children_share_out_the_genes_of_their_parents(cut):
    encoding = CartesianEncoding(("x", "y"), ("u",), ("add", "sub"), ParameterSpace(3), columns=30, cut=cut)
    rng = stream(4)
    a, b = encoding.random(rng), encoding.random(rng)
    first, second = encoding.crossover(a, b, rng)
    swapped = [p != x for x, p in zip(a.genes, first.genes, strict=True)]
    assert sum(s != t for s, t in pairwise(swapped)) > 10 or cut == "one_point"
    for x, y, p, q in zip(
        a.genes + a.values,
        b.genes + b.values,
        first.genes + first.values,
        second.genes + second.values,
        strict=True,
    ):
        assert (p, q) in ((x, y), (y, x))


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"columns": 0}, "columns must be an integer of at least 1"),
        ({"gene_rate": 0.0}, "gene_rate must lie in"),
        ({"gene_rate": float("nan")}, "gene_rate must lie in"),
        ({"cut": "two_point"}, "cut must be 'uniform' or 'one_point'"),
    ],
)
def test_wrong_settings_are_named(changes, sentence):
    with pytest.raises(EncodingError, match=sentence):
        CartesianEncoding(("x",), ("u",), ("add",), **changes)


@pytest.mark.parametrize(
    ("genome", "sentence"),
    [
        (CartesianGenome((1, 0, 0), (0.5,)), "expected 7 genes, got 3"),
        (CartesianGenome((2, 0, 0, 0, 2, 1, 3), (0.5,)), "gene 0 is 2"),
        (CartesianGenome((1, 2, 0, 0, 2, 1, 3), (0.5,)), "gene 1 is 2"),
        (CartesianGenome((1, 0, 0, 0, 2, 1, 4), (0.5,)), "gene 6 is 4"),
        (CartesianGenome((1, 0, 0, 0, 2, -1, 3), (0.5,)), "gene 5 is -1"),
        (CartesianGenome((1, 0, 0, 0, 2, 1, 3.0), (0.5,)), "gene 6 is 3.0"),
        (CartesianGenome(GENOME.genes, (float("nan"),)), "parameter 0 is nan"),
    ],
)
def test_foreign_genomes_are_refused(genome, sentence):
    with pytest.raises(EncodingError, match=sentence):
        SMALL.check(genome)
