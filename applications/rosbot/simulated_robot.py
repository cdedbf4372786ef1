"""A simulated robot that shares nothing with the planner: its gains are off, its wheels slip, its pose is noisy."""

from dataclasses import dataclass

import numpy as np

from gpsynth.arrays import Floats, frozen
from gpsynth.checks import check_number
from gpsynth.errors import ScenarioError

TRUST = (
    0.3  # in a noisy measurement of the pose, against what the last estimate and the controls since lead to
)


@dataclass(frozen=True)
class Flaws:
    """Standard deviations of what is wrong with a robot; all 0: it does what it is told and knows where it is."""

    gain: float = 0.0  # of a factor on v and of one on omega, constant over a run
    slip: float = 0.0  # of further factors on both, drawn anew every control period
    position: float = 0.0  # m, of each coordinate of a measured pose
    heading: float = 0.0  # rad, of its heading

    def __post_init__(self) -> None:
        for name in ("gain", "slip", "position", "heading"):
            value = getattr(self, name)
            check_number(f"the flaw {name}", value)
            if not 0.0 <= value < np.inf:
                raise ScenarioError(f"the flaw {name} is {value}; expected a finite number, at least 0")


UNCERTAIN = Flaws(gain=0.05, slip=0.1, position=0.01, heading=0.01)


@dataclass(frozen=True, eq=False)
class SimulatedRobot:
    """One robot with its flaws: what becomes of a command, and what it measures of its pose."""

    flaws: Flaws
    gains: Floats  # (2,) of v and omega
    rng: np.random.Generator

    @classmethod
    def drawn(cls, flaws: Flaws, rng: np.random.Generator) -> "SimulatedRobot":
        """A robot with random gains."""
        return cls(flaws, frozen(1.0 + flaws.gain * rng.normal(size=2)), rng)

    def applied(self, control: Floats) -> Floats:
        """The speeds (2,) that the wheels make of a command over one period."""
        slipping: Floats = control * self.gains * (1.0 + self.flaws.slip * self.rng.normal(size=2))
        return slipping

    def located(self, predicted: Floats, pose: Floats) -> Floats:
        """What the robot takes for its pose (3,): between what it predicts and what it measures, if that is noisy."""
        spread = np.array([self.flaws.position, self.flaws.position, self.flaws.heading])
        error = pose + spread * self.rng.normal(size=3) - predicted
        error[2] = np.remainder(error[2] + np.pi, 2.0 * np.pi) - np.pi
        trust = TRUST if spread.any() else 1.0
        estimate: Floats = predicted + trust * error
        return estimate
