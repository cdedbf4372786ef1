"""Scenarios as problems of the package: what laws are rolled out on, each under the scenario's limits."""

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np

from applications.rosbot.model import reached
from applications.rosbot.others import tracks_of
from applications.rosbot.scenario import Scenario
from applications.rosbot.vehicles import first_state, law_for, plant_of, step_of, widened
from gpsynth.checks import check_kind
from gpsynth.errors import ScenarioError
from gpsynth.law import Law
from gpsynth.obstacles import Obstacles
from gpsynth.plant import Plant
from gpsynth.problem import Problem

PERIOD = 0.05  # s of the control: 2.5 cm at 0.5 m/s; twice as long costs time at every switch, half as long computing
INSIDE = (0.001, 0.002)  # m, rad: how far within the tolerance a plan arrives, so that no rounding undoes it


def problem_of(scenario: Scenario, law: Law) -> Problem:
    """The scenario as a problem for a law under its limits: least time into the tolerance, a little within its edge."""
    tolerances = scenario.position_tolerance, scenario.heading_tolerance
    return replace(
        _like(law, *tolerances, step_of(scenario, PERIOD)),
        starts=first_state(scenario, law.plant),
        goal=widened(scenario.goal, law.plant),
        horizon=max(PERIOD, scenario.time_limit - PERIOD),
        obstacles=_obstacles(scenario),
    )


@lru_cache(maxsize=32)
def _like(law: Law, position: float, heading: float, step: float) -> Problem:
    """A problem with the programs of all problems for this law and tolerance (m, rad): to trace them takes a while."""
    shrunk = max(0.5 * position, position - INSIDE[0]), max(0.5 * heading, heading - INSIDE[1])
    nowhere = widened(np.zeros(3), law.plant)
    return Problem(
        law.plant,
        nowhere,
        nowhere,
        tolerance=[shrunk[0], shrunk[0], shrunk[1], *np.ones(len(nowhere) - 3)],
        period=PERIOD,
        step=step,
        features=law.features,
        reached=reached(*shrunk),
    )


def _obstacles(scenario: Scenario) -> Obstacles:
    if scenario.is_round:
        return Obstacles(
            scenario.circles,
            scenario.bounds,
            scenario.radius,
            field=scenario.field,
            tracks=tracks_of(scenario.others, PERIOD),
        )
    position = ("x", "y", "theta")
    return Obstacles(scenario.circles, scenario.bounds, 0.0, position, scenario.body, scenario.field)


def problems_of(scenario: Scenario, laws: Sequence[Law]) -> list[tuple[Problem, Law]]:
    """The laws under the scenario's limits, each with the problem as it sees it.

    Raises ScenarioError if there is no law, or one that does not steer v and omega.
    """
    check_kind("laws", laws, list, tuple, error=ScenarioError)
    if not laws:
        raise ScenarioError("a plan needs at least one law")
    for law in laws:
        check_kind("one of the laws", law, Law, error=ScenarioError)
        if law.plant.control_names != ("v", "omega"):
            raise ScenarioError(
                f"the law steers {', '.join(law.plant.control_names)}; a scenario needs v, omega"
            )
    plant = plant_of(scenario)
    adapted = [_carried(law, plant) for law in laws]
    return [(problem_of(scenario, law), law) for law in adapted]


@lru_cache(maxsize=32)
def _carried(law: Law, plant: Plant) -> Law:
    return law_for(law, plant)
