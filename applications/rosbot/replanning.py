"""Planning on from the schedule that a robot follows: a few generations of a swarm around what is left of it.

The swarm of one cycle, moved on in time, is where the next begins (receding horizon). What is left of the course that
was followed is one of the candidates, and what is clear for the next moments wins over what is not.
"""

from dataclasses import dataclass

import numpy as np

from applications.rosbot.courses import Course, along_route, alternatives, anew, standing
from applications.rosbot.guides import top_speed
from applications.rosbot.problems import problem_of
from applications.rosbot.scenario import Scenario
from applications.rosbot.vehicles import POSE, widened
from applications.rosbot.wayfinder import Part
from gpsynth.arrays import Floats
from gpsynth.checks import check_number, check_whole
from gpsynth.errors import ScenarioError
from gpsynth.evaluate import Evaluator
from gpsynth.law import Law
from gpsynth.optimizers import PSO, minimize
from gpsynth.planning import Objective, PlanSettings
from gpsynth.rollouts import Rollouts
from gpsynth.schedule import Schedules

CRASH = 1e3  # cost of less clearance than the least, more than that of any delay
SHORTEST = 4.0  # s; T+ is no less, so that there is time for another way close to the goal
SOON = 2.5  # s; where no course is clear to its end, it is to be clear this long
BEYOND = 1.0  # m, how far beyond start, goal and courses equilibrium points may lie
LONGEST = 6.0  # s, of one dwell time


@dataclass(frozen=True)
class Replanning:
    """How much is searched in a cycle, and how far the robot keeps from obstacles."""

    points: int = 5  # equilibrium points at least
    particles: int = 48
    generations: int = 4  # while the course that is followed is clear
    anew: int = 8  # generations otherwise
    kept: int = 24  # of the swarm, for the next cycle
    margin: float = 0.05  # m of clearance, wanted
    least: float = 0.02  # m, below which a course counts as a collision
    gamma: float = 2.0  # weight of what is missing of the margin, eq. 17
    gain: float = 0.05  # s by which a course must be faster to be preferred to the one that is followed

    def __post_init__(self) -> None:
        for name in ("points", "particles", "generations", "anew", "kept"):
            check_whole(f"{name} of replanning", getattr(self, name), 1)
        for name in ("margin", "least", "gamma", "gain"):
            check_number(f"{name} of replanning", getattr(self, name))
        if not 0.0 <= self.least <= self.margin < np.inf:
            raise ScenarioError(
                f"the margin is {self.margin} m and the least clearance {self.least} m; expected 0 <= least <= margin"
            )

    @classmethod
    def keeping(cls, margin: float) -> "Replanning":
        """The same with another margin (m), half of which is the least clearance."""
        check_number("margin of replanning", margin)
        return cls(margin=margin, least=0.5 * margin)


@dataclass(frozen=True, eq=False)
class Caution:
    """The planner's objective, and a price on coming closer than the least clearance that no haste outweighs."""

    objective: Objective
    least: float  # m

    def __call__(self, vectors: Floats, limits: Floats | None = None) -> Floats:
        """Costs (N,) of vectors (N, d), the poses (k, 3) and dwell times (k,) of courses, with limits (N,) of these."""
        courses = self.courses(vectors)
        return self.costs(self.rollouts(courses, limits), courses)

    def courses(self, vectors: Floats) -> Schedules:
        """What vectors (N, d) stand for."""
        count = self.objective.settings.points
        return Schedules(vectors[:, : POSE * count].reshape(-1, count, POSE), vectors[:, POSE * count :])

    def rollouts(self, courses: Schedules, limits: Floats | None = None) -> Rollouts:
        """Rollouts (N, 1) of courses, with limits (N,) as the objective has them."""
        return self.objective.rollouts(self._states(courses), courses.dwell, limits)

    def costs(self, rollouts: Rollouts, courses: Schedules) -> Floats:
        """Costs (N,) of what has been rolled out."""
        missing = self.least - rollouts.clearance[:, 0]
        crash = np.where(missing > 0.0, CRASH * (1.0 + missing), 0.0)
        costs: Floats = self.objective.costs(rollouts, self._states(courses)) + crash
        return costs

    def soon(self, courses: Schedules) -> Floats:
        """The least clearance (N,) of courses in the next moments."""
        evaluator, law = self.objective.evaluator, self.objective.law
        return evaluator.of_schedules(law, self._states(courses), courses.dwell, SOON).clearance[:, 0]

    def is_clear(self, course: Schedules) -> bool:
        """Whether the first of these courses leads to the goal with at least the least clearance."""
        rollouts = self.rollouts(course.take(np.arange(1)))
        return bool(np.isfinite(rollouts.arrival[0, 0]) and rollouts.clearance[0, 0] >= self.least)

    def _states(self, courses: Schedules) -> Floats:
        return widened(courses.points, self.objective.law.plant)


