"""The search behind a plan: a swarm for each way around the obstacles and each law, the best of them followed up."""

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace

import numpy as np

from applications.rosbot.guides import Guide, direct_guides, guides_along, top_speed
from applications.rosbot.routes import Route
from applications.rosbot.scenario import Scenario
from applications.rosbot.seeds import nearby, schedules_along
from gpsynth.arrays import Floats
from gpsynth.law import Law
from gpsynth.planning import Plan, PlanSettings, plan
from gpsynth.problem import Problem
from gpsynth.schedule import Schedule
from gpsynth.seeds import stream

SCOUT, CHASE, REFINE = range(1, 4)  # stages of the random streams
GUIDES = 8  # along which a swarm's first schedules lie
BEYOND = 1.0  # m, how far from the guides equilibrium points may lie

Callback = Callable[[Plan], bool | None]


@dataclass(frozen=True)
class Effort:
    """How much is searched: swarms of a few rounds everywhere, more for the best, then refinement."""

    points: int = 6
    swarms: int = 2  # at least, on every way, however few the laws
    scouts: PlanSettings = PlanSettings(particles=32, iterations=12, rounds=3)
    chasers: PlanSettings = PlanSettings(particles=48, iterations=15, rounds=6, patience=1.1)
    refiners: PlanSettings = PlanSettings(particles=32, iterations=30, rounds=5, patience=1.02)
    chased: int = 4  # scouts that are followed up
    refined: int = 2
    added: int = 2  # points that refinement adds
    nearness: float = 0.3  # noise of refinement's first schedules, as a share of the scouts'
    attempts: int = 3  # with other random numbers and twice the time budget, while nothing is found


@dataclass(frozen=True, eq=False)
class Way:
    """Where a swarm starts: along a route, straight to the goal, or anywhere."""

    number: int
    kind: Route | None
    is_anywhere: bool = False

    def guides(self, scenario: Scenario) -> tuple[Guide, ...]:
        """The guides of this way, the best first; none for anywhere."""
        if self.is_anywhere:
            return ()
        found = direct_guides(scenario) if self.kind is None else guides_along(scenario, self.kind)
        return tuple(found[:GUIDES])


@dataclass(frozen=True, eq=False)
class Swarm:
    """One law on one way, and the best plan it has found."""

    number: int
    problem: Problem
    law: Law
    guides: tuple[Guide, ...]
    region: tuple[Floats, Floats]
    plan: Plan


