"""What a rollout kernel is told, as tuples of arrays and numbers, and where things stand in its workspace."""

from typing import Any, NamedTuple, TypeVar

import numpy as np
from numba import types

from gpsynth.arrays import Floats, Ints
from gpsynth.kernels.compile import CODE, INTEGERS, MATRIX, TENSOR, VECTOR


class Rows(NamedTuple):
    """First rows of the workspace; n states, p parameters, s stages."""

    base: int  # n, the state at the beginning of a step
    state: int  # n, where the programs read it
    target: int  # n
    goal: int  # n
    time: int  # 1
    sum: int  # n, the state at the end of a step as far as it is known
    slope: int  # 2 n, the first and the last derivatives of a step
    alive: int  # 1, 1.0 while the lane runs
    arrival: int  # 1, s
    end: int  # 1, s
    diverged: int  # 1
    cost: int  # 1
    before: int  # 1, the arrival measure at the tick before
    share: int  # 1, of the last period, that lies behind the arrival
    limit: int  # 1, of the toll
    near: int  # 10, clearance, exposure, depth and seven rows of scratch
    plant: int  # q, parameters of the plant
    error: int  # n or 0, of the measured state
    acting: int  # m or 0, controls that have arrived
    past: int  # slots m, controls computed at the latest ticks
    parameter: int  # p, behind the programs that do not depend on the law
    total: int  # all rows


class Code(NamedTuple):
    """Control law, rates and arrival test, one after the other in the same workspace."""

    instructions: Ints  # (c, 5) operation, destination row, operand rows
    ends: Ints  # (3,) one past the last instruction of each part
    constant_rows: Ints
    constants: Floats
    rates: Ints  # (n + 1,) rows of the derivatives and of the running cost
    arrival: Ints  # (1 + q,) rows of the measure and of the terminal costs
    controls: Ints  # (m,) rows
    angles: Ints  # (a,) states wrapped to [-pi, pi) after each period


class Lanes(NamedTuple):
    """Which start, parameter vector and schedule each lane has."""

    picks: Ints  # (L, 3)
    starts: Floats  # (S, n)
    goals: Floats  # (S, n)
    parameters: Floats  # (C, p)
    points: Floats  # (K, k, n)
    ends: Floats  # (K, k) s, when a point stops being the target


class Conditions(NamedTuple):
    """What else differs from start to start; lengths of 0 where the problem knows no such thing."""

    parameters: Floats  # (S, q) of the plant
    delays: Ints  # (S,) or (0,) integration steps between a control and its effect
    slots: int  # ticks that the longest delay spans, and one; 0 without delays
    rest: Floats  # (m,) controls that act before the first command
    noise: Floats  # (K, T, n) errors of the measured state
    tables: Ints  # (S,) which table of noise each start has


class Clock(NamedTuple):
    """The time grid and the Runge-Kutta tableau."""

    b: Floats  # (s,)
    c: Floats  # (s,)
    step: float  # s
    substeps: int  # of a control period
    periods: int
    hold: bool  # the control is held over the period, else computed at every stage
    stop: bool  # a lane ends when it arrives
    reach: (
        float  # distance at which a point counts as reached and the next is due at once; 0: dwell times alone
    )
    bound: float  # of the running cost of a block's lanes together: beyond it the block ends, at a cost of infinity


class Buckets(NamedTuple):
    """For each cell of a grid the circles that can be nearest from there; no cells: all circles everywhere."""

    firsts: Ints  # (cells + 1,) where the circles of a cell, row by row, begin in `members`
    members: Ints  # numbers of circles, counted from the first at rest
    lattice: Floats  # (6,) x, y of its corner (m), side of a cell (m), columns, rows, longest chord (m)


class World(NamedTuple):
    """Obstacles and the robot's body; none when `position` is empty."""

    position: Ints  # states that are x and y, (2,), and the heading, (3,), where the body has one; or (0,)
    circles: Floats  # (o, 5) x, y, vx, vy, radius; those that move first
    movers: int  # how many of them move
    buckets: Buckets  # of the others
    area: Floats  # (4,) x_low, x_high, y_low, y_high, of the origin of the body
    margin: float  # m, less clearance than this counts as exposure
    body: Floats  # (f, 3) circles of the robot: x, y in its own frame, radius
    squares: Floats  # (r, c) m^2, of a distance field; (0, 0) without one
    grid: Floats  # (3,) x, y of its first node and its spacing
    tracks: Floats  # (r, K, 2) places of discs at every multiple of `tempo`, straight in between
    sizes: Floats  # (r,) their radii
    tempo: float  # s


class Toll(NamedTuple):
    """The least that a lane will have cost its planner, and how much it may: a lane that cannot keep its limit ends.

    If the lane arrives no earlier than at s, it costs rate s + late max(0, s - due), and what exposure and depth cost.
    """

    limits: Floats  # (L,), or (0,): none
    due: float  # s
    rate: float  # 1/s
    late: float  # 1/s
    pace: float  # s/m: no state is nearer to its goal by a meter any sooner; 0: unknown
    slack: float  # m, how near a goal counts as arrival
    entry: float  # where there is any exposure
    exposure: float  # 1/s
    depth: float  # 1/(m s)


_INTEGER, _NUMBER, _FLAG = types.int64, types.float64, types.boolean
ROWS = types.NamedUniTuple(_INTEGER, len(Rows._fields), Rows)
CODES = types.NamedTuple((CODE, INTEGERS, INTEGERS, VECTOR, INTEGERS, INTEGERS, INTEGERS, INTEGERS), Code)
LANES = types.NamedTuple((CODE, MATRIX, MATRIX, MATRIX, TENSOR, MATRIX), Lanes)
CONDITIONS = types.NamedTuple((MATRIX, INTEGERS, _INTEGER, VECTOR, TENSOR, INTEGERS), Conditions)
CLOCK = types.NamedTuple((VECTOR, VECTOR, _NUMBER, _INTEGER, _INTEGER, _FLAG, _FLAG, _NUMBER, _NUMBER), Clock)
BUCKETS = types.NamedTuple((INTEGERS, INTEGERS, VECTOR), Buckets)
WORLD = types.NamedTuple(
    (
        *(INTEGERS, MATRIX, _INTEGER, BUCKETS, VECTOR, _NUMBER, MATRIX, MATRIX, VECTOR),
        *(TENSOR, VECTOR, _NUMBER),
    ),
    World,
)
TOLL = types.NamedTuple((VECTOR, *[_NUMBER] * 8), Toll)

Group = TypeVar("Group", bound=tuple[Any, ...])
Array = TypeVar("Array", bound=np.ndarray[Any, Any])


def sealed(group: Group) -> Group:
    """The same tuple with read-only views of its arrays: to numba a writable array is another type."""
    return type(group)(*(readonly(item) if isinstance(item, np.ndarray) else item for item in group))


def readonly(array: Array) -> Array:
    """The array, or if it can be written a view of it that cannot."""
    if not array.flags.writeable:
        return array
    view = array.view()
    view.flags.writeable = False
    return view
