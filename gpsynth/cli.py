"""The command `gpsynth`: synthesize a law for the plant in a Python file, export, assess and describe laws."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, get_args

import click

from gpsynth import __version__
from gpsynth.command_line import LOADING, law_argument, load_law, run, seed_option, status, threads_option
from gpsynth.errors import FileError
from gpsynth.files import write_json
from gpsynth.run_files import begin, export_law, recorder, write_result

if TYPE_CHECKING:
    from gpsynth.encodings.protocol import Encoding
    from gpsynth.problem import Problem
    from gpsynth.record import Run

EncodingName = Literal["tree", "cartesian", "network-operator"]
ENCODINGS: tuple[EncodingName, ...] = get_args(EncodingName)
FORMATS = ("json", "text", "latex", "c", "python")
TASK, TASK_FORMAT = "synthesis.json", "gpsynth-synthesis/1"


def main(arguments: Sequence[str] | None = None) -> int:
    """The entry point `gpsynth`."""
    return run(cli, arguments, name="gpsynth")


@click.group()
@click.version_option(__version__, prog_name="gpsynth")
def cli() -> None:
    """Genetic programming finds a stabilizer u = g(x, x*) as a readable formula."""


@cli.command()
@click.argument("plant_file", metavar="PLANT.py", type=click.Path(path_type=Path))
@click.option("--out", type=click.Path(path_type=Path), help="Run folder. [default: runs/PLANT]")
@click.option("--budget", type=click.IntRange(min=1), default=20_000, show_default=True, help="Evaluations.")
@click.option(
    "--encoding", "encoding_name", type=click.Choice(ENCODINGS), help="[default: the file's, or tree]"
)
@seed_option()
@threads_option
def synthesize(
    plant_file: Path,
    out: Path | None,
    budget: int,
    encoding_name: EncodingName | None,
    seed: int,
    threads: int,
) -> None:
    """Synthesize a law for the plant in PLANT.py, from scratch.

    PLANT.py is a Python file that defines `problem`, a gpsynth.Problem, and may define `encoding`. It is code and is
    executed: run only files you trust.
    """
    with status(LOADING):
        from gpsynth import synthesis
    problem, encoding = _task(plant_file, encoding_name)
    synthesis.check_encoding(problem, encoding)
    folder = begin(out or Path("runs") / plant_file.stem, seed)
    task = {
        "plant_file": str(plant_file.absolute()),
        "encoding": encoding_name,
        "seed": seed,
        "budget": budget,
    }
    write_json(folder.folder / TASK, {"format": TASK_FORMAT, **task})
    _synthesize(folder, problem, encoding, seed=seed, budget=budget, threads=threads)


@cli.command()
@click.argument("run_folder", metavar="RUN", type=click.Path(path_type=Path))
@click.option("--budget", type=click.IntRange(min=1), help="Evaluations in all. [default: the run's]")
@threads_option
def resume(run_folder: Path, budget: int | None, threads: int) -> None:
    """Go on with a synthesis that was ended in the run folder RUN.

    The result is that of a run without interruption. The plant file is executed again: run only files you trust.
    """
    from gpsynth.record import Run

    task = read_task(run_folder)
    with status(LOADING):
        problem, encoding = _task(Path(task["plant_file"]), task["encoding"])
    budget = budget or task["budget"]
    _synthesize(
        Run(run_folder), problem, encoding, seed=task["seed"], budget=budget, threads=threads, resume=True
    )


@cli.command()
@law_argument
@click.option("--out", type=click.Path(path_type=Path), required=True, help="Folder for the files.")
@click.option("--name", default="law", show_default=True, help="Of the files and of the C function.")
@click.option(
    "--format", "formats", type=click.Choice(FORMATS), multiple=True, help="Repeatable. [default: all]"
)
def export(law_file: Path, out: Path, name: str, formats: tuple[str, ...]) -> None:
    """Write a law as JSON, text, LaTeX, C99 and Python."""
    for path in export_law(load_law(law_file), out, name=name, formats=formats):
        click.echo(path)


@cli.command()
@law_argument
@click.argument("plant_file", metavar="PLANT.py", type=click.Path(path_type=Path))
@threads_option
def assess(law_file: Path, plant_file: Path, threads: int) -> None:
    """Say how a law does on the problem in PLANT.py: as given, with a finer clock, with other limits.

    PLANT.py is code and is executed, as in synthesize.
    """
    with status(LOADING):
        from gpsynth.plant_file import read_plant_file
        from gpsynth.verify import robustness
    law = load_law(law_file)
    click.echo(robustness.assess(law, read_plant_file(plant_file)[0], threads=threads).table())


@cli.command()
@law_argument
def info(law_file: Path) -> None:
    """Say what is in a law: formulas, limits, complexity, hash."""
    from gpsynth.law import FORMAT
    from gpsynth.record import versions

    law = load_law(law_file)
    plant = law.plant
    states = ", ".join(f"{state} ({unit})" for state, unit in plant.states.items())
    click.echo(f"plant       {plant.name}: {states}")
    for control, (unit, low, high) in plant.controls.items():
        click.echo(f"limits      {low:g} <= {control} <= {high:g} {unit}")
    click.echo(f"complexity  {law.complexity} instructions, {len(law.parameters)} parameters")
    click.echo(f"hash        {law.hash}")
    click.echo(f"format      {FORMAT}")
    click.echo(
        f"read with   {', '.join(f'{package} {text}' for package, text in versions(__version__).items())}"
    )
    click.echo("\n".join(["", *law.formulas()]))


def read_task(folder: Path) -> dict[str, Any]:
    """What `synthesize` was asked to do in a run folder; raises FileError if that is not written there."""
    from gpsynth.files import read_json

    task = read_json(folder / TASK)
    kinds = {"format": str, "plant_file": str, "encoding": str | None, "seed": int, "budget": int}
    if not isinstance(task, dict) or task.get("format") != TASK_FORMAT or set(task) != set(kinds):
        raise FileError(f"{folder / TASK} is no task of format {TASK_FORMAT!r}")
    wrong = [name for name, kind in kinds.items() if not isinstance(task[name], kind)]
    if wrong or task["encoding"] not in (None, *ENCODINGS):
        raise FileError(f"{folder / TASK} has a wrong {(*wrong, 'encoding')[0]}")
    return task


def _task(plant_file: Path, encoding_name: EncodingName | None) -> tuple["Problem", "Encoding[Any]"]:
    """The problem in a file, and the encoding that is named, or else the file's, or else trees."""
    from gpsynth.plant_file import read_plant_file

    problem, own = read_plant_file(plant_file)
    if own is not None and encoding_name is None:
        return problem, own
    return problem, named_encoding(encoding_name or "tree", problem)


