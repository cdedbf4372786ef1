"""The search behind a plan: swarms side by side for each way around the obstacles, the best of them followed up."""

from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import ceil, inf

import numpy as np

from applications.rosbot.guides import Guide, direct_guides, guides_along, top_speed
from applications.rosbot.routes import Route
from applications.rosbot.scenario import Scenario
from applications.rosbot.seeds import anywhere, nearby, repeated, schedules_along
from applications.rosbot.vehicles import pose_plans
from gpsynth.arrays import Floats
from gpsynth.checks import check_kind, check_number, check_whole
from gpsynth.errors import ScenarioError
from gpsynth.law import Law
from gpsynth.planning import Particles, Plan, PlanSettings, Weights
from gpsynth.problem import Problem
from gpsynth.schedule import Schedules
from gpsynth.seeds import stream

SCOUT, CHASE, REFINE = range(1, 4)  # stages of the random streams
GUIDES = 8  # along which a swarm's first schedules lie
SPARE = 1.5  # of the time along a guide, for a first plan
LEG = 2.5  # s, that equilibrium points are apart at most at first
BEYOND = 1.0  # m, how far from the guides equilibrium points may lie


@dataclass(frozen=True)
class Effort:
    """How much is searched: swarms of a few rounds everywhere, more for the best, then refinement."""

    points: int = 6
    swarms: int = 3  # at least, on every way, however few the laws
    scouts: PlanSettings = PlanSettings(particles=24, iterations=12, rounds=3)
    chasers: PlanSettings = PlanSettings(particles=48, iterations=15, rounds=6, patience=1.1)
    refiners: PlanSettings = PlanSettings(particles=32, iterations=30, rounds=5, patience=1.02)
    followers: PlanSettings = PlanSettings(particles=32, iterations=7, rounds=1)  # of a previous plan
    chased: int = 4  # scouts that are followed up
    refined: int = 2
    added: int = 2  # points that refinement adds
    nearness: float = 0.3  # noise of refinement's first schedules, as a share of the scouts'
    weights: Weights = Weights()  # of what counts beside time
    attempts: int = (
        3  # while nothing is found, each with other random numbers, twice the time and less margin
    )
    rollouts: float = inf  # after which the best plan so far is given
    deadline: float = inf  # s of wall clock, likewise; what comes of it is not the same every time

    def __post_init__(self) -> None:
        for name in ("points", "swarms", "attempts"):
            check_whole(f"{name} of an effort", getattr(self, name), 1)
        for name in ("chased", "refined", "added"):
            check_whole(f"{name} of an effort", getattr(self, name), 0)
        for name in ("scouts", "chasers", "refiners", "followers"):
            check_kind(f"{name} of an effort", getattr(self, name), PlanSettings)
        check_kind("weights of an effort", self.weights, Weights)
        check_number("nearness of an effort", self.nearness)
        for name in ("rollouts", "deadline"):
            check_number(f"the {name} of an effort", getattr(self, name))
            if not getattr(self, name) > 0.0:
                raise ScenarioError(f"{name} of an effort is {getattr(self, name)}; expected more than 0")


@dataclass(frozen=True, eq=False)
class Found:
    """The best plan of a stage so far."""

    plan: Plan
    law: Law
    evaluations: int  # of the whole search


@dataclass(frozen=True, eq=False)
class Swarm:
    """One law on one way: the best schedule of every particle."""

    number: int  # within its law
    team: int  # the number of its law
    promise: float  # s, the score of its best guide
    schedules: Schedules  # the best first
    cost: float  # of the best one


@dataclass(frozen=True, eq=False)
class Task:
    """Swarms of one law that are evaluated together; `promises` has one number for each of them."""

    team: int
    settings: PlanSettings
    initial: Schedules
    promises: Sequence[float]
    path: tuple[int, ...]  # of the random streams

    def swarms(self, particles: Particles) -> list[Swarm]:
        """The swarms that have come of it."""
        costs = particles.costs.reshape(len(self.promises), -1)
        order = np.argsort(costs, axis=1, kind="stable")
        first = costs.shape[1] * np.arange(len(costs))
        return [
            Swarm(number, self.team, promise, particles.schedules.take(ranked), float(costs[number].min()))
            for number, (promise, ranked) in enumerate(
                zip(self.promises, order + first[:, None], strict=True)
            )
        ]


Stage = Generator[
    Found, None, tuple[list[Swarm], float, int]
]  # the swarms, T+ (s) and the evaluations so far


