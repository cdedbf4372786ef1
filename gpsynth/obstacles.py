"""Obstacles: what a robot must not touch, and the body that must not touch it."""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from gpsynth.arrays import Floats, frozen, shaped
from gpsynth.distance_field import DistanceField
from gpsynth.errors import ProblemError
from gpsynth.tracks import Tracks

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


def check_starts(obstacles: Obstacles, poses: Floats) -> None:
    """Raises ProblemError if a start, at poses (S, 2) or (S, 3), lies in an obstacle or out of bounds."""
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
