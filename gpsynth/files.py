"""Files are data: JSON read strictly and with limits, everything written whole or not at all."""

import contextlib
import errno
import json
import math
import os
import re
import secrets
from pathlib import Path
from typing import Any, NoReturn

from gpsynth.errors import FileError

MOST_BYTES = 1_000_000
DEEPEST = 32
LARGEST_INTEGER = 2**53  # beyond it a double no longer holds every integer
SURROGATES = re.compile("[\ud800-\udfff]")


def read_json(path: str | os.PathLike[str], most_bytes: int = MOST_BYTES) -> Any:
    """The content of a JSON file; raises FileError if it is missing, too large or not strict JSON."""
    return parse_json(_read(_path(path), most_bytes), str(path))


def parse_json(content: bytes | str, source: str = "the text") -> Any:
    """The value of strict JSON: no key twice, no NaN, Infinity or 1e400, integers below 2**53, at most 32 levels.

    Raises FileError, which calls the text `source`.
    """
    try:
        text = content.decode("utf-8") if isinstance(content, bytes) else content
        value = json.loads(
            text,
            object_pairs_hook=_distinct,
            parse_int=_integer,
            parse_float=_finite,
            parse_constant=_not_a_number,
        )
        _check_values(value)
    except json.JSONDecodeError as error:
        raise FileError(
            f"{source} is not JSON: {error.msg} at line {error.lineno}, column {error.colno}"
        ) from None
    except UnicodeDecodeError as error:
        raise FileError(f"{source} is not UTF-8 text: byte {error.start} does not belong there") from None
    except RecursionError:
        raise FileError(f"{source} is nested more than {DEEPEST} levels deep") from None
    except ValueError as error:
        raise FileError(f"{source} is not acceptable: {error}") from None
    return value


def write_json(path: str | os.PathLike[str], document: Any) -> None:
    """Write a document that `read_json` gives back; raises FileError if it holds NaN or infinity."""
    write_text(path, json_text(document, str(path)))


def json_text(document: Any, source: str = "the document") -> str:
    """The document as indented JSON; raises FileError if it is not representable."""
    try:
        return json.dumps(document, indent=1, allow_nan=False) + "\n"
    except (TypeError, ValueError) as error:
        raise FileError(f"{source} cannot be written as JSON: {error}") from None


def write_text(path: str | os.PathLike[str], text: str) -> None:
    """Write a text file: whoever reads `path` sees the old content or the new one, never a part."""
    write_bytes(path, text.encode("utf-8"))


def write_bytes(path: str | os.PathLike[str], content: bytes) -> None:
    """Write a file through a temporary one beside it; raises FileError and leaves nothing behind on failure."""
    target = _path(path)
    temporary = target.with_name(f".{target.name}.{secrets.token_hex(8)}.tmp")
    try:
        with temporary.open("xb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        temporary.replace(target)
    except OSError as error:
        raise FileError(f"{target} cannot be written: {_reason(error)}") from None
    finally:
        with contextlib.suppress(OSError):
            temporary.unlink(missing_ok=True)


def make_folder(path: str | os.PathLike[str]) -> Path:
    """The folder, made with its parents if it is not there; raises FileError if that fails."""
    folder = _path(path)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileError(f"{folder} cannot be made: {_reason(error)}") from None
    return folder


def check_readable(path: Path) -> None:
    """Raise OSError for a pipe or device, whose reading might never end."""
    if path.exists() and not (path.is_file() or path.is_dir()):
        raise OSError(errno.EINVAL, "it is not a regular file")


def _path(path: str | os.PathLike[str]) -> Path:
    try:
        return Path(path)
    except TypeError:
        raise FileError(f"a path must be text or a Path, got {path!r}") from None


def _read(path: Path, most_bytes: int) -> bytes:
    try:
        check_readable(path)
        with path.open("rb") as file:
            content = file.read(most_bytes + 1)  # and not its size, which may change
    except FileNotFoundError:
        raise FileError(f"{path} does not exist") from None
    except (OSError, ValueError) as error:
        raise FileError(f"{path} cannot be read: {_reason(error)}") from None
    if len(content) > most_bytes:
        raise FileError(f"{path} is larger than the {most_bytes} bytes allowed")
    return content


def _reason(error: Exception) -> str:
    return (isinstance(error, OSError) and error.strerror) or str(error)


def _distinct(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    fields = dict(pairs)
    if len(fields) < len(pairs):
        keys = [key for key, _ in pairs]
        twice = next(key for key in keys if keys.count(key) > 1)
        raise ValueError(f"the key {twice!r} stands twice in one object")
    return fields


def _integer(text: str) -> int:
    if len(text) > 17 or abs(int(text)) >= LARGEST_INTEGER:
        raise ValueError(f"the integer {_shortened(text)} is not below 2**53")
    return int(text)


def _finite(text: str) -> float:
    value = float(text)
    if not math.isfinite(value):
        raise ValueError(f"the number {_shortened(text)} is too large for a double")
    return value


def _not_a_number(text: str) -> NoReturn:
    raise ValueError(f"{text} is not a JSON number")


def _shortened(text: str) -> str:
    return text if len(text) <= 24 else f"{text[:24]}..."


def _check_values(value: Any) -> None:
    """Raise RecursionError if the value is too deep, ValueError if a text in it cannot be printed."""
    level, depth = [value], 0
    while level:
        if any(isinstance(item, str) and SURROGATES.search(item) for item in level):
            raise ValueError("a text in it holds half of a surrogate pair")
        if depth == DEEPEST and any(isinstance(item, dict | list) for item in level):
            raise RecursionError
        level, depth = [item for group in level for item in _items(group)], depth + 1


def _items(value: Any) -> list[Any]:
    if isinstance(value, dict):
        return [*value, *value.values()]
    return value if isinstance(value, list) else []
