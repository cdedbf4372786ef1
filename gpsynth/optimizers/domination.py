"""Pareto domination of rows of costs, and the ranks of Diveev's genetic algorithm: by how many each is dominated."""

import numpy as np
import numpy.typing as npt

from gpsynth.arrays import Floats, Ints


def dominates(a: Floats, b: Floats) -> npt.NDArray[np.bool_]:
    """Whether costs a (..., k) are nowhere worse than b and somewhere better; broadcast."""
    better: npt.NDArray[np.bool_] = np.all(a <= b, axis=-1) & np.any(a < b, axis=-1)
    return better


def domination_ranks(costs: Floats) -> Ints:
    """By how many others each row of costs (n, k) is dominated, (n,); 0 on the Pareto front."""
    ranks: Ints = dominates(costs[:, np.newaxis], costs[np.newaxis]).sum(axis=0, dtype=np.int32)
    return ranks


def nearest_to_utopia(costs: Floats) -> int | None:
    """The row nearest to the point of all least costs, each cost scaled to [0, 1] over the finite rows.

    None where some cost is the same in all of them, or where fewer than two rows are finite.
    """
    finite = np.flatnonzero(np.isfinite(costs).all(axis=1))
    if len(finite) < 2:
        return None
    least, most = costs[finite].min(axis=0), costs[finite].max(axis=0)
    if np.any(most <= least):
        return None
    distance = np.linalg.norm((costs[finite] - least) / (most - least), axis=1)
    return int(finite[np.argmin(distance)])
