"""A planning scenario: a robot with its limits, start and goal, circles that may move, and the room around them."""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from applications.rosbot.footprint import inner_radius
from applications.rosbot.gaps import gaps_at, gaps_to_room
from applications.rosbot.others import Other
from applications.rosbot.room import Room
from gpsynth.arrays import Floats, frozen
from gpsynth.checks import check_kind, check_number
from gpsynth.distance_field import DistanceField
from gpsynth.errors import ScenarioError

MOST = 1e4  # m, s: what is larger is a slip of the pen, and no plan for it ends
FASTEST = 100.0  # m/s, rad/s
SLOWEST = 1e-6  # m/s, rad/s: with less no plan comes to its end within MOST
MODELS = ("unicycle", "dynamic_unicycle", "car")
FINE, COARSE = (
    0.01,
    0.05,
)  # m, between the nodes of the room's field: a fifth of the smallest circle of the body


@dataclass(frozen=True, eq=False)
class Scenario:
    """What is to be planned: from `start` into the tolerance around `goal`, clear of every obstacle, in least time.

    Raises ScenarioError if a number is not finite, limits are reversed, or start or goal are out of place.
    """

    start: Floats  # (3,) x m, y m, theta rad
    goal: Floats  # (3,)
    speed_limits: tuple[float, float] = (-0.5, 0.5)  # m/s, backwards and forwards
    turn_limits: tuple[float, float] = (-0.5, 0.5)  # rad/s, to the right and to the left
    bounds: Floats = field(
        default_factory=lambda: np.array([-np.inf, np.inf] * 2)
    )  # x low, x high, y low, y high
    circles: Floats = field(
        default_factory=lambda: np.zeros((0, 5))
    )  # (c, 5) x m, y m, vx m/s, vy m/s, radius m
    radius: float = 0.15  # m, of the robot; of another body than a disc the largest around its origin
    footprint: Floats = field(
        default_factory=lambda: np.zeros((0, 3))
    )  # (f, 3) x m, y m, radius m in the robot's frame; without any it is a disc
    room: Room | None = None  # obstacles at rest that are no circles
    others: tuple[Other, ...] = ()  # robots whose way is known
    model: str = "unicycle"  # or another of MODELS
    speeds: tuple[float, float] = (0.0, 0.0)  # m/s, rad/s at the start, of a robot with lags; 0 of others
    turning_radius: float = 0.0  # m, the least of a car; 0 of others
    position_tolerance: float = 0.05  # m
    heading_tolerance: float = 0.1  # rad
    time_limit: float = 60.0  # s
    name: str = ""
    note: str = ""
    expect_feasible: bool | None = None  # what the author of the scenario says

    def __post_init__(self) -> None:
        for name, shape in (
            ("start", (3,)),
            ("goal", (3,)),
            ("bounds", (4,)),
            ("circles", (-1, 5)),
            ("footprint", (-1, 3)),
        ):
            object.__setattr__(self, name, frozen(_shaped(name, getattr(self, name), shape)))
        for name in ("speed_limits", "turn_limits", "speeds"):
            low, high = _shaped(name, getattr(self, name), (2,))
            object.__setattr__(self, name, (float(low), float(high)))
        if len(self.footprint):
            _check_footprint(self.footprint)
            object.__setattr__(self, "radius", inner_radius(self.footprint))
        _check_kinds(self)
        _check_numbers(self)
        _check_model(self)
        _check_obstacles(self)
        _check_places(self)

    @cached_property
    def body(self) -> Floats:
        """The circles (f, 3) of the robot in its frame: its footprint, or the one disc that it is."""
        return self.footprint if len(self.footprint) else frozen(np.array([[0.0, 0.0, self.radius]]))

    @property
    def discs(self) -> Floats:
        """The obstacles at time 0, grown by the robot: (c, 3) x, y, radius; its center must stay outside."""
        return np.column_stack([self.circles[:, :2], self.circles[:, 4] + self.radius])

    @property
    def is_static(self) -> bool:
        """Whether no obstacle moves."""
        return not np.any(self.circles[:, 2:4])

    @property
    def is_round(self) -> bool:
        """Whether the robot is a disc around its origin."""
        return len(self.body) == 1 and not np.any(self.body[:, :2])

    @property
    def covers_origin(self) -> bool:
        """Whether the origin of the robot's frame is part of its body, so that it must not be in an obstacle."""
        return bool(np.any(np.hypot(self.body[:, 0], self.body[:, 1]) <= self.body[:, 2]))

    @cached_property
    def field(self) -> DistanceField | None:
        """The distance field of the room; start, goal and circles lie within its grid."""
        if self.room is None:
            return None
        x, y, radius = self.discs.T
        places = [self.start[:2], self.goal[:2], *np.column_stack([x - radius, y - radius])]
        places += list(np.column_stack([x + radius, y + radius]))
        return self.room.field(float(np.clip(0.2 * self.body[:, 2].min(), FINE, COARSE)), np.array(places))


def _shaped(name: str, value: object, shape: tuple[int, ...]) -> Floats:
    try:
        array = np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError):
        raise ScenarioError(f"{name} must hold numbers in rows of equal length, got {value!r}") from None
    if not array.size and -1 in shape:
        return np.zeros([max(size, 0) for size in shape])
    if array.ndim != len(shape) or any(
        size not in (-1, got) for size, got in zip(shape, array.shape, strict=True)
    ):
        wanted = str(shape).replace("-1", "any")
        raise ScenarioError(f"{name} has shape {array.shape}; expected {wanted}")
    return array


