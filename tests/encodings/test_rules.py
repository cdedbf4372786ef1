import pytest

from gpsynth.encodings.parameters import ParameterSpace
from gpsynth.encodings.rules import Rules
from gpsynth.encodings.tree import TreeEncoding, TreeGenome
from gpsynth.errors import EncodingError
from gpsynth.operations import OPERATIONS
from gpsynth.seeds import stream
from tests.encodings.helpers import ENCODINGS, PLAIN
from tests.encodings.test_contract import walk


def nested(tree):
    """A prefix tree of operation names as (name, operands), leaves being empty texts."""
    arity = {operation.name: operation.arity for operation in OPERATIONS} | {"": 0}
    nodes = iter(tree)

    def node():
        name = next(nodes)
        return name, [node() for _ in range(arity[name])]

    return node()


def within(node):
    """Every operation that stands somewhere below a node."""
    return {name for operand in node[1] for name in {operand[0], *within(operand)}}


def every(node):
    return [node, *(inner for operand in node[1] for inner in every(operand))]


def names(encoding, codes):
    first = len(encoding.inputs) + 1
    return ["" if code < first else encoding.operations[code - first] for code in codes]


def test_no_tree_breaks_a_rule_whatever_the_search_does():
    encoding = ENCODINGS["tree-rules"]
    seen = set()
    for family in walk(encoding, 1000, seed=1):
        for codes in (codes for genome in family for codes in genome.trees):
            nodes = every(nested(names(encoding, codes)))
            assert not any(name == "sin" and within((name, rest)) & {"sin", "tanh"} for name, rest in nodes)
            assert not any(name == "tanh" and "square" in within((name, rest)) for name, rest in nodes)
            count = [name for name, _ in nodes]
            assert count.count("tanh") <= 1
            assert count.count("mul") <= 3
            assert len(count) + 3 * count.count("sin") <= encoding.max_size
            seen |= set(count)
    assert seen == {"", *PLAIN}


def test_a_node_that_breaks_a_rule_gives_way_to_its_first_operand():
    rules = Rules(forbid={"sin": ("sin",)}, limits={"mul": 1})
    # sin(add(sin(mul(a, b)), mul(c, d))) -> sin(add(mul(a, b), c))
    tree = ["sin", "add", "sin", "mul", "", "", "mul", "", ""]
    assert rules.kept(tree) == [0, 1, 3, 4, 5, 7]
    assert rules.kept(["add", "sin", "", "sin", ""]) == [0, 1, 2, 3, 4]


def test_a_heavy_operation_leaves_less_room():
    encoding = TreeEncoding(("x",), ("u",), ("sin", "add"), max_size=6, rules=Rules(weights={"sin": 5}))
    sine, add = 2, 3
    encoding.check(TreeGenome(((sine, 0),), ()))
    with pytest.raises(EncodingError, match="has height 2 and 8 nodes; at most 10 and 6"):
        encoding.check(TreeGenome(((add, 0, sine, 0),), ()))


def test_a_genome_that_breaks_a_rule_is_refused():
    encoding = TreeEncoding(("x",), ("u",), ("sin", "add"), rules=Rules(forbid={"sin": ("sin",)}))
    with pytest.raises(EncodingError, match="tree 0 breaks a rule"):
        encoding.check(TreeGenome(((2, 2, 0),), ()))


@pytest.mark.parametrize(
    ("rules", "sentence"),
    [
        ({"forbid": {"cos": ("sin",)}}, "a rule is about 'cos', which is not one of sin, add"),
        ({"forbid": {"sin": ("cos",)}}, "a rule is about 'cos'"),
        ({"forbid": {"sin": "cos"}}, "what may not stand within sin must be names in a tuple, got 'cos'"),
        ({"limits": {"exp": 1}}, "a rule is about 'exp'"),
        ({"limits": {"sin": -1}}, "the limit of sin must be an integer of at least 0"),
        ({"limits": {"sin": 0, "add": 0}}, "the limits allow none of the operations"),
        ({"weights": {"sin": 0}}, "the weight of sin must be an integer of at least 1"),
    ],
)
def test_wrong_rules_are_named(rules, sentence):
    with pytest.raises(EncodingError, match=sentence):
        TreeEncoding(("x",), ("u",), ("sin", "add"), rules=Rules(**rules))


def test_rules_that_forbid_much_still_give_formulas():
    rules = Rules(forbid=dict.fromkeys(PLAIN, PLAIN))  # a formula is one operation at most
    encoding = TreeEncoding(("x", "y"), ("u",), PLAIN, ParameterSpace(2), rules=rules)
    rng = stream(1)
    sizes = {len(encoding.random(rng).trees[0]) for _ in range(100)}
    assert sizes == {2, 3}
