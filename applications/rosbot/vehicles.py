"""The plants that a scenario can be about, and plans with a law that sees nothing but poses.

A law for the unicycle drives all of them. Equilibrium points are poses: what further states a plant has are 0 there.
"""

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

from applications.rosbot.model import STATES, STEP, car, dynamic_unicycle, unicycle
from applications.rosbot.scenario import Scenario
from gpsynth.arrays import Floats
from gpsynth.builder import Builder
from gpsynth.law import Law
from gpsynth.planning import Particles, Plan, PlanSettings, plans
from gpsynth.plant import Plant
from gpsynth.problem import Problem
from gpsynth.program import Program
from gpsynth.schedule import Schedule, Schedules

POSE = len(STATES)
NOTHING = 1e-9  # half the range of a state that equilibrium points leave at 0


def plant_of(scenario: Scenario) -> Plant:
    """The scenario's robot under its limits."""
    limits = scenario.speed_limits, scenario.turn_limits
    if scenario.model == "dynamic_unicycle":
        return dynamic_unicycle(*limits)
    if scenario.model == "car":
        return car(*limits, turning_radius=scenario.turning_radius)
    return unicycle(*limits)


def law_for(law: Law, plant: Plant) -> Law:
    """A law that steers v and omega by a pose, for another plant with a pose."""
    return Law(plant, features_for(law.features, plant), law.program, law.parameters)


def features_for(features: Program, plant: Plant) -> Program:
    """Features of a pose and its target as those of a plant with further states."""
    states = plant.state_names
    builder = Builder((*states, *(f"{name}_target" for name in states)))
    of = dict(zip((*states, *(f"{name}_target" for name in states)), builder.inputs, strict=True))
    return builder.build(builder.inline(features, [of[name] for name in features.inputs]), features.names)


def step_of(scenario: Scenario, period: float) -> float:
    """The step (s) of the integration: short enough for lags."""
    return STEP if scenario.model == "dynamic_unicycle" else period


def widened(poses: Floats, plant: Plant) -> Floats:
    """Poses (..., 3) as states (..., n), the further ones 0."""
    further = len(plant.state_names) - POSE
    return np.concatenate([poses, np.zeros((*poses.shape[:-1], further))], axis=-1)


def first_state(scenario: Scenario, plant: Plant) -> Floats:
    """The state (n,) that the scenario's robot starts in."""
    return np.append(scenario.start, scenario.speeds)[: len(plant.state_names)]


def steered(scenario: Scenario, controls: Floats) -> Floats:
    """The v and omega (m, 2) that a robot makes of the controls it is given."""
    if scenario.model != "car":
        return controls
    sharpest = np.abs(controls[:, 0]) / scenario.turning_radius
    return np.column_stack([controls[:, 0], np.clip(controls[:, 1], -sharpest, sharpest)])


def pose_plans(
    problem: Problem,
    law: Law,
    settings: PlanSettings,
    *,
    seed: int,
    initial: Schedules,
    region: tuple[Floats, Floats],
    budget: float,
    path: tuple[int, ...],
    threads: int = 1,
    stop: Callable[[], bool] | None = None,
) -> Iterator[Plan]:
    """`gpsynth.planning.plans` for a plant with a pose and perhaps more, all points being poses (3,)."""
    plant = problem.plant
    further = np.full(len(plant.state_names) - POSE, NOTHING)
    found = plans(
        problem,
        law,
        settings,
        seed=seed,
        initial=Schedules(widened(initial.points, plant), initial.dwell),
        region=(np.append(region[0], -further), np.append(region[1], further)),
        budget=budget,
        path=path,
        threads=threads,
        stop=stop,
    )
    return found if not len(further) else map(_narrowed, found)


def _narrowed(plan: Plan) -> Plan:
    points, schedules = plan.schedule.points[:, :POSE], plan.particles.schedules
    particles = Particles(Schedules(schedules.points[..., :POSE], schedules.dwell), plan.particles.costs)
    return replace(plan, schedule=Schedule(points, plan.schedule.dwell), particles=particles)
