"""Closed-loop rollouts of many lanes: a lane is one start under one parameter vector and one schedule.

A block of lanes goes through time together. Its workspace `w` has one row a quantity and one column a lane, so every
inner loop is a plain array loop. Lanes that have ended make room: those that run stand in the first columns. What
happens in one lane never touches another: results are the same bit for bit for any block size and any number of
threads.
"""

import math

import numpy as np
import numpy.typing as npt
from numba import types

from gpsynth.arrays import Floats, Ints
from gpsynth.kernels import trigonometry
from gpsynth.kernels.clearance import approach
from gpsynth.kernels.compile import OUT_MATRIX, OUT_TENSOR, kernel, part, widest_vectors
from gpsynth.kernels.conditions import arrive, command, measure, settle
from gpsynth.kernels.layout import (
    CLOCK,
    CODES,
    CONDITIONS,
    LANES,
    ROWS,
    TOLL,
    WORLD,
    Clock,
    Code,
    Conditions,
    Lanes,
    Rows,
    Toll,
    World,
)
from gpsynth.kernels.machine import execute, wrap
from gpsynth.kernels.steps import advance
from gpsynth.kernels.vectors import WIDTH, choose, magnitude, put, root, take

ARRIVAL, END, COST, CLEARANCE, EXPOSURE, DEPTH, DIVERGED, SHARE, TERMINAL = range(9)  # columns of the result
ENORMOUS = 1e10  # a state beyond it has diverged
NUMBER = 3  # column of a block's picks that numbers its lanes
INSTANT = 1e-9  # s; a clock reading this close to a switching time has reached it

_INTEGER = types.int64


@part
def load(
    w: Floats, rows: Rows, code: Code, lanes: Lanes, toll: Toll, first: int, count: int, picks: Ints
) -> None:
    """Set a block up: constants, and for lanes [first, first + count) start, goal, target, parameters and limit.

    picks (., 4) takes for each column what its lane has, and the number of the lane in the block.
    """
    w[:] = 0.0
    for k in range(len(code.constants)):
        w[code.constant_rows[k], :] = code.constants[k]
    n, p = lanes.starts.shape[1], lanes.parameters.shape[1]
    for lane in range(count):
        start, vector = lanes.picks[first + lane, 0], lanes.picks[first + lane, 1]
        for i in range(n):
            w[rows.state + i, lane] = lanes.starts[start, i]
            w[rows.goal + i, lane] = lanes.goals[start, i]
            w[rows.target + i, lane] = lanes.goals[start, i]
        for k in range(p):
            w[rows.parameter + k, lane] = lanes.parameters[vector, k]
        for k in range(3):
            picks[lane, k] = lanes.picks[first + lane, k]
        picks[lane, NUMBER] = lane
        w[rows.alive, lane] = 1.0
        w[rows.arrival, lane] = np.inf
        w[rows.before, lane] = np.inf
        w[rows.limit, lane] = toll.limits[first + lane] if len(toll.limits) > 0 else np.inf
        w[rows.near, lane] = np.inf


@part
def distance(w: Floats, rows: Rows, code: Code, point: Floats, lane: int) -> float:
    """Euclidean distance of a lane's state from `point` (n,), angles wrapped, in the units of the states."""
    square = 0.0
    for i in range(len(point)):
        error = point[i] - w[rows.state + i, lane]
        for k in range(len(code.angles)):
            error = trigonometry.wrap(error) if code.angles[k] == i else error
        square += error * error
    return math.sqrt(square)


@part
def retarget(
    w: Floats,
    rows: Rows,
    code: Code,
    lanes: Lanes,
    clock: Clock,
    picks: Ints,
    passed: npt.NDArray[np.int64],
    shift: Floats,
    count: int,
    time: float,
) -> None:
    """Move each lane's target to the point of its schedule that is due at `time`; after the last comes the goal.

    passed: points that a lane has behind it; shift: how much earlier than planned its points end, s, at most 0.
    """
    k, n = lanes.ends.shape[1], lanes.starts.shape[1]
    for lane in range(count):
        plan, number = picks[lane, 2], picks[lane, NUMBER]
        due = passed[number]
        while due < k:
            over = time >= lanes.ends[plan, due] + shift[number] - INSTANT
            if not over:
                if not (
                    clock.reach > 0.0
                    and distance(w, rows, code, lanes.points[plan, due], lane) <= clock.reach
                ):
                    break
                shift[number] = time - lanes.ends[plan, due]
            due += 1
        passed[number] = due
        for i in range(n):
            w[rows.target + i, lane] = lanes.points[plan, due, i] if due < k else w[rows.goal + i, lane]


