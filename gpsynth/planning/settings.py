"""How a plan is searched: its free numbers, the weights of its cost, and the swarm."""

from dataclasses import dataclass, replace
from math import inf
from typing import Literal, get_args

from gpsynth.arrays import shaped
from gpsynth.checks import check_kind, check_number, check_whole
from gpsynth.errors import ProblemError
from gpsynth.planning.weights import Weights

Clear = Literal["path", "points"]
Method = Literal["clerc", "seed", "shade", "cmaes"]


@dataclass(frozen=True)
class PlanSettings:
    """Settings of `plan`; the weights and their letters are those of Shmalko & Yamshanov, eq. 17."""

    points: int = 6  # equilibrium points before the goal, which comes last
    dwell: tuple[float, float] | None = (0.0, 4.0)  # s, range of each; None: all equal, T+ / (points + 1)
    obstacles: Clear = "path"  # what must be clear of them: all of the path, or the points alone
    alpha: float = 10.0  # weight of the error at the end
    beta: float = 0.25  # weight of the time
    gamma: float = 5.0  # weight of the obstacles
    margin: float = 0.004  # m, clearance that counts as none
    optimizer: Method = "clerc"  # a swarm, "seed" being the paper's; differential evolution; CMA-ES
    swarms: int = 1  # side by side, sharing T+ alone; `seed` and `clerc` only
    particles: int = 64  # of each swarm
    iterations: int = 15  # in a round; the first rounds are shorter
    rounds: int = 10  # so many times `iterations` in all; T+ is tightened between rounds
    spread: float = 0.05  # first step of CMA-ES, as a fraction of the range
    patience: float = 1.5  # rollouts end after so many T+, and a second
    top_speed: float = inf  # m/s: known to be the greatest, it shows sooner which rollouts cannot win
    weights: Weights = Weights()  # of what counts beside time
    reach: float = 0.0  # distance from its point at which the next one is due at once; 0: dwell times alone

    def __post_init__(self) -> None:
        for name in ("points", "swarms", "particles", "iterations", "rounds"):
            check_whole(f"{name} of a plan", getattr(self, name), 1)
        for name in ("alpha", "beta", "gamma", "margin", "spread", "patience", "reach"):
            value = getattr(self, name)
            check_number(f"{name} of a plan", value)
            if not 0.0 <= value < inf:
                raise ProblemError(f"{name} of a plan must be finite and at least 0, not {value}")
        check_kind("weights of a plan", self.weights, Weights)
        check_number("top_speed of a plan", self.top_speed)
        if not self.top_speed > 0.0:
            raise ProblemError(f"top_speed of a plan must be greater than 0, not {self.top_speed}")
        for name, choices in (("obstacles", get_args(Clear)), ("optimizer", get_args(Method))):
            if getattr(self, name) not in choices:
                raise ProblemError(f"{name} of a plan must be one of {choices}, not {getattr(self, name)!r}")
        if self.optimizer in ("shade", "cmaes") and self.swarms > 1:
            raise ProblemError(f"the optimizer {self.optimizer!r} searches alone; swarms is {self.swarms}")
        if self.dwell is not None:
            shortest, longest = shaped("dwell, (shortest, longest) in s,", self.dwell, (2,))
            if not 0.0 <= shortest < longest:
                raise ProblemError(
                    f"dwell is {self.dwell}; expected two times with 0 <= shortest < longest, or None"
                )

    @classmethod
    def paper(cls, points: int = 5, *, particles: int = 100, rounds: int = 20) -> "PlanSettings":
        """As printed: equal dwell times, obstacles count where a point lies in one, inertia 1.0 and c1 = c2 = 0.65.

        A point that is reached makes way for the next one; how near that is, swarm size and iterations are not
        printed: those here are ours.
        """
        return cls(
            points=points,
            dwell=None,
            obstacles="points",
            margin=0.0,
            optimizer="seed",
            particles=particles,
            rounds=rounds,
            patience=1.0,
            reach=0.05,
        )

    def on_path(self) -> "PlanSettings":
        """The same with the path itself kept clear of obstacles."""
        return replace(self, obstacles="path")
