"""The ROSbot: its kinematics (Shmalko & Yamshanov, eq. 12) and dynamics, what its stabilizer sees, when it is there."""

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
SPEEDS = MappingProxyType({"speed": "m/s", "turn_rate": "rad/s"})

# Rate-limited lags fitted to the robot in MuJoCo under Husarion's ROS 2 controller (nominal), and the range over
# simulators and controllers: Gazebo 11 with Husarion's own model, MuJoCo with and without the host's limits. The gain
# of turning is that of skid steer, (s/2)(t/2) / ((t/2)^2 + a^2) for wheel separation s, track t and half wheelbase a:
# 0.77 for Husarion's geometry, 1.08 for the separation their controller is told (rosbot_ros, Apache-2.0).
FAMILY = MappingProxyType(
    {
        "k_v": ("", 0.98, 1.02, 1.0),
        "tau_v": ("s", 0.02, 0.2, 0.04),
        "a_v": ("m/s2", 1.0, 1.5, 1.0),
        "k_omega": ("", 0.6, 1.05, 1.04),
        "tau_omega": ("s", 0.02, 0.2, 0.1),
        "a_omega": ("rad/s2", 2.0, 4.0, 2.5),
    }
)
DELAY = (0.0, 0.1)  # s, from the measured pose to the command's effect
STEP = 0.01  # s; half of the shortest lag, where the Runge-Kutta method is stable up to 2.7 lags


def unicycle(
    v: tuple[float, float] = (-0.5, 0.5), omega: tuple[float, float] = (-0.5, 0.5), *, name: str = "unicycle"
) -> Plant:
    """Speed v (m/s) and turn rate omega (rad/s) as the controls, each within its own limits."""
    controls = {"v": ("m/s", *v), "omega": ("rad/s", *omega)}
    return Plant(_unicycle, states=STATES, controls=controls, angles=("theta",), name=name)


def dynamic_unicycle(
    v: tuple[float, float] = (-0.5, 0.5),
    omega: tuple[float, float] = (-0.5, 0.5),
    *,
    name: str = "dynamic_unicycle",
) -> Plant:
    """Commanded speeds (m/s, rad/s) that the robot follows with a gain, a lag and limited accelerations (FAMILY).

    The first states and the controls are those of `unicycle`, so a law of the one drives the other. Integrate with
    steps of at most STEP.
    """
    controls = {"v": ("m/s", *v), "omega": ("rad/s", *omega)}
    states = {**STATES, **SPEEDS}
    return Plant(_dynamic_unicycle, states, controls, parameters=FAMILY, angles=("theta",), name=name)


def car(
    v: tuple[float, float] = (-0.5, 0.5),
    omega: tuple[float, float] = (-0.5, 0.5),
    *,
    turning_radius: float,
    name: str = "car",
) -> Plant:
    """A car as a unicycle whose front wheels turn so far and no farther: |omega| <= |v| / turning_radius (m).

    v and the steering angle arctan(wheelbase omega / v) are held over a control period, so a turn asked for that is too
    sharp becomes the sharpest there is.
    """

    def rates(x: Pose, u: Pose) -> tuple[Any, ...]:
        sharpest = np.abs(u.v) / turning_radius
        return u.v * np.cos(x.theta), u.v * np.sin(x.theta), np.clip(u.omega, -sharpest, sharpest)

    controls = {"v": ("m/s", *v), "omega": ("rad/s", *omega)}
    return Plant(rates, states=STATES, controls=controls, angles=("theta",), name=name)


def wheel_coupled(limit: float = 10.0) -> Plant:
    """The reading under which the paper's times are possible: two wheel commands within ±limit.

    v = (u1 + u2) / 2 and omega = (u1 - u2) / 2, so full speed leaves nothing to turn with.
    """
    controls = {"u1": ("m/s", -limit, limit), "u2": ("m/s", -limit, limit)}
    return Plant(_wheel_coupled, states=STATES, controls=controls, angles=("theta",), name="wheel_coupled")


def _unicycle(x: Pose, u: Pose) -> tuple[Any, ...]:
    return u.v * np.cos(x.theta), u.v * np.sin(x.theta), u.omega  # eq. 12


def _dynamic_unicycle(x: Pose, u: Pose, p: Pose) -> tuple[Any, ...]:
    forward = np.clip((p.k_v * u.v - x.speed) / p.tau_v, -p.a_v, p.a_v)
    turning = np.clip((p.k_omega * u.omega - x.turn_rate) / p.tau_omega, -p.a_omega, p.a_omega)
    return x.speed * np.cos(x.theta), x.speed * np.sin(x.theta), x.turn_rate, forward, turning


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