def _check_kinds(scenario: Scenario) -> None:
    check_kind("room", scenario.room, Room, error=ScenarioError, optional=True)
    check_kind("others", scenario.others, tuple, error=ScenarioError)
    for other in scenario.others:
        check_kind("one of the others", other, Other, error=ScenarioError)
    check_kind("name", scenario.name, str, error=ScenarioError)


def _check_numbers(scenario: Scenario) -> None:
    largest = {
        "start": MOST,
        "goal": MOST,
        "speed_limits": FASTEST,
        "turn_limits": FASTEST,
        "speeds": FASTEST,
    }
    for name, most in largest.items():
        value = np.asarray(getattr(scenario, name))
        if not np.all(np.abs(value) <= most):
            raise ScenarioError(f"{name} is {value.tolist()}; expected finite numbers within ±{most:g}")
    for name in ("radius", "turning_radius", "position_tolerance", "heading_tolerance", "time_limit"):
        check_number(name, getattr(scenario, name), ScenarioError)
    for name in ("position_tolerance", "heading_tolerance", "time_limit"):
        if not 0.0 < getattr(scenario, name) <= MOST:
            raise ScenarioError(
                f"{name} is {getattr(scenario, name)}; expected a number above 0, at most {MOST:g}"
            )
    pairs = {"limits of v": scenario.speed_limits, "limits of omega": scenario.turn_limits}
    pairs |= {"bounds of x": tuple(scenario.bounds[:2]), "bounds of y": tuple(scenario.bounds[2:])}
    for name, (low, high) in pairs.items():
        if not low < high:
            raise ScenarioError(f"{name} are [{low:g}, {high:g}]; the first must be less than the second")
    for name in ("limits of v", "limits of omega"):
        low, high = pairs[name]
        if max(-low, high) < SLOWEST:
            raise ScenarioError(
                f"{name} are [{low:g}, {high:g}]; expected one of at least {SLOWEST:g} in size"
            )


def _check_model(scenario: Scenario) -> None:
    if scenario.model not in MODELS:
        raise ScenarioError(f"the model is {scenario.model!r}; expected {', '.join(MODELS)}")
    if scenario.model != "dynamic_unicycle" and scenario.speeds != (0.0, 0.0):
        raise ScenarioError(
            f"a {scenario.model} begins at the speeds {list(scenario.speeds)}; expected 0, for it has no lags"
        )
    if scenario.model == "car" and not 0.0 < scenario.turning_radius <= MOST:
        raise ScenarioError(
            f"the car's turning radius is {scenario.turning_radius:g} m; expected more than 0"
        )
    if scenario.model != "car" and scenario.turning_radius != 0.0:
        raise ScenarioError(
            f"a {scenario.model} has the turning radius {scenario.turning_radius:g} m; expected none"
        )


def _check_footprint(footprint: Floats) -> None:
    for index, (x, y, radius) in enumerate(footprint):
        if not (max(abs(x), abs(y)) <= MOST and 0.0 <= radius <= MOST):
            raise ScenarioError(
                f"circle {index} of the robot is [{x:g}, {y:g}, {radius:g}]; expected x, y and a radius of at least 0"
            )


def _check_obstacles(scenario: Scenario) -> None:
    if not 0.0 <= scenario.radius <= MOST:
        raise ScenarioError(f"the robot's radius is {scenario.radius}; expected a number from 0 to {MOST:g}")
    for index, circle in enumerate(scenario.circles):
        if not np.all(np.abs(circle) <= MOST):
            raise ScenarioError(
                f"obstacles[{index}] is {circle.tolist()}; expected finite numbers within ±{MOST:g}"
            )
        if circle[4] < 0.0:
            raise ScenarioError(f"obstacles[{index}] has radius {circle[4]:g}; expected at least 0")


def _check_places(scenario: Scenario) -> None:
    x_low, x_high, y_low, y_high = scenario.bounds
    for name, (x, y, _) in (("start", scenario.start), ("goal", scenario.goal)):
        if not (x_low <= x <= x_high and y_low <= y <= y_high):
            raise ScenarioError(
                f"{name} ({x:g}, {y:g}) lies outside the bounds, "
                f"x in [{x_low:g}, {x_high:g}] and y in [{y_low:g}, {y_high:g}]"
            )
    gaps = gaps_at(scenario.body, scenario.circles, scenario.start)
    if np.any(gaps < 0.0):
        raise _overlap(scenario, f"obstacles[{int(np.argmin(gaps))}]", float(gaps.min()))
    if scenario.room is not None:
        gap = float(gaps_to_room(scenario.body, scenario.room, scenario.start[np.newaxis])[0])
        if gap < 0.0:
            raise _overlap(scenario, "the map, a polygon or a segment", gap)
    _check_others(scenario)


def _check_others(scenario: Scenario) -> None:
    if scenario.others and (not scenario.is_round or scenario.model == "dynamic_unicycle"):
        what = f"a {scenario.model}" if scenario.is_round else "one that is not round"
        raise ScenarioError(
            f"among other robots a robot must be round, and a unicycle or a car without lags, not {what}"
        )
    for number, other in enumerate(scenario.others):
        gap = float(np.hypot(*(scenario.start - other.start)[:2])) - scenario.radius - other.radius
        if gap < 0.0:
            raise _overlap(scenario, f"other robot {number}", gap)


def _overlap(scenario: Scenario, what: str, gap: float) -> ScenarioError:
    robot = f"the robot's radius of {scenario.radius:g} m" if scenario.is_round else "the robot's footprint"
    x, y, _ = scenario.start
    return ScenarioError(
        f"start ({x:g}, {y:g}) overlaps {what} by {-gap:.3g} m with {robot}; expected a free start"
    )
