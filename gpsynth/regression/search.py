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
from gpsynth.regression.state import Shelf, State, shelf
from gpsynth.regression.sums import exhaustive, greedy, multiples, multiplied
from gpsynth.regression.targets import Target, derived, plain

LIMITS = (300, 3000, 20_000)  # formulas of a small, a middle and a large library
ARITHMETIC = frozenset(("add", "sub", "mul", "div"))


SETTLING = 12  # least number of steps after a formula is exact, in which a smaller one may turn up
BEGINNING = 20  # structured steps before evolution begins
TEMPLATES, QUOTIENTS = 5, 2  # of how many targets these are tried
LOOSENING = 15  # steps between two attempts with more numbers
_OVER = object()
GENERATIONS = 4  # of evolution for each structured step


class Budget(NamedTuple):
    """When a search ends, if it has not found an exact formula: the first limit that is reached counts."""

    evaluations: int
    seconds: float | None = None  # of processor time; the same seed need not give the same result then


def search(state: State, budget: Budget) -> State:
    """Structured steps and generations of evolution in turn, until the budget is spent or the formula is exact."""
    if budget.seconds is not None:
        state.deadline = time.process_time() + budget.seconds
    structured, evolving = steps(state), evolve(state)
    count, settled = 0, 0
    while state.evaluations < budget.evaluations and not state.late:
        count += 1
        if next(structured, _OVER) is _OVER or (count > BEGINNING and not state.done):
            for _ in range(GENERATIONS):
                if not state.late:
                    next(evolving)
        if count % LOOSENING == 0 and not state.late:
            loosen_front(state)
        if state.done:
            settled += 1
            if settled > max(SETTLING, count // 3):
                break
    return state


class _Shelves(NamedTuple):
    """Libraries of three sizes, of all functions and of arithmetic alone."""

    tiny: Shelf
    small: Shelf
    large: Shelf
    tiny_arithmetic: Shelf
    small_arithmetic: Shelf
    large_arithmetic: Shelf
    functions_of_arithmetic: Shelf


def steps(state: State) -> Iterator[None]:
    """Structures from the simplest on; each `next` does one step, the caller decides when it is enough."""
    inputs, functions = state.data.inputs, state.functions
    y = plain(state.y)
    first = [y, *derived(y, inputs, functions)]
    polynomials(state, first)
    yield
    shelves = _shelves(state)
    yield
    yield from _simple(state, shelves, first)
    yield from _larger(state, shelves, first)
    second = [target for level in first[1:] for target in derived(level, inputs, functions)]
    yield from _deeper(state, shelves, first, second)


def _shelves(state: State) -> _Shelves:
    rows = state.data.inputs[state.rows]
    full, arithmetic = (
        enumerate_formulas(rows, functions, state.library, lambda: state.late)
        for functions in (state.functions, state.functions & ARITHMETIC)
    )
    outer = wrapped(arithmetic, state.functions, state.library // 4)
    state.evaluations += len(full.ops) + len(outer.ops)
    tiny, small, large = (shelf(full, limit, "formulas") for limit in LIMITS)
    few, some, many = (shelf(arithmetic, limit, "arithmetic") for limit in LIMITS)
    return _Shelves(
        tiny, small, large, few, some, many, shelf(outer, len(outer.ops), "functions of arithmetic")
    )


def _simple(state: State, shelves: _Shelves, first: list[Target]) -> Iterator[None]:
    """Sums, pairs, powers, products and templates of small formulas."""
    y = first[0]
    for target in first:
        for some in (shelves.tiny, shelves.tiny_arithmetic, shelves.small):
            greedy(state, some, target)
        yield
    exhaustive(state, shelves.small, y)
    yield
    for some in (shelves.tiny, shelves.small, shelves.small_arithmetic):
        powers(state, some, y)
        yield
    products = [multiples(some, some) for some in (shelves.tiny_arithmetic, shelves.tiny)]
    for target in first:
        for pairs in products:
            multiplied(state, pairs, target)
        greedy(state, shelves.small_arithmetic, target)
        yield
    for target in first[:TEMPLATES]:
        templates(state, shelves.small.library, target)
        yield


def _larger(state: State, shelves: _Shelves, first: list[Target]) -> Iterator[None]:
    """Pairs and products of more formulas; quotients of sums; powers of many."""
    exhaustive(state, shelves.large, first[0])
    yield
    products = multiples(shelves.tiny, shelves.large)
    for target in first:
        exhaustive(state, shelves.small, target)
        yield
        multiplied(state, products, target)
        yield
    for target in first[:QUOTIENTS]:
        for some in (shelves.tiny_arithmetic, shelves.small_arithmetic, shelves.tiny, shelves.small):
            quotients(state, some, target)
            yield
    for some in (shelves.large_arithmetic, shelves.large):
        powers(state, some, first[0])
        yield


def _deeper(state: State, shelves: _Shelves, first: list[Target], second: list[Target]) -> Iterator[None]:
    """Functions of arithmetic, and everything once more for functions of functions of y."""
    outer, small = shelves.functions_of_arithmetic, shelves.small_arithmetic
    products = multiples(small, small)
    for target in first:
        greedy(state, outer, target)
        greedy(state, shelves.large, target)
        multiplied(state, products, target)
        yield
    products = multiples(shelves.tiny, outer)
    for target in first:
        multiplied(state, products, target)
        yield
    products = multiples(shelves.tiny, shelves.tiny)
    for target in second:
        greedy(state, shelves.tiny, target)
        greedy(state, shelves.small, target)
        multiplied(state, products, target)
        yield
    products = multiples(shelves.tiny, shelves.large)
    for target in second:
        greedy(state, shelves.large, target)
        multiplied(state, products, target)
        yield
