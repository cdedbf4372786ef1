"""Stage 1's problem for the ROSbot: from anywhere to a target that stays, in least time."""

from typing import Any

import numpy as np

from applications.rosbot.model import STATES, STEP, Pose, features, reached, unicycle
from gpsynth.arrays import Floats
from gpsynth.draws import Draws
from gpsynth.plant import Plant
from gpsynth.problem import Method, Problem
from gpsynth.tracing import where, wrap_angle

POSITION, HEADING = 0.05, 0.1  # m, rad: tolerance of arrival
BOX = 3.0  # m
SEAM = (0.01, 0.3, 0.01)  # of BOX and of half a turn: 3 cm, 0.9 m, 2 degrees


def poses(rng: np.random.Generator, count: int, box: float = BOX) -> Floats:
    """Random poses (count, 3): x and y within ±box m, any heading."""
    heading = rng.uniform(-np.pi, np.pi, (count, 1))
    return np.concatenate([rng.uniform(-box, box, (count, 2)), heading], axis=1)


def training_poses(rng: np.random.Generator, count: int) -> Floats:
    """Half of the poses within ±3 m, a quarter within ±0.3 m, an eighth at the goal with another heading.

    The last eighth lies within SEAM of standing beside the goal, turned half round: bearing and heading error both jump
    there, and some laws that arrive from everywhere else go to and fro for ever.
    """
    scale = np.resize([[1.0, 1.0, 1.0], [1.0, 1.0, 1.0], [0.1, 0.1, 1.0], [0.0, 0.0, 1.0]], (count, 3))
    scale[7::8] = SEAM
    drawn: Floats = scale * poses(rng, count)
    drawn[7::8, 2] += np.pi
    return drawn


def stabilization(
    starts: Floats,
    *,
    period: float = 0.05,
    horizon: float = 30.0,
    method: Method = "rk4",
    plant: Plant | None = None,
    stop: bool = True,
    draws: Draws | None = None,
    step: float = STEP,
) -> Problem:
    """Bring the robot from `starts` (S, 3) to the origin with heading 0 in least time; with stop=False, keep it there.

    Running cost is the time outside the tolerance and a tenth of what is missing; a run that is not within it at the
    horizon (s) pays for the rest. On a plant with speeds among its states the robot starts from rest, and steps (s) are
    at most as long as `step`.
    """
    plant = plant or unicycle()
    speeds = len(plant.states) - len(STATES)
    return Problem(
        plant,
        np.pad(np.atleast_2d(starts), ((0, 0), (0, speeds))),
        goal=np.zeros(len(plant.states)),
        tolerance=(POSITION, POSITION, HEADING, *[1.0] * speeds),
        horizon=horizon,
        period=period,
        step=period / np.ceil(period / step - 1e-9) if speeds else period,
        method=method,
        features=features,
        reached=reached(POSITION, HEADING),
        running=_away,
        terminal=_missing,
        stop=stop,
        draws=draws,
    )


def _away(x: Pose, u: Pose, goal: Pose) -> Any:
    distance, turn = _errors(x, goal)
    outside = where((distance <= POSITION) & (turn <= HEADING), 0.0, 1.0)
    return outside + 0.1 * (distance + turn)


def _missing(x: Pose, goal: Pose) -> Any:
    """What a run pays that ends away from the goal, in s: about the time that mending it would take, and 10 more."""
    distance, turn = _errors(x, goal)
    return where((distance <= POSITION) & (turn <= HEADING), 0.0, 10.0 + 5.0 * distance + 3.0 * turn)


def _errors(x: Pose, goal: Pose) -> tuple[Any, Any]:
    return np.hypot(goal.x - x.x, goal.y - x.y), np.abs(wrap_angle(goal.theta - x.theta))
