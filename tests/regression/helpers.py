"""Random expressions for the tests of regression."""

import numpy as np

from gpsynth.kernels.data_code import BINARY, NAMES
from gpsynth.regression.expressions import Expression, number, variable


def random_expression(
    rng: np.random.Generator, nodes: int, columns: int, names: tuple[str, ...] = NAMES
) -> Expression:
    """About `nodes` nodes over `columns` variables and numbers."""
    if nodes <= 1:
        if rng.random() < 0.4:
            return number(rng.choice([0.0, -1.0, 2.0, 0.5, round(rng.uniform(-3, 3), 2)]))
        return variable(int(rng.integers(columns)))
    name = names[rng.integers(len(names))]
    if name not in BINARY:
        return (name, random_expression(rng, nodes - 1, columns, names))
    left = int(rng.integers(1, nodes)) if nodes > 2 else 1
    return (
        name,
        random_expression(rng, left, columns, names),
        random_expression(rng, nodes - 1 - left, columns, names),
    )
