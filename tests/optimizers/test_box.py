"""First positions and costs, where rounding and bad numbers would do harm."""

import numpy as np
import pytest

from gpsynth.optimizers.box import finite_or_worst, scatter


class Edge:
    """A generator that always draws the largest number below 1."""

    def random(self, shape):
        return np.full(shape, np.nextafter(1.0, 0.0))


def test_rounding_never_carries_a_first_position_over_the_wall():
    rng = np.random.default_rng(1)
    upper = rng.uniform(-1e-3, 1e-3, 5_000)
    lower = upper - rng.uniform(0, 1, 5_000)
    assert (lower + (upper - lower) > upper).any()  # what a factor of 1 would do
    x = scatter(Edge(), np.empty((0, 5_000)), lower, upper, 1)
    assert ((lower <= x) & (x <= upper)).all()


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_a_row_that_is_not_finite_becomes_the_worst(bad):
    assert finite_or_worst(np.array([1.0, bad]), (2,)).tolist() == [1.0, np.inf]
    rows = finite_or_worst(np.array([[1.0, 2.0], [3.0, bad]]), (2, 2))
    assert rows.tolist() == [[1.0, 2.0], [np.inf, np.inf]]
