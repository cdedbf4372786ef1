"""Courses: schedules on their way, and what else a robot on its way could do."""

from dataclasses import dataclass

import numpy as np

from applications.rosbot.guides import direct_guides, top_speed
from applications.rosbot.routes import Route, routes
from applications.rosbot.scenario import Scenario
from applications.rosbot.seeds import along
from applications.rosbot.wayfinder import Part
from gpsynth.arrays import Floats
from gpsynth.schedule import Schedule, Schedules

INSTANT = 1e-9  # s; a clock reading this close to a switching time has reached it
WAITS = (0.5, 1.0, 2.0)  # s
RETREATS = (-1.0, -0.5, 0.5, 1.0)  # m, back and ahead
TURNS = (-0.7, 0.0, 0.7)  # rad, of a retreat
DETOURS = (-1.0, -0.5, 0.5, 1.0)  # m, to the right and to the left
GUIDES = 4  # curves straight to the goal
ROUTES = 3  # routes around the obstacles
STAY = 4.0  # s


@dataclass(frozen=True, eq=False)
class Course:
    """A schedule to follow, what it promises, and others like it that are good."""

    schedule: Schedule
    goal: Floats  # (3,), the target after the last point
    arrival_time: float  # s from its beginning; infinity if the goal is not reached
    clearance: float  # m, smallest on the way; infinity without obstacles
    swarm: Schedules

    @classmethod
    def of(cls, schedule: Schedule, goal: Floats, points: int) -> "Course":
        """A schedule to a goal (3,) of which nothing is known yet, with so many points at least."""
        divided = schedule.split(points)
        return cls(divided, goal, np.inf, -np.inf, Schedules.of([divided]))

    def target(self, time: float) -> Floats:
        """The equilibrium point (3,) at a time (s) after the beginning."""
        due = int(np.sum(time >= self.schedule.ends - INSTANT))
        return self.schedule.points[due] if due < len(self.schedule.dwell) else self.goal

    def remainder(self, elapsed: float) -> Schedules:
        """What is left after so many seconds of the schedule, which comes first, and of the others."""
        every = [self.schedule, *(self.swarm[number] for number in range(len(self.swarm)))]
        return Schedules.of([each.after(elapsed).split(len(each.dwell)) for each in every])


def standing(pose: Floats) -> Schedule:
    """Stay at a pose (3,) for a while."""
    return Schedule(pose[np.newaxis], np.array([STAY]))


def alternatives(course: Schedule, pose: Floats, goal: Floats) -> Schedules:
    """What else a robot at a pose (3,) might do: go straight, wait or retreat first, or pass on another side."""
    points, dwell = course.points, course.dwell
    found = [(np.tile(goal, (len(points), 1)), np.zeros(len(dwell)))]
    found += [_preceded(course, pose, wait) for wait in WAITS]
    for way in RETREATS:
        for turn in TURNS:
            heading = pose[2] + 0.5 * turn
            place = pose + np.array([way * np.cos(heading), way * np.sin(heading), turn])
            found.append(_preceded(course, place, 2.0 * abs(way)))
    ahead = goal[:2] - pose[:2]
    aside = np.array([-ahead[1], ahead[0], 0.0]) / max(float(np.hypot(*ahead)), INSTANT)
    found += [(points + offset * aside, dwell) for offset in DETOURS]
    return Schedules(np.array([places for places, _ in found]), np.array([times for _, times in found]))


def anew(scene: Scenario, points: int, margin: float, part: Part | None = None) -> Schedules:
    """Courses that owe nothing to an earlier one: to stand still, curves to the goal, and ways around obstacles.

    Obstacles count where they are at time 0, and routes keep `margin` (m) besides the robot's radius. In a `part` of a
    room they do not leave it.
    """
    found = [standing(scene.start).split(points)]
    found += [along(guide, points) for guide in direct_guides(scene)[:GUIDES]]
    ways = part.routes(scene, ROUTES, margin) if part else routes(scene, count=ROUTES, margin=margin)
    return Schedules.of(found + [along_route(route, points, top_speed(scene)) for route in ways])


def along_route(route: Route, points: int, speed: float) -> Schedule:
    """Points at equal distances along a route, taken at a speed in m/s."""
    ways = route.length * np.arange(1, points + 1) / (points + 1)
    return Schedule(route.poses(ways), np.full(points, route.length / (points + 1) / speed))


def _preceded(course: Schedule, point: Floats, time: float) -> tuple[Floats, Floats]:
    """The course with another point before it, and without its last."""
    return np.vstack([point, course.points[:-1]]), np.append(time, course.dwell[:-1])
