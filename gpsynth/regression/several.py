"""Targets searched one after the other, each with parts of the formulas found before as further columns.

What one target is made of is often in the next one, too: a reaction rate, a force, a distance. As a column it costs one
node, as in the joint formula.
"""

import time
from collections.abc import Iterator, Sequence
from itertools import chain, zip_longest
from typing import NamedTuple

import numpy as np

from gpsynth import seeds
from gpsynth.arrays import Floats
from gpsynth.errors import RegressionError
from gpsynth.regression.expressions import Expression, evaluate, number, rewrite, size, variables
from gpsynth.regression.front import Candidate, Front
from gpsynth.regression.joint import choose, joined, operations
from gpsynth.regression.library import LARGEST
from gpsynth.regression.polish import data_of
from gpsynth.regression.search import Budget, search
from gpsynth.regression.state import State

SMALLEST_LIBRARY, LARGEST_LIBRARY = 300, 20_000  # enumerated formulas; small budgets get small libraries
MOST_PARTS, SMALLEST_PART = 6, 3  # further columns; nodes


class Found(NamedTuple):
    """What was found for one target."""

    front: list[Candidate]
    evaluations: int
    history: list[tuple[int, str, float]]  # evaluations, what found it, error; at each progress


def search_each(
    data: tuple[Floats, Floats, Floats],
    functions: frozenset[str],
    *,
    budget: Budget,
    seed: int,
    use_all_inputs: bool = False,
) -> list[Found]:
    """The front of each target of data: rows (n, m), targets (n, k) and weights (n,).

    Each may spend a k-th of the budget, and what those before it have left of theirs. Raises RegressionError if all
    inputs are to be used and there is nothing to explain.
    """
    rows, targets, weights = data
    begin, spent, count = time.process_time(), 0, targets.shape[1]
    found: list[Found] = []
    chosen: list[Expression] = []
    for y in targets.T:
        share = share_of(budget, Budget(spent, time.process_time() - begin), count, count - len(found))
        parts = _parts(chosen, rows)
        columns = np.column_stack((rows, *evaluate(parts, rows))) if parts else rows
        library = min(LARGEST_LIBRARY, max(SMALLEST_LIBRARY, share.evaluations // 500))
        inputs = [frozenset((column,)) for column in range(rows.shape[1])]
        front = Front([*inputs, *map(variables, parts)], len(inputs) * use_all_inputs)
        state = State(data_of(columns, y, weights), functions, seeds.stream(seed), library, front)
        if state.data.total > 0.0 and len(state.y) > 1:
            state.consider([number(float(state.y.mean()))], "constant")
            search(state, share)
        elif use_all_inputs:
            raise RegressionError("a formula cannot be asked to use all inputs: the target is constant")
        members = [_written_out(each, parts, rows.shape[1]) for each in state.members()]
        found.append(Found(members, state.evaluations, state.found))
        chosen.append(choose(joined([members]), len(rows)).parts[0].expression)
        spent += state.evaluations
    return found


def share_of(whole: Budget, spent: Budget, count: int, left: int) -> Budget:
    """Of one target; the last step of the one before may have taken more than was due to it."""
    evaluations = max(whole.evaluations // count, (whole.evaluations - spent.evaluations) // left)
    if whole.seconds is None or spent.seconds is None:
        return Budget(evaluations)
    return Budget(evaluations, max(whole.seconds / count, (whole.seconds - spent.seconds) / left))


def _parts(formulas: Sequence[Expression], rows: Floats) -> list[Expression]:
    """The largest parts of the formulas in turn, as many as may become columns."""
    turns = chain.from_iterable(zip_longest(*map(_sizeable, formulas)))
    parts = [part for part in dict.fromkeys(turns) if part is not None]
    usable = np.all(np.abs(evaluate(parts, rows)) < LARGEST, axis=1) if parts else ()
    return [part for part, fits in zip(parts, usable, strict=True) if fits][:MOST_PARTS]


def _sizeable(formula: Expression) -> Iterator[Expression]:
    return (part for part in operations(formula) if size(part) >= SMALLEST_PART)


def _written_out(candidate: Candidate, parts: Sequence[Expression], inputs: int) -> Candidate:
    """The formula without further columns."""

    def rule(node: Expression) -> Expression:
        return parts[node[1] - inputs] if node[0] == "variable" and node[1] >= inputs else node

    expression = rewrite(candidate.expression, rule)
    return Candidate(expression, candidate.error, size(expression))
