"""A population of expressions in flat postfix arrays, and its values on data."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from gpsynth.arrays import Floats, Ints
from gpsynth.errors import RegressionError
from gpsynth.kernels import data_machine, placing, sharing
from gpsynth.kernels.data_code import CONSTANT, NAMES, OPCODE, VARIABLE
from gpsynth.kernels.layout import readonly, sealed
from gpsynth.kernels.vectors import WIDTH, aligned
from gpsynth.program import Program


class Population(NamedTuple):
    """Expressions one after the other; operands are positions in the same arrays, an expression ends in its root."""

    ops: Ints  # (t,) see kernels.data_code
    a: Ints  # (t,)
    b: Ints  # (t,)
    numbers: Floats  # (t,)
    roots: Ints  # (p,) positions


class Shared(NamedTuple):
    """A population whose equal subtrees are one node, as instructions of the data machine."""

    nodes: int  # unique nodes, leaves included
    outputs: Ints  # (p,) which output each expression is
    distinct: int  # outputs
    code: Ints  # (c, 5)
    numbers: Floats  # (c,)
    rows: int  # of the workspace


class Scoring(NamedTuple):
    """Data to score expressions on: the best slope * value + constant for y."""

    columns: Floats  # (m + 2, N) variables, y minus its mean, weights
    mean: float  # of y
    weight: float  # sum of the weights
    total: float  # weighted squares of y minus its mean


def scoring(inputs: Floats, y: Floats, weights: Floats) -> Scoring:
    """Data for `scores`; rows that pad to the machine's width have weight 0."""
    weight = float(weights.sum())
    mean = float(weights @ y) / weight
    extra = np.zeros((2, columns_of(inputs).shape[1]))
    extra[:, : len(y)] = y - mean, weights
    columns = readonly(np.concatenate((columns_of(inputs), extra)))
    return Scoring(columns, mean, weight, float(weights @ (y - mean) ** 2))


def scores(whole: Population, data: Scoring) -> tuple[Floats, Floats, Floats]:
    """Error, slope and constant (p,) of each expression; the error is a share of y's squares, infinite where undefined.

    Linear scaling (Keijzer 2003) in one pass: sums are taken of values minus the first of them.
    """
    shared = share(whole, data)
    sums, lines = np.zeros((shared.distinct, 3 * WIDTH + 1)), np.empty((shared.distinct, 3))
    block = min(data_machine.BLOCK, data.columns.shape[1])
    data_machine.run(readonly(shared.code), readonly(shared.numbers), data.columns, shared.rows, block, sums)
    data_machine.best_lines(readonly(sums), data.weight, data.mean, data.total, lines)
    error, slope, constant = lines[shared.outputs].T.copy()
    return error, slope, constant


def population(programs: Sequence[Program]) -> Population:
    """Programs with one output and no parameters; raises RegressionError for operations regression does not have."""
    ops: list[int] = []
    a: list[int] = []
    b: list[int] = []
    numbers: list[float] = []
    roots = []
    for program in programs:
        base = len(ops)
        for leaf in program.leaves:
            ops.append(CONSTANT if leaf.kind == "constant" else VARIABLE - leaf.index)
            numbers.append(leaf.value)
        for row, operands in program.instructions:
            if row.name not in OPCODE:
                raise RegressionError(
                    f"{row.name} is no operation of regression; possible are {', '.join(NAMES)}"
                )
            ops.append(OPCODE[row.name])
            numbers.append(0.0)
            a.extend([base] * (len(ops) - 1 - len(a)))
            b.extend([base] * (len(ops) - 1 - len(b)))
            a.append(base + operands[0])
            b.append(base + operands[-1])
        a.extend([base] * (len(ops) - len(a)))
        b.extend([base] * (len(ops) - len(b)))
        roots.append(base + int(program.outputs[0]))
    return Population(_ints(ops), _ints(a), _ints(b), np.array(numbers), _ints(roots))


def share(whole: Population, scored: Scoring | None = None) -> Shared:
    """One program of all expressions: equal subtrees once, rows reused; outputs are values, or only scores."""
    size, flat = len(whole.ops), sealed(whole)
    table = np.zeros(1 << size.bit_length(), dtype=np.int32)
    if scored is None:
        variables, target = max(0, int(VARIABLE - whole.ops.min(initial=0)) + 1), -1
    else:
        variables, target = len(scored.columns), len(scored.columns) - 2
    ids, ops, a, b, output = np.empty((5, size + variables), dtype=np.int32)
    numbers, outputs = np.empty(size + variables), np.empty(len(whole.roots), dtype=np.int32)
    count, distinct = sharing.share(*flat, variables, table, ids, ops, a, b, numbers, output, outputs)
    unique = sealed(Population(ops[:count], a[:count], b[:count], numbers[:count], output[:count]))
    room = count + distinct + np.count_nonzero(ops[:count] == CONSTANT)
    code, immediate = np.empty((room, 5), dtype=np.int32), np.empty(room)
    length, rows = placing.place(*unique, variables, target, code, immediate)
    return Shared(count, outputs, distinct, code[:length], immediate[:length], max(rows, 1))


def columns_of(inputs: Floats) -> Floats:
    """Rows (n, m) as columns (m, N), N the next multiple of the machine's width; the last row is repeated."""
    padding = -len(inputs) % WIDTH
    return np.ascontiguousarray(np.pad(inputs, ((0, padding), (0, 0)), mode="edge").T)


def evaluate(shared: Shared, columns: Floats, block: int = data_machine.BLOCK) -> Floats:
    """The values (u, N) of the unique outputs on columns (m, N) as `columns_of` makes them."""
    out: Floats = aligned(shared.distinct, columns.shape[1])
    code, numbers, columns = sealed(_Group(shared.code, shared.numbers, columns))
    rows = max(shared.rows, len(columns))
    data_machine.run(code, numbers, columns, rows, min(block, columns.shape[1]), out)
    return out


def values_of(whole: Population, inputs: Floats) -> Floats:
    """The value of each expression (p, n) on rows (n, m)."""
    shared = share(whole)
    return evaluate(shared, columns_of(inputs))[shared.outputs, : len(inputs)]


class _Group(NamedTuple):
    code: Ints
    numbers: Floats
    columns: Floats


def _ints(values: npt.ArrayLike) -> Ints:
    return np.asarray(values, dtype=np.int32)
