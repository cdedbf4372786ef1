"""The search, one small step after the other: cheap and simple structures first, deeper ones after them."""

import time
from collections.abc import Iterator
from typing import NamedTuple

from gpsynth.regression.dense import polynomials
from gpsynth.regression.evolution import evolve
from gpsynth.regression.library import enumerate_formulas, wrapped
from gpsynth.regression.loosening import loosen_front, templates
from gpsynth.regression.powers import powers
from gpsynth.regression.quotients import quotients
from gpsynth.regression.state import State, shelf
from gpsynth.regression.sums import exhaustive, greedy, multiples, multiplied
from gpsynth.regression.targets import derived, plain

LIMITS = (300, 3000, 20_000)  # formulas of a small, a middle and a large library
ARITHMETIC = frozenset(("add", "sub", "mul", "div"))


SETTLING = 12  # least number of steps after a formula is exact, in which a smaller one may turn up
BEGINNING = 20  # structured steps before evolution begins
LOOSENING = 15  # steps between two attempts with more numbers
_OVER = object()
GENERATIONS = 4  # of evolution for each structured step


class Budget(NamedTuple):
    """When a search ends, if it has not found an exact formula: the first limit that is reached counts."""

    evaluations: int
    seconds: float | None = None  # of processor time; the same seed need not give the same result then


def search(state: State, budget: Budget) -> State:
    """Structured steps and generations of evolution in turn, until the budget is spent or the formula is exact."""
    begin = time.process_time()
    structured, evolving = steps(state), evolve(state)
    count, settled = 0, 0
    while state.evaluations < budget.evaluations:
        if budget.seconds is not None and time.process_time() - begin >= budget.seconds:
            break
        count += 1
        if next(structured, _OVER) is _OVER or (count > BEGINNING and not state.done):
            for _ in range(GENERATIONS):
                next(evolving)
        if count % LOOSENING == 0:
            loosen_front(state)
        if state.done:
            settled += 1
            if settled > max(SETTLING, count // 3):
                break
    return state


def steps(state: State) -> Iterator[None]:
    """Each `next` does one step; the caller decides when it is enough."""
    inputs, functions = state.data.inputs, state.functions
    y = plain(state.y)
    first = [y, *derived(y, inputs, functions)]
    polynomials(state, first)
    yield
    rows = inputs[state.rows]
    full = enumerate_formulas(rows, functions, state.library)
    arithmetic = enumerate_formulas(rows, functions & ARITHMETIC, state.library)
    state.evaluations += len(full.ops) + len(arithmetic.ops)
    tiny, small, large = (shelf(full, limit, "formulas") for limit in LIMITS)
    plainest, plainer, plain_large = (shelf(arithmetic, limit, "arithmetic") for limit in LIMITS)
    plain_products, tiny_products = multiples(plainest, plainest), multiples(tiny, tiny)
    yield
    for target in first:
        greedy(state, tiny, target)
        greedy(state, plainest, target)
        greedy(state, small, target)
        yield
    exhaustive(state, small, y)
    yield
    for some in (tiny, small, plainer):
        powers(state, some, y)
        yield
    for target in first:
        multiplied(state, plain_products, target)
        multiplied(state, tiny_products, target)
        yield
        greedy(state, plainer, target)
        yield
    for target in first[:5]:
        templates(state, full, target)
        yield
    exhaustive(state, large, y)
    yield
    large_products = multiples(tiny, large)
    for target in first:
        exhaustive(state, small, target)
        yield
        multiplied(state, large_products, target)
        yield
    for target in first[:2]:
        for some in (plainest, plainer, tiny, small):
            quotients(state, some, target)
            yield
    for some in (plain_large, large):
        powers(state, some, y)
        yield
    deep = shelf(wrapped(arithmetic, functions, 5000), 30_000, "functions of arithmetic")
    plainer_products = multiples(plainer, plainer)
    for target in first:
        greedy(state, deep, target)
        greedy(state, large, target)
        multiplied(state, plainer_products, target)
        yield
    deep_products = multiples(tiny, deep)
    for target in first:
        multiplied(state, deep_products, target)
        yield
    second = [t for level in first[1:] for t in derived(level, inputs, functions)]
    for target in second:
        greedy(state, tiny, target)
        greedy(state, small, target)
        multiplied(state, tiny_products, target)
        yield
    for target in second:
        greedy(state, large, target)
        multiplied(state, large_products, target)
        yield