def _synthesize(folder: "Run", problem: "Problem", encoding: "Encoding[Any]", **settings: Any) -> None:
    """Search, and write what was found, also after Ctrl-C."""
    from gpsynth import synthesis

    result = synthesis.synthesize(
        problem,
        encoding,
        folder=folder.folder,
        progress=True,
        callback=recorder(folder, problem),
        **settings,
    )
    write_result(result, folder)
    click.echo(result.table())
    click.echo(f"the best law, its exports and the front are in {folder.folder}")


def named_encoding(name: EncodingName, problem: "Problem") -> "Encoding[Any]":
    """An encoding for the problem's features and controls, with operations of general use."""
    from gpsynth.encodings.cartesian import CartesianEncoding
    from gpsynth.encodings.parameters import ParameterSpace
    from gpsynth.encodings.tree import TreeEncoding
    from gpsynth.encodings.variational import VariationalEncoding

    inputs, outputs = problem.features.names, problem.plant.control_names
    operations = ("add", "sub", "mul", "div_protected", "sin", "cos", "tanh", "sqrt_protected", "min", "max")
    space = ParameterSpace(count=8)
    if name == "network-operator":
        return VariationalEncoding(inputs, outputs, space=space)
    if name == "cartesian":
        return CartesianEncoding(inputs, outputs, operations, space)
    return TreeEncoding(inputs, outputs, operations, space)
