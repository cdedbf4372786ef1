"""The command `gpsynth`: synthesize a law for the plant in a Python file, export, assess and describe laws."""

import os
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, TypeVar, get_args

import click

from gpsynth import __version__
from gpsynth.errors import FileError, GpsynthError
from gpsynth.files import write_json

if TYPE_CHECKING:
    from gpsynth.encodings.protocol import Encoding
    from gpsynth.law import Law
    from gpsynth.optimizers import Progress
    from gpsynth.problem import Problem
    from gpsynth.record import Run
    from gpsynth.structure_search import SearchState
    from gpsynth.synthesis import FrontEntry, SynthesisResult

EncodingName = Literal["tree", "cartesian", "network-operator"]
ENCODINGS: tuple[EncodingName, ...] = get_args(EncodingName)
FORMATS = ("json", "text", "latex", "c", "python")
FRONT_FORMAT = "gpsynth-front/1"
TASK, TASK_FORMAT = "synthesis.json", "gpsynth-synthesis/1"
LOADING = "loading; the first time, the kernels are compiled"
Command = TypeVar("Command", bound=Callable[..., Any])
MOST_SEED = 2**53 - 1  # the largest integer that every reader of JSON keeps
INTERRUPTED = 130  # what a shell expects after Ctrl-C


def seed_option(default: int = 1) -> Callable[[Command], Command]:
    """The option --seed."""
    return click.option(
        "--seed",
        type=click.IntRange(0, MOST_SEED),
        default=default,
        show_default=True,
        help="Same seed, same result.",
    )


threads_option = click.option(
    "--threads",
    type=click.IntRange(min=1),
    default=os.cpu_count() or 1,
    show_default="all cores",
    help="They change the time, not the result.",
)
law_argument = click.argument("law_file", metavar="LAW.json", type=click.Path(path_type=Path))


def run(command: click.Command, arguments: Sequence[str] | None = None, *, name: str) -> int:
    """Run a command line, by default the process's, and give its exit code.

    What a user got wrong is one sentence on stderr and 2; Ctrl-C is 130.
    """
    try:
        return int(command.main(args=arguments, prog_name=name, standalone_mode=False) or 0)
    except click.ClickException as error:
        error.show()
        return error.exit_code
    except GpsynthError as error:
        click.echo(f"error: {_one_line(error)}", err=True)
        return 2
    except (click.Abort, KeyboardInterrupt):
        click.echo("interrupted", err=True)
        return INTERRUPTED


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


@contextmanager
def status(text: str) -> Iterator[None]:
    """A spinner with a text where stderr is a terminal, else nothing."""
    from rich.console import Console

    with Console(stderr=True).status(text):
        yield


def begin(folder: Path, seed: int, *, resume: bool = False) -> "Run":
    """A run of this command line in a folder, or with `resume` the one that is there.

    Raises FileError if the folder cannot be written to, or a new run would overwrite the checkpoint of an earlier one.
    """
    from gpsynth import record
    from gpsynth.runs import FILE

    if resume:
        return record.Run(folder)
    if (folder / FILE).exists():
        raise FileError(f"{folder} holds the checkpoint of an earlier run: resume it, or name another folder")
    return record.begin(folder, sys.argv, seed=seed, release=__version__)


def load_law(path: Path) -> "Law":
    """The law in a file; raises FileError or LawError."""
    from gpsynth.law import Law

    return Law.load(path)


def export_law(law: "Law", folder: Path, *, name: str = "law", formats: Sequence[str] = ()) -> list[Path]:
    """Write a law into `folder` in all formats, or in those given."""
    from gpsynth import export as exports
    from gpsynth.files import json_text, make_folder, write_text

    if not formats:
        return exports.write(law, folder, name)
    source, header = exports.to_c(law, name)  # also the check of the name
    contents = {
        "json": {".json": json_text(law.to_dict())},
        "text": {".txt": exports.to_text(law, name)},
        "latex": {".tex": exports.to_document(law, name)},
        "c": {".c": source, ".h": header},
        "python": {".py": exports.to_python(law, name)},
    }
    place = make_folder(folder)
    texts = {
        place / f"{name}{end}": text for key in dict.fromkeys(formats) for end, text in contents[key].items()
    }
    for path, text in texts.items():
        write_text(path, text)
    return list(texts)


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


def recorder(folder: "Run", problem: "Problem") -> Callable[["Progress[SearchState[Any]]"], None]:
    """A callback of `synthesize` that logs each generation and keeps the best law so far in law.json."""
    from gpsynth.law import Law

    begun = False

    def record(progress: "Progress[SearchState[Any]]") -> None:
        nonlocal begun
        if not begun:
            folder.rewind("synthesis", progress.generation)
            begun = True
        evaluations, cost = progress.history[-1] if progress.history else (0, float("inf"))
        folder.log(
            "synthesis", generation=progress.generation, evaluations=progress.evaluations, best_cost=cost
        )
        if evaluations == progress.evaluations:
            best = progress.state.front[-1]
            Law(problem.plant, problem.features, best.program, best.values).save(folder.folder / "law.json")

    return record


def write_result(result: "SynthesisResult", folder: "Run") -> None:
    """Write the best law in every form and the front; raises LawError if nothing was found.

    Raises KeyboardInterrupt when that is done, if Ctrl-C has ended the search.
    """
    from gpsynth.runs import INTERRUPTED as CUT_SHORT

    export_law(result.law, folder.folder)
    front = [_described(entry) for entry in result.front]
    write_json(folder.folder / "front.json", {"format": FRONT_FORMAT, "laws": front})
    if result.reason == CUT_SHORT:
        raise KeyboardInterrupt


def _described(entry: "FrontEntry") -> dict[str, Any]:
    return {
        "complexity": entry.complexity,
        "cost": entry.cost,
        "reached": entry.reached,
        "reached_at_least": entry.reached_at_least,
        "median_time": entry.median_time if entry.reached > 0.0 else None,  # s
        "worst_time": entry.worst_time if entry.reached > 0.0 else None,  # s
        "law": entry.law.to_dict(),
    }


def _one_line(error: BaseException) -> str:
    """What the error says, which may quote anything, without line breaks."""
    return " ".join(filter(None, map(str.strip, str(error).splitlines())))
