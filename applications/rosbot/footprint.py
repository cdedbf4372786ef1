"""Bodies as circles: a rectangle is covered by them, so what the circles do not touch the rectangle does not."""

import numpy as np

from gpsynth.arrays import Floats

EXCESS = 0.03  # m that the circles may stick out of a rectangle


def rectangle_circles(length: float, width: float, center: tuple[float, float] = (0.0, 0.0)) -> Floats:
    """The fewest equal circles (f, 3) in rows and columns that cover a rectangle and stick out by EXCESS at most.

    Each covers one of equal parts, a rectangle whose corners it goes through. length (m) is along the robot's axis,
    width across; `center` is in the robot's frame.
    """
    # parts of this size stick out by less than EXCESS, and those of half of it however narrow they are
    square = max(min(4.0 * EXCESS, length, width), 2.0 * EXCESS)
    columns, rows = min(
        (
            (columns, rows)
            for columns in range(1, 1 + int(np.ceil(length / square)))
            for rows in range(1, 1 + int(np.ceil(width / square)))
            if _excess(length / columns, width / rows) <= EXCESS
        ),
        key=lambda counts: (counts[0] * counts[1], counts),
    )
    part = np.array([length / columns, width / rows])
    along = (np.arange(columns) + 0.5) * part[0] - 0.5 * length + center[0]
    across = (np.arange(rows) + 0.5) * part[1] - 0.5 * width + center[1]
    x, y = (axis.ravel() for axis in np.meshgrid(along, across))
    return np.column_stack([x, y, np.full(len(x), 0.5 * np.hypot(*part))])


def _excess(length: float, width: float) -> float:
    """How far (m) the circle around a rectangle sticks out of it."""
    return 0.5 * float(np.hypot(length, width) - min(length, width))


def inner_radius(body: Floats) -> float:
    """The radius (m) of the largest disc around the origin of the robot's frame within one of the circles (f, 3)."""
    return max(float(np.max(body[:, 2] - np.hypot(body[:, 0], body[:, 1]))), 0.0)


def outer_radius(body: Floats) -> float:
    """The radius (m) of the disc around the origin of the robot's frame that the circles (f, 3) never leave."""
    return float(np.max(body[:, 2] + np.hypot(body[:, 0], body[:, 1])))


def placed(body: Floats, poses: Floats) -> Floats:
    """The centers (N, f, 2) of the circles (f, 3) of a robot at poses (N, 3)."""
    sine, cosine = np.sin(poses[:, 2:]), np.cos(poses[:, 2:])
    ahead, left, _ = body.T
    x = poses[:, :1] + ahead * cosine - left * sine
    y = poses[:, 1:2] + ahead * sine + left * cosine
    return np.stack([x, y], axis=-1)
