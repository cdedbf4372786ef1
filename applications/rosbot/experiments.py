"""The two experiments of Shmalko & Yamshanov, section V, each under two readings of its limits.

`paper-replica`: two wheel commands within ±10 without a scale, a robot of no size, points in obstacles counted, equal
dwell times, inertia 1.0, a point left as soon as it is reached: the reading under which the paper's 4.5 s and 3 s are
possible, and under which points may collapse onto the start at no cost. `physical`: |v| and |omega| at most 0.5, the
robot's real size, the whole path clear of obstacles, free dwell times that run to their end.
"""

from dataclasses import dataclass
from typing import Literal

from applications.rosbot.model import reached, unicycle, wheel_coupled
from applications.rosbot.polar_law import SATURATING, Gains, polar_law
from applications.rosbot.scenario import Scenario
from gpsynth.law import Law
from gpsynth.obstacles import Obstacles
from gpsynth.planning import PlanSettings
from gpsynth.problem import Problem

Reading = Literal["paper-replica", "physical"]


@dataclass(frozen=True, eq=False)
class Experiment:
    """All that `plan` needs."""

    problem: Problem
    law: Law
    settings: PlanSettings


def experiment(
    scenario: Scenario, reading: Reading, law: Law | None = None, *, gains: Gains = SATURATING
) -> Experiment:
    """An experiment of the paper: 18 s and 6 segments with obstacles, 15 s and 5 segments without.

    The law is the polar law with these gains unless one for the reading's plant is given.
    """
    replica = reading == "paper-replica"
    plant = wheel_coupled(10.0) if replica else unicycle(scenario.speed_limits, scenario.turn_limits)
    law = law or polar_law(plant, gains)
    horizon, segments = (18.0, 6) if len(scenario.circles) else (15.0, 5)
    problem = Problem(
        law.plant,
        scenario.start,
        scenario.goal,
        tolerance=[scenario.position_tolerance] * 2 + [scenario.heading_tolerance],
        horizon=horizon,
        period=0.01 if replica else 0.05,  # at 10 m/s the robot moves 10 cm in a hundredth of a second
        features=law.features,
        reached=reached(scenario.position_tolerance, scenario.heading_tolerance),
        obstacles=Obstacles(scenario.circles, scenario.bounds, 0.0 if replica else scenario.radius),
    )
    settings = PlanSettings.paper(segments - 1) if replica else PlanSettings(points=segments - 1)
    return Experiment(problem, law, settings)
