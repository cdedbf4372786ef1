"""What is fitted instead of y: invertible functions of it, in which a nested formula becomes a sum.

1 / y turns a quotient into a sum, y^2 takes a root away, log y a product or an exponential, y / x_j a common factor
(divide and conquer after Udrescu and Tegmark 2020).
"""

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from gpsynth.arrays import Floats
from gpsynth.regression.expressions import Expression, number, variable

LARGEST = 1e12
ONE = number(1.0)


class Target(NamedTuple):
    """Values to be fitted, and how a formula for them becomes one for y."""

    name: str
    values: Floats  # (n,)
    inverse: Callable[[Expression], Expression]
    depth: int = 0


def plain(y: Floats) -> Target:
    """y itself."""
    return Target("y", y, lambda e: e)


def derived(target: Target, inputs: Floats, functions: frozenset[str]) -> Iterator[Target]:
    """The targets one step further, those that are finite on all rows."""
    with np.errstate(all="ignore"):
        for name, values, inverse, needed in _steps(target.values, inputs):
            spread = np.ptp(values)
            if (
                needed <= functions
                and np.all(np.abs(values) < LARGEST)
                and spread > 1e-9 * np.abs(values).max()
            ):
                yield Target(
                    name.format(target.name), values, _then(inverse, target.inverse), target.depth + 1
                )


def _then(
    first: Callable[[Expression], Expression], second: Callable[[Expression], Expression]
) -> Callable[..., Expression]:
    return lambda e: second(first(e))


def _steps(
    y: Floats, inputs: Floats
) -> Iterator[tuple[str, Floats, Callable[[Expression], Expression], set[str]]]:
    yield "1/({})", 1.0 / y, lambda e: ("div", ONE, e), {"div"}
    if np.all(y >= 0.0):
        yield "({})^2", y * y, lambda e: ("sqrt", e), {"sqrt"}
    if np.all(y > 0.0):
        yield "log({})", np.log(y), lambda e: ("exp", e), {"exp"}
        yield "sqrt({})", np.sqrt(y), lambda e: ("square", e), {"mul"}
    if np.all(np.abs(y) < 20.0):
        yield "exp({})", np.exp(y), lambda e: ("log", e), {"log"}
    for j, column in enumerate(inputs.T):
        if np.all(column != 0.0):
            yield f"({{}})/x{j}", y / column, _around("mul", j), {"mul"}
        yield f"({{}})*x{j}", y * column, _around("div", j), {"div"}


def _around(operation: str, j: int) -> Callable[[Expression], Expression]:
    return lambda e: (operation, e, variable(j))
