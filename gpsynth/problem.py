"""Problem: from where to where a plant is to be brought, under which clock, what it costs and when it has arrived."""

import functools
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from gpsynth.arrays import Floats, frozen, numbers, shaped
from gpsynth.builder import Builder
from gpsynth.draws import Draws, check_draws
from gpsynth.errors import ProblemError
from gpsynth.obstacles import Obstacles, check_starts
from gpsynth.plant import Plant
from gpsynth.plant_parts import TIME
from gpsynth.program import Program
from gpsynth.signs import nonnegative
from gpsynth.tracing import Names, input_names, takes_time, trace, wrap_angle

MOST_STEPS = 1_000_000  # of a period
METHODS = ("euler", "heun", "rk4")
Method = Literal["euler", "heun", "rk4"]
Function = Callable[..., Any]


@dataclass(frozen=True, eq=False, init=False)
class Problem:
    """What a law is judged by. Functions are traced once and then stand here as Programs.

    Raises ProblemError if the parts do not fit the plant, TracingError if a function cannot become a Program.
    """

    plant: Plant
    starts: Floats  # (S, n)
    goal: Floats  # (n,)
    tolerance: Floats  # (n,) around the goal, in the units of the states
    horizon: float  # s
    period: float  # s, between two evaluations of the law
    step: float  # s, of the integration
    method: Method
    features: Program  # inputs: states, <state>_target; what a law sees
    reached: Program | None  # inputs: states, <state>_goal; at most 0 on arrival; None: all within tolerance
    running: Program  # inputs: states, controls, <state>_goal, t; cost per second
    terminal: Program | None  # inputs: states, <state>_goal; costs at the end
    hold: bool  # the control is held over a period, else computed at every stage of a step
    stop: bool  # the rollout ends on arrival
    obstacles: Obstacles | None
    draws: Draws | None  # the conditions of each start; None: the nominal plant, no delay, no noise

    def __init__(  # noqa: PLR0913 names each choice as a keyword
        self,
        plant: Plant,
        starts: npt.ArrayLike,
        goal: npt.ArrayLike,
        *,
        tolerance: npt.ArrayLike,
        horizon: float = 30.0,
        period: float = 0.05,
        step: float | None = None,
        method: Method = "rk4",
        features: Function | Program | None = None,
        reached: Function | Program | None = None,
        running: Function | Program | None = None,
        terminal: Function | Program | None = None,
        hold: bool = True,
        stop: bool = True,
        obstacles: Obstacles | None = None,
        draws: Draws | None = None,
    ) -> None:
        """`features(x, target)` gives a dictionary of values; by default the error of each state, angles wrapped.

        `reached(x, goal)` gives a measure, by default the largest error in tolerances minus 1; `running(x, u, goal)` or
        `(x, u, goal, t)` a cost per second, by default 1; `terminal(x, goal)` one or several costs, by default none.
        """
        if not isinstance(plant, Plant):
            raise ProblemError(f"a problem needs a Plant, got {plant!r}")
        size = len(plant.states)
        widths = numbers("tolerance", tolerance)
        widths = shaped("tolerance", np.repeat(widths, size) if widths.ndim == 0 else widths, (size,))
        to_goal, to_target = _arguments(plant, "goal"), _arguments(plant, "target")
        at_work = (to_goal[0], ("u", plant.control_names), to_goal[1], (TIME, TIME))
        values = {
            "plant": plant,
            "starts": shaped("starts", np.atleast_2d(numbers("starts", starts)), (-1, size)),
            "goal": shaped("goal", goal, (size,)),
            "tolerance": widths,
            "horizon": _positive("horizon", horizon),
            "period": _positive("period", period),
            "step": _positive("step", period if step is None else step),
            "method": method,
            "features": _program("features", features or _errors(plant), to_target),
            "reached": None if reached is None else _program("reached", reached, to_goal, 1),
            "running": _program("running", running or _time, at_work, 1),
            "terminal": None if terminal is None else _program("terminal", terminal, to_goal),
            "hold": bool(hold),
            "stop": bool(stop),
            "obstacles": obstacles,
            "draws": draws,
        }
        for name, value in values.items():
            object.__setattr__(self, name, value)
        _check(self)

    @cached_property
    def rates(self) -> Program:
        """Derivatives of the states and the running cost; inputs: states, controls, <state>_goal, t.

        Its parameters are the plant's.
        """
        builder = Builder(self.running.inputs, self.plant.parameter_names)
        of = dict(zip(self.running.inputs, builder.inputs, strict=True))
        inputs = [of[name] for name in self.plant.dynamics.inputs]
        derivatives = builder.inline(self.plant.dynamics, inputs, builder.parameters)
        outputs = [*derivatives, *builder.inline(self.running, builder.inputs)]
        return builder.build(outputs, (*self.plant.state_names, "running"))

    @cached_property
    def measured(self) -> Program:
        """The features of a measured state; inputs: states, <state>_target and the errors of the states."""
        states, targets = self.plant.state_names, self.features.inputs[len(self.plant.states) :]
        builder = Builder((*states, *targets, *(f"_error_{name}" for name in states)))
        given = builder.inputs
        seen = [
            builder.apply("add", state, error)
            for state, error in zip(given, given[2 * len(states) :], strict=False)
        ]
        wrapped = [
            builder.apply("wrap", value) if name in self.plant.angles else value
            for name, value in zip(states, seen, strict=True)
        ]
        outputs = builder.inline(self.features, [*wrapped, *given[len(states) : 2 * len(states)]])
        return builder.build(outputs, self.features.names)

    @cached_property
    def plant_parameters(self) -> Floats:
        """The plant's parameters (S, q) at each start."""
        if self.draws is not None and self.draws.parameters.shape[1] > 0:
            return self.draws.parameters
        return frozen(np.tile(self.plant.nominal, (len(self.starts), 1)))

    @cached_property
    def costs_nonnegative(self) -> bool:
        """Whether the running cost and all terminal costs are proven to be at least 0."""
        terminal = () if self.terminal is None else nonnegative(self.terminal)
        return all((*nonnegative(self.running), *terminal))

    @cached_property
    def arrival(self) -> Program:
        """The arrival measure and the terminal costs; inputs: states, <state>_goal."""
        reached = self.reached or trace(_largest(self.plant, self.tolerance), _arguments(self.plant, "goal"))
        builder = Builder(reached.inputs)
        terminal = [] if self.terminal is None else builder.inline(self.terminal, builder.inputs)
        names = ("measure", *(f"terminal_{index}" for index in range(len(terminal))))
        return builder.build([*builder.inline(reached, builder.inputs), *terminal], names)


