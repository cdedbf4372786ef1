"""What makes one start's plant differ from another's: parameters, controls that come late, errors of measurement."""

from numba import types

from gpsynth.arrays import Floats, Ints
from gpsynth.kernels.compile import OUT_CODE, OUT_MATRIX, kernel
from gpsynth.kernels.layout import CODES, CONDITIONS, ROWS, Code, Conditions, Rows

_INTEGER = types.int64


@kernel(types.void(OUT_MATRIX, ROWS, OUT_CODE, CONDITIONS, _INTEGER))
def settle(w: Floats, rows: Rows, picks: Ints, given: Conditions, count: int) -> None:
    """Load the plant of each lane, picks (., 3) saying which, and the controls that act before the first command."""
    for lane in range(count):
        start = picks[lane, 0]
        for k in range(given.parameters.shape[1]):
            w[rows.plant + k, lane] = given.parameters[start, k]
    m = len(given.rest)
    for slot in range(given.slots):
        for k in range(m):
            w[rows.past + slot * m + k, :] = given.rest[k]


@kernel(types.void(OUT_MATRIX, ROWS, OUT_CODE, CONDITIONS, _INTEGER, _INTEGER))
def measure(w: Floats, rows: Rows, picks: Ints, given: Conditions, count: int, period: int) -> None:
    """Load the errors of this tick's measurement; a table that has come to its end begins again."""
    tick = period % given.noise.shape[1]
    for lane in range(count):
        table = given.tables[picks[lane, 0]]
        for i in range(given.noise.shape[2]):
            w[rows.error + i, lane] = given.noise[table, tick, i]


@kernel(types.void(OUT_MATRIX, ROWS, CODES, CONDITIONS, _INTEGER, _INTEGER))
def command(w: Floats, rows: Rows, code: Code, given: Conditions, count: int, period: int) -> None:
    """Send the controls of this tick on their way: a ring of as many ticks as the longest delay spans."""
    m = len(given.rest)
    slot = rows.past + (period % given.slots) * m
    for k in range(m):
        for lane in range(count):
            w[slot + k, lane] = w[code.controls[k], lane]


@kernel(types.void(OUT_MATRIX, ROWS, OUT_CODE, CONDITIONS, _INTEGER, _INTEGER, _INTEGER))
def arrive(
    w: Floats, rows: Rows, picks: Ints, given: Conditions, count: int, step: int, substeps: int
) -> None:
    """Let the controls act that have arrived by the beginning of this integration step, counted from time 0."""
    m = len(given.rest)
    for lane in range(count):
        sent = (step - given.delays[picks[lane, 0]]) // substeps
        slot = rows.past + (sent % given.slots) * m  # before tick 0 the ring still holds the rest
        for k in range(m):
            w[rows.acting + k, lane] = w[slot + k, lane]
