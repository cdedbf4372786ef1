"""Stage 1 for the ROSbot: the problem, the search, and the law that ships with the application."""

from collections.abc import Callable
from pathlib import Path
from types import MappingProxyType
from typing import Any, Literal

import numpy as np

from applications.rosbot.model import DELAY, STATES, STEP, Pose, dynamic_unicycle, features, reached, unicycle
from gpsynth.arrays import Floats
from gpsynth.draws import Draws, random_draws
from gpsynth.encodings.cartesian import CartesianEncoding
from gpsynth.encodings.parameters import ParameterSpace
from gpsynth.encodings.tree import TreeEncoding
from gpsynth.encodings.variational import VariationalEncoding
from gpsynth.errors import EncodingError
from gpsynth.islands import Islands
from gpsynth.law import Law
from gpsynth.optimizers import Progress
from gpsynth.plant import Plant
from gpsynth.problem import Method, Problem
from gpsynth.seeds import stream
from gpsynth.structure_search import SearchState
from gpsynth.synthesis import SynthesisResult, synthesize
from gpsynth.tracing import where, wrap_angle

OPERATIONS = ("add", "sub", "mul", "min", "max", "abs", "square", "tanh", "sin", "cos", "atan")
# all continuous, and no division: laws with sgn, atan2 or roots arrive as early, but chatter on the way
POSITION, HEADING = 0.05, 0.1  # m, rad: tolerance of arrival
SEARCH_BUDGET = 80_000  # parameter vectors
ISLANDS, ENOUGH = Islands(8), 40_000  # islands, and the budget from which each has enough
# The first sign: left and right change places. The second: the robot turns round, so that forward is backward. A law
# without these symmetries can be good on its training; it reaches the goal by turning the same way all the time.
SYMMETRIES = MappingProxyType(
    {
        **{"error_x": "+-", "error_y": "--", "error_theta": "-+", "distance": "++"},
        **{"bearing": "-+", "approach": "-+", "heading": "-+", "v": "+-", "omega": "-+"},
    }
)
_LAW = Path(__file__).with_name("law.json")
BOX = 3.0  # m
SEAM = (0.01, 0.3, 0.01)  # of BOX and of half a turn: 3 cm, 0.9 m, 2 degrees
LAG = 0.05  # s
_ROUGH, _TUNING, _UNSEEN, _DRAWS = 101, 102, 103, 104  # streams of the starts and of the draws


def default_law() -> Law:
    """The law that ships with the application; `python -m applications.rosbot synthesize` shows where it comes from."""
    return Law.load(_LAW)


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


def synthesize_stabilizer(
    *,
    seed: int,
    budget: int = SEARCH_BUDGET,
    encoding: Literal["tree", "cartesian", "network-operator"] = "tree",
    folder: Path | None = None,
    resume: bool = False,
    threads: int = 2,
    progress: bool = False,
    callback: Callable[[Progress[SearchState[Any]]], bool | None] | None = None,
) -> SynthesisResult:
    """Find the stabilizer from scratch: a law that reaches every target and holds it.

    Searched on the kinematics from 64 starts at 0.1 s; tuned on the dynamics from 64 others, each under a draw of its
    own, at 0.05 s; scored on 2048 more on the dynamics, and on the kinematics at 0.05 s and 0.005 s. Checkpoints in
    `folder` and `resume` are those of `synthesize`.
    """
    unseen = training_poses(stream(seed, _UNSEEN), 2_048)
    problem = stabilization(unseen, stop=False)
    trials = [stabilization(unseen, period=0.005, stop=False)]
    draws = random_draws(dynamic_unicycle(), stream(seed, _DRAWS), len(unseen), delay=DELAY)
    trials.append(stabilization(unseen, plant=dynamic_unicycle(), draws=draws, stop=False))
    chosen = _encoding(encoding, problem)
    return synthesize(
        *(problem, chosen),
        seed=seed,
        budget=budget,
        tuning=300,
        rough=stabilization(
            training_poses(stream(seed, _ROUGH), 64), period=0.1, horizon=20.0, method="heun", stop=False
        ),
        tuned=_tuning(seed),
        trials=trials,
        islands=ISLANDS if budget >= ENOUGH else None,
        folder=folder,
        resume=resume,
        threads=threads,
        progress=progress,
        callback=callback,
    )


def _tuning(seed: int) -> Problem:
    """Dynamics in long steps: lags below LAG would need shorter ones, and to a law they are all the same."""
    plant, starts = dynamic_unicycle(), training_poses(stream(seed, _TUNING), 64)
    draws = random_draws(plant, stream(seed, _TUNING, _DRAWS), len(starts), delay=DELAY)
    lags = [name.startswith("tau") for name in plant.parameter_names]
    slower = Draws(np.where(lags, np.maximum(draws.parameters, LAG), draws.parameters), delay=draws.delay)
    return stabilization(starts, horizon=20.0, method="heun", plant=plant, stop=False, draws=slower, step=LAG)


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


def _encoding(name: str, problem: Problem) -> Any:
    inputs, outputs = problem.features.names, tuple(problem.plant.control_names)
    space = ParameterSpace(8, -10.0, 10.0)
    if name == "tree":
        return TreeEncoding(inputs, outputs, OPERATIONS, space, max_size=20, symmetries=SYMMETRIES)
    if name == "cartesian":
        return CartesianEncoding(inputs, outputs, OPERATIONS, space)
    if name == "network-operator":
        return VariationalEncoding(inputs, outputs, space=ParameterSpace(len(inputs), -10.0, 10.0))
    raise EncodingError(f"encoding must be tree, cartesian or network-operator, not {name!r}")
