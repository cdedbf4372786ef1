"""Plans for scenarios: what can be reached is searched for, and what is found is replayed by another simulator."""

import time
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from applications.rosbot.bounds import lower_bound
from applications.rosbot.certificate import Certificate, certify
from applications.rosbot.model import reached
from applications.rosbot.reachability import reachability
from applications.rosbot.replay import Replay, replay
from applications.rosbot.routes import routes
from applications.rosbot.scenario import Scenario
from applications.rosbot.swarms import Callback, Effort, Search, Swarm, first_budget
from gpsynth.errors import ScenarioError
from gpsynth.law import Law
from gpsynth.planning import Plan
from gpsynth.problem import Obstacles, Problem
from gpsynth.schedule import Schedule
from gpsynth.simulation import Trajectory

__all__ = ["PERIOD", "Effort", "PlanReport", "plan_scenario", "problem_of"]

PERIOD = 0.05  # s of the control: 2.5 cm at 0.5 m/s; twice as long costs time at every switch, half as long computing
INSIDE = (0.001, 0.002)  # m, rad: how far within the tolerance a plan arrives, so that no rounding undoes it


@dataclass(frozen=True, eq=False)
class PlanReport:
    """What planning came to."""

    status: Literal["planned", "unreachable", "not_found"]
    reason: str  # empty for a plan
    planning_time: float  # s
    evaluations: int
    lower_bound: float  # s
    seed: int
    plan: Plan | None = None
    law: Law | None = None
    replay: Replay | None = None  # by the simulator that shares nothing with the planner's
    certificate: Certificate | None = None  # for the path between its samples
    history: tuple[tuple[int, float], ...] = ()  # (evaluations, arrival time in s) at every improvement

    @property
    def ratio(self) -> float:
        """Arrival time over its lower bound; infinity without a plan, 1 where there is nothing to drive."""
        if self.replay is None:
            return np.inf
        return self.replay.arrival_time / self.lower_bound if self.lower_bound else 1.0


def plan_scenario(
    scenario: Scenario,
    laws: Sequence[Law],
    *,
    seed: int = 0,
    effort: Effort = Effort(),
    threads: int = 1,
    callback: Callback | None = None,
) -> PlanReport:
    """The fastest collision-free plan found with any of the laws; the same seed gives the same plan.

    `callback` gets every swarm's best plan after each of its rounds, not yet replayed; returning True ends that swarm.
    Raises ScenarioError if there is no law, or one that does not steer v and omega.
    """
    began = time.perf_counter()
    problems = _problems(scenario, laws)
    at_rest = replay(scenario, np.empty((0, 2)), PERIOD)
    stay = certify(scenario, np.empty((0, 2)), PERIOD)
    if at_rest.solves and stay.is_clear:
        report = _arrived(scenario, problems[0][1], at_rest, seed)
        return replace(report, certificate=stay, planning_time=time.perf_counter() - began)
    verdict = reachability(scenario)
    report = PlanReport("unreachable", verdict.reason, 0.0, 0, lower_bound(scenario), seed)
    if verdict.status != "unreachable":
        ways = routes(scenario, margin=effort.scouts.margin)
        budget, found = first_budget(scenario, ways), list[Swarm]()
        for attempt in range(effort.attempts):
            with ThreadPoolExecutor(threads) as pool:
                search = Search(scenario, problems, effort, seed, attempt, pool, callback)
                found += search.run(ways, min(budget * 2.0**attempt, scenario.time_limit))
            report = _verified(scenario, found, report)
            if report.status == "planned":
                break
    return replace(report, planning_time=time.perf_counter() - began)


def problem_of(scenario: Scenario, law: Law) -> Problem:
    """The scenario as a problem for a law: least time into the tolerance, a little within its edge."""
    position, heading = scenario.position_tolerance, scenario.heading_tolerance
    shrunk = max(0.5 * position, position - INSIDE[0]), max(0.5 * heading, heading - INSIDE[1])
    return Problem(
        law.plant,
        scenario.start,
        scenario.goal,
        tolerance=[shrunk[0], shrunk[0], shrunk[1]],
        horizon=max(PERIOD, scenario.time_limit - PERIOD),
        period=PERIOD,
        features=law.features,
        reached=reached(*shrunk),
        obstacles=_obstacles(scenario),
    )


def _obstacles(scenario: Scenario) -> Obstacles:
    if scenario.is_round:
        return Obstacles(scenario.circles, scenario.bounds, scenario.radius, field=scenario.field)
    position = ("x", "y", "theta")
    return Obstacles(scenario.circles, scenario.bounds, 0.0, position, scenario.body, scenario.field)


def _problems(scenario: Scenario, laws: Sequence[Law]) -> list[tuple[Problem, Law]]:
    """The laws under the scenario's limits, each with the problem as it sees it."""
    if not laws:
        raise ScenarioError("a plan needs at least one law")
    for law in laws:
        if law.plant.control_names != ("v", "omega"):
            raise ScenarioError(
                f"the law steers {', '.join(law.plant.control_names)}; a scenario needs v, omega"
            )
    low, high = zip(scenario.speed_limits, scenario.turn_limits, strict=True)
    adapted = [law.with_limits(low, high) for law in laws]
    return [(problem_of(scenario, law), law) for law in adapted]


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
        swarm=(),
    )
    return PlanReport("planned", "", 0.0, 0, lower_bound(scenario), seed, plan=plan, law=law, replay=at_rest)


def _verified(scenario: Scenario, swarms: Sequence[Swarm], report: PlanReport) -> PlanReport:
    """The fastest plan that the other simulator confirms and the certificate clears, or that there is none."""
    plans = [swarm.plan for swarm in swarms]
    evaluations = sum(plan.evaluations for plan in plans)
    for swarm in sorted(swarms, key=lambda swarm: swarm.plan.rank):
        check = replay(scenario, swarm.plan.trajectory.u, PERIOD) if swarm.plan.is_free else None
        if check is None or not check.solves:
            continue
        proof = certify(scenario, swarm.plan.trajectory.u, PERIOD, until=check.arrival_time)
        if proof.is_clear:
            return replace(
                report,
                status="planned",
                reason="",
                evaluations=evaluations,
                plan=swarm.plan,
                law=swarm.law,
                replay=check,
                certificate=proof,
                history=_improvements(plans),
            )
    reason = (
        f"no collision-free plan within {scenario.time_limit:g} s was found; the goal may still be reachable"
    )
    return replace(report, status="not_found", reason=reason, evaluations=evaluations)


def _improvements(plans: Sequence[Plan]) -> tuple[tuple[int, float], ...]:
    """(evaluations, arrival time) at every improvement, as if the searches had run one after the other."""
    spent, best, history = 0, np.inf, []
    for each in plans:
        spent += each.evaluations
        if each.is_free and each.arrival_time < best:
            best = each.arrival_time
            history.append((spent, best))
    return tuple(history)
