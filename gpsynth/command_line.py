"""What the command lines of the package share: options, and mistakes told as one sentence with an exit code."""

import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from gpsynth.errors import GpsynthError

if TYPE_CHECKING:
    from gpsynth.law import Law

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


@contextmanager
def status(text: str) -> Iterator[None]:
    """A spinner with a text where stderr is a terminal, else nothing."""
    from rich.console import Console

    with Console(stderr=True).status(text):
        yield


def load_law(path: Path) -> "Law":
    """The law in a file; raises FileError or LawError."""
    from gpsynth.law import Law

    return Law.load(path)


def _one_line(error: BaseException) -> str:
    """What the error says, which may quote anything, without line breaks."""
    return " ".join(filter(None, map(str.strip, str(error).splitlines())))
