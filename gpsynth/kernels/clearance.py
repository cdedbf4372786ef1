"""Clearance along a step: the smallest distance between the moving robot and what it must not touch.

The robot is one or several circles. Within one integration step each of them, and every moving obstacle, goes along a
nearly straight line, so the distance is smallest at a closed-form point of the chord. The path bends away from its
chord by at most b = h / 8 |v1 - v0| to first order (the sagitta of an arc), which is deducted, so that a step is judged
by all of its path and not by its ends. At the share s of the chord it is 4 s (1 - s) b away: where an end is nearest
and the distance grows from there by 4 b a chord or more, the end is nearest on the path too, and nothing is deducted.
So a robot that touches an obstacle can leave it.

All obstacles of other shapes are one distance field (`field.py`).
"""

import math

import numba

from gpsynth.arrays import Floats
from gpsynth.kernels.compile import OUT_MATRIX, kernel, part
from gpsynth.kernels.field import least_square, square_at
from gpsynth.kernels.layout import WORLD, World
from gpsynth.kernels.machine import sine_and_cosine
from gpsynth.kernels.vectors import WIDTH, put, root, take

_INT, _FLOAT = numba.types.int64, numba.types.float64
GAP, NEAR, X, Y, DX, DY, BEND = range(3, 10)  # rows of scratch: of the robot, then of one of its circles


@part
def rooms(
    w: Floats,
    lanes: int,
    before: int,
    after: int,
    slope0: int,
    slope1: int,
    out: int,
    i: int,
    j: int,
    area: Floats,
    step: float,
) -> None:
    """How far the origin of the body stays within the bounds."""
    x_low, x_high, y_low, y_high = area[0], area[1], area[2], area[3]
    for lane in range(lanes):
        x0, x1, y0, y1 = w[before + i, lane], w[after + i, lane], w[before + j, lane], w[after + j, lane]
        bend_x = 0.125 * step * abs(w[slope1 + i, lane] - w[slope0 + i, lane])
        bend_y = 0.125 * step * abs(w[slope1 + j, lane] - w[slope0 + j, lane])
        x_room = min(min(x0, x1) - x_low, x_high - max(x0, x1))
        y_room = min(min(y0, y1) - y_low, y_high - max(y0, y1))
        x_room -= 0.0 if abs(x1 - x0) >= 4.0 * bend_x else bend_x
        y_room -= 0.0 if abs(y1 - y0) >= 4.0 * bend_y else bend_y
        w[out + GAP, lane] = min(x_room, y_room)


@part
def lead(
    w: Floats,
    lanes: int,
    before: int,
    after: int,
    slope0: int,
    slope1: int,
    out: int,
    world: World,
    k: int,
    step: float,
) -> None:
    """Where circle k of the body begins, its chord and how far it bends away from that."""
    i, j = world.position[0], world.position[1]
    a, b = world.body[k, 0], world.body[k, 1]
    for lane in range(0, lanes, WIDTH):
        x, y = take(w, before + i, lane), take(w, before + j, lane)
        dx, dy = take(w, after + i, lane) - x, take(w, after + j, lane) - y
        bend_x = take(w, slope1 + i, lane) - take(w, slope0 + i, lane)
        bend_y = take(w, slope1 + j, lane) - take(w, slope0 + j, lane)
        if len(world.position) > 2:
            h = world.position[2]
            sine0, cosine0 = sine_and_cosine(take(w, before + h, lane))
            sine1, cosine1 = sine_and_cosine(take(w, after + h, lane))
            ahead0, left0 = a * cosine0 - b * sine0, a * sine0 + b * cosine0
            ahead1, left1 = a * cosine1 - b * sine1, a * sine1 + b * cosine1
            x, y = x + ahead0, y + left0
            dx, dy = dx + (ahead1 - ahead0), dy + (left1 - left0)
            turn0, turn1 = take(w, slope0 + h, lane), take(w, slope1 + h, lane)
            bend_x = bend_x - (turn1 * left1 - turn0 * left0)
            bend_y = bend_y + (turn1 * ahead1 - turn0 * ahead0)
        put(w, out + X, lane, x)
        put(w, out + Y, lane, y)
        put(w, out + DX, lane, dx)
        put(w, out + DY, lane, dy)
        put(w, out + BEND, lane, 0.125 * step * root(bend_x * bend_x + bend_y * bend_y))
        put(w, out + NEAR, lane, math.inf)


@part
def pass_circles(
    w: Floats, lanes: int, out: int, circles: Floats, body: float, time: float, step: float
) -> None:
    """The least distance of one circle of the body from the obstacles that are circles."""
    for k in range(len(circles)):
        x, y = circles[k, 0] + circles[k, 2] * time, circles[k, 1] + circles[k, 3] * time
        pass_disc(w, lanes, out, x, y, circles[k, 2] * step, circles[k, 3] * step, circles[k, 4] + body)


@part
def pass_tracks(w: Floats, lanes: int, out: int, world: World, body: float, time: float, step: float) -> None:
    """The same of the discs that follow tracks, between whose places no step may turn."""
    for k in range(len(world.sizes)):
        x, y = place(world.tracks, k, time / world.tempo)
        later_x, later_y = place(world.tracks, k, (time + step) / world.tempo)
        pass_disc(w, lanes, out, x, y, later_x - x, later_y - y, world.sizes[k] + body)


