"""Costs of many candidates at once: laws, parameter vectors and schedules, each from every start of a problem."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from gpsynth.arrays import Floats, Ints, frozen, numbers
from gpsynth.checks import check_kind, check_number, check_whole
from gpsynth.errors import ProblemError
from gpsynth.kernels import rollout
from gpsynth.kernels.layout import Clock, Conditions, Lanes, Toll, World, readonly
from gpsynth.kernels.pack import Frame, pack
from gpsynth.law import Law
from gpsynth.loop_arrays import clock_of, conditions_of, frame_of, instructions, world_of
from gpsynth.plant import Plant
from gpsynth.problem import Problem
from gpsynth.program import Program
from gpsynth.rollouts import Paths, Rollouts, rollouts_of
from gpsynth.schedule import Schedules

MOST_PERIODS = 10_000_000  # of one rollout
ROUNDING = 1e-9  # of a sum of costs: what is above a bound by no more is not above it
_NO_TRACE = np.empty((0, 0, 0))
_NO_TOLL = Toll(frozen(np.empty(0)), *[0.0] * 8)


class _Plans(NamedTuple):
    points: Floats  # (K, k, n)
    ends: Floats  # (K, k) s
    reach: float = 0.0
    toll: Toll = _NO_TOLL


_NO_PLAN = _Plans(frozen(np.empty((1, 0, 1))), frozen(np.empty((1, 0))))


@dataclass(frozen=True)
class Evaluator:
    """Rolls candidates out on a problem, `threads` slices of lanes at a time.

    `margin` (m) is the clearance below which a path counts as exposed. Raises ProblemError if a setting, or what is to
    be rolled out, does not fit.
    """

    problem: Problem
    threads: int = 1
    block: int = 128
    margin: float = 0.0

    def __post_init__(self) -> None:
        check_kind("problem", self.problem, Problem)
        for name in ("threads", "block"):
            check_whole(name, getattr(self, name), 1)
        check_number("the margin", self.margin)
        if not 0.0 <= self.margin < np.inf:
            raise ProblemError(f"the margin must be finite and at least 0 m, got {self.margin}")

    def of_program(
        self, program: Program, parameters: Floats, *, bound: float = np.inf, paths: bool = False
    ) -> Rollouts:
        """Rollouts (N, S) of one law, features -> raw controls, under N parameter vectors (N, p).

        A single vector that costs more than `bound` in the mean over the starts need not be rolled out to the end: it
        ends early where costs cannot be negative, and costs infinity. With `paths` everything the rollouts pass through
        is kept.
        """
        problem, vectors = self.problem, self._vectors(program, parameters)
        check_number("the bound", bound)
        bounded = len(vectors) == 1 and problem.costs_nonnegative
        total = float(bound) * len(problem.starts) * (1.0 + ROUNDING) if bounded else np.inf
        picks = _picks(len(vectors), len(problem.starts), 1 if len(vectors) > 1 else 2)
        return self._roll(
            program, vectors, _NO_PLAN, self.until(problem.horizon, bound=total), picks, paths=paths
        )

    def of_schedules(
        self,
        law: Law,
        points: Floats,
        dwell: Floats,
        horizon: float | None = None,
        *,
        reach: float = 0.0,
        toll: Toll | None = None,
    ) -> Rollouts:
        """Rollouts (N, S) of one law under N schedules: points (N, k, n) and their dwell times (N, k) in s.

        With a positive `reach`, a state this near to its point (Euclidean, angles wrapped, in the units of the
        states) goes on to the next point at once. A rollout that cannot keep its limit of the `toll` ends early.
        Raises ProblemError as well if the law is not for the problem's plant and features.
        """
        check_law(self.problem, law)
        plans = self._plans(points, dwell, reach)._replace(toll=toll or _NO_TOLL)
        horizon = self.problem.horizon if horizon is None else horizon
        clock = self.until(horizon, reach=reach)
        picks = _picks(len(plans.points), len(self.problem.starts), 2)
        return self._roll(law.program, law.parameters[np.newaxis], plans, clock, picks)

    def of_plans(
        self, program: Program, parameters: Floats, schedules: Schedules, horizon: float | None = None
    ) -> Rollouts:
        """Rollouts (N, K) from the first start: a law under N parameter vectors (N, p), with each of K schedules.

        The horizon is in s; by default it is the problem's.
        """
        vectors = self._vectors(program, parameters)
        plans = self._plans(schedules.points, schedules.dwell, 0.0)
        clock = self.until(self.problem.horizon if horizon is None else horizon)
        return self._roll(program, vectors, plans, clock, _pairs(len(vectors), len(schedules)))

    def stays(self, rollouts: Rollouts) -> npt.NDArray[np.bool_]:
        """Which of these rollouts (N, S) arrive and end within the tolerance, whether they stop there or not."""
        ends = np.concatenate([rollouts.final, np.broadcast_to(self.goals, rollouts.final.shape)], axis=-1)
        measure = self.problem.arrival(ends.reshape(-1, ends.shape[-1]))[:, 0]
        within: npt.NDArray[np.bool_] = measure.reshape(rollouts.arrival.shape) <= 0.0
        return within & np.isfinite(rollouts.arrival)

    def _vectors(self, program: Program, parameters: Floats) -> Floats:
        """The parameter vectors (N, p) of a program that is a law for this problem; raises ProblemError otherwise."""
        problem = self.problem
        check_kind("program", program, Program)
        if program.inputs != problem.features.names or len(program.outputs) != len(problem.plant.controls):
            raise ProblemError(
                f"the program computes {_listed(program.names)} from {_listed(program.inputs)}; expected "
                f"{_listed(problem.plant.control_names)} from the features {_listed(problem.features.names)}"
            )
        vectors = np.atleast_2d(numbers("parameters", parameters))
        if vectors.ndim != 2 or vectors.shape[1] != len(program.parameters):
            raise ProblemError(
                f"parameters have shape {np.shape(parameters)}; the law has {len(program.parameters)} parameters"
            )
        return vectors

    def _plans(self, points: Floats, dwell: Floats, reach: float) -> _Plans:
        places, times = numbers("points", points), numbers("dwell times", dwell)
        states = self.problem.starts.shape[1]
        if places.ndim != 3 or places.shape[2] != states or times.shape != places.shape[:2]:
            raise ProblemError(
                f"points and dwell times have shapes {places.shape} and {times.shape}; "
                f"expected (N, k, {states}) and (N, k)"
            )
        if not np.isfinite(places).all():
            raise ProblemError("the points hold NaN or infinity; expected finite numbers")
        if not (np.isfinite(times) & (times >= 0.0)).all():
            raise ProblemError(
                "the dwell times hold NaN, infinity or a negative number; expected at least 0 s"
            )
        return _Plans(readonly(np.ascontiguousarray(places)), readonly(np.cumsum(times, axis=1)), reach)

    def _roll(
        self,
        program: Program,
        vectors: Floats,
        plans: _Plans,
        clock: Clock,
        picks: Ints,
        *,
        paths: bool = False,
    ) -> Rollouts:
        """A rollout for each of the picks."""
        lanes = Lanes(
            picks=picks.reshape(-1, 3),
            starts=readonly(self.problem.starts),
            goals=self.goals,
            parameters=readonly(np.ascontiguousarray(vectors)),
            points=plans.points,
            ends=plans.ends,
        )
        trace = self._trace(picks.shape[0] * picks.shape[1], clock.periods) if paths else _NO_TRACE
        result = roll(self, program, lanes, clock, trace, plans.toll)
        rollouts = rollouts_of(result, picks.shape[:2], len(self.problem.arrival.outputs) - 1)
        return replace(rollouts, paths=self._paths(trace, len(picks))) if paths else rollouts

    def _trace(self, lanes: int, periods: int) -> Floats:
        """Room for states, controls and targets at each tick."""
        width = 2 * self.problem.starts.shape[1] + len(self.problem.plant.controls)
        return np.full((lanes, periods + 1, width), np.nan)

    def _paths(self, trace: Floats, candidates: int) -> Paths:
        table = trace.reshape(candidates, -1, *trace.shape[1:])
        states = self.problem.starts.shape[1]
        return Paths(
            t=self.problem.period * np.arange(trace.shape[1], dtype=np.float64),
            x=table[..., :states],
            u=table[..., states:-states],
            target=table[..., -states:],
        )

    @cached_property
    def world(self) -> World:
        """The problem's obstacles as the kernels want them."""
        return world_of(self.problem, self.margin)

    @property
    def frame(self) -> Frame:
        """The closed loop but for the law: what does not change from candidate to candidate."""
        return frame_of(self.problem)

    @cached_property
    def conditions(self) -> Conditions:
        """The problem's draws as the kernels want them."""
        return conditions_of(self.problem)

    @cached_property
    def clock(self) -> Clock:
        """The problem's time grid, without an end."""
        return clock_of(self.problem)

    def until(self, horizon: float, *, reach: float = 0.0, bound: float = np.inf) -> Clock:
        """The time grid up to the horizon (s); raises ProblemError unless that, and the reach, are sensible numbers."""
        check_number("the reach", reach)
        if not reach >= 0.0:
            raise ProblemError(f"the reach must be at least 0, got {reach}")
        return self.clock._replace(periods=periods_of(self.problem, horizon), reach=float(reach), bound=bound)

    @cached_property
    def goals(self) -> Floats:
        """The goal of each start (S, n)."""
        return frozen(np.broadcast_to(self.problem.goal, self.problem.starts.shape))


