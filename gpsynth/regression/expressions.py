"""Expressions as nested tuples while they are searched: ("add", left, right), ("variable", 0), ("number", 1.5).

They become a `Program` when they leave the search, and flat postfix arrays when they are evaluated or fitted.
"""

from collections.abc import Callable, Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from gpsynth.arrays import Floats, Ints
from gpsynth.builder import Builder
from gpsynth.kernels.data_code import BINARY, CONSTANT, OPCODE, VARIABLE
from gpsynth.program import Program
from gpsynth.regression.population import Population, values_of

Expression = tuple[Any, ...]


def variable(index: int) -> Expression:
    """Column `index` of the data."""
    return ("variable", index)


def number(value: float) -> Expression:
    """A constant."""
    return ("number", float(value))


def size(expression: Expression) -> int:
    """Nodes of the tree: operations, variables and numbers; a square counts as the product it stands for."""
    kind, *operands = expression
    if kind in {"variable", "number"}:
        return 1
    copies = {"square": 2, "cube": 3}.get(kind, 1)
    return copies * sum(map(size, operands)) + max(1, copies - 1)


def numbers(expression: Expression) -> Iterator[float]:
    """The constants from left to right."""
    if expression[0] == "number":
        yield expression[1]
    elif expression[0] != "variable":
        for operand in expression[1:]:
            yield from numbers(operand)


def variables(expression: Expression) -> frozenset[int]:
    """The columns that are read."""
    if expression[0] == "variable":
        return frozenset((expression[1],))
    if expression[0] == "number":
        return frozenset()
    return frozenset().union(*map(variables, expression[1:]))


def with_numbers(expression: Expression, values: Iterator[float]) -> Expression:
    """The same structure with other constants, from left to right."""
    if expression[0] == "number":
        return number(next(values))
    if expression[0] == "variable":
        return expression
    return (expression[0], *(with_numbers(operand, values) for operand in expression[1:]))


def rewrite(expression: Expression, rule: Callable[[Expression], Expression]) -> Expression:
    """The expression with `rule` applied to every node, operands first."""
    if expression[0] in {"variable", "number"}:
        return rule(expression)
    return rule((expression[0], *(rewrite(operand, rule) for operand in expression[1:])))


class Flat(NamedTuple):
    """Expressions in postfix arrays, and where the constants of each stand."""

    population: Population
    firsts: Ints  # (p,) first position of each
    places: Ints  # positions of constants
    ends: Ints  # (p,) one past the last of each in `places`


def flatten(expressions: Sequence[Expression]) -> Flat:
    """Expressions as trees: nothing is shared, so each constant is a parameter of its own."""
    rows: list[tuple[int, int, int, float]] = []
    places: list[int] = []
    firsts, ends, roots = [], [], []

    def write(expression: Expression) -> int:
        kind = expression[0]
        if kind == "variable":
            rows.append((VARIABLE - expression[1], len(rows), len(rows), 0.0))
        elif kind == "number":
            places.append(len(rows))
            rows.append((CONSTANT, len(rows), len(rows), expression[1]))
        else:
            operands = [write(operand) for operand in expression[1:]]
            rows.append((OPCODE[kind], operands[0], operands[-1], 0.0))
        return len(rows) - 1

    for expression in expressions:
        firsts.append(len(rows))
        roots.append(write(expression))
        ends.append(len(places))
    ops, a, b, values = zip(*rows, strict=True)
    whole = Population(_ints(ops), _ints(a), _ints(b), np.array(values), _ints(roots))
    return Flat(whole, _ints(firsts), _ints(places), _ints(ends))


def expression_of(population: Population, root: int) -> Expression:
    """The tree that ends in position `root`."""
    op = int(population.ops[root])
    if op == CONSTANT:
        return number(float(population.numbers[root]))
    if op <= VARIABLE:
        return variable(VARIABLE - op)
    name = _NAMES[op]
    operands = (population.a[root], population.b[root]) if name in BINARY else (population.a[root],)
    return (name, *(expression_of(population, int(operand)) for operand in operands))


_NAMES = {code: name for name, code in OPCODE.items()}


def program_of(expressions: Sequence[Expression], inputs: Sequence[str], names: Sequence[str]) -> Program:
    """The program with these inputs, `names` being those of its outputs; what is computed twice is so once."""
    builder = Builder(inputs)

    def write(node: Expression) -> int:
        if node[0] == "variable":
            return builder.inputs[node[1]]
        if node[0] == "number":
            return builder.constant(node[1])
        return builder.apply(node[0], *(write(operand) for operand in node[1:]))

    return builder.build([write(expression) for expression in expressions], names)


def evaluate(expressions: Sequence[Expression], inputs: Floats) -> Floats:
    """The value of each expression (p, n) on rows (n, m)."""
    return values_of(flatten(expressions).population, inputs)


def _ints(values: Sequence[int]) -> Ints:
    return np.array(values, dtype=np.int32)
