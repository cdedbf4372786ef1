"""Stage 1 for the ROSbot: the problem, the search, and the law that ships with the application."""

from collections.abc import Callable
from pathlib import Path
from types import MappingProxyType
from typing import Any, Literal, get_args

import numpy as np

from applications.rosbot.model import DELAY, dynamic_unicycle
from applications.rosbot.stabilization import stabilization, training_poses
from applications.rosbot.training import plan_cost, training_scenarios
from gpsynth.draws import Draws, random_draws
from gpsynth.encodings.cartesian import CartesianEncoding
from gpsynth.encodings.parameters import ParameterSpace
from gpsynth.encodings.tree import TreeEncoding
from gpsynth.encodings.variational import VariationalEncoding
from gpsynth.errors import EncodingError, ProblemError
from gpsynth.islands import Islands
from gpsynth.law import Law
from gpsynth.optimizers import Progress
from gpsynth.planning import PlanCost
from gpsynth.problem import Problem
from gpsynth.seeds import stream
from gpsynth.structure_search import SearchState
from gpsynth.synthesis import SynthesisResult, synthesize

Wanted = Literal["plans", "settling"]
OPERATIONS = ("add", "sub", "mul", "min", "max", "abs", "square", "tanh", "sin", "cos", "atan")
# all continuous, and no division: laws with sgn, atan2 or roots arrive as early, but chatter on the way
SEARCH_BUDGET = 80_000  # parameter vectors
TASKS, WEIGHT = (
    10,
    0.5,
)  # scenarios whose plans count, two of each kind, and their mean beside that of the starts
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
LAG = 0.05  # s
QUICK = MappingProxyType({"k_v": 1.0, "k_omega": 1.0, "a_v": 100.0, "a_omega": 100.0})
_ROUGH, _TUNING, _UNSEEN, _DRAWS = 101, 102, 103, 104  # streams of the starts and of the draws


def default_law() -> Law:
    """The law that ships with the application; `python -m applications.rosbot synthesize` shows where it comes from."""
    return Law.load(_LAW)


def synthesize_stabilizer(
    *,
    seed: int,
    budget: int = SEARCH_BUDGET,
    encoding: Literal["tree", "cartesian", "network-operator"] = "tree",
    objective: Wanted = "plans",
    folder: Path | None = None,
    resume: bool = False,
    threads: int = 2,
    progress: bool = False,
    callback: Callable[[Progress[SearchState[Any]]], bool | None] | None = None,
) -> SynthesisResult:
    """Find the stabilizer from scratch: a law that reaches every target and holds it, and that plans are fast with.

    Searched from 64 starts at 0.1 s, half of them on the dynamics, each under a draw of its own; tuned from 256 others
    on the dynamics at 0.05 s; scored on 2048 more on the dynamics, and on the kinematics at 0.05 s and 0.005 s. All
    through, what plans of TASKS generated scenarios cost is added (`training.plan_cost`). The objective "settling"
    leaves that out, searches on the kinematics alone and tunes from 64 starts. Checkpoints in `folder` and `resume` are
    those of `synthesize`. Raises ProblemError or EncodingError for another objective or encoding.
    """
    if objective not in get_args(Wanted):
        raise ProblemError(f"objective must be plans or settling, not {objective!r}")
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
        plans=_plans(seed) if objective == "plans" else None,
        rough=_kinematics(seed) if objective == "settling" else _dynamics(seed, _ROUGH, 64, quick=True),
        tuned=_dynamics(seed, _TUNING, 64 if objective == "settling" else 256),
        trials=trials,
        islands=ISLANDS if budget >= ENOUGH else None,
        folder=folder,
        resume=resume,
        threads=threads,
        progress=progress,
        callback=callback,
    )


def _plans(seed: int) -> PlanCost:
    return plan_cost(training_scenarios(TASKS, seed=seed), seed=seed, weight=WEIGHT)


def _kinematics(seed: int) -> Problem:
    starts = training_poses(stream(seed, _ROUGH), 64)
    return stabilization(starts, period=0.1, horizon=20.0, method="heun", stop=False)


def _dynamics(seed: int, which: int, count: int, *, quick: bool = False) -> Problem:
    """Each start under a draw; lags below LAG would need shorter steps, and to a law they are all the same.

    With `quick`, at the rough period, every second robot does at once what it is told, as far as LAG allows: laws that
    only lags keep from going to and fro lose, and so do those that lags or delays unsettle.
    """
    plant, starts = dynamic_unicycle(), training_poses(stream(seed, which), count)
    draws = random_draws(plant, stream(seed, which, _DRAWS), count, delay=DELAY)
    lags = [name.startswith("tau") for name in plant.parameter_names]
    parameters = np.where(lags, np.maximum(draws.parameters, LAG), draws.parameters)
    delay = draws.delay.copy()
    if quick:
        parameters[1::2] = [QUICK.get(name, LAG) for name in plant.parameter_names]
        delay[1::2] = 0.0
    return stabilization(
        starts,
        period=0.1 if quick else 0.05,
        horizon=20.0,
        method="heun",
        plant=plant,
        stop=False,
        draws=Draws(parameters, delay=delay),
        step=LAG,
    )


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
