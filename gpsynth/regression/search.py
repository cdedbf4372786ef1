"""The search, one small step after the other: cheap and simple structures first, deeper ones after them."""

from collections.abc import Iterator

from gpsynth.regression.dense import polynomials
from gpsynth.regression.library import enumerate_formulas, wrapped
from gpsynth.regression.loosening import loosen_front
from gpsynth.regression.powers import powers
from gpsynth.regression.quotients import quotients
from gpsynth.regression.state import State, shelf
from gpsynth.regression.sums import exhaustive, greedy, multiples, multiplied
from gpsynth.regression.targets import derived, plain

ARITHMETIC = frozenset(("add", "sub", "mul", "div"))


def steps(state: State) -> Iterator[None]:
    """Each `next` does one step; the caller decides when it is enough."""
    inputs, functions = state.data.inputs, state.functions
    y = plain(state.y)
    first = [y, *derived(y, inputs, functions)]
    polynomials(state, first)
    yield
    rows = inputs[state.rows]
    full = enumerate_formulas(rows, functions, 20_000)
    arithmetic = enumerate_formulas(rows, functions & ARITHMETIC, 20_000)
    tiny, small, large = (shelf(full, limit, "formulas") for limit in (300, 3000, 20_000))
    plainest, plainer, plain_large = (shelf(arithmetic, limit, "arithmetic") for limit in (300, 3000, 20_000))
    plain_products, tiny_products = multiples(plainest, plainest), multiples(tiny, tiny)
    yield
    for target in first:
        greedy(state, tiny, target)
        greedy(state, plainest, target)
        greedy(state, small, target)
        yield
    for target in first:
        multiplied(state, plain_products, target)
        multiplied(state, tiny_products, target)
        yield
        greedy(state, plainer, target)
        yield
    for some in (tiny, small, plainer):
        powers(state, some, y)
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
    loosen_front(state)
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
    loosen_front(state)
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
