"""Problem: from where to where a plant is to be brought, under which clock, what it costs and when it has arrived."""

import functools
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from gpsynth.arrays import Floats, frozen, numbers, shaped
from gpsynth.builder import Builder
from gpsynth.distance_field import DistanceField
from gpsynth.draws import Draws, check_draws
from gpsynth.errors import ProblemError
from gpsynth.plant import Plant
from gpsynth.plant_parts import TIME
from gpsynth.program import Program
from gpsynth.signs import nonnegative
from gpsynth.tracing import Names, input_names, takes_time, trace, wrap_angle
from gpsynth.tracks import Tracks

MOST_STEPS = 1_000_000  # of a period
METHODS = ("euler", "heun", "rk4")
Method = Literal["euler", "heun", "rk4"]
Function = Callable[..., Any]

_EVERYWHERE = (-np.inf, np.inf, -np.inf, np.inf)


@dataclass(frozen=True, eq=False)
class Obstacles:
    """What a robot must not touch, and its body; raises ProblemError if they make no sense.

    The robot is round, or the circles of its `footprint`, which turn with it; then `position` names its heading too.
    """

    # (c, 5) x, y (m) at t = 0, their velocities (m/s) and the radius (m)
    circles: Floats = field(default_factory=lambda: np.empty((0, 5)))
    # (4,) x low, x high, y low, y high (m) of the robot's origin
    bounds: Floats = field(default_factory=lambda: np.array(_EVERYWHERE))
    radius: float = 0.0  # m, of a round robot
    position: tuple[str, ...] = ("x", "y")  # states
    footprint: Floats | None = None  # (f, 3) x, y (m) in the robot's frame and radius (m)
    field: DistanceField | None = None  # of obstacles at rest that are no circles
    tracks: Tracks | None = None  # discs whose places over time are known

    def __post_init__(self) -> None:
        object.__setattr__(self, "circles", shaped("circles", self.circles, (-1, 5)))
        object.__setattr__(self, "bounds", shaped("bounds", self.bounds, (4,), finite=False))
        object.__setattr__(self, "radius", float(shaped("the robot's radius", self.radius, ())))
        if self.footprint is not None:
            object.__setattr__(self, "footprint", shaped("footprint", self.footprint, (-1, 3)))
        if isinstance(self.position, list):
            object.__setattr__(self, "position", tuple(self.position))
        _check_obstacles(self)

    @cached_property
    def body(self) -> Floats:
        """The circles of the robot (f, 3): x, y (m) in its frame and radius (m)."""
        return frozen(np.array([[0.0, 0.0, self.radius]])) if self.footprint is None else self.footprint

    def gaps(self, poses: Floats) -> Floats:
        """How far (N,) the robot at poses (N, 2) or (N, 3) is from the obstacles at time 0; see `DistanceField.at`.

        Tracks are left out: what moves on them is elsewhere soon.
        """
        gaps: Floats = self.gaps_to_circles(poses).min(axis=1, initial=np.inf)
        return gaps if self.field is None else np.minimum(gaps, self.gaps_to_field(poses))

    def gaps_to_circles(self, poses: Floats) -> Floats:
        """The same (N, c) from each circle."""
        between = self._centers(poses)[:, :, np.newaxis] - self.circles[:, :2]
        distances = np.hypot(between[..., 0], between[..., 1]) - self.body[:, 2:]
        gaps: Floats = distances.min(axis=1) - self.circles[:, 4]
        return gaps

    def gaps_to_field(self, poses: Floats) -> Floats:
        """The same (N,) from what the field is of; infinity without one."""
        if self.field is None:
            return np.full(len(poses), np.inf)
        gaps: Floats = np.min(self.field.at(self._centers(poses)) - self.body[:, 2], axis=1)
        return gaps

    def _centers(self, poses: Floats) -> Floats:
        """The centers (N, f, 2) of the circles of the robot."""
        angles = poses[:, 2:] if poses.shape[1] > 2 else np.zeros((len(poses), 1))
        sine, cosine, (ahead, left, _) = np.sin(angles), np.cos(angles), self.body.T
        turned = np.stack([ahead * cosine - left * sine, ahead * sine + left * cosine], axis=-1)
        centers: Floats = poses[:, np.newaxis, :2] + turned
        return centers


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


