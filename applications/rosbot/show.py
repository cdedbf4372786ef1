"""What a run folder or a plan file holds: the figures in a table, and the pictures drawn anew."""

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Literal

import msgspec
import numpy as np

from applications.rosbot.figures import draw_plan, save_figure
from applications.rosbot.scenario import MOST
from applications.rosbot.scenario_file import read_scenario
from gpsynth.arrays import Floats
from gpsynth.errors import FileError
from gpsynth.files import read_json

LARGEST_PLAN = 20_000_000  # bytes
FARTHEST = 2.0 * MOST  # a scenario may end at MOST, and a plan or its points go beyond
Number = Annotated[float, msgspec.Meta(ge=-FARTHEST, le=FARTHEST)]
Duration = Annotated[float, msgspec.Meta(ge=0.0, le=FARTHEST)]


class SavedSchedule(msgspec.Struct):
    """The equilibrium points of a plan and their dwell times (s)."""

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


def read_plan(path: Path) -> SavedPlan:
    """The plan in a file; raises FileError if it is not one."""
    try:
        return msgspec.convert(read_json(path, LARGEST_PLAN), SavedPlan)
    except msgspec.ValidationError as error:
        raise FileError(f"{path} is not a plan: {error}") from None


def plan_files(place: Path) -> list[Path]:
    """The plans of a run folder, or the one that is named."""
    return sorted(place.glob("plan*.json")) if place.is_dir() else [place]


def scenario_beside(plan_file: Path) -> Path:
    """Where the scenario of a plan is kept: scenario.json beside plan.json, scenario_x.json beside plan_x.json."""
    return plan_file.with_name("scenario" + plan_file.name.removeprefix("plan"))


def name_of(plan_file: Path) -> str:
    """The name of a plan's scenario, or the plan's own where the scenario is not there."""
    scenario_file = scenario_beside(plan_file)
    return read_scenario(scenario_file).name if scenario_file.exists() else plan_file.stem


def redraw(plan_file: Path) -> Path | None:
    """Draw a plan as a PNG beside it; where there is no path to draw, an older picture is removed."""
    plan, picture = read_plan(plan_file), plan_file.with_suffix(".png")
    if not (plan.is_found and plan.controls) or not scenario_beside(plan_file).exists():
        picture.unlink(missing_ok=True)
        return None
    figure = draw_plan(
        read_scenario(scenario_beside(plan_file)),
        np.array(plan.trajectory),
        np.array(plan.controls),
        plan.control_period,
        _waypoints(plan),
        np.array(plan.via).reshape(-1, 3),
    )
    save_figure(figure, picture)
    return picture


def print_plans(plans: Sequence[tuple[str, SavedPlan]]) -> None:
    """A table with a row per plan: time, clearance, lower bound and their ratio; then why a plan is missing."""
    from rich import box
    from rich.console import Console
    from rich.table import Table

    table = Table(box=box.SIMPLE_HEAD, padding=(0, 1))
    table.add_column("scenario", overflow="fold")
    table.add_column("status", no_wrap=True)
    for heading in ("time\n(s)", "clearance\n(m)", "lower\nbound (s)", "ratio", "planning\n(s)"):
        table.add_column(heading, justify="right", no_wrap=True)
    for name, plan in plans:
        numbers = (plan.arrival_time, plan.clearance, plan.lower_bound, _ratio(plan), plan.planning_time)
        table.add_row(name, plan.status, *map(_text, numbers, (2, 3, 2, 3, 2)))
    console = Console()
    console.print(table)
    for name, plan in plans:
        if plan.reason:
            console.print(f"{name}: {plan.reason}", soft_wrap=True, markup=False)


def _waypoints(plan: SavedPlan) -> Floats:
    """The points (k, 3) whose turn comes before the arrival."""
    if plan.schedule is None:
        return np.empty((0, 3))
    points, dwell = (
        np.array(plan.schedule.points, dtype=np.float64).reshape(-1, 3),
        np.array(plan.schedule.dwell),
    )
    return points[: int(np.sum(np.cumsum(dwell) - dwell < plan.trajectory[-1][0]))]


def _ratio(plan: SavedPlan) -> float | None:
    return plan.arrival_time / plan.lower_bound if plan.arrival_time and plan.lower_bound else None


def _text(value: float | None, digits: int) -> str:
    return "-" if value is None or not math.isfinite(value) else f"{value:.{digits}f}"
