"""`python -m tests.bench.data_speed`: expressions on data, beside pyoperon in the same run, one core.

Node rates count every node of every tree, leaves included, however often it occurs; so what is shared counts as done.
"""

import argparse
from collections.abc import Callable, Iterator
from importlib import metadata
from importlib.util import find_spec
from typing import NamedTuple

import numpy as np

from gpsynth.arrays import Floats
from gpsynth.kernels import genomes
from gpsynth.kernels.data_code import BINARY, CONSTANT, OPCODE, VARIABLE
from gpsynth.kernels.layout import readonly
from gpsynth.regression.evolution import Evolution, Trees, evolve
from gpsynth.regression.polish import data_of
from gpsynth.regression.population import Population, columns_of, evaluate, share
from gpsynth.regression.state import State
from tests.bench.measure import machine, median_time, pin

TREES, EVOLVING, VARIABLES = 128, 500, 5
ARITHMETIC = ("add", "sub", "mul", "div")


class Tree(NamedTuple):
    """Postfix tokens: an operation, a variable's number or a constant."""

    tokens: tuple[str | int | float, ...]


def main() -> None:
    """Measure and print."""
    argparse.ArgumentParser(description=__doc__).parse_args()
    if find_spec("pyoperon") is None:
        raise SystemExit("this comparison needs pyoperon: pip install pyoperon")
    pin()
    rng = np.random.default_rng(1)
    print(f"{machine()}, pyoperon {metadata.version('pyoperon')}")
    print(f"\n{'10^9 nodes/s':34}{'gpsynth float64':>17}{'pyoperon float32':>18}{'ratio':>8}{'copies':>12}")
    for label, unary in (("arithmetic", ()), ("with sine and cosine", ("sin", "cos"))):
        trees = [random_tree(rng, unary) for _ in range(TREES)]
        for rows in (1000, 10_000):
            _row(
                f"{TREES} random trees, {label}, {rows} rows", trees, rng.uniform(0.5, 2.0, (rows, VARIABLES))
            )
    for generations in (10, 20):
        evolved = evolved_trees(rng, generations)
        _row(
            f"{len(evolved)} trees after {generations} generations, 1000 rows",
            evolved,
            rng.uniform(0.5, 2.0, (1000, VARIABLES)),
        )
    print(f"\n{'genomes/s, variation and evaluation at 20 rows':50}{genome_rate(rng):12,.0f}")
    print(f"{'the same with numbers fitted and survivors chosen':50}{generation_rate(rng):12,.0f}")


def _row(label: str, trees: list[Tree], rows: Floats) -> None:
    total = sum(len(tree.tokens) for tree in trees)
    nodes = total * len(rows)
    whole, columns = population_of(trees), columns_of(rows)
    ours, found = median_time(_repeated(lambda: evaluate(share(whole), columns)))
    theirs, expected = median_time(_repeated(operon_evaluator(trees, rows)))
    values = found[share(whole).outputs, : len(rows)]
    agree = np.isclose(values, expected, rtol=1e-3, atol=1e-3) | ~np.isfinite(expected)
    if agree.mean() < 0.98:
        raise SystemExit(f"{label}: {1 - agree.mean():.1%} of the values differ from pyoperon's")
    rates = [REPEATED * nodes / seconds / 1e9 for seconds in (ours, theirs)]
    print(
        f"{label:50}{rates[0]:9.2f}{rates[1]:14.2f}{rates[0] / rates[1]:12.1f}{total / share(whole).nodes:12.1f}"
    )


REPEATED = 5


def _repeated(work: Callable[[], Floats]) -> Callable[[], Floats]:
    def several() -> Floats:
        for _ in range(REPEATED - 1):
            work()
        return work()

    return several


def random_tree(rng: np.random.Generator, unary: tuple[str, ...]) -> Tree:
    """A random tree of 20 to 30 nodes."""

    def grown(size: int) -> Iterator[str | int | float]:
        if size <= 1:
            yield float(rng.uniform(-2, 2)) if rng.random() < 0.2 else int(rng.integers(VARIABLES))
        elif unary and (size == 2 or rng.random() < 0.35):
            yield from grown(size - 1)
            yield unary[rng.integers(len(unary))]
        else:
            left = int(rng.integers(1, size - 1)) if size > 2 else 1
            yield from grown(left)
            yield from grown(size - 1 - left)
            yield ARITHMETIC[rng.integers(4)]

    return Tree(tuple(grown(int(rng.integers(20, 31)))))


def population_of(trees: list[Tree]) -> Population:
    """The trees as the data machine reads them."""
    rows: list[tuple[int, int, int, float]] = []
    roots = []
    for tree in trees:
        stack: list[int] = []
        for token in tree.tokens:
            k = len(rows)
            if isinstance(token, str):
                b = stack.pop()
                a = stack.pop() if token in BINARY else b
                rows.append((OPCODE[token], a, b, 0.0))
            else:
                rows.append(
                    (CONSTANT, k, k, token) if isinstance(token, float) else (VARIABLE - token, k, k, 0.0)
                )
            stack.append(k)
        roots.append(stack[0])
    ops, a, b, numbers = zip(*rows, strict=True)
    arrays = (np.array(part, dtype=np.int32) for part in (ops, a, b))
    return Population(*arrays, np.array(numbers), np.array(roots, dtype=np.int32))


