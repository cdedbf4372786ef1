"""A planning scenario: a round robot with its limits, start, goal and circular obstacles that may move."""

from dataclasses import dataclass, field

import numpy as np

from gpsynth.arrays import Floats, frozen
from gpsynth.errors import ScenarioError

MOST = 1e4  # m, s: what is larger is a slip of the pen, and no plan for it ends
FASTEST = 100.0  # m/s, rad/s


@dataclass(frozen=True, eq=False)
class Scenario:
    """What is to be planned: from `start` into the tolerance around `goal`, clear of every circle, in least time.

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
    radius: float = 0.15  # m, of the robot
    position_tolerance: float = 0.05  # m
    heading_tolerance: float = 0.1  # rad
    time_limit: float = 60.0  # s
    name: str = ""
    note: str = ""
    expect_feasible: bool | None = None  # what the author of the scenario says

    def __post_init__(self) -> None:
        for name, shape in (("start", (3,)), ("goal", (3,)), ("bounds", (4,)), ("circles", (-1, 5))):
            object.__setattr__(self, name, frozen(_shaped(name, getattr(self, name), shape)))
        for name in ("speed_limits", "turn_limits"):
            low, high = _shaped(name, getattr(self, name), (2,))
            object.__setattr__(self, name, (float(low), float(high)))
        _check_numbers(self)
        _check_obstacles(self)
        _check_places(self)

    @property
    def discs(self) -> Floats:
        """The obstacles at time 0, grown by the robot: (c, 3) x, y, radius; its center must stay outside."""
        return np.column_stack([self.circles[:, :2], self.circles[:, 4] + self.radius])

    @property
    def is_static(self) -> bool:
        """Whether no obstacle moves."""
        return not np.any(self.circles[:, 2:4])


def _shaped(name: str, value: object, shape: tuple[int, ...]) -> Floats:
    array = np.asarray(value, dtype=np.float64)
    if not array.size and -1 in shape:
        return np.zeros([max(size, 0) for size in shape])
    if array.ndim != len(shape) or any(
        size not in (-1, got) for size, got in zip(shape, array.shape, strict=True)
    ):
        wanted = str(shape).replace("-1", "any")
        raise ScenarioError(f"{name} has shape {array.shape}; expected {wanted}")
    return array


def _check_numbers(scenario: Scenario) -> None:
    largest = {"start": MOST, "goal": MOST, "speed_limits": FASTEST, "turn_limits": FASTEST}
    for name, most in largest.items():
        value = np.asarray(getattr(scenario, name))
        if not np.all(np.abs(value) <= most):
            raise ScenarioError(f"{name} is {value.tolist()}; expected finite numbers within ±{most:g}")
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
    x, y, radius = scenario.discs.T
    gaps = np.hypot(x - scenario.start[0], y - scenario.start[1]) - radius
    if np.any(gaps < 0.0):
        index = int(np.argmin(gaps))
        raise ScenarioError(
            f"start ({scenario.start[0]:g}, {scenario.start[1]:g}) overlaps obstacles[{index}] by {-gaps[index]:.3g} m "
            f"with the robot's radius of {scenario.radius:g} m; expected a free start"
        )
