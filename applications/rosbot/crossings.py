"""Random crossings: a way of several meters that discs cross at constant velocity, timed to meet the robot."""

import numpy as np

from applications.rosbot.scenario import Scenario
from gpsynth.arrays import Floats
from gpsynth.seeds import stream

MOVERS = (3, 10)
SPEEDS = (0.1, 0.4)  # m/s
RADII = (0.15, 0.35)  # m
WAY = (4.0, 7.0)  # m from start to goal
PACE = 0.45  # m/s at which the robot is expected on its way
SOONEST = 2.0  # s; nothing is on the robot's way earlier
JITTER = 2.0  # s, standard deviation of when a mover crosses
ROOM = 0.6  # m between the robot and any mover at the start
BOUNDS = np.array([-2.0, 9.0, -4.0, 4.0])  # m


def crossing(number: int, *, seed: int = 0) -> Scenario:
    """Scene `number` of a seed: 3 to 10 movers of up to 0.4 m/s that cross the straight way to the goal."""
    rng = stream(seed, number)
    way = rng.uniform(*WAY)
    start = np.array([0.0, 0.0, rng.uniform(-np.pi, np.pi) / 3.0])
    goal = np.array([way, rng.uniform(-1.0, 1.0), rng.uniform(-np.pi, np.pi) / 3.0])
    count = int(rng.integers(MOVERS[0], MOVERS[1] + 1))
    circles: list[Floats] = []
    while len(circles) < count:
        share = rng.uniform(0.1, 0.95)
        meeting = start[:2] + share * (goal - start)[:2]
        when = max(SOONEST, share * float(np.hypot(*(goal - start)[:2])) / PACE + JITTER * rng.normal())
        circle = mover(meeting, when, rng)
        if np.hypot(*(circle[:2] - start[:2])) - circle[4] - Scenario.radius >= ROOM:
            circles.append(circle)
    return Scenario(start, goal, bounds=BOUNDS, circles=np.array(circles), name=f"crossing_{number:03}")


def mover(place: Floats, when: float, rng: np.random.Generator) -> Floats:
    """A disc (x, y, vx, vy, radius) that comes to a place (2,) after so many seconds."""
    speed, direction = rng.uniform(*SPEEDS), rng.uniform(-np.pi, np.pi)
    velocity = speed * np.array([np.cos(direction), np.sin(direction)])
    return np.concatenate([place - when * velocity, velocity, [rng.uniform(*RADII)]])
