"""OMPL from PyPI: RRT* and BIT* over Reeds-Shepp curves, SST and RRT over controls.

In the Reeds-Shepp space of radius v / omega, length over top speed is the time of a drivable path, so both trees
minimize exactly what is compared. The control planners draw v and omega themselves. OMPL has one random generator for
all of a process, so a seed would not make an answer repeatable, and is not used.
"""

import math
from collections.abc import Callable, Iterator
from typing import Any

import numba
import numpy as np

from applications.rosbot.discs import grown
from applications.rosbot.guides import top_speed
from applications.rosbot.reeds_shepp import ReedsSheppPath, paths
from applications.rosbot.scenario import Scenario
from gpsynth.arrays import Floats
from tests.bench.planners.attempt import MARGIN, Answer, Watch

SLICE = 0.03  # s, after which the best path so far is looked at
SPACING = 0.02  # m, between the states of a path that are checked
TIE = 1e-6  # m; two words of this little difference are told apart by where they lead
PERIOD = 0.05  # s, of which a control planner holds its controls 1 to 20


@numba.njit
def is_free(x: float, y: float, discs: Floats, bounds: Floats) -> bool:
    """Whether the robot's center may be there; discs (c, 3) are grown."""
    if not (bounds[0] <= x <= bounds[1] and bounds[2] <= y <= bounds[3]):
        return False
    for k in range(len(discs)):
        dx, dy = x - discs[k, 0], y - discs[k, 1]
        if dx * dx + dy * dy < discs[k, 2] * discs[k, 2]:
            return False
    return True


def over_curves(name: str) -> Callable[[Scenario, int, Watch], Iterator[Answer]]:
    """RRTstar or BITstar, whose answers get better until the time is up."""

    def plan(scenario: Scenario, seed: int, watch: Watch) -> Iterator[Answer]:
        from ompl import base, geometric

        radius = top_speed(scenario) / min(map(abs, scenario.turn_limits))
        space = base.ReedsSheppStateSpace(radius)
        setup = geometric.SimpleSetup(space)
        _prepare(setup, space, scenario)
        information = setup.getSpaceInformation()
        information.setStateValidityCheckingResolution(SPACING / space.getMaximumExtent())
        setup.setPlanner(getattr(geometric, name)(information))
        best = np.inf
        for _ in _slices(setup, watch):
            path = setup.getSolutionPath()
            if path.length() < best:
                best = path.length()
                yield Answer(watch.spent, *_driven(space, path, radius, top_speed(scenario)))

    return plan


def over_controls(name: str) -> Callable[[Scenario, int, Watch], Iterator[Answer]]:
    """SST or RRT, which grow their tree by driving."""

    def plan(scenario: Scenario, seed: int, watch: Watch) -> Iterator[Answer]:
        from ompl import base, control

        space = base.SE2StateSpace()
        commands = control.RealVectorControlSpace(space, 2)
        limits = base.RealVectorBounds(2)
        for index, (low, high) in enumerate((scenario.speed_limits, scenario.turn_limits)):
            limits.setLow(index, low)
            limits.setHigh(index, high)
        commands.setBounds(limits)
        setup = control.SimpleSetup(commands)
        _prepare(setup, space, scenario)
        setup.setStatePropagator(_propagate)
        information = setup.getSpaceInformation()
        information.setPropagationStepSize(PERIOD)
        information.setMinMaxControlDuration(1, 20)
        setup.setPlanner(getattr(control, name)(information))
        best = np.inf
        for _ in _slices(setup, watch):
            path = setup.getSolutionPath()
            count = path.getControlCount()
            durations = np.array([path.getControlDuration(k) for k in range(count)])
            if durations.sum() < best:
                best = durations.sum()
                controls = [[path.getControl(k)[0], path.getControl(k)[1]] for k in range(count)]
                yield Answer(watch.spent, np.array(controls), durations)
            else:
                return  # RRT has come to its end with its first path

    return plan


def no_constructor(name: str) -> str:
    """Why a control planner cannot be used: some wheels bind its class and forget its constructor."""
    from ompl import control

    bound = "Initialize self" not in (getattr(control, name).__init__.__doc__ or "")
    return "" if bound else f"this wheel of ompl has no constructor of control.{name}"


def _prepare(setup: Any, space: Any, scenario: Scenario) -> None:
    from ompl import base, util

    util.setLogLevel(util.LOG_ERROR)
    bounds = base.RealVectorBounds(2)
    for axis in (0, 1):
        bounds.setLow(axis, float(scenario.bounds[2 * axis]))
        bounds.setHigh(axis, float(scenario.bounds[2 * axis + 1]))
    space.setBounds(bounds)
    discs, limits = grown(scenario.discs, MARGIN), np.array(scenario.bounds)
    setup.setStateValidityChecker(lambda state: is_free(state.getX(), state.getY(), discs, limits))
    # The distance is that of the places and half of that of the headings, so that this is within both tolerances.
    tolerance = 0.98 * min(scenario.position_tolerance, 0.5 * scenario.heading_tolerance)
    setup.setStartAndGoalStates(_state(space, scenario.start), _state(space, scenario.goal), tolerance)


def _state(space: Any, pose: Floats) -> Any:
    state = space.allocState()
    state.setX(float(pose[0]))
    state.setY(float(pose[1]))
    state.setYaw(float(np.remainder(pose[2] + np.pi, 2.0 * np.pi) - np.pi))
    return state


def _slices(setup: Any, watch: Watch) -> Iterator[None]:
    """After every slice of time in which there is a path that ends at the goal."""
    from ompl import base

    while not watch.is_over:
        end = min(watch.spent + SLICE, watch.limit)
        setup.solve(base.PlannerTerminationCondition(lambda end=end: watch.spent >= end))
        if setup.haveExactSolutionPath():
            yield


def _driven(space: Any, path: Any, radius: float, speed: float) -> tuple[Floats, Floats]:
    """Controls and durations along a path of Reeds-Shepp curves."""
    states = [path.getState(k) for k in range(path.getStateCount())]
    poses = np.array([[state.getX(), state.getY(), state.getYaw()] for state in states])
    middle, controls, durations = space.allocState(), [], []
    for k in range(len(poses) - 1):
        space.interpolate(states[k], states[k + 1], 0.5, middle)
        curve = _through(poses[k], poses[k + 1], np.array([middle.getX(), middle.getY()]), radius)
        senses = np.sign(curve.lengths)
        controls.append(np.column_stack([speed * senses, speed / radius * senses * np.array(curve.turns)]))
        durations.append(np.abs(curve.lengths) / speed)
    return np.concatenate(controls), np.concatenate(durations)


def _through(start: Floats, goal: Floats, middle: Floats, radius: float) -> ReedsSheppPath:
    """The shortest curve between two poses; of equally short ones that which OMPL has checked."""
    curves = paths(start, goal, radius)
    shortest = [curve for curve in curves if curve.length <= curves[0].length + TIE]
    return min(
        shortest, key=lambda curve: np.hypot(*(curve.poses(np.array([0.5 * curve.length]))[0, :2] - middle))
    )


def _propagate(start: Any, control: Any, duration: float, result: Any) -> None:
    x, y, heading = start.getX(), start.getY(), start.getYaw()
    half = 0.5 * control[1] * duration
    chord = control[0] * duration * (math.sin(half) / half if half else 1.0)
    result.setX(x + chord * math.cos(heading + half))
    result.setY(y + chord * math.sin(heading + half))
    result.setYaw(math.remainder(heading + 2.0 * half, 2.0 * math.pi))
