"""The ROSbot's kinematics (Shmalko & Yamshanov, eq. 12), what its stabilizer sees, and when it has arrived."""

from collections.abc import Callable
from types import MappingProxyType
from typing import Any

import numpy as np

from gpsynth.plant import Plant
from gpsynth.tracing import where, wrap_angle

# A state or target while tracing: a vector of symbols, named as in STATES.
Pose = Any
NEAR = 0.05  # m
STATES = MappingProxyType({"x": "m", "y": "m", "theta": "rad"})


def unicycle(
    v: tuple[float, float] = (-0.5, 0.5), omega: tuple[float, float] = (-0.5, 0.5), *, name: str = "unicycle"
) -> Plant:
    """Speed v (m/s) and turn rate omega (rad/s) as the controls, each within its own limits."""
    controls = {"v": ("m/s", *v), "omega": ("rad/s", *omega)}
    return Plant(_unicycle, states=STATES, controls=controls, angles=("theta",), name=name)


def wheel_coupled(limit: float = 10.0) -> Plant:
    """The reading under which the paper's times are possible: two wheel commands within ±limit.

    v = (u1 + u2) / 2 and omega = (u1 - u2) / 2, so full speed leaves nothing to turn with.
    """
    controls = {"u1": ("m/s", -limit, limit), "u2": ("m/s", -limit, limit)}
    return Plant(_wheel_coupled, states=STATES, controls=controls, angles=("theta",), name="wheel_coupled")


def _unicycle(x: Pose, u: Pose) -> tuple[Any, ...]:
    return u.v * np.cos(x.theta), u.v * np.sin(x.theta), u.omega  # eq. 12


def _wheel_coupled(x: Pose, u: Pose) -> tuple[Any, ...]:
    v, omega = 0.5 * (u.u1 + u.u2), 0.5 * (u.u1 - u.u2)
    return v * np.cos(x.theta), v * np.sin(x.theta), omega


def features(x: Pose, target: Pose) -> dict[str, Any]:
    """What the stabilizer sees of a pose and its target, all unchanged when both are moved and turned together.

    Errors in the body frame (forward, left) rather than in the world, so one formula serves every place and heading;
    distance and two angles besides, since arriving with a heading means weighing the line to the target against the
    robot's axis (bearing) and against the target's heading (approach). The robot drives both ways equally well, so
    bearing is the angle of a line, within ±pi/2, and a target straight behind is as well aimed at as one ahead. Within
    NEAR of the target that line means nothing and bearing fades, while the heading error alone counts (heading).
    """
    dx, dy = target.x - x.x, target.y - x.y
    forward = np.cos(x.theta) * dx + np.sin(x.theta) * dy
    left = np.cos(x.theta) * dy - np.sin(x.theta) * dx
    turn = wrap_angle(target.theta - x.theta)
    distance = np.hypot(dx, dy)
    bearing = np.arctan2(where(forward < 0.0, -left, left), np.abs(forward) + NEAR)
    return {
        "error_x": forward,
        "error_y": left,
        "error_theta": turn,
        "distance": distance,
        "bearing": bearing,
        "approach": wrap_angle(bearing - turn),
        "heading": turn / (1.0 + (distance / NEAR) ** 2),
    }


def reached(position: float = 0.05, heading: float = 0.1) -> Callable[[Pose, Pose], Any]:
    """The arrival measure of a tolerance in m and rad: at most 0 when both are met at once."""

    def measure(x: Pose, goal: Pose) -> Any:
        distance = np.hypot(goal.x - x.x, goal.y - x.y)
        turn = np.abs(wrap_angle(goal.theta - x.theta))
        return np.maximum(distance / position, turn / heading) - 1.0

    return measure
