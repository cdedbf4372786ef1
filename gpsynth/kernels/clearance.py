"""Clearance along a step: the smallest distance between the moving robot and moving circles, and to the bounds.

Within one integration step both move along nearly straight lines, so the distance is smallest at a closed-form point
of the chord. The path bends away from its chord by at most h / 8 |v1 - v0| to first order (the sagitta of an arc),
which is deducted, so that a step is judged by all of its path and not by its ends.
"""

import math

import numba

from gpsynth.arrays import Floats, Ints
from gpsynth.kernels.compile import INTEGERS, MATRIX, OUT_MATRIX, VECTOR, kernel

_INT, _FLOAT = numba.types.int64, numba.types.float64


@kernel(
    numba.types.void(
        *(OUT_MATRIX, _INT, _INT, _INT, _INT, _INT, _INT, _INT),
        *(INTEGERS, MATRIX, VECTOR, _FLOAT, _FLOAT, _FLOAT),
    )
)
def approach(
    w: Floats,
    lanes: int,
    before: int,
    after: int,
    slope0: int,
    slope1: int,
    alive: int,
    out: int,
    position: Ints,
    circles: Floats,
    area: Floats,
    time: float,
    step: float,
    margin: float,
) -> None:
    """Update rows out, out+1, out+2 of `w`: clearance (m), exposure (s), depth (m s).

    before, after: first rows of the states at `time` and time + step (s); slope0, slope1: of the first and the last
    derivatives in between; position: (2,) states that are x and y (m); circles: (o, 5) x, y, vx, vy, radius;
    area: (4,) x_low, x_high, y_low, y_high. Lanes whose row `alive` is 0 keep their values.
    """
    i, j = position[0], position[1]
    x_low, x_high, y_low, y_high = area[0], area[1], area[2], area[3]
    near = out + 3
    for lane in range(lanes):
        x0, x1, y0, y1 = w[before + i, lane], w[after + i, lane], w[before + j, lane], w[after + j, lane]
        x_room = min(min(x0, x1) - x_low, x_high - max(x0, x1))
        y_room = min(min(y0, y1) - y_low, y_high - max(y0, y1))
        w[near, lane] = min(x_room, y_room)
    for k in range(len(circles)):
        x, y = circles[k, 0] + circles[k, 2] * time, circles[k, 1] + circles[k, 3] * time
        dx, dy, radius = circles[k, 2] * step, circles[k, 3] * step, circles[k, 4]
        for lane in range(lanes):
            px, py = w[before + i, lane] - x, w[before + j, lane] - y
            qx = w[after + i, lane] - w[before + i, lane] - dx
            qy = w[after + j, lane] - w[before + j, lane] - dy
            square = qx * qx + qy * qy
            s = -(px * qx + py * qy) / (square if square > 0.0 else 1.0)
            s = 0.0 if s < 0.0 else (1.0 if s > 1.0 else s)
            px += s * qx
            py += s * qy
            gap = math.sqrt(px * px + py * py) - radius
            w[near, lane] = gap if gap < w[near, lane] else w[near, lane]
    for lane in range(lanes):
        bend_x = w[slope1 + i, lane] - w[slope0 + i, lane]
        bend_y = w[slope1 + j, lane] - w[slope0 + j, lane]
        gap = w[near, lane] - 0.125 * step * math.sqrt(bend_x * bend_x + bend_y * bend_y)
        depth = margin - gap
        running = w[alive, lane] > 0.0
        w[out, lane] = gap if running and gap < w[out, lane] else w[out, lane]
        w[out + 1, lane] += step if running and depth > 0.0 else 0.0
        w[out + 2, lane] += step * depth if running and depth > 0.0 else 0.0
