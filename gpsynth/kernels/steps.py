"""Explicit Runge-Kutta steps of a block of lanes; the tableau is data (`tableaus.py`)."""

from gpsynth.arrays import Floats, Ints
from gpsynth.kernels.compile import part
from gpsynth.kernels.layout import Clock, Code, Rows
from gpsynth.kernels.machine import execute
from gpsynth.kernels.vectors import WIDTH, choose, put, take


@part
def advance(
    w: Floats, rows: Rows, code: Code, clock: Clock, n: int, count: int, time: float, bends: bool
) -> None:
    """One Runge-Kutta step of states and running cost; lanes that have ended stay where they are.

    If `bends`, the first and the last derivatives of the step are kept in the rows from `slope` on.
    """
    first, last = code.ends[0] if clock.hold else 0, len(clock.b) - 1
    for stage in range(last + 1):
        if stage == 0 or clock.c[stage] != clock.c[stage - 1]:
            for lane in range(0, count, WIDTH):
                put(w, rows.time, lane, time + clock.c[stage] * clock.step)
        execute(code.instructions, first, code.ends[1], w, count)
        if bends and stage == 0:
            copy(w, code.rates, rows.slope, n, count)
        if bends and stage == last:
            copy(w, code.rates, rows.slope + n, n, count)
        weight = clock.step * clock.b[stage]
        charge(w, rows, code.rates[n], count, weight)
        if stage == 0:  # the state is still the one at the beginning
            for i in range(n):
                for lane in range(0, count, WIDTH):
                    put(w, rows.base + i, lane, take(w, rows.state + i, lane))
        summed = rows.state if stage == 0 else rows.sum
        if stage == last:
            finish(w, rows, code, n, count, weight, summed)
        else:
            proceed(w, rows, code, n, count, weight, summed, clock.step * clock.c[stage + 1])


@part
def charge(w: Floats, rows: Rows, rate: int, count: int, weight: float) -> None:
    """Add a stage's running cost for the lanes that run."""
    for lane in range(0, count, WIDTH):
        cost = take(w, rows.cost, lane)
        moved = cost + weight * take(w, rate, lane)
        put(w, rows.cost, lane, choose(take(w, rows.alive, lane) > 0.0, moved, cost))


@part
def proceed(
    w: Floats, rows: Rows, code: Code, n: int, count: int, weight: float, summed: int, ahead: float
) -> None:
    """Add a stage's derivatives to the sum so far, in rows from `summed` on, and lead the state to the next stage."""
    for i in range(n):
        for lane in range(0, count, WIDTH):
            rate = take(w, code.rates[i], lane)
            put(w, rows.sum + i, lane, take(w, summed + i, lane) + weight * rate)
            put(w, rows.state + i, lane, take(w, rows.base + i, lane) + ahead * rate)


@part
def finish(w: Floats, rows: Rows, code: Code, n: int, count: int, weight: float, summed: int) -> None:
    """Add the last stage's derivatives to the sum, which is the new state of the lanes that run."""
    for i in range(n):
        for lane in range(0, count, WIDTH):
            end = take(w, summed + i, lane) + weight * take(w, code.rates[i], lane)
            base = take(w, rows.base + i, lane)
            put(w, rows.state + i, lane, choose(take(w, rows.alive, lane) > 0.0, end, base))


@part
def copy(w: Floats, sources: Ints, first: int, n: int, count: int) -> None:
    """Copy n rows to those from `first` on."""
    for i in range(n):
        for lane in range(0, count, WIDTH):
            put(w, first + i, lane, take(w, sources[i], lane))
