"""Fleet files: of format `rosbot-fleet/1` what is given, of format `rosbot-fleet-plan/1` what came of it."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from applications.rosbot.fleet import FleetReport
from applications.rosbot.plan_file import plan_document
from applications.rosbot.scenario import Scenario
from applications.rosbot.scenario_file import FORMAT as SCENARIO_FORMAT
from applications.rosbot.scenario_file import json_of, read_with, scenario_of
from gpsynth.errors import ScenarioError
from gpsynth.files import write_json

FORMAT = "rosbot-fleet/1"
PLAN_FORMAT = "rosbot-fleet-plan/1"
MOST_ROBOTS = 100


@dataclass(frozen=True)
class Fleet:
    """Robots that start together, each with a scenario of its own."""

    name: str
    scenarios: tuple[Scenario, ...]


def read_fleet(path: str | Path) -> Fleet:
    """The fleet in a file; ScenarioError names the file, the robot, the field and the value that is wrong."""
    return read_with(parse_fleet, path, "a fleet")


def parse_fleet(text: str | bytes, *, name: str = "", folder: Path = Path()) -> Fleet:
    """The fleet in a JSON text: fields of a scenario for all, and in `robots` those of each, which come before them."""
    data = json_of(text)
    if not isinstance(data, dict) or data.get("format") != FORMAT:
        came = data.get("format") if isinstance(data, dict) else type(data).__name__
        raise ScenarioError(f'format is {str(came)[:60]!r}; expected "{FORMAT}"')
    robots = data.get("robots")
    if not isinstance(robots, list) or not 2 <= len(robots) <= MOST_ROBOTS:
        came = f"{len(robots)} of them" if isinstance(robots, list) else type(robots).__name__
        raise ScenarioError(f"robots is {came}; expected a list of 2 to {MOST_ROBOTS} robots")
    shared = {key: value for key, value in data.items() if key != "robots"} | {"format": SCENARIO_FORMAT}
    scenarios = []
    for number, own in enumerate(robots):
        if not isinstance(own, dict) or "format" in own:
            raise ScenarioError(f"robots[{number}] is no object with a start and a goal of its own")
        try:
            scenarios.append(scenario_of(shared | own, name=f"{number}", folder=folder))
        except ScenarioError as error:
            raise ScenarioError(f"robots[{number}]: {error}") from None
    return Fleet(str(data.get("name") or name), tuple(scenarios))


def write_fleet(report: FleetReport, path: Path) -> None:
    """Write a report as JSON, whole or not at all; raises FileError if that is not possible."""
    write_json(path, fleet_document(report))


def fleet_document(report: FleetReport) -> dict[str, Any]:
    """The report as a JSON-ready dictionary; without plans its robots are none.

    `robots` are documents of plans, each of which holds to its arrival, when the robot stops. `encounters` has the
    proved clearance (m) of every pair, `last_arrival` and `alone` are in s, the latter each robot's without the others.
    """
    return {
        "format": PLAN_FORMAT,
        "status": report.status,
        "reason": report.reason,
        "ended": report.ended,
        "last_arrival": max(report.arrivals, default=None),
        "clearance": report.clearance if np.isfinite(report.clearance) else None,
        "alone": [each.replay.arrival_time if each.replay else None for each in report.alone],
        "encounters": [
            {"robots": [each.first, each.second], "clearance": each.clearance, "time": each.time}
            for each in report.encounters
        ],
        "planning_time": report.planning_time,
        "evaluations": report.evaluations,
        "seed": report.seed,
        "robots": [plan_document(robot) for robot in report.robots],
    }
