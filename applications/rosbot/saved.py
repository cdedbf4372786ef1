"""What files of plans, drives and fleets are read back as, so much as is shown of them."""

from pathlib import Path
from typing import Annotated, Literal, TypeVar

import msgspec

from applications.rosbot.scenario import MOST
from gpsynth.errors import FileError
from gpsynth.files import read_json

LARGEST = 20_000_000  # bytes
FARTHEST = 2.0 * MOST  # a scenario may end at MOST, and a plan or its points go beyond
Number = Annotated[float, msgspec.Meta(ge=-FARTHEST, le=FARTHEST)]
Saved = TypeVar("Saved")
Duration = Annotated[float, msgspec.Meta(ge=0.0, le=FARTHEST)]


class SavedSchedule(msgspec.Struct):
    """Equilibrium points and their dwell times (s)."""

    points: list[tuple[Number, Number, Number]]
    dwell: list[Duration]

    def __post_init__(self) -> None:
        if len(self.points) != len(self.dwell):
            raise ValueError(
                f"Expected as many points as dwell times, got {len(self.points)} and {len(self.dwell)}"
            )


class SavedPlan(msgspec.Struct):
    """What is shown of a plan.json; without a plan all but status, reason and times are null or empty."""

    status: Literal["planned", "unreachable", "not_found"]
    planning_time: Annotated[float, msgspec.Meta(ge=0.0)]  # s
    control_period: Annotated[float, msgspec.Meta(gt=0.0, le=FARTHEST)]  # s
    reason: str = ""
    ended: str = "complete"
    arrival_time: Duration | None = None  # s
    clearance: float | None = None  # m; null without obstacles
    lower_bound: float | None = None  # s
    controls: list[tuple[Number, Number]] = []
    trajectory: list[tuple[Duration, Number, Number, Number]] = []
    schedule: SavedSchedule | None = None
    via: list[tuple[Number, Number, Duration]] = []  # m

    def __post_init__(self) -> None:
        if self.is_found and (self.arrival_time is None or not self.trajectory):
            raise ValueError("Expected an arrival time and a trajectory, the status being planned")

    @property
    def is_found(self) -> bool:
        """Whether there is a plan, be it to stay."""
        return self.status == "planned"


class CycleTimes(msgspec.Struct):
    """Processor time (ms) that planning took in a cycle of a drive."""

    median: float | None  # null if nothing was planned
    max: float | None


class SavedDrive(msgspec.Struct):
    """What is shown of a drive.json."""

    status: str
    arrival_time: Duration | None  # s; null if it does not arrive
    clearance: float | None  # m; null without obstacles
    reach: Annotated[float, msgspec.Meta(gt=0.0)] | None  # m, of the sensor; null: it sees everything
    planning_ms: CycleTimes
    control_period: Annotated[float, msgspec.Meta(gt=0.0, le=FARTHEST)]  # s
    speeds: list[tuple[Number, Number]]
    courses: list[SavedSchedule]
    reason: str = ""  # why nothing was driven


class SavedFleet(msgspec.Struct):
    """What is shown of a fleet.json; without plans its robots are none."""

    status: Literal["planned", "unreachable", "not_found"]
    planning_time: Annotated[float, msgspec.Meta(ge=0.0)]  # s
    robots: list[SavedPlan]
    reason: str = ""
    last_arrival: Duration | None = None  # s
    clearance: float | None = None  # m
    alone: list[Duration | None] = []  # s

    def __post_init__(self) -> None:
        whole = self.last_arrival is not None and None not in self.alone and all(map(_found, self.robots))
        if self.status == "planned" and not (whole and self.alone and self.robots):
            raise ValueError("Expected arrivals and a plan of every robot, the status being planned")


def _found(plan: SavedPlan) -> bool:
    return plan.is_found


def read_plan(path: Path) -> SavedPlan:
    """The plan in a file; raises FileError if it is not one."""
    return _read(path, SavedPlan, "a plan")


def read_drive(path: Path) -> SavedDrive:
    """The drive in a file; raises FileError if it is not one."""
    return _read(path, SavedDrive, "a drive")


def read_fleet_plan(path: Path) -> SavedFleet:
    """The plans of a fleet in a file; raises FileError if it holds none."""
    return _read(path, SavedFleet, "a plan of a fleet")


def _read(path: Path, kind: type[Saved], what: str) -> Saved:
    try:
        return msgspec.convert(read_json(path, LARGEST), kind)
    except msgspec.ValidationError as error:
        raise FileError(f"{path} is not {what}: {error}") from None
