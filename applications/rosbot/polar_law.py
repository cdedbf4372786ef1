"""The hand-tuned polar law: the baseline that a synthesized stabilizer has to beat in planning."""

from dataclasses import astuple, dataclass
from typing import Any

import numpy as np

from applications.rosbot.model import STATES, features
from gpsynth.law import Law
from gpsynth.plant import Plant
from gpsynth.tracing import trace, where, wrap_angle


@dataclass(frozen=True)
class Gains:
    """The numbers of the polar law; the values given here were tuned for arriving fast from point to point."""

    distance: float = 0.954  # k1, 1/s
    bearing: float = 2.294  # k2, 1/s
    approach: float = 1.202  # k3
    near: float = 0.0629  # rho0, m: closer than this the heading is turned in place
    heading: float = 5.014  # k_theta, 1/s
    detour: float = 0.240  # k_d: how much the heading at the target counts for the direction of travel


SETTLING = Gains()
SATURATING = Gains(4.0, 4.0, 1.2, 0.06, 6.0, 0.24)
HOT = Gains(8.0, 6.0, 2.0, 0.05, 8.0, 0.24)


def polar_law(plant: Plant, gains: Gains = SATURATING) -> Law:
    """The law for a plant with the states of the model and the controls (v, omega) or two coupled wheels (u1, u2)."""
    coupled = plant.control_names == ("u1", "u2")

    def controls(seen: Any) -> tuple[Any, ...]:
        v, omega = _polar(seen, gains)
        return (v + omega, v - omega) if coupled else (v, omega)

    target = {name: f"{name}_target" for name in STATES}
    sight = trace(features, [("x", tuple(STATES)), ("target", target)])
    return Law(plant, sight, trace(controls, [("seen", sight.names)], plant.control_names), np.empty(0))


def _polar(seen: Any, gains: Gains) -> tuple[Any, Any]:
    k1, k2, k3, rho0, k_theta, k_d = astuple(gains)
    bearing = np.arctan2(seen.error_y, seen.error_x)
    approach = wrap_angle(bearing - seen.error_theta)
    behind, opposite = wrap_angle(bearing + np.pi), wrap_angle(approach + np.pi)
    ahead = np.abs(bearing) + k_d * np.abs(approach)
    backwards = np.abs(behind) + k_d * np.abs(opposite) < ahead
    gamma, delta = where(backwards, behind, bearing), where(backwards, opposite, approach)
    sense = where(backwards, -1.0, 1.0)
    tiny = np.abs(gamma) < 1e-6
    slope = where(tiny, 1.0, np.sin(gamma) / where(tiny, 1.0, gamma)) * np.cos(gamma)
    near = seen.distance < rho0
    v = where(near, k1 * seen.error_x, sense * k1 * seen.distance * np.cos(gamma))
    omega = where(near, k_theta * seen.error_theta, k2 * gamma + k1 * slope * (gamma + k3 * delta))
    return v, omega
