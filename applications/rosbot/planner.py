"""Plans for scenarios: what can be reached is searched for, and what is found is replayed by another simulator."""

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import inf
from types import MappingProxyType
from typing import Literal

import numpy as np

from applications.rosbot.bounds import lower_bound
from applications.rosbot.certificate import Certificate, certify
from applications.rosbot.following import follow
from applications.rosbot.guides import top_speed
from applications.rosbot.margins import FINER, start_gap, ways_within
from applications.rosbot.problems import PERIOD, problems_of
from applications.rosbot.reachability import Reachability, reachability
from applications.rosbot.replay import Replay, replay
from applications.rosbot.scenario import Scenario
from applications.rosbot.swarms import Effort, Found, Search
from applications.rosbot.vehicles import first_state, plant_of, steered, widened
from gpsynth.arrays import Floats
from gpsynth.checks import check_function, check_kind, check_number
from gpsynth.errors import ScenarioError
from gpsynth.law import Law
from gpsynth.planning import Particles, Plan
from gpsynth.schedule import Schedule, Schedules
from gpsynth.simulation import Trajectory

__all__ = ["Callback", "Effort", "PlanReport", "plan_scenario"]

CONFIRMING = 0.01  # s that it takes to confirm a plan, until it is known
ROUNDING = 1e-9  # share of a bound that its arithmetic may be off by

