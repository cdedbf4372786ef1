"""Schedule: the equilibrium points a plant is led through, and how long each is the target."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from gpsynth.arrays import Floats, frozen
from gpsynth.checks import check_kind, check_number, check_whole
from gpsynth.errors import ProblemError


@dataclass(frozen=True, eq=False)
class Schedule:
    """Point j is the target for dwell[j] seconds; after the last one the target is the goal.

    Raises ProblemError if shapes do not agree, a number is not finite or a dwell time is negative.
    """

    points: Floats  # (k, n) in the units of the states
    dwell: Floats  # (k,) s

    def __post_init__(self) -> None:
        object.__setattr__(self, "points", _numbers("points", self.points))
        object.__setattr__(self, "dwell", _numbers("dwell times", self.dwell))
        if self.points.ndim != 2 or self.dwell.shape != (len(self.points),):
            raise ProblemError(
                f"points and dwell of a schedule have shapes {self.points.shape} and {self.dwell.shape}; "
                "expected (k, n) and (k,)"
            )
        if not np.all(np.isfinite(self.points)):
            raise ProblemError("the points of a schedule hold NaN or infinity; expected finite numbers")
        if not np.all(np.isfinite(self.dwell) & (self.dwell >= 0.0)):
            raise ProblemError(f"the dwell times must be finite and at least 0 s, got {self.dwell.tolist()}")

    @property
    def ends(self) -> Floats:
        """When each point stops being the target, (k,) s."""
        return np.cumsum(self.dwell)

    def after(self, elapsed: float) -> "Schedule":
        """What is left of it after so many seconds: points that are over drop out, the last one stays for no time."""
        check_number("the time elapsed of a schedule", elapsed)
        left = np.diff(np.maximum(self.ends - elapsed, 0.0), prepend=0.0)
        kept = left > 0.0
        kept[-1:] |= not np.any(kept)
        return Schedule(self.points[kept], left[kept])

    def split(self, count: int) -> "Schedule":
        """The same motion with `count` points, more than it has: the longest dwell times are cut in two."""
        check_whole("the count of points of a schedule", count, 0)
        if not len(self.dwell) and count:
            raise ProblemError("a schedule without points has none that could be split")
        points, dwell = self.points, self.dwell
        while len(dwell) < count:
            longest = int(np.argmax(dwell))
            points = np.insert(points, longest, points[longest], axis=0)
            dwell = np.insert(dwell, longest, 0.5 * dwell[longest])
            dwell[longest + 1] -= dwell[longest]
        return Schedule(points, dwell)


@dataclass(frozen=True, eq=False)
class Schedules:
    """N schedules of as many points each, as arrays; raises ProblemError if their shapes do not agree."""

    points: Floats  # (N, k, n)
    dwell: Floats  # (N, k) s

    def __post_init__(self) -> None:
        object.__setattr__(self, "points", _numbers("points", self.points))
        object.__setattr__(self, "dwell", _numbers("dwell times", self.dwell))
        if self.points.ndim != 3 or self.dwell.shape != self.points.shape[:2]:
            raise ProblemError(
                f"points and dwell of schedules have shapes {self.points.shape} and {self.dwell.shape}; "
                "expected (N, k, n) and (N, k)"
            )

    @classmethod
    def of(cls, schedules: Sequence[Schedule]) -> "Schedules":
        """These schedules, at least one; raises ProblemError if they are none, or of several shapes."""
        for each in schedules:
            check_kind("a schedule", each, Schedule)
        shapes = sorted({each.points.shape for each in schedules})
        if len(shapes) != 1:
            raise ProblemError(
                f"schedules that are tried together need points of one shape; these have {_joined(shapes)}"
            )
        return cls(
            np.stack([each.points for each in schedules]), np.stack([each.dwell for each in schedules])
        )

    @classmethod
    def joined(cls, parts: "Sequence[Schedules]") -> "Schedules":
        """All schedules of some parts, at least one."""
        return cls(
            np.concatenate([each.points for each in parts]), np.concatenate([each.dwell for each in parts])
        )

    def __len__(self) -> int:
        return len(self.points)

    def __getitem__(self, number: int) -> Schedule:
        return Schedule(self.points[number], self.dwell[number])

    def take(self, numbers: npt.NDArray[np.intp]) -> "Schedules":
        """Some of them, by their numbers."""
        return Schedules(self.points[numbers], self.dwell[numbers])


def _joined(shapes: Sequence[tuple[int, ...]]) -> str:
    return " and ".join(map(str, shapes)) or "none"


def _numbers(what: str, values: npt.ArrayLike) -> Floats:
    try:
        return frozen(np.asarray(values, dtype=np.float64))
    except (TypeError, ValueError):
        raise ProblemError(
            f"the {what} of a schedule must be numbers in rows of equal length, got {values!r}"
        ) from None
