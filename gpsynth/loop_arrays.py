"""A problem as the kernels take it: obstacles, draws, the clock and the closed loop but for its law."""

from functools import lru_cache

import numpy as np

from gpsynth.arrays import Floats, frozen
from gpsynth.kernels.buckets import NONE, buckets
from gpsynth.kernels.layout import Buckets, Clock, Conditions, World, sealed
from gpsynth.kernels.pack import Extent, Frame, Instructions, Loop, frame
from gpsynth.kernels.tableaus import TABLEAUS
from gpsynth.obstacles import Obstacles
from gpsynth.problem import Problem
from gpsynth.program import Program
from gpsynth.tracks import NOBODY


def instructions(program: Program) -> Instructions:
    """A program."""
    return Instructions(program.code, program.constants, program.outputs)


def world_of(problem: Problem, margin: float) -> World:
    """The obstacles; `margin` (m) is the clearance below which a path counts as exposed."""
    obstacles = problem.obstacles
    if obstacles is None:
        nowhere = np.empty(0, dtype=np.int32)
        everywhere = np.array([-np.inf, np.inf, -np.inf, np.inf])
        nothing, origin = np.empty((0, 0)), np.zeros(3)
        return sealed(
            World(
                *(nowhere, np.empty((0, 5)), 0, NONE, everywhere, float(margin)),
                *(np.empty((0, 3)), nothing, origin, NOBODY.places, NOBODY.radii, NOBODY.period),
            )
        )
    states, body, field = problem.plant.state_names, obstacles.body, obstacles.field
    tracks = obstacles.tracks or NOBODY
    names = obstacles.position if np.any(body[:, :2]) else obstacles.position[:2]
    return sealed(
        World(
            np.array([states.index(name) for name in names], dtype=np.int32),
            *(*_sorted_circles(obstacles), obstacles.bounds, float(margin), body),
            *((np.empty((0, 0)), np.zeros(3)) if field is None else (field.squares, field.grid)),
            tracks.places,
            tracks.radii,
            tracks.period,
        )
    )


def conditions_of(problem: Problem) -> Conditions:
    """The draws."""
    draws = problem.draws
    rest = np.clip(np.zeros(len(problem.plant.controls)), problem.plant.lower, problem.plant.upper)
    nothing = np.empty(0, dtype=np.int32)
    if draws is None:
        return sealed(Conditions(problem.plant_parameters, nothing, 0, rest, np.empty((0, 0, 0)), nothing))
    delays = np.rint(draws.delay / problem.step).astype(np.int32)
    substeps, longest = clock_of(problem).substeps, int(delays.max(initial=0))
    slots = -(-longest // substeps) + 1 if longest else 0
    return sealed(Conditions(problem.plant_parameters, delays, slots, rest, draws.noise, draws.tables))


def clock_of(problem: Problem) -> Clock:
    """The time grid, without an end."""
    tableau = TABLEAUS[problem.method]
    substeps = round(problem.period / problem.step)
    flags = (problem.hold, problem.stop)
    return Clock(tableau.b, tableau.c, problem.step, substeps, 0, *flags, 0.0, np.inf)


@lru_cache(maxsize=16)
def frame_of(problem: Problem) -> Frame:
    """The closed loop but for the law: what does not change from candidate to candidate."""
    given = conditions_of(problem)
    noisy, late = len(given.noise) > 0, given.slots > 0
    features = problem.measured if noisy else problem.features
    parts = (features, problem.plant.saturation, problem.rates, problem.arrival)
    names = problem.plant.state_names
    extent = Extent(
        states=len(names),
        plant=given.parameters.shape[1],
        noise=noisy,
        acting=len(given.rest) if late else 0,
        slots=given.slots,
    )
    angles = np.array([names.index(angle) for angle in problem.plant.angles], dtype=np.int32)
    return frame(Loop(*map(instructions, parts)), extent, angles)


@lru_cache(maxsize=16)
def _sorted_circles(obstacles: Obstacles) -> tuple[Floats, int, Buckets]:
    """The circles with those that move first, the number of these, and the buckets of the others."""
    moves = np.any(obstacles.circles[:, 2:4] != 0.0, axis=1)
    movers = int(np.count_nonzero(moves))
    circles = frozen(np.concatenate([obstacles.circles[moves], obstacles.circles[~moves]]))
    return circles, movers, buckets(circles[movers:])
