"""Discs, rows of x, y and radius: what the center of a round robot must stay out of."""

import numpy as np

from gpsynth.arrays import Floats


def grown(discs: Floats, margin: float) -> Floats:
    """The discs (c, 3) with a margin (m) added to their radii; none falls below 0."""
    return np.column_stack([discs[:, :2], np.maximum(discs[:, 2] + margin, 0.0)])


def clear_of(discs: Floats, point: Floats) -> Floats:
    """The discs, each shrunk as far as it takes to leave a point (2,) outside."""
    distance = np.hypot(*(discs[:, :2] - point).T)
    return np.column_stack([discs[:, :2], np.minimum(discs[:, 2], distance * (1.0 - 1e-9))])


def outermost(discs: Floats) -> Floats:
    """Without the discs that lie inside another; of equal ones the first stays."""
    between = discs[:, None, :2] - discs[None, :, :2]
    inside = np.hypot(between[..., 0], between[..., 1]) + discs[:, None, 2] <= discs[None, :, 2]
    earlier = np.tri(len(discs), k=-1, dtype=np.bool_)
    kept: Floats = discs[~np.any(inside & (earlier | ~inside.T), axis=1)]
    return kept
