"""What a planner of the comparison is, and what it hands in."""

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from applications.rosbot.guides import Guide, direct_guides, guides_along
from applications.rosbot.routes import routes
from applications.rosbot.scenario import Scenario
from gpsynth.arrays import Floats

BLOCKED = 1.0  # s of score: a line that cuts obstacles by this much is not one to follow
MARGIN = 2e-3  # m, clearance that planners which check samples only keep in hand


class Answer(NamedTuple):
    """A plan, and the processor time (s) after which it was there."""

    spent: float
    controls: Floats  # (n, 2) v, omega
    durations: Floats  # (n,) s


@dataclass(frozen=True)
class Watch:
    """Processor time of this process since it was made; planners that can stop at any time do so at `limit` (s)."""

    limit: float
    began: float = field(default_factory=time.process_time)

    @property
    def spent(self) -> float:
        return time.process_time() - self.began

    @property
    def left(self) -> float:
        return self.limit - self.spent

    @property
    def is_over(self) -> bool:
        return self.left <= 0.0


class Planner(NamedTuple):
    """Answers in the order in which they are found, each better than the one before if all goes well."""

    name: str
    packages: tuple[str, ...]  # distributions that it needs
    plan: Callable[[Scenario, int, Watch], Iterator[Answer]]  # scenario, seed, watch
    missing: Callable[[], str] = lambda: ""  # why it cannot run although the packages are there


def guides_of(scenario: Scenario, *, count: int = 3) -> list[Guide]:
    """Drivable lines for planners that begin at one: the best of each of `count` routes and the best direct one.

    They are the ones that gpsynth's own swarms begin at; those that cut obstacles come last.
    """
    found = guides_along(scenario, routes(scenario, count=count, margin=MARGIN))
    bests = [guides[0] for guides in (*found, direct_guides(scenario)) if guides]
    return sorted(bests, key=lambda guide: (guide.score > guide.duration + BLOCKED, guide.score))


def resampled(guide: Guide, count: int) -> Floats:
    """`count` poses (count, 3) at equal times along a guide, headings without jumps."""
    poses = np.column_stack([guide.poses[:, :2], np.unwrap(guide.poses[:, 2])])
    instants = np.linspace(0.0, guide.duration, count)
    return np.column_stack([np.interp(instants, guide.times, values) for values in poses.T])