@dataclass(frozen=True, eq=False)
class Search:
    """One attempt at a scenario, given as a problem for each law. Swarms share nothing but the time budget T+."""

    scenario: Scenario
    routes: Sequence[Route]
    problems: Sequence[tuple[Problem, Law]]
    effort: Effort
    margin: float  # m, of clearance that is asked for at most
    seed: int
    attempt: int = 0
    threads: int = 1
    stop: Callable[[], bool] | None = None  # asked within the rounds; once it says so, the search ends

    def run(self) -> Iterator[Found]:
        """The best plan after every round of every stage."""
        scouts, budget, spent = yield from self._stage(self._scouts(), self.first_budget, 0)
        leaders = _leaders(scouts, self.effort.chased)
        chasers, budget, spent = yield from self._stage(self._chasers(leaders), budget, spent)
        leaders = sorted(chasers, key=_cost)[: self.effort.refined]
        yield from self._stage(map(self._refiner, leaders), budget, spent)

    @cached_property
    def ways(self) -> list[list[Guide]]:
        """The guides of every route, of the straight way to the goal, and none for anywhere."""
        return [
            *guides_along(self.scenario, self.routes, GUIDES),
            direct_guides(self.scenario, GUIDES),
            [],
        ]

    @cached_property
    def points(self) -> int:
        """The equilibrium points: more on a long way, one for every LEG of the best guide."""
        best = min((way[0] for way in self.ways if way), key=lambda guide: guide.score, default=None)
        return self.effort.points if best is None else max(self.effort.points, ceil(best.duration / LEG))

    @property
    def first_budget(self) -> float:
        """The first T+ (s): half as long again as the best guide, and twice as long at every further attempt."""
        scores = [way[0].score for way in self.ways if way]
        return min(self.scenario.time_limit, SPARE * 2.0**self.attempt * min(scores, default=np.inf))

    @cached_property
    def region(self) -> tuple[Floats, Floats]:
        """Bounds (3,) of the equilibrium points: the guides and some more, and two turns."""
        guides = [guide.poses[:, :2] for way in self.ways for guide in way]
        ends = np.array([self.scenario.start[:2], self.scenario.goal[:2]])
        places, turns = np.vstack([ends, *(route.points for route in self.routes), *guides]), 2.0 * np.pi
        return np.append(places.min(axis=0) - BEYOND, -turns), np.append(places.max(axis=0) + BEYOND, turns)

    def _stage(self, tasks: Iterable[Task], budget: float, spent: int) -> Stage:
        """The tasks one after the other."""
        swarms: list[Swarm] = []
        for task in tasks:
            problem, law = self.problems[task.team]
            settings = replace(
                task.settings,
                margin=min(task.settings.margin, self.margin),
                top_speed=top_speed(self.scenario),
                weights=self.effort.weights,
            )
            for plan in pose_plans(
                problem,
                law,
                settings,
                seed=self.seed,
                initial=task.initial,
                region=self.region,
                budget=budget,
                path=task.path,
                threads=self.threads,
                stop=self.stop,
            ):
                yield Found(plan, law, spent + plan.evaluations)
            swarms += task.swarms(plan.particles)
            spent += plan.evaluations
            budget = min(budget, plan.value) if plan.is_free else budget
        return swarms, budget, spent

    def _scouts(self) -> Iterator[Task]:
        """For each law swarms along the guides of every way, every fourth particle anywhere.

        Two of three swarms begin with schedules that lead through the goal: who aims at it arrives slowly.
        """
        effort, teams = self.effort, len(self.problems)
        for team in range(teams):
            ways = [
                (way, schedules_along(way, self.points, through=number % 3 > 0) if way else None)
                for way in self.ways
                for number in range(team, team + -(-effort.swarms // teams))
            ]
            settings = replace(effort.scouts, points=self.points, swarms=len(ways))
            rng = stream(self.seed, SCOUT, self.attempt, team, 0)
            initial = []
            for _, known in ways:
                guided = settings.particles * 3 // 4 if known else 0
                if known:
                    initial.append(repeated(known, guided, rng))
                initial.append(self._anywhere(settings.particles - guided, rng))
            promises = [way[0].score if way else np.inf for way, _ in ways]
            path = (SCOUT, self.attempt, team, 1)
            yield Task(team, settings, Schedules.joined(initial), promises, path)

    def _chasers(self, leaders: Sequence[Swarm]) -> Iterator[Task]:
        """The swarms go on from where their particles were best, with new ones besides."""
        settings = replace(self.effort.chasers, points=self.points)
        for team in range(len(self.problems)):
            rng = stream(self.seed, CHASE, self.attempt, team, 0)
            members = [swarm for swarm in leaders if swarm.team == team]
            initial = []
            for swarm in members:
                kept = swarm.schedules.take(np.arange(min(len(swarm.schedules), settings.particles)))
                initial += [kept, self._anywhere(settings.particles - len(kept), rng)]
            if members:
                promises, path = [swarm.promise for swarm in members], (CHASE, self.attempt, team, 1)
                together = replace(settings, swarms=len(members))
                yield Task(team, together, Schedules.joined(initial), promises, path)

    def _refiner(self, swarm: Swarm) -> Task:
        """The best schedule with more points, searched nearby."""
        count = self.points + self.effort.added
        settings = replace(self.effort.refiners, points=count)
        path = (REFINE, self.attempt, swarm.team, swarm.number)
        rng = stream(self.seed, *path, 0)
        initial = nearby(swarm.schedules[0].split(count), settings.particles, self.effort.nearness, rng)
        return Task(swarm.team, settings, initial, [swarm.promise], (*path, 1))

    def _anywhere(self, count: int, rng: np.random.Generator) -> Schedules:
        return anywhere(self.region, self.points, count, rng)


def _leaders(swarms: Sequence[Swarm], count: int) -> list[Swarm]:
    """The best swarms, and those along the most promising guide: a little collision is soon mended."""
    promise = min(swarm.promise for swarm in swarms)
    promising = [swarm for swarm in swarms if swarm.promise == promise < np.inf][: count // 2]
    ranked = [swarm for swarm in sorted(swarms, key=_cost) if swarm not in promising]
    return promising + ranked[: count - len(promising)]


def _cost(swarm: Swarm) -> float:
    return swarm.cost