@part
def judge(w: Floats, rows: Rows, code: Code, clock: Clock, n: int, count: int, time: float) -> int:
    """Mark the lanes that have arrived or diverged at `time`; the number of lanes still running.

    Of the period before an arrival, the share that lies behind it is the one that a linear measure would give.
    """
    execute(code.instructions, code.ends[1], code.ends[2], w, count)
    for lane in range(0, count, WIDTH):
        alive, diverged = take(w, rows.alive, lane), take(w, rows.diverged, lane)
        runs = alive > 0.0
        put(w, rows.end, lane, choose(runs, time, take(w, rows.end, lane)))
        for i in range(n):
            lost = choose(magnitude(take(w, rows.state + i, lane)) <= ENORMOUS, diverged, 1.0)
            diverged = choose(runs, lost, diverged)
        put(w, rows.diverged, lane, diverged)
        alive = choose(diverged > 0.0, 0.0, alive)
        arrival, measure = take(w, rows.arrival, lane), take(w, code.arrival[0], lane)
        arrives = (alive > 0.0) & (measure <= 0.0)
        first = arrives & (arrival > time)
        share = measure / (measure - take(w, rows.before, lane))
        put(w, rows.share, lane, choose(first, share, take(w, rows.share, lane)))
        put(w, rows.before, lane, measure)
        put(w, rows.arrival, lane, choose(first, time, arrival))
        put(w, rows.alive, lane, choose(arrives, 0.0 if clock.stop else 1.0, alive))
    running = 0
    for lane in range(count):
        running += 1 if w[rows.alive, lane] > 0.0 else 0
    return running


@part
def dismiss(w: Floats, rows: Rows, position: Ints, toll: Toll, count: int, time: float, running: int) -> int:
    """End the lanes that have not arrived and cannot keep their limit; of `running` lanes how many are left."""
    if len(toll.limits) == 0:
        return running
    for lane in range(0, count, WIDTH):
        soonest = take(w, rows.alive, lane) * time
        if toll.pace > 0.0:
            x = take(w, rows.goal + position[0], lane) - take(w, rows.state + position[0], lane)
            y = take(w, rows.goal + position[1], lane) - take(w, rows.state + position[1], lane)
            ahead = root(x * x + y * y) - toll.slack
            soonest = soonest + choose(ahead > 0.0, toll.pace * ahead, 0.0)
        late = soonest - toll.due
        cost = toll.rate * soonest + choose(late > 0.0, toll.late * late, 0.0)
        exposure = take(w, rows.near + 1, lane)
        price = toll.entry + toll.exposure * exposure + toll.depth * take(w, rows.near + 2, lane)
        cost = cost + choose(exposure > 0.0, price, 0.0)
        put(w, rows.alive, lane, choose(cost > take(w, rows.limit, lane), 0.0, take(w, rows.alive, lane)))
    left = 0
    for lane in range(count):
        left += 1 if w[rows.alive, lane] > 0.0 else 0
    return left


@part
def hopeless(w: Floats, rows: Rows, picks: Ints, bound: float, count: int) -> bool:
    """Whether the lanes together cost more than `bound` already or one has diverged; then all of them cost infinity."""
    costs = w[rows.sum]  # nobody reads it between two steps
    lost = 0.0
    for lane in range(count):
        costs[picks[lane, NUMBER]] = w[rows.cost, lane]
        lost += w[rows.diverged, lane]
    total = 0.0
    for number in range(count):  # in an order that does not depend on which lanes have ended
        total += costs[number]
    if total <= bound and lost == 0.0:
        return False
    w[rows.cost, :] = np.inf
    return True


@part
def gather(w: Floats, rows: Rows, picks: Ints, count: int) -> None:
    """Put the lanes that run ahead of those that have ended: columns change places."""
    last = count - 1
    for lane in range(count):
        if w[rows.alive, lane] <= 0.0:
            while last > lane and w[rows.alive, last] <= 0.0:
                last -= 1
            if last <= lane:
                return
            for row in range(len(w)):
                w[row, lane], w[row, last] = w[row, last], w[row, lane]
            for k in range(NUMBER + 1):
                picks[lane, k], picks[last, k] = picks[last, k], picks[lane, k]


@part
def store(
    w: Floats, rows: Rows, code: Code, picks: Ints, n: int, first: int, count: int, result: Floats
) -> None:
    """Write the block's results, one row a lane; what diverged costs +inf."""
    q = len(code.arrival) - 1
    for lane in range(count):
        out = result[first + picks[lane, NUMBER]]
        bad = w[rows.diverged, lane] > 0.0 or not np.isfinite(w[rows.cost, lane])
        out[ARRIVAL], out[END] = w[rows.arrival, lane], w[rows.end, lane]
        out[COST] = np.inf if bad else w[rows.cost, lane]
        out[CLEARANCE], out[EXPOSURE] = w[rows.near, lane], w[rows.near + 1, lane]
        out[DEPTH], out[DIVERGED] = w[rows.near + 2, lane], 1.0 if bad else 0.0
        out[SHARE] = w[rows.share, lane]
        for k in range(q):
            out[TERMINAL + k] = w[code.arrival[1 + k], lane]
        for i in range(n):
            out[TERMINAL + q + i] = w[rows.state + i, lane]


