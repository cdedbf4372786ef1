"""The command `python -m applications.rosbot`: synthesize a stabilizer, plan with it, export it, show what came out."""

import sys
from collections.abc import Sequence
from math import inf
from pathlib import Path
from types import MappingProxyType
from typing import Literal

import click

from gpsynth.cli import ENCODINGS, EncodingName, export
from gpsynth.command_line import LOADING, run, seed_option, status, threads_option
from gpsynth.run_files import begin

PATH = click.Path(path_type=Path)
SEED = 1  # of the law that comes along
EXIT_CODES = MappingProxyType({"planned": 0, "unreachable": 3, "not_found": 4})
DRIVE_EXIT_CODES = MappingProxyType({"arrived": 0, "unreachable": 3, "late": 4, "collision": 4})
resume_option = click.option(
    "--resume", is_flag=True, help="Go on with the synthesis in the run folder, other options being the same."
)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and give the exit code."""
    return run(cli, arguments, name="python -m applications.rosbot")


@click.group()
def cli() -> None:
    """The ROSbot: a stabilizer found by genetic programming, and plans that move its equilibrium point."""


cli.add_command(export)


@cli.command()
@click.option("--out", type=PATH, default=Path("runs/rosbot"), show_default=True, help="Run folder.")
@click.option("--short", is_flag=True, help="A small search, to see that everything works.")
@resume_option
@seed_option(SEED)
@threads_option
def demo(out: Path, short: bool, resume: bool, seed: int, threads: int) -> int:
    """Both stages on the paper's scenario.

    From scratch, with obstacles and without; the run folder holds the law, the plans and their pictures.
    """
    with status(LOADING):
        from applications.rosbot.demo import run_demo
    plans = run_demo(out, seed=seed, short=short, resume=resume, threads=threads)
    return max(EXIT_CODES[each.status] for each in plans)


@cli.command()
@click.option("--out", type=PATH, default=Path("runs/stabilizer"), show_default=True, help="Run folder.")
@click.option("--budget", type=click.IntRange(min=1), help="Evaluations. [default: as in the demo]")
@click.option("--encoding", type=click.Choice(ENCODINGS), default="tree", show_default=True)
@click.option(
    "--objective",
    type=click.Choice(["plans", "settling"]),
    default="plans",
    show_default=True,
    help="What a law is to be fast at: plans and settling at one point, or settling alone.",
)
@resume_option
@seed_option(SEED)
@threads_option
def synthesize(
    out: Path,
    budget: int | None,
    encoding: EncodingName,
    objective: Literal["plans", "settling"],
    resume: bool,
    seed: int,
    threads: int,
) -> None:
    """Stage 1: find a stabilizer from scratch."""
    with status(LOADING):
        from applications.rosbot.stages import run_synthesis
    result = run_synthesis(
        begin(out, seed, resume=resume),
        seed=seed,
        budget=budget,
        encoding=encoding,
        objective=objective,
        resume=resume,
        threads=threads,
    )
    click.echo(result.table())
    click.echo(f"the best law, its exports and the front are in {out}")


@cli.command()
@click.argument("scenario_file", metavar="SCENARIO.json", type=PATH)
@click.option("--out", type=PATH, required=True, help="Folder for plan.json and its picture.")
@click.option("--law", "law_file", metavar="LAW.json", type=PATH, help="[default: the law that comes along]")
@click.option(
    "--via",
    type=(float, float, float),
    multiple=True,
    metavar="X Y TOLERANCE",
    help="A place (m) to pass on the way; repeatable, in their order.",
)
@click.option(
    "--deadline",
    type=click.FloatRange(min=0.0, min_open=True),
    help="Seconds by the clock, after which the best plan so far is taken: not the same one every time.",
)
@seed_option()
@threads_option
def plan(
    scenario_file: Path,
    out: Path,
    law_file: Path | None,
    via: tuple[tuple[float, float, float], ...],
    deadline: float | None,
    seed: int,
    threads: int,
) -> int:
    """Stage 2: plan for a scenario.

    Exit code 0 with a plan, 3 if the goal is proved to be unreachable, 4 if no plan was found, 2 if the input is wrong;
    plan.json says why. Ctrl-C ends the search and keeps the best plan so far: exit code 130.
    """
    with status(LOADING):
        from applications.rosbot.planner import Effort
        from applications.rosbot.saved import read_plan
        from applications.rosbot.scenario_file import read_scenario
        from applications.rosbot.show import print_plans
        from applications.rosbot.stabilizer import default_law
        from applications.rosbot.stages import load_steering_law, run_plan
        from applications.rosbot.through import check_via
    scenario = read_scenario(scenario_file)  # and every complaint about it before anything is written
    if via:
        check_via(scenario, via)
    law = load_steering_law(law_file) if law_file else default_law()
    effort = Effort(deadline=deadline or inf)
    path = run_plan(begin(out, seed), scenario_file, law, seed=seed, effort=effort, threads=threads, via=via)
    made = read_plan(path)
    print_plans([(scenario.name, made)])
    if made.ended == "interrupted":
        raise KeyboardInterrupt
    return EXIT_CODES[made.status]


@cli.command()
@click.argument("scenario_file", metavar="SCENARIO.json", type=PATH)
@click.option("--out", type=PATH, required=True, help="Folder for drive.json and its picture.")
@click.option("--law", "law_file", metavar="LAW.json", type=PATH, help="[default: the law that comes along]")
@click.option("--margin", type=float, default=0.05, show_default=True, help="Clearance to keep, in m.")
@click.option("--reach", type=float, default=3.0, show_default=True, help="How far the robot sees, in m.")
@click.option("--uncertain", is_flag=True, help="Gains that are off, wheels that slip, a noisy pose.")
@seed_option()
def drive(
    scenario_file: Path,
    out: Path,
    law_file: Path | None,
    margin: float,
    reach: float,
    uncertain: bool,
    seed: int,
) -> int:
    """Drive a simulated robot and plan on at 10 Hz.

    What rests is known from the beginning, what moves is seen when it is near. Exit code 0 if the goal is reached
    without a collision, 3 if what rests is proved to leave no way to it, 4 if it is not reached otherwise, 2 if the
    input is wrong.
    """
    with status(LOADING):
        from applications.rosbot.drive_file import status_of
        from applications.rosbot.loop import check_drivable, drive_scenario
        from applications.rosbot.replanning import Replanning
        from applications.rosbot.saved import read_drive
        from applications.rosbot.scenario_file import read_scenario
        from applications.rosbot.sensing import Sensor
        from applications.rosbot.show import drive_line
        from applications.rosbot.simulated_robot import UNCERTAIN, Flaws
        from applications.rosbot.stabilizer import default_law
        from applications.rosbot.stages import load_steering_law, write_drive_run
    scenario = read_scenario(scenario_file)
    law = load_steering_law(law_file) if law_file else default_law()
    sensor, settings = Sensor(reach), Replanning.keeping(margin)
    check_drivable(scenario, sensor)
    run_folder = begin(out, seed)
    with status(f"driving {scenario.name}"):
        driven = drive_scenario(
            scenario,
            law,
            flaws=UNCERTAIN if uncertain else Flaws(),
            sensor=sensor,
            settings=settings,
            seed=seed,
        )
    path = write_drive_run(run_folder, scenario_file, driven, law, sensor, seed)
    click.echo(drive_line(scenario.name, read_drive(path)))
    return DRIVE_EXIT_CODES[status_of(driven)]


@cli.command()
@click.argument("fleet_file", metavar="FLEET.json", type=PATH)
@click.option("--out", type=PATH, required=True, help="Folder for fleet.json and its picture.")
@click.option("--law", "law_file", metavar="LAW.json", type=PATH, help="[default: the law that comes along]")
@seed_option()
@threads_option
def fleet(fleet_file: Path, out: Path, law_file: Path | None, seed: int, threads: int) -> int:
    """Plan for several robots that start together.

    Their mutual clearance is proved. Exit code 0 with plans, 3 if a goal is proved to be unreachable, 4 if no plans
    were found, 2 if the input is wrong. Ctrl-C ends the search and keeps the best plans so far: exit code 130.
    """
    with status(LOADING):
        from applications.rosbot.fleet import check_fleet, plan_fleet
        from applications.rosbot.fleet_file import read_fleet
        from applications.rosbot.saved import read_fleet_plan
        from applications.rosbot.show import fleet_line
        from applications.rosbot.stabilizer import default_law
        from applications.rosbot.stages import load_steering_law, write_fleet_run
    robots = read_fleet(fleet_file)
    check_fleet(robots.scenarios)
    law = load_steering_law(law_file) if law_file else default_law()
    run_folder = begin(out, seed)
    with status(f"planning {robots.name}"):
        report = plan_fleet(robots.scenarios, [law], seed=seed, threads=threads)
    path = write_fleet_run(run_folder, fleet_file, report)
    click.echo(fleet_line(robots.name, read_fleet_plan(path)))
    if report.ended == "interrupted":
        raise KeyboardInterrupt
    return EXIT_CODES[report.status]


@cli.command()
@click.argument("place", metavar="RUN_OR_FILE", type=PATH)
def show(place: Path) -> None:
    """Print what a run folder holds.

    RUN_OR_FILE is a run folder, or a law.json, plan.json, drive.json or fleet.json. The pictures of plans, drives and
    fleets are drawn anew.
    """
    from applications.rosbot.show import show_place

    show_place(place)


if __name__ == "__main__":
    sys.exit(main())
