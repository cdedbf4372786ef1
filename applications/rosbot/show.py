"""What a run folder or one of its files holds: the figures in words, and the pictures drawn anew."""

import math
from collections.abc import Sequence
from pathlib import Path

import click
import numpy as np

from applications.rosbot.drive_figure import draw_drive
from applications.rosbot.figures import draw_plan, save_figure
from applications.rosbot.fleet_figure import draw_fleet
from applications.rosbot.fleet_file import read_fleet
from applications.rosbot.others import Other, held_until
from applications.rosbot.replay import replay
from applications.rosbot.saved import (
    SavedDrive,
    SavedFleet,
    SavedPlan,
    read_drive,
    read_fleet_plan,
    read_plan,
)
from applications.rosbot.scenario_file import read_scenario
from applications.rosbot.sensing import Sensor
from gpsynth.arrays import Floats
from gpsynth.command_line import load_law
from gpsynth.errors import FileError

DRIVE, FLEET, LAW = "drive.json", "fleet.json", "law.json"


def show_place(place: Path) -> None:
    """Print what a run folder or a single file holds, and draw its pictures anew.

    Raises FileError if there is nothing to show, or a file is damaged.
    """
    files = plan_files(place)
    law_file, drive_file, fleet_file = (_named(place, name) for name in (LAW, DRIVE, FLEET))
    if not (files or law_file or drive_file or fleet_file):
        raise FileError(f"{place} holds none of {LAW}, plan.json, {DRIVE} and {FLEET}")
    if law_file:
        click.echo("\n".join(load_law(law_file).formulas()))
    if files:
        print_plans([(name_of(path), read_plan(path)) for path in files])
    if drive_file:
        click.echo(drive_line(name_of(drive_file), read_drive(drive_file)))
    if fleet_file:
        click.echo(fleet_line(name_of(fleet_file), read_fleet_plan(fleet_file)))
    drawn = [
        *map(redraw, files),
        drive_file and redraw_drive(drive_file),
        fleet_file and redraw_fleet(fleet_file),
    ]
    for picture in filter(None, drawn):
        click.echo(f"drawn: {picture}")


def _named(place: Path, name: str) -> Path | None:
    """The file of a name in a folder, or the one that is named itself."""
    path = place / name if place.is_dir() else place
    return path if path.name == name and path.exists() else None


def plan_files(place: Path) -> list[Path]:
    """The plans of a run folder, or the one that is named."""
    if place.is_dir():
        return sorted(place.glob("plan*.json"))
    return [] if place.name in (DRIVE, FLEET, LAW) and place.exists() else [place]


def scenario_beside(file: Path) -> Path:
    """Where the scenario of a plan is kept: scenario.json beside plan.json, scenario_x.json beside plan_x.json.

    A drive has scenario_drive.json, a fleet scenario_fleet.json, so that all may share a folder.
    """
    stem = file.stem.removeprefix("plan").removeprefix("_")
    return file.with_name(f"scenario_{stem}.json" if stem else "scenario.json")


def name_of(file: Path) -> str:
    """The name of the scenario of a plan, drive or fleet, or the file's own where the scenario is not there."""
    scenario_file = scenario_beside(file)
    if not scenario_file.exists():
        return file.stem
    return read_fleet(scenario_file).name if file.name == FLEET else read_scenario(scenario_file).name


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


def redraw_drive(file: Path) -> Path | None:
    """Draw a drive as a PNG beside its file; where its scenario is not there, an older picture is removed."""
    drive, picture = read_drive(file), file.with_suffix(".png")
    if not scenario_beside(file).exists():
        picture.unlink(missing_ok=True)
        return None
    scenario = read_scenario(scenario_beside(file))
    trajectory = replay(scenario, np.array(drive.speeds).reshape(-1, 2), drive.control_period).trajectory
    ways = [np.array(course.points).reshape(-1, 3) for course in drive.courses]
    save_figure(draw_drive(scenario, trajectory, ways, Sensor(drive.reach or math.inf)), picture)
    return picture


def redraw_fleet(file: Path) -> Path | None:
    """Draw the plans of a fleet as a PNG beside their file; where there are none, an older picture is removed."""
    fleet, picture = read_fleet_plan(file), file.with_suffix(".png")
    if not fleet.robots or not scenario_beside(file).exists():
        picture.unlink(missing_ok=True)
        return None
    scenarios = read_fleet(scenario_beside(file)).scenarios
    if len(scenarios) != len(fleet.robots):
        raise FileError(
            f"{scenario_beside(file)} has {len(scenarios)} robots; {file} has {len(fleet.robots)}"
        )
    driven = []
    for scenario, plan in zip(scenarios, fleet.robots, strict=True):
        controls = np.array(plan.controls).reshape(-1, 2)
        held = held_until(controls, plan.control_period, plan.arrival_time or 0.0)
        driven.append(Other(scenario.start, *held, scenario.radius))
    save_figure(draw_fleet(scenarios, driven), picture)
    return picture


def drive_line(name: str, drive: SavedDrive) -> str:
    """What came of a drive."""
    cycle, end = drive.planning_ms, len(drive.speeds) * drive.control_period
    end = end if drive.arrival_time is None else drive.arrival_time
    clearance = "" if drive.clearance is None else f", clearance {drive.clearance:.3f} m"
    if drive.reason:
        return f"{name}: {drive.status}, {drive.reason}"
    planning = f"planning {_text(cycle.median, 0)} ms a cycle, at most {_text(cycle.max, 0)} ms"
    return f"{name}: {drive.status}, {end:.2f} s{clearance}, {planning}"


def fleet_line(name: str, fleet: SavedFleet) -> str:
    """What came of the plans of a fleet."""
    if fleet.last_arrival is None:
        return f"{name}: {fleet.status}, {fleet.reason}"
    alone = max(each or 0.0 for each in fleet.alone)
    return (
        f"{name}: {fleet.status}, last arrival {fleet.last_arrival:.2f} s, alone {alone:.2f} s, clearance of "
        f"any two at least {_text(fleet.clearance, 4)} m, planned in {fleet.planning_time:.1f} s"
    )


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