@part
def record(
    w: Floats,
    rows: Rows,
    code: Code,
    picks: Ints,
    n: int,
    first: int,
    count: int,
    period: int,
    time: float,
    trace: Floats,
) -> None:
    """Keep state, control and target of the lanes that have not ended before `time`."""
    m = len(code.controls)
    for lane in range(count):
        if w[rows.end, lane] == time:
            out = trace[first + picks[lane, NUMBER], period]
            for i in range(n):
                out[i] = w[rows.state + i, lane]
                out[n + m + i] = w[rows.target + i, lane]
            for k in range(m):
                out[n + k] = w[code.controls[k], lane]


@kernel(OUT_MATRIX(_INTEGER, _INTEGER))
def workspace(rows: int, columns: int) -> Floats:
    """An array (rows, columns) that begins at a cache line, so that no vector straddles two."""
    flat = np.empty(rows * columns + 7)
    skipped = -(flat.ctypes.data // 8) % 8
    return flat[skipped : skipped + rows * columns].reshape((rows, columns))


@kernel(
    types.void(
        *(
            ROWS,
            CODES,
            LANES,
            CONDITIONS,
            CLOCK,
            WORLD,
            TOLL,
            _INTEGER,
            _INTEGER,
            _INTEGER,
            OUT_MATRIX,
            OUT_TENSOR,
        )
    )
)
def roll(
    rows: Rows,
    code: Code,
    lanes: Lanes,
    given: Conditions,
    clock: Clock,
    world: World,
    toll: Toll,
    block: int,
    first: int,
    last: int,
    result: Floats,
    trace: Floats,
) -> None:
    """Run lanes [first, last), `block` at a time, into result (L, TERMINAL + q + n).

    `trace` (L, periods + 1, n + m + n) takes state, control and target at each tick unless its length is 0; what a
    lane does after its end is not recorded. The control at the last tick is the one that would be applied next. A lane
    that cannot keep its limit of the toll any more ends without arrival.
    """
    widest_vectors()
    n = lanes.starts.shape[1]
    w = workspace(rows.total, -(-min(block, last - first) // WIDTH) * WIDTH)
    picks = np.empty((block, NUMBER + 1), np.int32)
    passed = np.empty(block, np.int64)
    shift = np.empty(block)
    bends = len(world.position) > 0
    for begin in range(first, last, block):
        count = min(block, last - begin)
        load(w, rows, code, lanes, toll, begin, count, picks)
        settle(w, rows, picks, given, count)
        passed[:] = 0
        shift[:] = 0.0
        ahead = count  # columns behind it hold lanes that have ended
        for period in range(clock.periods + 1):
            time = period * clock.substeps * clock.step
            if lanes.ends.shape[1] > 0:
                retarget(w, rows, code, lanes, clock, picks, passed, shift, ahead, time)
            running = judge(w, rows, code, clock, n, ahead, time)
            running = dismiss(w, rows, world.position, toll, ahead, time, running)
            if clock.bound < np.inf and hopeless(w, rows, picks, clock.bound, count):
                break
            if len(given.noise) > 0:
                measure(w, rows, picks, given, ahead, period)
            if clock.hold or len(trace) > 0:
                execute(code.instructions, 0, code.ends[0], w, ahead)
            if len(trace) > 0:
                record(w, rows, code, picks, n, begin, count, period, time, trace)
            if running == 0 or period == clock.periods:
                break
            if -(-running // WIDTH) < -(-ahead // WIDTH):  # a vector less
                gather(w, rows, picks, ahead)
                ahead = running
            if given.slots > 0:
                command(w, rows, code, given, ahead, period)
            for substep in range(clock.substeps):
                now = time + substep * clock.step
                if given.slots > 0:
                    step = period * clock.substeps + substep
                    arrive(w, rows, picks, given, ahead, step, clock.substeps)
                advance(w, rows, code, clock, n, ahead, now, bends)
                if bends:
                    approach(
                        *(w, ahead, rows.base, rows.state, rows.slope, rows.slope + n, rows.alive, rows.near),
                        *(world, now, clock.step),
                    )
            for k in range(len(code.angles)):
                row = rows.state + code.angles[k]
                for lane in range(0, ahead, WIDTH):
                    angle = take(w, row, lane)
                    put(w, row, lane, choose(take(w, rows.alive, lane) > 0.0, wrap(angle), angle))
        execute(code.instructions, code.ends[1], code.ends[2], w, count)  # the law has used its rows since
        store(w, rows, code, picks, n, begin, count, result)
