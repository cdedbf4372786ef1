"""Plans for scenarios: what can be reached is searched for, and what is found is replayed by another simulator."""

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Literal

import numpy as np

from applications.rosbot.bounds import lower_bound
from applications.rosbot.following import follow
from applications.rosbot.model import reached
from applications.rosbot.reachability import reachability
from applications.rosbot.replay import Replay, replay
from applications.rosbot.routes import routes
from applications.rosbot.scenario import Scenario
from applications.rosbot.swarms import Effort, Found, Search
from gpsynth.errors import ScenarioError
from gpsynth.law import Law
from gpsynth.planning import Particles, Plan
from gpsynth.problem import Obstacles, Problem
from gpsynth.schedule import Schedule, Schedules
from gpsynth.simulation import Trajectory

__all__ = ["PERIOD", "Callback", "Effort", "PlanReport", "plan_scenario", "problem_of"]

PERIOD = 0.05  # s of the control: 2.5 cm at 0.5 m/s; twice as long costs time at every switch, half as long computing
Ended = Literal["complete", "callback", "rollouts", "deadline", "interrupted"]
INSIDE = (0.001, 0.002)  # m, rad: how far within the tolerance a plan arrives, so that no rounding undoes it


@dataclass(frozen=True, eq=False)
class PlanReport:
    """What planning came to, or has come to so far."""

    status: Literal["planned", "unreachable", "not_found"]
    reason: str  # empty for a plan
    planning_time: float  # s
    evaluations: int
    scenario: Scenario
    seed: int
    plan: Plan | None = None
    law: Law | None = None
    replay: Replay | None = None  # by the simulator that shares nothing with the planner's
    history: tuple[tuple[int, float], ...] = ()  # (evaluations, arrival time in s) at every improvement
    ended: Ended = "complete"

    @cached_property
    def lower_bound(self) -> float:
        """A time (s) below which no plan can be; it takes longer to find than a first plan, so only when asked for."""
        return lower_bound(self.scenario)

    @property
    def ratio(self) -> float:
        """Arrival time over its lower bound; infinity without a plan, 1 where there is nothing to drive."""
        if self.replay is None:
            return np.inf
        return self.replay.arrival_time / self.lower_bound if self.lower_bound else 1.0


Callback = Callable[[PlanReport], bool | None]


def plan_scenario(
    scenario: Scenario,
    laws: Sequence[Law],
    *,
    seed: int = 0,
    effort: Effort = Effort(),
    threads: int = 1,
    callback: Callback | None = None,
    previous: PlanReport | None = None,
    elapsed: float = 0.0,
) -> PlanReport:
    """The fastest collision-free plan found with any of the laws; the same seed gives the same plan.

    `callback` gets the report as it stands after every round, its plan replayed; returning True ends the search, and so
    does Ctrl-C once there is a plan. With a `previous` report, whose plan has been driven for `elapsed` seconds, what
    is left of that plan is improved under the scenario as it is now: its start is where the robot is, its circles where
    they are. Only if no collision-free plan lies near, everything is searched. Raises ScenarioError if there is no law,
    or one that does not steer v and omega.
    """
    watch = _Watch(time.perf_counter(), effort, callback)
    problems = _problems(scenario, laws)
    at_rest = replay(scenario, np.empty((0, 2)), PERIOD)
    if at_rest.solves:
        return watch.stamped(_arrived(scenario, problems[0][1], at_rest, seed))
    report = PlanReport("not_found", "", 0.0, 0, scenario, seed)
    if previous is not None and previous.plan is not None and previous.law is not None:
        report = watch.improved(report, _followed(report, previous.plan, previous.law, elapsed, effort))
        if report.status == "planned" or report.ended != "complete":
            return report
    verdict = reachability(scenario)
    if verdict.status == "unreachable":
        return watch.stamped(replace(report, status="unreachable", reason=verdict.reason))
    ways = routes(scenario, margin=effort.scouts.margin)
    for attempt in range(effort.attempts):
        search = Search(scenario, ways, problems, effort, seed, attempt, threads)
        report = watch.improved(report, search.run())
        if report.status == "planned" or report.ended != "complete":
            break
    return report