@dataclass(frozen=True, eq=False)
class Search:
    """One attempt at a scenario, given as a problem for each law. Swarms share nothing but the time budget T+."""

    scenario: Scenario
    problems: Sequence[tuple[Problem, Law]]
    effort: Effort
    seed: int
    attempt: int
    pool: ThreadPoolExecutor
    watch: Callable[[Law], Callback]  # the callback of a swarm with this law

    def run(self, routes: Sequence[Route], budget: float) -> list[Swarm]:
        """The swarms after every stage; T+ (s) is `budget` at first."""
        ways = [Way(number, route) for number, route in enumerate(routes)]
        ways += [Way(len(ways), None), Way(len(ways) + 1, None, is_anywhere=True)]
        area = np.vstack(
            [self.scenario.start[:2], self.scenario.goal[:2], *(route.points for route in routes)]
        )
        groups = list(self.pool.map(lambda way: self.scouts(way, area, budget), ways))
        scouts = [swarm for group in groups for swarm in group]
        budget = _tightened(scouts, budget)
        leaders = _leaders(scouts, self.effort.chased)
        chasers = list(self.pool.map(lambda swarm: self.chaser(swarm, budget), leaders))
        budget = _tightened(chasers, budget)
        leaders = sorted(chasers, key=_rank)[: self.effort.refined]
        return [*scouts, *chasers, *self.pool.map(lambda swarm: self.refiner(swarm, budget), leaders)]

    def scouts(self, way: Way, area: Floats, budget: float) -> list[Swarm]:
        """For each law a swarm or more along the guides of a way, every fourth particle anywhere."""
        guides, settings = way.guides(self.scenario), replace(self.effort.scouts, points=self.effort.points)
        region = _region(area, guides)
        team = list(self.problems) * -(-self.effort.swarms // len(self.problems))
        swarms = []
        for index, (problem, law) in enumerate(team):
            number = way.number * len(team) + index
            rng = stream(self.seed, SCOUT, self.attempt, number, 0)
            initial = schedules_along(guides, settings.points, settings.particles * 3 // 4, rng)
            found = plan(
                problem,
                law,
                settings,
                seed=self.seed,
                initial=initial,
                region=region,
                budget=budget,
                path=(SCOUT, self.attempt, number, 1),
                callback=self.watch(law),
            )
            swarms.append(Swarm(number, problem, law, guides, region, found))
        return swarms

    def chaser(self, swarm: Swarm, budget: float) -> Swarm:
        """The swarm goes on from where its particles were best, with new ones besides."""
        settings = replace(self.effort.chasers, points=self.effort.points)
        return self._continued(swarm, CHASE, settings, swarm.plan.swarm, budget)

    def refiner(self, swarm: Swarm, budget: float) -> Swarm:
        """The best schedule with more points, searched nearby."""
        schedule = _with_more_points(swarm.plan.schedule, self.effort.added)
        settings = replace(self.effort.refiners, points=len(schedule.dwell))
        rng = stream(self.seed, REFINE, self.attempt, swarm.number, 0)
        initial = nearby(schedule, settings.particles, self.effort.nearness, rng)
        return self._continued(swarm, REFINE, settings, initial, budget)

    def _continued(
        self, swarm: Swarm, stage: int, settings: PlanSettings, initial: Sequence[Schedule], budget: float
    ) -> Swarm:
        found = plan(
            swarm.problem,
            swarm.law,
            settings,
            seed=self.seed,
            initial=initial,
            region=swarm.region,
            budget=budget,
            path=(stage, self.attempt, swarm.number, 1),
            callback=self.watch(swarm.law),
        )
        return replace(swarm, plan=found)


def first_budget(scenario: Scenario, routes: Sequence[Route]) -> float:
    """A time (s) that a plan should not need: twice that of the shortest route, with time to turn at either end."""
    lengths = [route.length for route in routes] or [float(np.hypot(*(scenario.goal - scenario.start)[:2]))]
    turn = np.pi / max(map(abs, scenario.turn_limits))
    return 2.0 * (lengths[0] / top_speed(scenario) + float(turn))


def _region(area: Floats, guides: Sequence[Guide]) -> tuple[Floats, Floats]:
    """Bounds (3,) of the equilibrium points: the guides and some more, and two turns."""
    places = np.vstack([area, *(guide.poses[:, :2] for guide in guides)])
    low, high, turns = places.min(axis=0) - BEYOND, places.max(axis=0) + BEYOND, 2.0 * np.pi
    return np.append(low, -turns), np.append(high, turns)


def _tightened(swarms: Sequence[Swarm], budget: float) -> float:
    return min([budget, *(swarm.plan.arrival_time for swarm in swarms if swarm.plan.is_free)])


def _leaders(swarms: Sequence[Swarm], count: int) -> list[Swarm]:
    """The best swarms, and those along the most promising guide: a little collision is soon mended."""
    promise = min((swarm.guides[0].score for swarm in swarms if swarm.guides), default=0.0)
    promising = [swarm for swarm in swarms if swarm.guides and swarm.guides[0].score == promise][: count // 2]
    ranked = [swarm for swarm in sorted(swarms, key=_rank) if swarm not in promising]
    return promising + ranked[: count - len(promising)]


def _rank(swarm: Swarm) -> tuple[bool, float]:
    return swarm.plan.rank


def _with_more_points(schedule: Schedule, added: int) -> Schedule:
    """The same motion with the longest dwell times cut in two."""
    points, dwell = schedule.points, schedule.dwell
    for _ in range(added):
        longest = int(np.argmax(dwell))
        points = np.insert(points, longest, points[longest], axis=0)
        dwell = np.insert(dwell, longest, 0.5 * dwell[longest])
        dwell[longest + 1] -= dwell[longest]
    return Schedule(points, dwell)
