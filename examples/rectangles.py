"""How far two rectangles are apart or overlap, written so that it can be traced."""

from collections.abc import Sequence
from typing import Any

import numpy as np

Box = tuple[Any, Any, Any]  # x, y (m) of the center and heading (rad)


def overlap(a: Box, b: Box, half_a: Sequence[float], half_b: Sequence[float]) -> Any:
    """How deep (m) two rectangles with these half lengths and widths are in each other, 0 if not at all.

    Convex shapes are apart if and only if an axis separates them, and for rectangles an axis of one of the two does.
    """
    dx, dy = a[0] - b[0], a[1] - b[1]
    cosine, sine = np.abs(np.cos(a[2] - b[2])), np.abs(np.sin(a[2] - b[2]))
    depth: Any = None
    for heading, own, other in ((a[2], half_a, half_b), (b[2], half_b, half_a)):
        along, across = (
            np.cos(heading) * dx + np.sin(heading) * dy,
            np.cos(heading) * dy - np.sin(heading) * dx,
        )
        inside = np.minimum(
            own[0] + other[0] * cosine + other[1] * sine - np.abs(along),
            own[1] + other[0] * sine + other[1] * cosine - np.abs(across),
        )
        depth = inside if depth is None else np.minimum(depth, inside)
    return np.maximum(0.0, depth)
