"""Plan files of format `rosbot-plan/1`: all that it takes to drive a plan, and to check it with another simulator."""

from pathlib import Path
from typing import Any

import numpy as np

from applications.rosbot.certificate import Certificate
from applications.rosbot.planner import PlanReport
from applications.rosbot.problems import PERIOD
from gpsynth.arrays import Floats
from gpsynth.files import write_json

FORMAT = "rosbot-plan/1"


def write_plan(report: PlanReport, path: Path) -> None:
    """Write a report as JSON, whole or not at all; raises FileError if that is not possible."""
    write_json(path, plan_document(report))


def plan_document(report: PlanReport) -> dict[str, Any]:
    """The report as a JSON-ready dictionary; without a plan its fields are null or empty.

    `controls` hold v (m/s) and omega (rad/s), each row for one `control_period` (s). `arrival_time` and `clearance` (m,
    null without obstacles) are those of the replay in steps of 1 ms; `trajectory` is that replay once a period;
    `certificate` is what is proved between its samples.
    """
    document: dict[str, Any] = {
        "format": FORMAT,
        "status": report.status,
        "reason": report.reason,
        "ended": report.ended,
        "via": [list(place) for place in report.via],
        "arrival_time": None,
        "clearance": None,
        "certificate": None,
        "lower_bound": report.lower_bound,
        "planning_time": report.planning_time,
        "evaluations": report.evaluations,
        "seed": report.seed,
        "law": None,
        "control_period": PERIOD,
        "controls": [],
        "trajectory": [],
        "schedule": None,
    }
    if report.plan is not None and report.replay is not None and report.law is not None:
        schedule, check = report.plan.schedule, report.replay
        document |= {
            "arrival_time": check.arrival_time,
            "clearance": _finite(check.clearance),
            "certificate": _proved(report.certificate) if report.certificate else None,
            "law": {"hash": report.law.hash, "formulas": list(report.law.formulas())},
            "controls": report.controls.tolist(),
            "trajectory": once_a_period(check.trajectory).tolist(),
            "schedule": {"points": schedule.points.tolist(), "dwell": schedule.dwell.tolist()},
        }
    return document


def _proved(certificate: Certificate) -> dict[str, Any]:
    return {
        "clearance": _finite(certificate.clearance),
        "room": _finite(certificate.room),
        "obstacle": certificate.obstacle,
        "robot": certificate.robot,
        "time": certificate.time,
    }


def _finite(value: float) -> float | None:
    return value if np.isfinite(value) else None


def once_a_period(trajectory: Floats) -> Floats:
    """The rows (t, x, y, theta) at every control period, and the last one."""
    periods = trajectory[:, 0] / PERIOD
    kept = np.abs(periods - np.round(periods)) < 1e-6
    kept[-1] = True
    return trajectory[kept]
