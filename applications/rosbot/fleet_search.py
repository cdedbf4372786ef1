"""The search behind a fleet: one robot after the other in several orders, and who loses much once more.

Prioritized planning (Erdmann & Lozano-Perez 1987) is neither complete nor optimal: who is planned early knows nothing
of those behind it. So orders are tried, and who finds no way, or loses most time, goes first in the next one
(Bennewitz, Burgard & Thrun 2002). In the best fleet, who loses much is planned anew among all others, which never makes
it worse. A robot whose plan of its own is clear of the others keeps that.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np

from applications.rosbot.certificate import certify
from applications.rosbot.others import Other, held_until
from applications.rosbot.planner import PlanReport, plan_scenario
from applications.rosbot.problems import PERIOD
from applications.rosbot.replay import replay
from applications.rosbot.scenario import Scenario
from applications.rosbot.swarms import Effort
from gpsynth.checks import check_number, check_whole
from gpsynth.law import Law
from gpsynth.planning import PlanSettings
from gpsynth.seeds import stream

ORDER = 5  # stage of the random streams
GAIN = 1e-6  # s, that counts as faster
DRAWS = 20  # for an order that has not been tried

Plans = Mapping[int, PlanReport]  # by the number of the robot
NOBODY: Plans = MappingProxyType({})
ROBOT = Effort(followers=PlanSettings(particles=64, iterations=15, rounds=4, patience=1.1))


@dataclass(frozen=True)
class FleetEffort:
    """How much is searched for a fleet."""

    robot: Effort = (
        ROBOT  # for each plan of a robot among others; its followers begin at what it would do alone
    )
    orders: int = 3  # priorities that are tried, though one of them succeeds
    retries: int = 4  # more of them while none does
    rounds: int = 2  # of improvements, at most
    loss: float = 0.02  # share of the time alone that a robot may lose without being planned anew

    def __post_init__(self) -> None:
        check_whole("orders of a fleet", self.orders, 1)
        for name in ("retries", "rounds"):
            check_whole(f"{name} of a fleet", getattr(self, name), 0)
        check_number("the loss in a fleet", self.loss)


@dataclass(frozen=True, eq=False)
class FleetSearch:
    """Robots that start together, each with a scenario of its own."""

    scenarios: Sequence[Scenario]
    laws: Sequence[Law]
    seed: int
    effort: FleetEffort
    threads: int = 1

    def alone(self) -> Iterator[PlanReport]:
        """What each robot would do without the others."""
        for number in range(len(self.scenarios)):
            yield self._planned(self.scenarios[number], None)

    def run(self, alone: Sequence[PlanReport]) -> Iterator[tuple[Plans, int]]:
        """The best fleet after every step, empty at first, and the evaluations of the step."""
        best, tried = NOBODY, set[tuple[int, ...]]()
        order = tuple(sorted(range(len(alone)), key=lambda number: -arrival(alone[number])))
        least = max(map(arrival, alone))
        for attempt in range(self.effort.orders + self.effort.retries):
            tried.add(order)
            plans, spent, stuck = self._in_order(order, alone)
            if stuck is None and (not best or rank(plans) < rank(best)):
                best = plans
            yield best, spent
            if best and (attempt + 1 >= self.effort.orders or rank(best)[0] <= least + GAIN):
                break
            first = _last_by(plans, alone) if stuck is None else stuck
            following = self._next(order, first, tried, attempt)
            if following is None:
                break
            order = following
        yield from self._improved(best, alone)

    def _in_order(self, order: Sequence[int], alone: Sequence[PlanReport]) -> tuple[Plans, int, int | None]:
        """Plans made in this order, their evaluations, and who found none."""
        plans, spent = dict[int, PlanReport](), 0
        for number in order:
            report, more = self._among(number, plans, alone[number], alone[number])
            spent += more
            if report.plan is None:
                return NOBODY, spent, number
            plans[number] = report
        return plans, spent, None

    def _improved(self, best: Plans, alone: Sequence[PlanReport]) -> Iterator[tuple[Plans, int]]:
        """Who loses much is planned anew among all others, on all ways, the last one first, until nobody gains."""
        for _ in range(self.effort.rounds if best else 0):
            before = rank(best)
            for number in sorted(best, key=lambda each: -arrival(best[each])):
                if arrival(best[number]) <= (1.0 + self.effort.loss) * arrival(alone[number]):
                    continue
                report, spent = self._among(number, best, alone[number], None)
                if arrival(report) < arrival(best[number]) - GAIN:
                    best = {**best, number: report}
                yield best, spent
            if rank(best) == before:
                break

    def _among(
        self, number: int, plans: Plans, own: PlanReport, previous: PlanReport | None
    ) -> tuple[PlanReport, int]:
        """A robot's plan among others, and its evaluations; its own, if that is clear of them."""
        scenario = among(self.scenarios[number], number, plans)
        kept = checked(scenario, own)
        if kept is not None:
            return kept, 0
        report = self._planned(scenario, previous)
        return report, report.evaluations

    def _planned(self, scenario: Scenario, previous: PlanReport | None) -> PlanReport:
        report = plan_scenario(
            scenario,
            self.laws,
            seed=self.seed,
            effort=self.effort.robot,
            threads=self.threads,
            previous=previous,
        )
        if report.ended == "interrupted":
            raise KeyboardInterrupt
        return report

    def _next(
        self, order: tuple[int, ...], first: int, tried: set[tuple[int, ...]], attempt: int
    ) -> tuple[int, ...] | None:
        """The order with one robot before all others; if that has been tried, any other; None if none is found."""
        changed = (first, *(each for each in order if each != first))
        rng = stream(self.seed, ORDER, attempt)
        drawn = (tuple(rng.permutation(len(order)).tolist()) for _ in range(DRAWS))
        return next((each for each in (changed, *drawn) if each not in tried), None)


def _last_by(plans: Plans, alone: Sequence[PlanReport]) -> int:
    """Who loses most time to the others."""
    return max(plans, key=lambda number: arrival(plans[number]) - arrival(alone[number]))


def among(scenario: Scenario, number: int, plans: Plans) -> Scenario:
    """The scenario of a robot among all others that have plans."""
    others = [other_of(plans[each]) for each in sorted(plans) if each != number]
    return replace(scenario, others=tuple(others))


def other_of(report: PlanReport) -> Other:
    """A robot with a plan as others see it: it stands from the moment when it has arrived."""
    scenario = report.scenario
    return Other(scenario.start, *held_until(report.controls, PERIOD, arrival(report)), scenario.radius)


def checked(scenario: Scenario, report: PlanReport) -> PlanReport | None:
    """The plan of a report for another scenario, if that is proved to be clear."""
    check = replay(scenario, report.controls, PERIOD)
    proof = certify(scenario, report.controls, PERIOD, until=check.arrival_time)
    if not (check.solves and proof.is_clear):
        return None
    return replace(report, scenario=scenario, replay=check, certificate=proof)


def arrival(report: PlanReport) -> float:
    """When (s) the robot of a report arrives; infinity without a plan."""
    return np.inf if report.replay is None else report.replay.arrival_time


def rank(plans: Plans) -> tuple[float, float]:
    """What fleets are sorted by: the last arrival, then all of them."""
    arrivals = list(map(arrival, plans.values()))
    return max(arrivals), sum(arrivals)