def roll(
    evaluator: Evaluator, program: Program, lanes: Lanes, clock: Clock, trace: Floats, toll: Toll = _NO_TOLL
) -> Floats:
    """The kernel's result (L, ...) for these lanes, computed in slices of whole blocks by the evaluator's threads."""
    rows, code = pack(evaluator.frame, instructions(program), len(program.parameters))
    total, block = len(lanes.picks), evaluator.block
    states, terminals = lanes.starts.shape[1], len(code.arrival) - 1
    result = np.empty((total, rollout.TERMINAL + terminals + states))

    def run(first: int, last: int) -> None:
        rollout.roll(
            *(rows, code, lanes, evaluator.conditions, clock, evaluator.world, toll),
            *(block, first, last, result, trace),
        )

    slice_size = block * max(1, -(-total // (block * evaluator.threads)))
    if slice_size >= total:
        run(0, total)
        return result
    with ThreadPoolExecutor(evaluator.threads) as pool:
        first = range(0, total, slice_size)
        list(pool.map(lambda begin: run(begin, min(begin + slice_size, total)), first))
    return result


@lru_cache(maxsize=16)
def _picks(candidates: int, starts: int, varying: int) -> Ints:
    """(N, S, 3) start, parameter vector and schedule of each lane; `varying` is the column of the candidate."""
    picks = np.zeros((candidates, starts, 3), dtype=np.int32)
    picks[..., 0], picks[..., varying] = np.arange(starts), np.arange(candidates)[:, np.newaxis]
    return frozen(picks)


@lru_cache(maxsize=16)
def _pairs(vectors: int, schedules: int) -> Ints:
    """(N, K, 3) the same for each parameter vector with each schedule, from the first start."""
    picks = np.zeros((vectors, schedules, 3), dtype=np.int32)
    picks[..., 1], picks[..., 2] = np.arange(vectors)[:, np.newaxis], np.arange(schedules)
    return frozen(picks)


def periods_of(problem: Problem, horizon: float) -> int:
    """The control periods until the horizon (s); raises ProblemError unless that is a sensible number."""
    check_number("the horizon", horizon)
    if not 0.0 <= horizon <= MOST_PERIODS * problem.period:
        raise ProblemError(
            f"the horizon is {horizon} s; expected at least 0 and at most {MOST_PERIODS} periods of "
            f"{problem.period} s"
        )
    return round(horizon / problem.period)


def check_law(problem: Problem, law: Law) -> None:
    """Raises ProblemError unless the law is for the problem's plant, limits included, and sees its features."""
    check_kind("problem", problem, Problem)
    check_kind("law", law, Law)
    if law.plant is not problem.plant or law.features is not problem.features:
        _check_content(problem, law)


@lru_cache(maxsize=64)
def _check_content(problem: Problem, law: Law) -> None:
    if law.features != problem.features:
        raise ProblemError(
            "the law sees other features than the problem; give the problem features=law.features"
        )
    if law.plant == problem.plant:
        return
    same_controls = law.plant.control_names == problem.plant.control_names
    if same_controls and law.plant.with_limits(problem.plant.lower, problem.plant.upper) == problem.plant:
        raise ProblemError(
            f"the law is for controls in {_limits(law.plant)}, the problem for {_limits(problem.plant)}; "
            "adapt the law by law.with_limits(problem.plant.lower, problem.plant.upper)"
        )
    given, wanted = law.plant.name, problem.plant.name
    other = (
        f"is not the problem's {wanted!r}" if given != wanted else "differs from the problem's of that name"
    )
    raise ProblemError(f"the law is for the plant {given!r}, which {other}; give the problem plant=law.plant")


def _limits(plant: Plant) -> str:
    return ", ".join(f"[{low:g}, {high:g}]" for _, low, high in plant.controls.values())


def _listed(names: tuple[str, ...]) -> str:
    return ", ".join(names) if names else "nothing"
