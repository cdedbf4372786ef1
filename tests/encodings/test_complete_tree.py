from dataclasses import replace

import numpy as np
import pytest

from gpsynth.encodings.complete_tree import CompleteTree, basic_tree
from gpsynth.encodings.parameters import ParameterSpace
from gpsynth.encodings.symbols import function_of, symbol_of
from gpsynth.encodings.variational import VariationalEncoding
from gpsynth.errors import EncodingError
from gpsynth.kernels import elementary
from gpsynth.optimizers import minimize
from gpsynth.seeds import stream
from gpsynth.structure_search import StructureSearch
from tests.encodings.helpers import ENCODINGS, PLAIN, check_weighted_sum

IDENTITY = symbol_of("identity")


def evaluated(tree, x, q):
    """The outputs by recursion over levels kept apart, units of functions included."""
    leaves = [*x, *q, *tree.units]
    levels, rest = [], tree.entries.tolist()
    for k in range(tree.depth):
        for size in (2**k, 2 ** (k + 1)):
            levels.append(rest[:size])
            rest = rest[size:]
    levels.append(rest)

    def value(level, index):
        symbol = levels[level][index]
        if level == 2 * tree.depth:
            return leaves[symbol]
        children = (index,) if level % 2 else (2 * index, 2 * index + 1)
        return elementary.evaluate(function_of(symbol), *[value(level + 1, child) for child in children])

    places = [(level, index) for level, symbols in enumerate(levels) for index in range(len(symbols))]
    return [value(*places[output]) for output in tree.outputs]


@pytest.mark.parametrize("name", ["complete-tree", "complete-tree-unary"])
def test_programs_equal_the_tree_evaluated_place_by_place(name):
    encoding = ENCODINGS[name]
    rng = stream(1)
    for _ in range(50):
        genome = encoding.random(rng)
        tree = encoding.rebased(genome).basis
        x = rng.uniform(-1, 1, len(encoding.inputs))
        values = encoding.decode(genome)(x[None], genome.values)[0]
        assert np.array_equal(values, evaluated(tree, x.tolist(), genome.values))


@pytest.mark.parametrize("counts", [(1, 0, 1), (1, 3, 2), (3, 3, 2), (5, 2, 3), (4, 4, 1)])
def test_the_basic_tree_weights_and_sums(counts):
    check_weighted_sum(basic_tree(*counts), counts)


@pytest.mark.parametrize("depth", [1, 2, 5])
def test_a_tree_has_the_published_size(depth):
    assert len(basic_tree(1, 0, 1, depth=depth).entries) == 2 ** (depth + 2) - 3


@pytest.mark.parametrize(("name", "unit"), [("max", -1e8), ("min", 1e8), ("add", 0.0), ("mul", 1.0)])
def test_leaves_can_be_the_units_of_the_functions(name, unit):
    tree = basic_tree(1, 0, 1, (name,), depth=1)
    leaf = 1 + tree.units.index(unit)
    entries = np.array([symbol_of(name), IDENTITY, IDENTITY, 0, leaf], dtype=np.int32)
    program = tree.program(entries, ("x",), ("u",))
    assert program.complexity == 0
    assert program(np.array([[3.5]]))[0, 0] == 3.5 == elementary.evaluate(name, 3.5, unit)


def test_no_variation_leads_out_of_the_leaves():
    tree = basic_tree(2, 3, 1, ("add", "max"))
    functions = tree.functions(("add", "max", "sin"))
    rng = stream(2)
    drawn = [tree.draw(tree.entries, functions, rng) for _ in range(3000)]
    leaves = {symbol for place, symbol in drawn if place >= len(tree.entries) - 2**tree.depth}
    assert leaves == set(range(2 + 3 + 3))  # inputs, parameters, units 0, 1, -1e8
    assert tree.varied(tree.entries, (tree.identity,)).tolist() == tree.entries.tolist()


@pytest.mark.parametrize(
    ("entries", "outputs", "sentence"),
    [
        ([1, 2, 3], (0,), r"2\^\(depth \+ 2\) - 3 symbols"),
        ([symbol_of("sin"), IDENTITY, IDENTITY, 0, 0], (0,), "place 0 has symbol"),
        ([symbol_of("add"), symbol_of("mul"), IDENTITY, 0, 0], (0,), "place 1 has symbol"),
        ([symbol_of("add"), IDENTITY, IDENTITY, 0, 3], (0,), "place 4 has symbol 3"),
        ([symbol_of("add"), IDENTITY, IDENTITY, 0, 0], (5,), "output place 5 does not exist"),
    ],
)
def test_trees_that_are_none_are_refused(entries, outputs, sentence):
    with pytest.raises(EncodingError, match=sentence):
        CompleteTree(np.array(entries), 1, 0, outputs)


def test_three_operands_are_refused():
    with pytest.raises(EncodingError, match="where takes three operands"):
        VariationalEncoding(("x",), ("u",), ("add", "where"), basis=basic_tree(1, 0, 1))


@pytest.mark.parametrize(
    "variation", [(0, symbol_of("sin")), (999, 1), (1, 0), (60, 99), (0, 0, 0), (0, 1.0)]
)
def test_foreign_variations_are_refused(variation):
    encoding = ENCODINGS["complete-tree"]
    genome = encoding.basic()
    with pytest.raises(EncodingError, match="variation 0 is"):
        encoding.check(replace(genome, variations=(variation, *genome.variations[1:])))


def test_a_search_finds_more_than_the_slope_of_a_curve():
    space = ParameterSpace(2, -4, 4)
    encoding = VariationalEncoding(
        ("x",), ("u",), PLAIN, space, basic_tree(1, 2, 1, depth=3), n_variations=12
    )
    x = np.linspace(-1.5, 1.5, 21)
    wanted = x**3 - 2.0 * x
    line = np.mean((wanted - np.polyval(np.polyfit(x, wanted, 1), x)) ** 2)

    def costs(batch):
        return np.array([(each.program(x[:, None], each.values)[:, 0] - wanted) ** 2 for each in batch])

    search = StructureSearch(encoding, population=60, offspring=30)
    assert minimize(costs, search, seed=1, budget=2_000, target=line / 6).cost < line / 5
