"""The time-adaptive search (Shmalko & Yamshanov, Algorithm 1), read as rounds.

T+ and the switching step stay fixed while a round of the swarm runs, and are tightened from the best plan between
rounds, so a cost never depends on what was evaluated before it. Personal bests are scored anew under the new T+: bests
that kept an old cost would be unbeatable, and the swarm would freeze.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from gpsynth.arrays import Floats
from gpsynth.checks import check_kind
from gpsynth.errors import ProblemError
from gpsynth.evaluate import Evaluator, check_law
from gpsynth.law import Law
from gpsynth.optimizers import (
    CMAES,
    PSO,
    CMAESState,
    DifferentialEvolution,
    DifferentialEvolutionState,
    Optimizer,
    Progress,
    PSOState,
    Result,
    minimize,
    rescore,
)
from gpsynth.planning.objective import Objective
from gpsynth.planning.settings import PlanSettings
from gpsynth.problem import Problem
from gpsynth.schedule import Schedule
from gpsynth.simulation import Trajectory, simulate

History = tuple[tuple[int, float], ...]


@dataclass(frozen=True, eq=False)
class Plan:
    """The best schedule of a search and what it does."""

    schedule: Schedule
    trajectory: Trajectory
    arrival_time: float  # s, between the control periods; infinity if the goal is not reached
    clearance: float  # m, along the path, robot radius deducted; infinity without obstacles
    is_admissible: bool  # the goal is reached, and what the settings want clear of obstacles is
    cost: float  # eq. 17 under the T+ it was found with
    evaluations: int
    history: History  # (evaluations, T+ in s) at the beginning and after every round
    swarm: tuple[Schedule, ...]  # the best of every particle: where another search can go on

    @property
    def is_free(self) -> bool:
        """Whether the goal is reached without a collision anywhere on the path."""
        return bool(np.isfinite(self.arrival_time)) and self.clearance >= 0.0

    @property
    def rank(self) -> tuple[bool, float]:
        """What plans are sorted by: admissible ones before others, fast before slow."""
        return (False, self.arrival_time) if self.is_admissible else (True, self.cost)


def plan(  # noqa: PLR0913 names each choice as a keyword
    problem: Problem,
    law: Law,
    settings: PlanSettings = PlanSettings(),
    *,
    seed: int = 0,
    initial: Sequence[Schedule] = (),
    region: tuple[Floats, Floats] | None = None,
    budget: float | None = None,
    path: tuple[int, ...] = (0,),
    threads: int = 1,
    callback: Callable[[Plan], bool | None] | None = None,
) -> Plan:
    """The best schedule for `law` from the problem's start: T+ is tightened from `budget` (s), or the horizon, on.

    `initial` are schedules of `settings.points` points that some particles begin at; `region` bounds the points, by
    default `default_region`. `callback` is called after every round and stops the search by returning True. The same
    seed and path give the same plan for any number of threads. Raises ProblemError if the parts do not fit together.
    """
    _check(problem, law, settings, initial)
    evaluator = Evaluator(problem, threads=threads, margin=settings.margin)
    objective = Objective(evaluator, law, settings, budget or problem.horizon)
    optimizer = _optimizer(objective, region or default_region(problem), initial)
    size = settings.particles * settings.iterations
    history: History = ((0, objective.budget),)
    found = minimize(objective, optimizer, seed=seed, path=path, budget=size)
    best = _plan(objective, found, history)
    for number in range(1, settings.rounds + 1):
        if best.is_admissible and best.arrival_time < objective.budget:
            # Algorithm 1: T+ <- T_used, and with it the switching step
            objective = replace(objective, budget=best.arrival_time)
        history = (*history, (found.evaluations, objective.budget))
        best = replace(best, evaluations=found.evaluations, history=history)
        if (callback is not None and callback(best)) or number == settings.rounds:
            break
        start, end = rescored(found, objective), found.evaluations + size
        found = minimize(objective, optimizer, seed=seed, path=path, budget=end, resume=start)
        latest = _plan(objective, found, history)
        best = latest if latest.rank < best.rank else replace(best, swarm=latest.swarm)
    return best


def default_region(problem: Problem) -> tuple[Floats, Floats]:
    """Where equilibrium points may lie: start, goal and as far again beyond them; two turns for an angle.

    A position reaches as far aside as it does ahead, for a way around an obstacle may lead there.
    """
    ends = np.vstack([problem.starts, problem.goal])
    low, high = ends.min(axis=0), ends.max(axis=0)
    beyond = np.maximum(high - low, 10.0 * problem.tolerance)
    names = problem.plant.state_names
    if problem.obstacles is not None:
        position = np.isin(names, problem.obstacles.position)
        beyond[position] = beyond[position].max()
    angle, turns = np.isin(names, problem.plant.angles), 2.0 * np.pi
    return np.where(angle, -turns, low - beyond), np.where(angle, turns, high + beyond)


def vector_of(schedule: Schedule, settings: PlanSettings) -> Floats:
    """The numbers of a schedule that are searched, (d,)."""
    free = schedule.points.ravel()
    return free if settings.dwell is None else np.concatenate([free, schedule.dwell])


def _optimizer(
    objective: Objective, region: tuple[Floats, Floats], initial: Sequence[Schedule]
) -> Optimizer[Any]:
    settings = objective.settings
    lower, upper = (np.tile(bound, settings.points) for bound in region)
    if settings.dwell is not None:
        shortest, longest = (np.full(settings.points, time) for time in settings.dwell)
        lower, upper = np.concatenate([lower, shortest]), np.concatenate([upper, longest])
    vectors = [np.clip(vector_of(each, settings), lower, upper) for each in initial[: settings.particles]]
    x0 = np.array(vectors).reshape(-1, len(lower)) if vectors else None
    if settings.optimizer == "cmaes":
        first = None if x0 is None else x0[int(np.argmin(objective(x0)))]
        return CMAES(lower, upper, size=settings.particles, sigma=settings.spread, restarts=0, x0=first)
    if settings.optimizer == "shade":
        return DifferentialEvolution(lower, upper, size=settings.particles, x0=x0)
    swarm = PSO.clerc if settings.optimizer == "clerc" else PSO.seed
    return swarm(lower, upper, size=settings.particles, x0=x0)


def _plan(objective: Objective, found: Result[Any, Floats], history: History) -> Plan:
    """The best position of a search under its T+, as a plan."""
    points, dwell = objective.schedules(found.x[np.newaxis])
    rollouts = objective.rollouts(points, dwell)
    schedule = Schedule(points[0], dwell[0])
    problem, horizon = objective.evaluator.problem, float(rollouts.end[0, 0])
    return Plan(
        schedule=schedule,
        trajectory=simulate(
            problem, objective.law, schedule=schedule, horizon=horizon, reach=objective.settings.reach
        ),
        arrival_time=float(objective.arrivals(rollouts, points, dwell)[0]),
        clearance=float(rollouts.clearance[0, 0]),
        is_admissible=bool(objective.admissible(rollouts, points)[0]),
        cost=float(objective.costs(rollouts, points, dwell)[0]),
        evaluations=found.evaluations,
        history=history,
        swarm=tuple(map(objective.schedule, _memory(found.state))),
    )


def _memory(state: PSOState | DifferentialEvolutionState | CMAESState) -> Floats:
    if isinstance(state, DifferentialEvolutionState):
        return state.x
    return state.best_x if isinstance(state, PSOState) else state.best_x[np.newaxis]


def rescored(found: Result[Any, Floats], objective: Objective) -> Progress[Any]:
    """The same search under a new T+: what it remembers is scored anew."""
    state = found.state
    if isinstance(state, PSOState):
        costs = objective(state.best_x)
        state, spent = rescore(state, costs), len(costs)
    elif isinstance(state, DifferentialEvolutionState):
        state, spent = replace(state, costs=objective(state.x)), len(state.x)
    else:
        state, spent = replace(state, best_cost=float(objective(state.best_x[np.newaxis])[0])), 1
    return replace(found.progress, state=state, evaluations=found.evaluations + spent, history=())


def _check(problem: Problem, law: Law, settings: PlanSettings, initial: Sequence[Schedule]) -> None:
    check_kind("problem", problem, Problem)
    check_kind("settings", settings, PlanSettings)
    if len(problem.starts) != 1:
        raise ProblemError(f"a plan begins at one start; the problem has {len(problem.starts)}")
    check_law(problem, law)
    for schedule in initial:
        check_kind("an initial schedule", schedule, Schedule)
        if schedule.points.shape != (settings.points, problem.starts.shape[1]):
            raise ProblemError(
                f"an initial schedule has points of shape {schedule.points.shape}; "
                f"expected ({settings.points}, {problem.starts.shape[1]})"
            )
