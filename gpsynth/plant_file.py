"""A plant file: Python code that defines `problem` and may define `encoding`, executed to take them from it."""

import runpy
import traceback
from pathlib import Path
from typing import Any, TypeGuard

from gpsynth.encodings.protocol import Encoding
from gpsynth.errors import FileError, GpsynthError, ProblemError
from gpsynth.problem import Problem


def read_plant_file(path: Path) -> tuple[Problem, Encoding[Any] | None]:
    """Execute a Python file and take its `problem` and, if it has one, its `encoding`.

    Raises FileError if there is no such file or it fails, ProblemError if one of the two is something else, and what is
    wrong with the plant or problem under its own name, with the file and line in front.
    """
    if not path.is_file():
        raise FileError(f"{path} {'is not a file' if path.exists() else 'does not exist'}")
    try:
        names = runpy.run_path(str(path))
    except GpsynthError as error:
        text = str(error)  # of tracing, which names a line itself
        raise type(error)(text if text.startswith(str(path)) else f"{_place(path, error)}: {text}") from None
    except (Exception, SystemExit) as error:  # noqa: BLE001 a plant file is code and may raise anything
        text = error.msg if _is_syntax_of(error, path) else str(error)
        raise FileError(f"{_place(path, error)}: {type(error).__name__}: {text}") from None
    problem = names.get("problem")
    if not isinstance(problem, Problem):
        found = (
            f"defines it as {type(problem).__name__}"
            if "problem" in names
            else "defines nothing of that name"
        )
        raise ProblemError(f"{path} must define `problem`, a gpsynth.Problem, but {found}")
    encoding = names.get("encoding")
    if encoding is not None and not _is_encoding(encoding):
        raise ProblemError(
            f"{path} must define `encoding`, if at all, as an encoding such as gpsynth.TreeEncoding(...), "
            f"but defines it as {encoding!r}"
        )
    return problem, encoding


def _place(path: Path, error: BaseException) -> str:
    """The file and, if the error passed through it, the line."""
    if _is_syntax_of(error, path):
        return f"{path}, line {error.lineno}"
    lines = [
        frame.lineno for frame in traceback.extract_tb(error.__traceback__) if frame.filename == str(path)
    ]
    return f"{path}, line {lines[-1]}" if lines else str(path)


def _is_syntax_of(error: BaseException, path: Path) -> TypeGuard[SyntaxError]:
    """Whether the file itself is not Python."""
    return isinstance(error, SyntaxError) and error.filename == str(path)


def _is_encoding(value: Any) -> bool:
    """Whether a value is made like the protocol `Encoding`."""
    parts = ("inputs", "outputs", "space", "random", "mutate", "crossover", "decode", "parameters")
    return not isinstance(value, type) and all(hasattr(value, part) for part in parts)
