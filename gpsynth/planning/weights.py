"""What a plan may be asked for beside little time: less energy, gentle turns, room around it, a steady heading."""

from dataclasses import astuple, dataclass, fields, replace
from functools import reduce
from math import inf
from typing import Any

import numpy as np

from gpsynth.builder import bind
from gpsynth.checks import check_kind, check_number
from gpsynth.errors import ProblemError
from gpsynth.obstacles import Obstacles
from gpsynth.plant_parts import TIME
from gpsynth.problem import Problem
from gpsynth.tracing import Names, inline, trace


@dataclass(frozen=True)
class Weights:
    """How many seconds a plan may take longer to be rid of one second of each of these, at its worst.

    Raises ProblemError if one is no number of at least 0.
    """

    energy: float = 0.0  # mean over the controls of (u / largest)^2
    smoothness: float = 0.0  # sum over the angles of (rate in rad/s)^2
    clearance: float = (
        0.0  # (1 - gap / comfort)^2 for the nearest obstacle, where it is nearer than `comfort`
    )
    heading: float = 0.0  # mean over the angles of (1 - cos(angle - that of the goal)) / 2
    comfort: float = 0.3  # m

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            check_number(f"the weight {field.name}", value)
            if not 0.0 <= value < inf:
                raise ProblemError(f"the weight {field.name} must be finite and at least 0, not {value}")
        if not self.comfort > 0.0:
            raise ProblemError("comfort must be greater than 0 m")

    @property
    def is_time_alone(self) -> bool:
        """Whether nothing else counts."""
        return not any(astuple(self)[:4])


def weighted(problem: Problem, weights: Weights) -> Problem:
    """The problem whose running cost, per second, is 1 and what the weights add; the same one if that is nothing.

    Raises ProblemError for a weight of what the problem does not have: angles, obstacles.
    """
    check_kind("weights", weights, Weights)
    if weights.is_time_alone:
        return problem
    plant = problem.plant
    if (weights.smoothness or weights.heading) and not plant.angles:
        raise ProblemError(f"smoothness and heading weigh the angles of a plant; {plant.name} has none")
    if weights.clearance and (problem.obstacles is None or not len(problem.obstacles.circles)):
        raise ProblemError("clearance is a weight for problems with circles; this one has none")
    if weights.clearance and problem.obstacles is not None:
        for what, given in (
            ("a distance field", problem.obstacles.field),
            ("tracks", problem.obstacles.tracks),
        ):
            if given is not None:
                raise ProblemError(f"clearance weighs circles alone; this problem has {what}")
    terms = (
        (weights.energy, _energy),
        (weights.smoothness, _smoothness),
        (weights.clearance, _nearness),
        (weights.heading, _away),
    )
    chosen = [(weight, term) for weight, term in terms if weight]

    def seconds(x: Any, u: Any, goal: Any, t: Any) -> Any:
        return 1.0 + sum(weight * term(problem, weights, (x, u, goal, t)) for weight, term in chosen)

    goal = {name: f"{name}_goal" for name in plant.states}
    arguments: list[tuple[str, Names]] = [
        ("x", plant.state_names),
        ("u", plant.control_names),
        ("goal", goal),
        (TIME, TIME),
    ]
    return replace(problem, running=trace(seconds, arguments, ("seconds",)))


Arguments = tuple[Any, Any, Any, Any]  # states, controls, goal, time, all traced


def _energy(problem: Problem, _: Weights, given: Arguments) -> Any:
    limits = {name: max(-low, high) for name, (_, low, high) in problem.plant.controls.items()}
    shares = [np.square(getattr(given[1], name) / limit) for name, limit in limits.items()]
    return sum(shares) / len(shares)


def _smoothness(problem: Problem, _: Weights, given: Arguments) -> Any:
    plant, (x, u, _, t) = problem.plant, given
    values = [getattr(x, name) for name in plant.states] + [getattr(u, name) for name in plant.controls]
    rates = inline(bind(plant.dynamics, plant.nominal.tolist()), [*values, t])
    named = dict(zip(plant.states, rates, strict=True))
    return sum(np.square(named[name]) for name in plant.angles)


def _nearness(problem: Problem, weights: Weights, given: Arguments) -> Any:
    obstacles = problem.obstacles
    assert obstacles is not None
    centers = [(*_center(obstacles, part, given[0]), part[2]) for part in obstacles.body.tolist()]
    gaps = [_gap(center, circle, given[3]) for center in centers for circle in obstacles.circles.tolist()]
    share = np.maximum(0.0, 1.0 - reduce(np.minimum, gaps) / weights.comfort)
    return np.square(share)


def _center(obstacles: Obstacles, part: list[float], x: Any) -> tuple[Any, Any]:
    """Where a circle of the body is, at a pose."""
    east, north, *heading = (getattr(x, name) for name in obstacles.position)
    ahead, left, _ = part
    if not heading:
        return east, north
    cosine, sine = np.cos(heading[0]), np.sin(heading[0])
    return east + ahead * cosine - left * sine, north + ahead * sine + left * cosine


def _gap(center: tuple[Any, Any, float], circle: list[float], t: Any) -> Any:
    x, y, vx, vy, radius = circle
    return np.hypot(center[0] - (x + vx * t), center[1] - (y + vy * t)) - (radius + center[2])


def _away(problem: Problem, _: Weights, given: Arguments) -> Any:
    x, _, goal, _ = given
    turns = [0.5 * (1.0 - np.cos(getattr(x, name) - getattr(goal, name))) for name in problem.plant.angles]
    return sum(turns) / len(turns)