def replan(
    scene: Scenario,
    law: Law,
    previous: Course,
    elapsed: float,
    settings: Replanning = Replanning(),
    *,
    part: Part | None = None,
    seed: int = 0,
    path: tuple[int, ...] = (0,),
) -> Course:
    """The course from the scene's start on, `elapsed` seconds after the previous one began.

    The law must be for the scene's limits; `part` is of the scene's room. The same seed and path give the same course.
    """
    left = previous.remainder(elapsed)
    caution = _caution(scene, law, settings, left, previous.arrival_time - elapsed)
    is_clear = caution.is_clear(left)
    tried = [left.take(np.arange(1)), alternatives(left[0], scene.start, scene.goal)]
    count = left.points.shape[1]
    if part is not None:
        tried.append(Schedules.of([along_route(part.way, count, top_speed(scene))]))
    if not is_clear:
        tried.append(anew(scene, count, settings.margin, part))
    tried.append(left.take(np.arange(1, len(left))))
    vectors = np.concatenate([_vectors(each) for each in tried])[: settings.particles]
    lower, upper = _box(vectors, scene, count)
    optimizer = PSO.clerc(lower, upper, size=settings.particles, x0=np.clip(vectors, lower, upper))
    generations = settings.generations if is_clear else settings.anew
    found = minimize(
        caution,
        optimizer,
        seed=seed,
        path=path,
        budget=settings.particles * generations,
        limits=optimizer.limits,
    )
    best = found.state.best_x[np.argsort(found.state.best_costs, kind="stable")]
    swarm = caution.courses(best)
    stay = Schedules.of([standing(scene.start).split(count)])
    return _chosen(caution, Schedules.joined([left.take(np.arange(1)), swarm, stay]), scene, settings)


def _caution(scene: Scenario, law: Law, settings: Replanning, left: Schedules, remaining: float) -> Caution:
    plan_settings = PlanSettings(
        points=left.points.shape[1],
        dwell=(0.0, LONGEST),
        gamma=settings.gamma,
        margin=settings.margin,
        top_speed=top_speed(scene),
    )
    evaluator = Evaluator(problem_of(scene, law), margin=settings.margin)
    budget = max(remaining if np.isfinite(remaining) else _ample(scene), SHORTEST)
    return Caution(Objective(evaluator, law, plan_settings, budget), settings.least)


def _ample(scene: Scenario) -> float:
    """A time (s) that should do: twice that of the straight line with a turn at either end."""
    turn = np.pi / max(map(abs, scene.turn_limits))
    return float(2.0 * (np.hypot(*(scene.goal - scene.start)[:2]) / top_speed(scene) + turn))


def _chosen(caution: Caution, courses: Schedules, scene: Scenario, settings: Replanning) -> Course:
    """The best course unless the first, which is followed, is nearly as good; if none is clear, what is clear soon.

    The last is to stay.
    """
    objective = caution.objective
    rollouts = caution.rollouts(courses)
    costs = caution.costs(rollouts, courses)
    costs[0] -= objective.settings.beta * settings.gain / objective.budget
    best = int(np.argmin(costs))
    if rollouts.clearance[best, 0] < settings.least:
        best = int(np.lexsort([costs, np.maximum(settings.least - caution.soon(courses), 0.0)])[0])
    return Course(
        schedule=courses[best],
        goal=scene.goal,
        arrival_time=float(objective.arrivals(rollouts)[best]),
        clearance=float(rollouts.clearance[best, 0]),
        swarm=courses.take(np.arange(1, 1 + min(settings.kept, len(courses) - 2))),
    )


def _vectors(courses: Schedules) -> Floats:
    return np.hstack([courses.points.reshape(len(courses), -1), courses.dwell])


def _box(vectors: Floats, scene: Scenario, points: int) -> tuple[Floats, Floats]:
    """Bounds of the vectors: points around all that they hold, within two turns, and dwell times."""
    places = vectors[:, : 3 * points].reshape(-1, 3)[:, :2]
    places = np.vstack([places, scene.start[:2], scene.goal[:2]])
    low, high, turns = places.min(axis=0) - BEYOND, places.max(axis=0) + BEYOND, 2.0 * np.pi
    lower, upper = np.append(low, -turns), np.append(high, turns)
    return (
        np.append(np.tile(lower, points), np.zeros(points)),
        np.append(np.tile(upper, points), np.full(points, LONGEST)),
    )