Ended = Literal["complete", "callback", "rollouts", "deadline", "interrupted"]
WHEN: Mapping[Ended, str] = MappingProxyType(
    {
        "complete": "",
        "callback": ", when the search was ended",
        "rollouts": ", all that were allowed",
        "deadline": ", when the deadline came",
        "interrupted": ", when the search was interrupted",
    }
)


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
    certificate: Certificate | None = None  # for the path between its samples
    # (evaluations, arrival time in s, planning time in s) at every improvement
    history: tuple[tuple[int, float, float], ...] = ()
    ended: Ended = "complete"
    via: tuple[tuple[float, ...], ...] = ()  # places that are passed on the way: x, y and tolerance in m

    @cached_property
    def lower_bound(self) -> float:
        """A time (s) below which no plan can be; it takes longer to find than a first plan, so only when asked for."""
        return lower_bound(self.scenario)

    @property
    def controls(self) -> Floats:
        """v and omega (m, 2) in every control period of the plan."""
        return np.empty((0, 2)) if self.plan is None else steered(self.scenario, self.plan.trajectory.u)

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
    or one that does not steer v and omega, and if an argument is of a wrong kind.
    """
    check_kind("scenario", scenario, Scenario, error=ScenarioError)
    check_kind("effort", effort, Effort, error=ScenarioError)
    check_kind("previous", previous, PlanReport, error=ScenarioError, optional=True)
    check_function("callback", callback, ScenarioError, optional=True)
    check_number("elapsed", elapsed, ScenarioError)
    if not 0.0 <= elapsed < np.inf:
        raise ScenarioError(f"elapsed is {elapsed} s; expected a finite number, at least 0")
    watch = _Watch(time.perf_counter(), effort, callback)
    problems = problems_of(scenario, laws)
    at_rest = replay(scenario, np.empty((0, 2)), PERIOD)
    stay = certify(scenario, np.empty((0, 2)), PERIOD)
    if at_rest.solves and stay.is_clear:
        arrived = _arrived(scenario, problems[0][1], at_rest, seed)
        return watch.stamped(replace(arrived, certificate=stay))
    report = PlanReport("not_found", "", 0.0, 0, scenario, seed)
    if previous is not None and previous.plan is not None and previous.law is not None:
        found = _followed(report, previous.plan, previous.law, elapsed, effort, stop=watch.stop)
        report = watch.improved(report, found)
        if report.status == "planned" or report.ended != "complete":
            return report
    verdict = _verdict(scenario)
    if verdict.status == "unreachable":
        return watch.stamped(replace(report, status="unreachable", reason=verdict.reason))
    for attempt in range(effort.attempts):
        if watch.is_over():
            return watch.stamped(replace(report, ended="deadline"))
        margin, ways = ways_within(scenario, effort.scouts.margin / FINER**attempt)
        search = Search(scenario, ways, problems, effort, margin, seed, attempt, threads, watch.stop)
        report = watch.improved(report, search.run())
        if report.status == "planned" or report.ended != "complete":
            break
    return report


@dataclass(eq=False)
class _Watch:
    """Keeps the fastest plan of a search that the other simulator confirms, and says when to end."""

    began: float
    effort: Effort
    callback: "Callback | None"
    confirming: float = CONFIRMING  # s, the longest so far; a round is broken off so much before the deadline

    @property
    def stop(self) -> Callable[[], bool] | None:
        """Whether the deadline is near, as a question; nobody needs to ask it if there is none."""
        return self.is_over if self.effort.deadline < inf else None

    def is_over(self) -> bool:
        """Whether the deadline is near."""
        return time.perf_counter() - self.began >= self.effort.deadline - self.confirming

    def improved(self, report: PlanReport, search: Iterator[Found]) -> PlanReport:
        """The report with the fastest plan of a search, or with the reason why there is none."""
        spent = report.evaluations
        try:
            for found in search:
                since = time.perf_counter()
                seconds = since - self.began
                so_far = replace(report, evaluations=spent + found.evaluations, planning_time=seconds)
                report = _confirmed(so_far, found)
                self.confirming = max(self.confirming, time.perf_counter() - since)
                ended = self._ended(report)
                if ended != "complete":
                    return self.stamped(replace(report, ended=ended))
        except KeyboardInterrupt:
            if report.status != "planned":
                raise
            report = replace(report, ended="interrupted")
        return self.stamped(report)

    def stamped(self, report: PlanReport) -> PlanReport:
        """The report with the time that it took and, without a plan, the reason."""
        reason = _not_found(report) if report.status == "not_found" else report.reason
        return replace(report, reason=reason, planning_time=time.perf_counter() - self.began)

    def _ended(self, report: PlanReport) -> Ended:
        if self.callback is not None and self.callback(self.stamped(report)):
            return "callback"
        if report.evaluations >= self.effort.rollouts:
            return "rollouts"
        return "deadline" if self.is_over() else "complete"


def _verdict(scenario: Scenario) -> Reachability:
    """Whether the goal can be reached, and where time is scarce, whether any plan is as fast as the time limit asks."""
    verdict, (dx, dy, _) = reachability(scenario), scenario.goal - scenario.start
    straight = np.hypot(dx, dy) / top_speed(scenario) + np.pi / max(map(abs, scenario.turn_limits))
    if verdict.status == "unreachable" or scenario.time_limit >= 2.0 * straight:
        return verdict
    least = lower_bound(scenario, enough=scenario.time_limit * (1.0 + ROUNDING))
    if least <= scenario.time_limit * (1.0 + ROUNDING):
        return verdict
    return Reachability(
        "unreachable",
        f"too late: no plan arrives before {least:.4g} s, and the time limit is {scenario.time_limit:g} s",
    )


def _arrived(scenario: Scenario, law: Law, at_rest: Replay, seed: int) -> PlanReport:
    """The plan to stay, of a start within the tolerance: without points, controls and search."""
    stay = Trajectory(
        plant=law.plant,
        t=np.zeros(1),
        x=first_state(scenario, law.plant)[np.newaxis],
        u=np.empty((0, 2)),
        target=widened(scenario.goal[np.newaxis], law.plant),
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
        value=0.0,
        cost=0.0,
        evaluations=0,
        history=(),
        particles=Particles(Schedules(np.empty((0, 0, 3)), np.empty((0, 0))), np.empty(0)),
    )
    return PlanReport("planned", "", 0.0, 0, scenario, seed, plan=plan, law=law, replay=at_rest)


def _followed(
    report: PlanReport,
    previous: Plan,
    law: Law,
    elapsed: float,
    effort: Effort,
    *,
    stop: Callable[[], bool] | None,
) -> Iterator[Found]:
    """Plans near what is left of the previous one; none if that was to stay, or of a robot with other states."""
    plant = plant_of(report.scenario)
    if not len(previous.schedule.dwell) or law.plant.state_names != plant.state_names:
        return iter(())
    [(problem, law)] = problems_of(report.scenario, [law])
    margin = min(effort.followers.margin, 0.5 * start_gap(report.scenario), max(previous.clearance, 0.0))
    settings = replace(effort.followers, margin=margin)
    return follow(problem, law, previous, elapsed, settings, report.seed, stop=stop)


def _confirmed(report: PlanReport, found: Found) -> PlanReport:
    """The report with what was found, if that is faster, confirmed by the other simulator and cleared."""
    scenario, plan = report.scenario, found.plan
    if not plan.is_free or (report.plan is not None and plan.rank >= report.plan.rank):
        return report
    controls = steered(scenario, plan.trajectory.u)
    check = replay(scenario, controls, PERIOD)
    proof = certify(scenario, controls, PERIOD, until=check.arrival_time)
    if not (check.solves and proof.is_clear):
        return report
    return replace(
        report,
        status="planned",
        reason="",
        plan=plan,
        law=found.law,
        replay=check,
        certificate=proof,
        history=(*report.history, (report.evaluations, plan.arrival_time, report.planning_time)),
    )


def _not_found(report: PlanReport) -> str:
    return (
        f"no collision-free plan within {report.scenario.time_limit:g} s was found in {report.evaluations} rollouts"
        f"{WHEN[report.ended]}; the goal may still be reachable"
    )