@dataclass(frozen=True, eq=False)
class _Watch:
    """Keeps the fastest plan of a search that the other simulator confirms, and says when to end."""

    began: float
    effort: Effort
    callback: "Callback | None"

    def improved(self, report: PlanReport, search: Iterator[Found]) -> PlanReport:
        """The report with the fastest plan of a search, or with the reason why there is none."""
        spent = report.evaluations
        try:
            for found in search:
                report = _confirmed(replace(report, evaluations=spent + found.evaluations), found)
                ended = self._ended(report)
                if ended != "complete":
                    return self.stamped(replace(report, ended=ended))
        except KeyboardInterrupt:
            if report.status != "planned":
                raise
            report = replace(report, ended="interrupted")
        return self.stamped(report)

    def stamped(self, report: PlanReport) -> PlanReport:
        """The report with the time that it took."""
        return replace(report, planning_time=time.perf_counter() - self.began)

    def _ended(self, report: PlanReport) -> Ended:
        if self.callback is not None and self.callback(self.stamped(report)):
            return "callback"
        if report.evaluations >= self.effort.rollouts:
            return "rollouts"
        return "deadline" if time.perf_counter() - self.began >= self.effort.deadline else "complete"


def problem_of(scenario: Scenario, law: Law) -> Problem:
    """The scenario as a problem for a law under its limits: least time into the tolerance, a little within its edge."""
    return replace(
        _like(law, scenario.position_tolerance, scenario.heading_tolerance),
        starts=scenario.start,
        goal=scenario.goal,
        horizon=max(PERIOD, scenario.time_limit - PERIOD),
        obstacles=Obstacles(scenario.circles, scenario.bounds, scenario.radius),
    )


@lru_cache(maxsize=32)
def _like(law: Law, position: float, heading: float) -> Problem:
    """A problem with the programs of all problems for this law and tolerance (m, rad): to trace them takes a while."""
    shrunk = max(0.5 * position, position - INSIDE[0]), max(0.5 * heading, heading - INSIDE[1])
    return Problem(
        law.plant,
        np.zeros(3),
        np.zeros(3),
        tolerance=[shrunk[0], shrunk[0], shrunk[1]],
        period=PERIOD,
        features=law.features,
        reached=reached(*shrunk),
    )


def _problems(scenario: Scenario, laws: Sequence[Law]) -> list[tuple[Problem, Law]]:
    """The laws under the scenario's limits, each with the problem as it sees it."""
    if not laws:
        raise ScenarioError("a plan needs at least one law")
    for law in laws:
        if law.plant.control_names != ("v", "omega"):
            raise ScenarioError(
                f"the law steers {', '.join(law.plant.control_names)}; a scenario needs v, omega"
            )
    adapted = [_limited(law, scenario.speed_limits, scenario.turn_limits) for law in laws]
    return [(problem_of(scenario, law), law) for law in adapted]


@lru_cache(maxsize=32)
def _limited(law: Law, speed: tuple[float, float], turn: tuple[float, float]) -> Law:
    low, high = zip(speed, turn, strict=True)
    return law.with_limits(low, high)


def _arrived(scenario: Scenario, law: Law, at_rest: Replay, seed: int) -> PlanReport:
    """The plan to stay, of a start within the tolerance: without points, controls and search."""
    stay = Trajectory(
        plant=law.plant,
        t=np.zeros(1),
        x=scenario.start[np.newaxis],
        u=np.empty((0, 2)),
        target=scenario.goal[np.newaxis],
        arrival=0.0,
        cost=0.0,
        clearance=at_rest.clearance,
    )
    plan = Plan(
        schedule=Schedule(np.empty((0, 3)), np.empty(0)),
        trajectory=stay,
        arrival_time=0.0,
        clearance=at_rest.clearance,
        is_admissible=True,
        cost=0.0,
        evaluations=0,
        history=(),
        particles=Particles(Schedules(np.empty((0, 0, 3)), np.empty((0, 0))), np.empty(0)),
    )
    return PlanReport("planned", "", 0.0, 0, scenario, seed, plan=plan, law=law, replay=at_rest)


def _followed(
    report: PlanReport, previous: Plan, law: Law, elapsed: float, effort: Effort
) -> Iterator[Found]:
    """Plans near what is left of the previous one."""
    if not len(previous.schedule.dwell):
        return iter(())
    [(problem, law)] = _problems(report.scenario, [law])
    return follow(problem, law, previous, elapsed, effort.followers, report.seed)


def _confirmed(report: PlanReport, found: Found) -> PlanReport:
    """The report with what was found, if it is faster and the other simulator confirms it."""
    scenario, plan = report.scenario, found.plan
    if plan.is_free and (report.plan is None or plan.arrival_time < report.plan.arrival_time):
        check = replay(scenario, plan.trajectory.u, PERIOD)
        if check.solves:
            return replace(
                report,
                status="planned",
                reason="",
                plan=plan,
                law=found.law,
                replay=check,
                history=(*report.history, (report.evaluations, plan.arrival_time)),
            )
    if report.status == "planned":
        return report
    reason = (
        f"no collision-free plan within {scenario.time_limit:g} s was found; the goal may still be reachable"
    )
    return replace(report, reason=reason)
