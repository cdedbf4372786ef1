"""The two stages as a person runs them: progress shown and logged, results in a run folder."""

import json
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path

import click
import numpy as np

from applications.rosbot.drive_file import write_drive
from applications.rosbot.fleet import FleetReport
from applications.rosbot.fleet_file import write_fleet
from applications.rosbot.loop import Drive
from applications.rosbot.map_copy import copy_map
from applications.rosbot.model import STATES
from applications.rosbot.plan_file import plan_document, write_plan
from applications.rosbot.planner import Effort, PlanReport, plan_scenario
from applications.rosbot.scenario_file import read_scenario
from applications.rosbot.sensing import Sensor
from applications.rosbot.show import (
    DRIVE,
    FLEET,
    redraw,
    redraw_drive,
    redraw_fleet,
    scenario_beside,
)
from applications.rosbot.stabilizer import SEARCH_BUDGET, stabilization, synthesize_stabilizer
from applications.rosbot.through import plan_through
from gpsynth.cli import EncodingName
from gpsynth.command_line import load_law, status
from gpsynth.errors import FileError, GpsynthError, LawError
from gpsynth.files import write_bytes
from gpsynth.law import Law
from gpsynth.record import Run
from gpsynth.run_files import recorder, write_result
from gpsynth.synthesis import SynthesisResult

CONTROLS = ("v", "omega")
# what drawing and writing can end with; a plan that is written is not lost for any of it
FAILURES = (
    GpsynthError,
    OSError,
    ImportError,
    MemoryError,
    ArithmeticError,
    ValueError,
    TypeError,
    RuntimeError,
)


def run_synthesis(
    run: Run,
    *,
    seed: int,
    budget: int | None = None,
    encoding: EncodingName = "tree",
    resume: bool = False,
    threads: int = 1,
) -> SynthesisResult:
    """Stage 1 into a run folder: the law in every form, the front and the log; the best so far is there all along.

    With `resume` it goes on from the folder's checkpoint, which must be of a run with the same settings.
    """
    problem = stabilization(np.zeros((1, 3)))
    result = synthesize_stabilizer(
        seed=seed,
        budget=budget or SEARCH_BUDGET,
        encoding=encoding,
        folder=run.folder,
        resume=resume,
        threads=threads,
        progress=True,
        callback=recorder(run, problem),
    )
    write_result(result, run)
    return result


def run_plan(
    run: Run,
    scenario_file: Path,
    law: Law,
    *,
    plan_file: str = "plan.json",
    seed: int,
    effort: Effort = Effort(),
    threads: int = 1,
    via: Sequence[tuple[float, float, float]] = (),
) -> Path:
    """Stage 2 into a run folder: the plan, its picture and a copy of its scenario; the log holds each improvement.

    The plan is written first. Raises FileError if that fails, when it has been printed; a failure after it is a warning
    on stderr.
    """
    scenario, source, before = read_scenario(scenario_file), scenario_file.read_bytes(), run.elapsed
    with status(f"planning {scenario.name}"):
        if via:
            report = plan_through(scenario, np.array(via), law, seed=seed, effort=effort, threads=threads)
        else:
            report = plan_scenario(scenario, [law], seed=seed, effort=effort, threads=threads)
    path = run.folder / plan_file
    _keep(report, path)
    for what, work, older in (
        ("its map", lambda: copy_map(scenario_file, run.folder), None),
        ("its scenario", lambda: write_bytes(scenario_beside(path), source), scenario_beside(path)),
        ("its picture", lambda: redraw(path), path.with_suffix(".png")),
        ("its log", lambda: _log(run, f"plan {scenario.name}", report, before), None),
    ):
        _besides(path, what, work, older)
    return path


def write_drive_run(run: Run, scenario_file: Path, drive: Drive, law: Law, sensor: Sensor, seed: int) -> Path:
    """A drive into a run folder, with its picture and a copy of its scenario.

    The drive is written first; a failure after that is a warning on stderr.
    """
    path = run.folder / DRIVE
    write_drive(drive, law, sensor, seed, path)
    _with_scenario(path, scenario_file)
    _besides(path, "its picture", lambda: redraw_drive(path), path.with_suffix(".png"))
    return path


def write_fleet_run(run: Run, fleet_file: Path, report: FleetReport) -> Path:
    """The plans of a fleet into a run folder, with their picture and a copy of what they are for.

    The plans are written first; a failure after that is a warning on stderr.
    """
    path = run.folder / FLEET
    write_fleet(report, path)
    _with_scenario(path, fleet_file)
    _besides(path, "its picture", lambda: redraw_fleet(path), path.with_suffix(".png"))
    return path


def _with_scenario(path: Path, source: Path) -> None:
    """A copy of the scenario, with its map, beside what is written."""
    copy = scenario_beside(path)
    _besides(path, "its map", lambda: copy_map(source, path.parent), None)
    _besides(path, "its scenario", lambda: write_bytes(copy, source.read_bytes()), copy)


def _keep(report: PlanReport, path: Path) -> None:
    """Write a plan, before anything else that may fail; if it cannot be written, print it and raise FileError."""
    try:
        write_plan(report, path)
    except KeyboardInterrupt:
        write_plan(report, path)
        raise
    except FileError as error:
        click.echo(json.dumps(plan_document(report), allow_nan=False))
        raise FileError(f"{error}; what was found is on standard output instead") from None


def _besides(path: Path, what: str, work: Callable[[], object], older: Path | None) -> None:
    """Do what comes after a plan is written; a failure is a warning, and what an earlier run has left there goes."""
    try:
        work()
    except FAILURES as error:
        if older is not None:
            with suppress(OSError):
                older.unlink(missing_ok=True)
        reason = " ".join(str(error).split()) or type(error).__name__
        click.echo(f"warning: {path} is written, {what} is not: {reason}", err=True)


def load_steering_law(path: Path) -> Law:
    """The law in a file, if it is one that scenarios can use; raises FileError or LawError."""
    law = load_law(path)
    names = law.plant.state_names, law.plant.control_names
    if names != (tuple(STATES), CONTROLS):
        states, controls = map(", ".join, names)
        raise LawError(
            f"{path} brings {states} to a target by {controls}; "
            f"a scenario needs {', '.join(STATES)} and {', '.join(CONTROLS)}"
        )
    return law


def _log(run: Run, stage: str, report: PlanReport, before: float) -> None:
    """A line for each improvement of a plan begun after `before` (s): its cost is its arrival time (s)."""
    run.rewind(stage)
    for number, (evaluations, arrival_time, seconds) in enumerate(report.history, start=1):
        times = {"best_cost": arrival_time, "elapsed": before + seconds}
        run.log(stage, generation=number, evaluations=evaluations, **times)
