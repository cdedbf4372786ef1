"""The time-adaptive search (Shmalko & Yamshanov, Algorithm 1), read as rounds.

T+ and the switching step stay fixed while a round of the swarm runs, and are tightened from the best plan between
rounds, so a cost never depends on what was evaluated before it. Personal bests are scored anew under the new T+: bests
that kept an old cost would be unbeatable, and the swarm would freeze.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from gpsynth.arrays import Floats, shaped
from gpsynth.checks import check_function, check_kind, check_number
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
from gpsynth.planning.objective import TOUCHING, Objective
from gpsynth.planning.settings import PlanSettings
from gpsynth.planning.slices import Slices, Stop
from gpsynth.planning.weights import weighted
from gpsynth.problem import Problem
from gpsynth.schedule import Schedule, Schedules
from gpsynth.simulation import Trajectory, simulate

History = tuple[tuple[int, float], ...]


@dataclass(frozen=True, eq=False)
class Particles:
    """The best schedule of every particle: where another search can go on."""

    schedules: Schedules
    costs: Floats  # (N,) of eq. 17


@dataclass(frozen=True, eq=False)
class Plan:
    """The best schedule of a search and what it does."""

    schedule: Schedule
    trajectory: Trajectory
    arrival_time: float  # s, between the control periods; infinity if the goal is not reached
    clearance: float  # m, along the path, robot radius deducted; infinity without obstacles
    is_admissible: bool  # the goal is reached, and what the settings want clear of obstacles is
    value: float  # s, the arrival time with what the weights add
    cost: float  # eq. 17 under the T+ it was found with
    evaluations: int
    history: History  # (evaluations, T+ in s) at the beginning and after every round
    particles: Particles

    @property
    def is_free(self) -> bool:
        """Whether the goal is reached without a collision anywhere on the path."""
        return bool(np.isfinite(self.arrival_time)) and self.clearance >= -TOUCHING

    @property
    def rank(self) -> tuple[bool, float]:
        """What plans are sorted by: admissible ones before others, fast before slow, or as the weights have it."""
        return (False, self.value) if self.is_admissible else (True, self.cost)


def plan(  # noqa: PLR0913 names each choice as a keyword
    problem: Problem,
    law: Law,
    settings: PlanSettings = PlanSettings(),
    *,
    seed: int = 0,
    initial: Sequence[Schedule] | Schedules = (),
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
    check_function("callback", callback, optional=True)
    found = plans(
        problem,
        law,
        settings,
        seed=seed,
        initial=initial,
        region=region,
        budget=budget,
        path=path,
        threads=threads,
    )
    for best in found:
        if callback is not None and callback(best):
            break
    return best


def plans(  # noqa: PLR0913 names each choice as a keyword
    problem: Problem,
    law: Law,
    settings: PlanSettings = PlanSettings(),
    *,
    seed: int = 0,
    initial: Sequence[Schedule] | Schedules = (),
    region: tuple[Floats, Floats] | None = None,
    budget: float | None = None,
    path: tuple[int, ...] = (0,),
    threads: int = 1,
    stop: Stop | None = None,
) -> Iterator[Plan]:
    """The best schedule after every round of `plan`, the first as soon as the initial schedules have been tried.

    Whoever stops asking stops the search, and has the best plan so far. `stop` is asked again and again within the
    rounds; once it says so the search ends with the best plan so far.
    """
    _check(problem, law, settings, initial)
    _check_keywords(problem, region, budget, path)
    problem = weighted(problem, settings.weights)
    evaluator = Evaluator(problem, threads=threads, margin=settings.margin)
    objective = Objective(evaluator, law, settings, budget or problem.horizon)
    optimizer = _optimizer(objective, region or default_region(problem), initial)
    limits = optimizer.limits if isinstance(optimizer, PSO) else None
    size = settings.particles * settings.swarms
    history: History = ((0, objective.budget),)
    best, start, end, costs = None, None, 0, Slices(objective, stop)
    for length in lengths(settings):
        end += size * length
        found = minimize(
            costs,
            optimizer,
            seed=seed,
            path=path,
            budget=end,
            limits=limits,
            resume=start,
            callback=lambda _: costs.is_over,
        )
        latest = _plan(objective, found, history, best)
        before = objective
        if latest.is_admissible and latest.value < objective.budget:
            # Algorithm 1: T+ <- T_used, and with it the switching step
            objective = replace(objective, budget=max(latest.value, problem.period))
        history = (*history, (found.evaluations, objective.budget))
        best = replace(latest, evaluations=found.evaluations - costs.skipped, history=history)
        yield best
        if costs.is_over:
            return
        costs.objective = objective
        start = found.progress if objective is before else rescored(found, costs)
        end += start.evaluations - found.evaluations


def lengths(settings: PlanSettings) -> list[int]:
    """The generations of each round: few at first, when T+ is far off, then `iterations`."""
    left, length, found = settings.rounds * settings.iterations, 1, list[int]()
    while left:
        found.append(min(length, settings.iterations, left))
        left -= found[-1]
        length *= 2
    return found


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


def vectors_of(initial: Sequence[Schedule] | Schedules, settings: PlanSettings) -> Floats:
    """The numbers of schedules that are searched, (N, d)."""
    schedules = initial if isinstance(initial, Schedules) else Schedules.of(initial)
    free = schedules.points.reshape(len(schedules), -1)
    return free if settings.dwell is None else np.hstack([free, schedules.dwell])


def _optimizer(
    objective: Objective, region: tuple[Floats, Floats], initial: Sequence[Schedule] | Schedules
) -> Optimizer[Any]:
    settings = objective.settings
    lower, upper = (np.tile(bound, settings.points) for bound in region)
    if settings.dwell is not None:
        shortest, longest = (np.full(settings.points, time) for time in settings.dwell)
        lower, upper = np.concatenate([lower, shortest]), np.concatenate([upper, longest])
    size = settings.particles * settings.swarms
    x0 = np.clip(vectors_of(initial, settings)[:size], lower, upper) if len(initial) else None
    if settings.optimizer == "cmaes":
        first = None if x0 is None else x0[int(np.argmin(objective(x0)))]
        return CMAES(lower, upper, size=size, sigma=settings.spread, restarts=0, x0=first)
    if settings.optimizer == "shade":
        return DifferentialEvolution(lower, upper, size=size, x0=x0)
    swarm = PSO.clerc if settings.optimizer == "clerc" else PSO.seed
    return swarm(lower, upper, size=size, x0=x0, swarms=settings.swarms)


def _plan(objective: Objective, found: Result[Any, Floats], history: History, before: Plan | None) -> Plan:
    """The best position of a search under its T+, as a plan, unless the one before is better."""
    points, dwell = objective.schedules(found.x[np.newaxis])
    particles = _particles(objective, found.state)
    rollouts = objective.rollouts(points, dwell)
    arrival, is_admissible = objective.arrivals(rollouts)[0], objective.admissible(rollouts, points)[0]
    value, cost = objective.spent(rollouts)[0], objective.costs(rollouts, points)[0]
    rank = (False, value) if is_admissible else (True, cost)
    if before is not None and before.rank <= rank:
        return replace(before, particles=particles)
    schedule, problem = Schedule(points[0], dwell[0]), objective.evaluator.problem
    trajectory = simulate(
        problem,
        objective.law,
        schedule=schedule,
        horizon=float(rollouts.end[0, 0]),
        reach=objective.settings.reach,
    )
    return Plan(
        schedule=schedule,
        trajectory=trajectory,
        arrival_time=float(arrival),
        clearance=float(rollouts.clearance[0, 0]),
        is_admissible=bool(is_admissible),
        value=float(value) if np.isfinite(arrival) else np.inf,
        cost=float(cost),
        evaluations=found.evaluations,
        history=history,
        particles=particles,
    )


def _particles(objective: Objective, state: PSOState | DifferentialEvolutionState | CMAESState) -> Particles:
    if isinstance(state, PSOState):
        return Particles(Schedules(*objective.schedules(state.best_x)), state.best_costs)
    if isinstance(state, DifferentialEvolutionState):
        return Particles(Schedules(*objective.schedules(state.x)), state.costs)
    best = Schedules(*objective.schedules(state.best_x[np.newaxis]))
    return Particles(best, np.array([state.best_cost]))


def rescored(found: Result[Any, Floats], objective: Callable[[Floats], Floats]) -> Progress[Any]:
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


def _check(
    problem: Problem, law: Law, settings: PlanSettings, initial: Sequence[Schedule] | Schedules
) -> None:
    check_kind("problem", problem, Problem)
    check_kind("settings", settings, PlanSettings)
    if len(problem.starts) != 1:
        raise ProblemError(f"a plan begins at one start; the problem has {len(problem.starts)}")
    check_law(problem, law)
    check_kind("initial, the schedules to begin with,", initial, list, tuple, Schedules)
    given = [initial.points[0]] if isinstance(initial, Schedules) and len(initial) else []
    for schedule in () if isinstance(initial, Schedules) else initial:
        check_kind("an initial schedule", schedule, Schedule)
        given.append(schedule.points)
    for points in given:
        if points.shape != (settings.points, problem.starts.shape[1]):
            raise ProblemError(
                f"an initial schedule has points of shape {points.shape}; "
                f"expected ({settings.points}, {problem.starts.shape[1]})"
            )


def _check_keywords(
    problem: Problem, region: tuple[Floats, Floats] | None, budget: float | None, path: tuple[int, ...]
) -> None:
    check_kind("path", path, tuple)
    if budget is not None:
        check_number("budget", budget)
        if not 0.0 < budget < np.inf:
            raise ProblemError(f"budget must be a finite time above 0 s, not {budget}")
    if region is not None:
        shaped("region, lowest and highest points,", region, (2, problem.starts.shape[1]))
