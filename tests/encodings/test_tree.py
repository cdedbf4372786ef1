import numpy as np
import pytest
from deap import gp

from gpsynth.encodings.parameters import ParameterSpace
from gpsynth.encodings.tree import TreeEncoding, TreeGenome
from gpsynth.errors import EncodingError
from gpsynth.operations import operation
from gpsynth.seeds import stream
from tests.encodings.helpers import PLAIN

FUNCTIONS = {
    "add": np.add,
    "sub": np.subtract,
    "mul": np.multiply,
    "square": np.square,
    "sin": np.sin,
    "tanh": np.tanh,
    "where": lambda a, b, c: np.where(a != 0, b, c),
    "max": lambda a, b: np.where(a >= b, a, b),
}
ENCODING = TreeEncoding(("x", "y"), ("u", "v"), tuple(FUNCTIONS), ParameterSpace(20, -2.0, 2.0))
SMALL = TreeEncoding(
    ("x",),
    ("u",),
    ("add", "sin"),
    ParameterSpace(2),
    max_height=2,
    max_size=4,
    grown_heights=(0, 1),
    start_heights=(0, 2),
)
X, Q, ADD, SIN = range(4)


def test_a_tree_reads_as_its_formula():
    genome = TreeGenome(((ADD, SIN, X, Q),), (0.5,))
    SMALL.check(genome)
    assert SMALL.decode(genome)(np.array([[0.3]]), [0.5])[0, 0] == pytest.approx(np.sin(0.3) + 0.5)


def test_programs_equal_the_trees_compiled_by_deap():
    primitives = gp.PrimitiveSet("test", 2)
    for name, function in FUNCTIONS.items():
        primitives.addPrimitive(function, operation(name).arity, name=name)
    rng = stream(1)
    points = rng.uniform(-1, 1, (5, 2))
    for _ in range(100):
        genome = ENCODING.mutate(ENCODING.random(rng), rng)
        values = ENCODING.decode(genome)(points, genome.values)
        for column, tree in enumerate(ENCODING.to_deap(genome)):
            expected = np.broadcast_to(gp.compile(tree, primitives)(*points.T), 5)
            # libm and our own sine and tanh differ in the last bits, which mul and square pass on
            assert values[:, column] == pytest.approx(expected, rel=1e-9, abs=1e-12)


def test_equal_subtrees_are_computed_once():
    encoding = TreeEncoding(("x",), ("u", "v"), ("add", "sin"))
    add, sine = 2, 3
    program = encoding.decode(TreeGenome(((add, sine, 0, sine, 0), (sine, 0)), ()))
    assert program.complexity == 2


def test_each_number_is_a_parameter_in_the_order_of_the_trees():
    encoding = TreeEncoding(("x",), ("u", "v"), ("sub",), ParameterSpace(3))
    genome = TreeGenome(((2, 1, 0), (2, 1, 1)), (1.0, 2.0, 4.0))
    assert encoding.decode(genome)(np.array([[10.0]]), genome.values).tolist() == [[-9.0, -2.0]]


def test_children_stay_within_the_limits():
    rng = stream(2)
    genome = SMALL.random(rng)
    sizes, heights, numbers = set(), set(), set()
    for _ in range(1000):
        genome, _ = SMALL.crossover(SMALL.mutate(genome, rng), SMALL.random(rng), rng)
        (tree,) = SMALL.to_deap(genome)
        sizes.add(len(tree))
        heights.add(tree.height)
        numbers.add(len(genome.values))
    assert sizes == {1, 2, 3, 4}
    assert heights == {0, 1, 2}
    assert numbers == {0, 1, 2}


def test_mutation_often_adds_a_number_that_hardly_changes_the_formula():
    encoding = TreeEncoding(("x", "y"), ("u",), ("add", "mul"), ParameterSpace(2, rate=0.0))
    parent, rng = TreeGenome(((0,),), ()), stream(5)
    children = [encoding.mutate(parent, rng) for _ in range(300)]
    values = [encoding.decode(child)(np.array([[3.0, 1.0]]), child.values)[0, 0] for child in children]
    near = [value for value in values if 0.0 < abs(value - 3.0) < 1.0]
    assert len(near) > 40  # DEAP's mutations alone give fewer than 10


def test_encodings_with_different_bounds_do_not_share_their_numbers():
    low, high = (TreeEncoding(("x",), ("u",), PLAIN, ParameterSpace(9, a, a + 1)) for a in (0.0, 5.0))
    for encoding in (low, high, low):
        rng = stream(3)
        values = [value for _ in range(50) for value in encoding.random(rng).values]
        assert values
        assert encoding.space.lower <= min(values) <= max(values) <= encoding.space.upper


def test_random_trees_are_full_and_grown_of_all_start_heights():
    encoding = TreeEncoding(("x",), ("u",), ("add",), start_heights=(2, 4))
    rng = stream(4)
    trees = [encoding.to_deap(encoding.random(rng))[0] for _ in range(200)]
    full = [tree for tree in trees if len(tree) == 2 ** (tree.height + 1) - 1]
    assert {tree.height for tree in trees} == {2, 3, 4}
    assert 80 < len(full) < 180  # half, and those grown that happen to be full


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"max_size": 0}, "max_size must be an integer of at least 1"),
        ({"max_height": -1}, "max_height must be an integer of at least 0"),
        ({"start_heights": (3, 2)}, "start_heights must rise"),
        ({"grown_heights": (0, 11)}, "grown_heights must rise"),
    ],
)
def test_wrong_settings_are_named(changes, sentence):
    with pytest.raises(EncodingError, match=sentence):
        TreeEncoding(("x",), ("u",), ("add",), **changes)


@pytest.mark.parametrize(
    ("trees", "values", "sentence"),
    [
        ((), (), "expected 1 trees, got 0"),
        (((ADD, X),), (), "tree 0 is not one complete tree"),
        (((X, X),), (), "tree 0 is not one complete tree"),
        (((),), (), "tree 0 is not one complete tree"),
        (((4,),), (), "tree 0 has a code that is not an integer in"),
        (((ADD, X, 0.0),), (), "tree 0 has a code that is not an integer in"),
        (((Q,),), (), "expected 1 parameters"),
        (((ADD, Q, ADD, Q, Q),), (1.0, 1.0, 1.0), "the trees have 3 numbers; at most 2"),
        (((ADD, X, ADD, X, X),), (), "tree 0 has height 2 and 5 nodes; at most 2 and 4"),
        (((SIN, SIN, SIN, X),), (), "tree 0 has height 3 and 4 nodes"),
    ],
)
def test_foreign_genomes_are_refused(trees, values, sentence):
    with pytest.raises(EncodingError, match=sentence):
        SMALL.check(TreeGenome(trees, values))