def operon_evaluator(trees: list[Tree], rows: Floats) -> Callable[[], Floats]:
    """The same trees in pyoperon; its trees hold the operands of an operation in reverse order."""
    import pyoperon

    values = np.asfortranarray(rows.astype(np.float32))
    data = pyoperon.Dataset(values)
    variables = data.Variables
    types = pyoperon.NodeType

    def node(token: str | int | float) -> object:
        if isinstance(token, str):
            made = pyoperon.Node(getattr(types, token.capitalize()))
        elif isinstance(token, float):
            made = pyoperon.Node.Constant(token)
        else:
            made = pyoperon.Node.Variable(1.0)
            made.HashValue = variables[token].Hash
        return made

    def reverse(tree: Tree) -> list[str | int | float]:
        stack: list[list[str | int | float]] = []
        for token in tree.tokens:
            operands = [
                stack.pop() for _ in range(0 if not isinstance(token, str) else 2 if token in BINARY else 1)
            ]
            stack.append([item for operand in operands for item in operand] + [token])
        return stack[0]

    made = [pyoperon.Tree([node(token) for token in reverse(tree)]).UpdateNodes() for tree in trees]
    out = np.zeros((len(trees), len(rows)), dtype=np.float32, order="C")
    span = pyoperon.Range(0, len(rows))

    def work() -> Floats:
        assert values.size  # the data set reads this array, which must live as long
        pyoperon.EvaluateTrees(made, data, span, out, 1)
        return out

    return work


def evolved_trees(rng: np.random.Generator, generations: int) -> list[Tree]:
    """A population of plain genetic programming: tournaments of 3, subtree crossover 0.9, one mutation in ten."""
    inputs = rng.uniform(0.5, 2.0, (100, VARIABLES))
    y = inputs[:, 0] * inputs[:, 1] / (1 + inputs[:, 2] ** 2) + inputs[:, 3] - inputs[:, 4]
    evolution = Evolution(State(data_of(inputs, y, np.ones(len(y))), frozenset(ARITHMETIC), rng))
    evolution.grammar = evolution.grammar._replace(unary=evolution.grammar.unary[:0])
    trees = evolution.random(EVOLVING)
    for _ in range(generations):
        error = evolution.scored(trees).error
        entrants = rng.integers(0, EVOLVING, (2, EVOLVING, 3))
        mates = np.take_along_axis(entrants, error[entrants].argmin(axis=2)[..., None], axis=2)[..., 0].T
        choices = rng.random((EVOLVING, genomes.CHOICES))
        choices[:, 2] = np.where(choices[:, 2] < 0.1, 0.0, 1.0)
        empty = np.zeros_like(trees.ops), np.zeros_like(trees.numbers), np.zeros_like(trees.lengths)
        parents = trees.ops, trees.numbers, readonly(trees.lengths)
        chosen = readonly(np.ascontiguousarray(mates, dtype=np.int32))
        genomes.vary(*evolution.grammar, *parents, *parents, chosen, readonly(choices), *empty)
        trees = Trees(*empty)
    names = {code: name for name, code in OPCODE.items()}
    return [
        Tree(
            tuple(
                float(number) if op == CONSTANT else int(VARIABLE - op) if op <= VARIABLE else names[int(op)]
                for op, number in zip(row[:length], numbers[:length], strict=True)
            )
        )
        for row, numbers, length in zip(*trees, strict=True)
    ]


def genome_rate(rng: np.random.Generator) -> float:
    """Children made, shared, evaluated and scored in a second."""
    inputs = rng.uniform(-1, 1, (20, 1))
    evolution = Evolution(_state(inputs, inputs[:, 0] ** 3 + inputs[:, 0]))
    parents = evolution.scored(evolution.random(600))
    for _ in range(5):
        parents = evolution.next_generation(parents)

    def work() -> None:
        for _ in range(20):
            evolution.scored(evolution.children(parents))

    return 20 * 600 / median_time(work)[0]


def generation_rate(rng: np.random.Generator) -> float:
    """Children in a second of whole generations."""
    inputs = rng.uniform(-1, 1, (20, 1))
    state = _state(inputs, np.exp(np.sin(3 * inputs[:, 0])))
    evolution = evolve(state)

    def work() -> None:
        for _ in range(20):
            next(evolution)

    return 20 * 600 / median_time(work)[0]


def _state(inputs: Floats, y: Floats) -> State:
    functions = frozenset((*ARITHMETIC, "sin", "cos", "exp", "log"))
    return State(data_of(inputs, y, np.ones(len(y))), functions, np.random.default_rng(2))


if __name__ == "__main__":
    main()