def _arguments(plant: Plant, other: str) -> tuple[tuple[str, Names], ...]:
    """A state and its target or goal, the inputs of which are called <state>_<other>."""
    return ("x", plant.state_names), (other, {name: f"{name}_{other}" for name in plant.states})


def _program(
    name: str, given: Function | Program, arguments: Sequence[tuple[str, Names]], count: int | None = None
) -> Program:
    if isinstance(given, Program):
        program = given
    elif not callable(given):
        raise ProblemError(f"{name} is a function or a Program, got {given!r}")
    elif arguments[-1][0] == TIME and not takes_time(given, len(arguments) - 1):
        program = trace(given, arguments[:-1], unread=(TIME,))
    else:
        program = trace(given, arguments)
    inputs = tuple(key for _, group in arguments for key in input_names(group))
    if program.inputs != inputs or program.parameters:
        found = program.inputs + program.parameters
        raise ProblemError(f"{name} takes {', '.join(found)}; expected {', '.join(inputs)}")
    if count is not None and len(program.outputs) != count:
        raise ProblemError(f"{name} returns {len(program.outputs)} values; expected {count}")
    return program


def _errors(plant: Plant) -> Function:
    """The default features: target - x for each state, angles wrapped."""

    def features(x: Any, target: Any) -> dict[str, Any]:
        errors = {name: getattr(target, name) - getattr(x, name) for name in plant.states}
        return {
            f"error_{name}": wrap_angle(error) if name in plant.angles else error
            for name, error in errors.items()
        }

    return features


def _largest(plant: Plant, tolerance: Floats) -> Function:
    """The default arrival measure: the largest error in tolerances, minus 1."""

    def reached(x: Any, goal: Any) -> Any:
        errors = _errors(plant)(x, goal).values()
        shares = [np.abs(error) / width for error, width in zip(errors, tolerance.tolist(), strict=True)]
        return functools.reduce(np.maximum, shares) - 1.0

    return reached


def _time(x: Any, u: Any, goal: Any) -> float:
    """The default running cost, whose integral is the time."""
    return 1.0


def _positive(name: str, value: Any) -> float:
    number = float(shaped(name, value, ()))
    if not number > 0.0:
        raise ProblemError(f"{name} must be positive, got {number}")
    return number


def _check(problem: Problem) -> None:
    if len(problem.starts) == 0:
        raise ProblemError("starts is empty; expected at least one row")
    if not isinstance(problem.obstacles, Obstacles | None):
        raise ProblemError(f"obstacles must be Obstacles or None, got {problem.obstacles!r}")
    if not np.all(problem.tolerance > 0.0):
        raise ProblemError(f"tolerance must be positive, got {problem.tolerance.tolist()}")
    if problem.method not in METHODS:
        raise ProblemError(f"there is no method {problem.method!r}; expected one of {', '.join(METHODS)}")
    if problem.period > MOST_STEPS * problem.step:
        raise ProblemError(
            f"the step, {problem.step} s, is too short; a period, {problem.period} s, has at most {MOST_STEPS} steps"
        )
    steps = round(problem.period / problem.step)
    if steps < 1 or abs(steps * problem.step - problem.period) > 1e-9 * problem.period:
        raise ProblemError(
            f"the period, {problem.period} s, must be a multiple of the step, {problem.step} s"
        )
    if problem.horizon < problem.period:
        raise ProblemError(
            f"the horizon, {problem.horizon} s, is shorter than the period, {problem.period} s"
        )
    if problem.obstacles is not None:
        _check_places(problem, problem.obstacles)
    if problem.draws is not None:
        check_draws(
            *(problem.draws, problem.plant, len(problem.starts)), hold=problem.hold, horizon=problem.horizon
        )


def _check_places(problem: Problem, obstacles: Obstacles) -> None:
    """The obstacles must speak of this plant's states and clock, and leave the starts free."""
    if obstacles.tracks is not None:
        ticks = obstacles.tracks.period / problem.period
        if round(ticks) < 1 or abs(ticks - round(ticks)) > 1e-9 * ticks:
            raise ProblemError(
                f"the period of tracks, {obstacles.tracks.period} s, must be a multiple of the problem's, "
                f"{problem.period} s"
            )
    names = problem.plant.state_names
    unknown = [name for name in obstacles.position if name not in names]
    if unknown:
        raise ProblemError(
            f"the position {unknown[0]!r} is no state of the plant; its states are {', '.join(names)}"
        )
    poses = problem.starts[:, [names.index(name) for name in obstacles.position]]
    check_starts(obstacles, poses)