def _check_obstacles(obstacles: Obstacles) -> None:
    negative = np.flatnonzero(obstacles.circles[:, 4] < 0.0)
    if negative.size:
        raise ProblemError(
            f"circle {negative[0]} has the negative radius {obstacles.circles[negative[0], 4]}"
        )
    if not 0.0 <= obstacles.radius < np.inf:
        raise ProblemError(f"the robot's radius must be finite and at least 0, got {obstacles.radius}")
    x_low, x_high, y_low, y_high = obstacles.bounds
    if not (x_low < x_high and y_low < y_high):
        raise ProblemError(f"bounds are x low, x high, y low, y high, got {obstacles.bounds.tolist()}")
    names = obstacles.position
    known = isinstance(names, tuple) and {*map(type, names)} == {str} and len({*names}) == len(names)
    if not known or len(names) not in {2, 3}:
        raise ProblemError(
            f"position names two different states, and the heading as a third, got {obstacles.position!r}"
        )
    _check_footprint(obstacles)


def _check_footprint(obstacles: Obstacles) -> None:
    if not isinstance(obstacles.field, DistanceField | None):
        raise ProblemError(f"the field must be a DistanceField or None, got {obstacles.field!r}")
    if not isinstance(obstacles.tracks, Tracks | None):
        raise ProblemError(f"the tracks must be Tracks or None, got {obstacles.tracks!r}")
    if obstacles.footprint is None:
        return
    if obstacles.radius != 0.0:
        raise ProblemError(
            f"a robot has a radius or a footprint, got {obstacles.radius} m and {obstacles.footprint.tolist()}"
        )
    if not len(obstacles.footprint) or np.any(obstacles.footprint[:, 2] < 0.0):
        raise ProblemError(
            f"a footprint has circles of radius at least 0, got {obstacles.footprint.tolist()}"
        )
    if np.any(obstacles.footprint[:, :2]) and len(obstacles.position) < 3:
        raise ProblemError(
            f"a footprint beside the origin turns with the robot: position must name its heading, "
            f"got {obstacles.position!r}"
        )


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
    """No start may lie in an obstacle or out of bounds."""
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
    x_low, x_high, y_low, y_high = obstacles.bounds
    for index, (x, y) in enumerate(poses[:, :2].tolist()):
        if not (x_low <= x <= x_high and y_low <= y <= y_high):
            raise ProblemError(
                f"start {index} at ({x}, {y}) is outside the bounds {obstacles.bounds.tolist()}"
            )
    _check_gaps(poses, obstacles)


def _check_gaps(poses: Floats, obstacles: Obstacles) -> None:
    inside = np.argwhere(obstacles.gaps_to_circles(poses) < 0.0)
    if len(inside):
        index, circle = inside[0].tolist()
        (x, y), (cx, cy, _, _, radius) = poses[index, :2].tolist(), obstacles.circles[circle].tolist()
        robot = f"the robot's {obstacles.radius}" if obstacles.footprint is None else "its footprint"
        raise ProblemError(
            f"start {index} at ({x}, {y}) is inside obstacle {circle}, the circle of radius {radius} "
            f"around ({cx}, {cy}) grown by {robot}"
        )
    if obstacles.field is not None:
        missing = 1.5 * obstacles.field.spacing  # of a distance, at most, between the nodes
        within = np.flatnonzero(obstacles.gaps_to_field(poses) < -missing)
        if len(within):
            x, y = poses[within[0], :2].tolist()
            raise ProblemError(f"start {within[0]} at ({x}, {y}) is inside what the distance field is of")
