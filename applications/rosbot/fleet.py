"""Several robots planned together, with their mutual clearance proved."""

import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from typing import Literal

import numpy as np

from applications.rosbot.encounters import least_distance
from applications.rosbot.fleet_search import (
    NOBODY,
    FleetEffort,
    FleetSearch,
    among,
    arrival,
    checked,
    other_of,
)
from applications.rosbot.planner import PlanReport
from applications.rosbot.scenario import Scenario
from gpsynth.checks import check_kind
from gpsynth.errors import ScenarioError
from gpsynth.law import Law

__all__ = ["Encounter", "FleetEffort", "FleetReport", "check_fleet", "plan_fleet"]

NOT_FOUND = "no plans that are clear of each other were found in any order; there may still be some"


@dataclass(frozen=True)
class Encounter:
    """How near two robots come."""

    first: int
    second: int
    clearance: float  # m, proved: their discs are never nearer, up to when both stand and after
    time: float  # s, when the piece begins in which they are


@dataclass(frozen=True, eq=False)
class FleetReport:
    """What planning for a fleet came to."""

    status: Literal["planned", "unreachable", "not_found"]
    reason: str  # empty for plans
    planning_time: float  # s
    evaluations: int
    seed: int
    scenarios: tuple[Scenario, ...]
    robots: tuple[
        PlanReport, ...
    ] = ()  # each with the plans of all others in its scenario; none without plans
    alone: tuple[PlanReport, ...] = ()  # what each would do without the others
    encounters: tuple[Encounter, ...] = ()  # of all pairs
    ended: Literal["complete", "interrupted"] = "complete"

    @property
    def arrivals(self) -> tuple[float, ...]:
        """When (s) each robot arrives."""
        return tuple(map(arrival, self.robots))

    @property
    def clearance(self) -> float:
        """The least clearance (m) that is proved between any two robots."""
        return min((each.clearance for each in self.encounters), default=np.inf)


def plan_fleet(
    scenarios: Sequence[Scenario],
    laws: Sequence[Law],
    *,
    seed: int = 0,
    effort: FleetEffort = FleetEffort(),
    threads: int = 1,
) -> FleetReport:
    """Plans for robots that start together, each with a scenario of its own, all clear of each other.

    The last arrival is made early, then the sum of all. A robot that has arrived stands at its goal, and the others
    keep clear of it. The same seed gives the same plans. Ctrl-C ends the search once there is a fleet. Raises
    ScenarioError if robots are fewer than two, overlap at their starts or goals, are not round, or have lags.
    """
    check_fleet(scenarios)
    begin = time.perf_counter()
    search = FleetSearch(scenarios, laws, seed, effort, threads)
    report = FleetReport("not_found", NOT_FOUND, 0.0, 0, seed, tuple(scenarios))
    for number, found in enumerate(search.alone()):
        spent = report.evaluations + found.evaluations
        report = replace(report, evaluations=spent, alone=(*report.alone, found))
        if found.status != "planned":
            reason = f"robot {number}, alone: {found.reason}"
            report = replace(report, status=found.status, reason=reason)
            break
    else:
        report = _searched(report, search)
    return replace(report, planning_time=time.perf_counter() - begin)


def check_fleet(scenarios: Sequence[Scenario]) -> None:
    """Raise ScenarioError unless there are several robots that can stand at their starts, and at their goals."""
    check_kind("scenarios", scenarios, list, tuple, error=ScenarioError)
    for scenario in scenarios:
        check_kind("one of the scenarios", scenario, Scenario, error=ScenarioError)
    if len(scenarios) < 2:
        raise ScenarioError(f"a fleet has at least two robots, got {len(scenarios)}")
    for number, scenario in enumerate(scenarios):
        if not scenario.is_round or scenario.model == "dynamic_unicycle":
            what = f"a {scenario.model}" if scenario.is_round else "not round"
            raise ScenarioError(
                f"robot {number} is {what}; robots of a fleet are round, and unicycles or cars without lags"
            )
    for first, second in combinations(range(len(scenarios)), 2):
        one, two = scenarios[first], scenarios[second]
        for name, here, there in (("starts", one.start, two.start), ("goals", one.goal, two.goal)):
            missing = one.radius + two.radius - float(np.hypot(*(here - there)[:2]))
            if missing > 0.0:
                raise ScenarioError(
                    f"the {name} of robots {first} and {second} overlap by {missing:.3g} m, "
                    f"their radii being {one.radius:g} and {two.radius:g} m"
                )


def _searched(report: FleetReport, search: FleetSearch) -> FleetReport:
    """The report with the best fleet, if all of it is proved to be clear."""
    plans = NOBODY
    try:
        for found, spent in search.run(report.alone):
            plans, report = found, replace(report, evaluations=report.evaluations + spent)
    except KeyboardInterrupt:
        if not plans:
            raise
        report = replace(report, ended="interrupted")
    scenarios = [among(scenario, number, plans) for number, scenario in enumerate(report.scenarios)]
    robots = tuple(checked(scenarios[number], plans[number]) for number in sorted(plans))
    proved = tuple(robot for robot in robots if robot is not None)
    if not plans or len(proved) < len(plans):
        return report
    return replace(report, status="planned", reason="", robots=proved, encounters=_encounters(proved))


def _encounters(robots: Sequence[PlanReport]) -> tuple[Encounter, ...]:
    """All pairs."""
    driven, found = [other_of(robot) for robot in robots], []
    for first, second in combinations(range(len(robots)), 2):
        one, two = driven[first], driven[second]
        distance, when = least_distance(one.path, two.path)
        found.append(Encounter(first, second, distance - one.radius - two.radius, when))
    return tuple(found)
