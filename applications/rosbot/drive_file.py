"""Drive files of format `rosbot-drive/1`: what became of a drive, and every course that was followed in it."""

from pathlib import Path
from typing import Any

import numpy as np

from applications.rosbot.courses import Course
from applications.rosbot.loop import CYCLE, Drive
from applications.rosbot.plan_file import once_a_period
from applications.rosbot.problems import PERIOD
from applications.rosbot.sensing import Sensor
from gpsynth.files import write_json
from gpsynth.law import Law

FORMAT = "rosbot-drive/1"


def write_drive(drive: Drive, law: Law, sensor: Sensor, seed: int, path: Path) -> None:
    """Write a drive as JSON, whole or not at all; raises FileError if that is not possible."""
    write_json(path, drive_document(drive, law, sensor, seed))


def drive_document(drive: Drive, law: Law, sensor: Sensor, seed: int) -> dict[str, Any]:
    """The drive as a JSON-ready dictionary.

    `speeds` hold the robot's v (m/s) and omega (rad/s), each row for one `control_period` (s); `trajectory` is their
    replay once a period. `courses` has one entry a `cycle` (s), with what it promised up to its goal when it was
    planned: null where it does not arrive, or nothing is in the way. Where the goal is unreachable, `reason` says why,
    and nothing is driven. `reach` (m) is the sensor's, null if it sees everything.
    """
    cycles = 1e3 * np.quantile(drive.cycles, (0.5, 0.99, 1.0)) if len(drive.cycles) else np.full(3, np.inf)
    return {
        "format": FORMAT,
        "status": status_of(drive),
        "reason": drive.unreachable,
        "arrival_time": _finite(drive.replay.arrival_time),
        "clearance": _finite(drive.replay.clearance),
        "seed": seed,
        "law": {"hash": law.hash, "formulas": list(law.formulas())},
        "reach": _finite(sensor.reach),
        "cycle": CYCLE,
        "planning_ms": dict(zip(("median", "p99", "max"), map(_finite, cycles.tolist()), strict=True)),
        "control_period": PERIOD,
        "speeds": drive.applied.tolist(),
        "trajectory": once_a_period(drive.replay.trajectory).tolist(),
        "courses": [_course(course) for course in drive.courses],
    }


def status_of(drive: Drive) -> str:
    """`unreachable`, `collision` or `late` if something went wrong, else `arrived`."""
    if drive.unreachable:
        return "unreachable"
    if not drive.is_safe:
        return "collision"
    return "arrived" if drive.arrives else "late"


def _course(course: Course) -> dict[str, Any]:
    return {
        "arrival_time": _finite(course.arrival_time),
        "clearance": _finite(course.clearance),
        "points": course.schedule.points.tolist(),
        "goal": course.goal.tolist(),
        "dwell": course.schedule.dwell.tolist(),
    }


def _finite(value: float) -> float | None:
    return value if np.isfinite(value) else None