@part
def place(tracks: Floats, k: int, when: float) -> tuple[float, float]:
    """Where track k is, `when` counted in its periods."""
    last = tracks.shape[1] - 1
    first = min(int(when), last)
    share, second = min(when - first, 1.0), min(first + 1, last)
    x, y = tracks[k, first, 0], tracks[k, first, 1]
    return x + share * (tracks[k, second, 0] - x), y + share * (tracks[k, second, 1] - y)


@part
def pass_disc(
    w: Floats, lanes: int, out: int, x: float, y: float, dx: float, dy: float, radius: float
) -> None:
    """The least distance of one circle of the body from a disc that goes from (x, y) by (dx, dy) in the step."""
    for lane in range(lanes):
        px, py = w[out + X, lane] - x, w[out + Y, lane] - y
        qx, qy = w[out + DX, lane] - dx, w[out + DY, lane] - dy
        square = qx * qx + qy * qy
        bend = w[out + BEND, lane]
        nearest = -(px * qx + py * qy) / (square if square > 0.0 else 1.0)
        s = 0.0 if nearest < 0.0 else (1.0 if nearest > 1.0 else nearest)
        px += s * qx
        py += s * qy
        apart = math.sqrt(px * px + py * py)
        gap = apart - radius + (bend if abs(nearest - s) * square >= 4.0 * bend * apart else 0.0)
        w[out + NEAR, lane] = gap if gap < w[out + NEAR, lane] else w[out + NEAR, lane]


@part
def pass_near_circles(w: Floats, lanes: int, out: int, world: World, body: float) -> None:
    """The same for circles at rest, of which a lane looks at those of its bucket; at all if that does not hold."""
    cells, circles = world.buckets, world.circles
    left, low, side = cells.lattice[0], cells.lattice[1], cells.lattice[2]
    columns, rows, reach = cells.lattice[3], cells.lattice[4], cells.lattice[5]
    for lane in range(lanes):
        x, y, qx, qy = w[out + X, lane], w[out + Y, lane], w[out + DX, lane], w[out + DY, lane]
        u, v, square = (x - left) / side, (y - low) / side, qx * qx + qy * qy
        holds = 0.0 <= u < columns and 0.0 <= v < rows and square <= reach * reach
        first, last = 0, len(circles) - world.movers
        if holds:
            cell = int(v) * int(columns) + int(u)
            first, last = cells.firsts[cell], cells.firsts[cell + 1]
        near, bend = w[out + NEAR, lane], w[out + BEND, lane]
        for number in range(first, last):
            k = world.movers + (cells.members[number] if holds else number)
            px, py = x - circles[k, 0], y - circles[k, 1]
            nearest = -(px * qx + py * qy) / (square if square > 0.0 else 1.0)
            s = 0.0 if nearest < 0.0 else (1.0 if nearest > 1.0 else nearest)
            px += s * qx
            py += s * qy
            apart = math.sqrt(px * px + py * py)
            gap = apart - (circles[k, 4] + body)
            gap += bend if abs(nearest - s) * square >= 4.0 * bend * apart else 0.0
            near = gap if gap < near else near
        w[out + NEAR, lane] = near


@part
def pass_field(w: Floats, lanes: int, out: int, squares: Floats, grid: Floats, body: float) -> None:
    """The least distance of one circle of the body from what the distance field is of."""
    for lane in range(lanes):
        x, y, dx, dy = w[out + X, lane], w[out + Y, lane], w[out + DX, lane], w[out + DY, lane]
        first, last = square_at(squares, grid, x, y), square_at(squares, grid, x + dx, y + dy)
        square = least_square(first, last, dx * dx + dy * dy)
        gap = (math.sqrt(square) if square > 0.0 else -math.sqrt(-square)) - body
        w[out + NEAR, lane] = gap if gap < w[out + NEAR, lane] else w[out + NEAR, lane]


@kernel(
    numba.types.void(
        *(OUT_MATRIX, _INT, _INT, _INT, _INT, _INT, _INT, _INT),
        *(WORLD, _FLOAT, _FLOAT),
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
    world: World,
    time: float,
    step: float,
) -> None:
    """Update rows out, out+1, out+2 of `w`: clearance (m), exposure (s), depth (m s).

    before, after: first rows of the states at `time` and time + step (s); slope0, slope1: of the first and the last
    derivatives in between. Lanes whose row `alive` is 0 keep their values.
    """
    i, j = world.position[0], world.position[1]
    rooms(w, lanes, before, after, slope0, slope1, out, i, j, world.area, step)
    for k in range(len(world.body)):
        lead(w, lanes, before, after, slope0, slope1, out, world, k, step)
        if len(world.buckets.firsts) > 0:
            pass_circles(w, lanes, out, world.circles[: world.movers], world.body[k, 2], time, step)
            pass_near_circles(w, lanes, out, world, world.body[k, 2])
        else:
            pass_circles(w, lanes, out, world.circles, world.body[k, 2], time, step)
        pass_tracks(w, lanes, out, world, world.body[k, 2], time, step)
        if len(world.squares) > 0:
            pass_field(w, lanes, out, world.squares, world.grid, world.body[k, 2])
        for lane in range(lanes):
            gap = w[out + NEAR, lane] - w[out + BEND, lane]
            w[out + GAP, lane] = gap if gap < w[out + GAP, lane] else w[out + GAP, lane]
    for lane in range(lanes):
        gap = w[out + GAP, lane]
        depth = world.margin - gap
        running = w[alive, lane] > 0.0
        w[out, lane] = gap if running and gap < w[out, lane] else w[out, lane]
        w[out + 1, lane] += step if running and depth > 0.0 else 0.0
        w[out + 2, lane] += step * depth if running and depth > 0.0 else 0.0
