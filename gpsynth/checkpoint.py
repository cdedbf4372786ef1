"""Where a run stands, as strict JSON and back bit for bit: dataclasses field by field, arrays as their bytes.

Reading builds dataclasses and named tuples of modules that are loaded already, from numbers, texts and arrays,
and nothing else: no pickle, no import, no code.
"""

import base64
import binascii
import hashlib
import json
import math
import sys
from collections.abc import Mapping
from dataclasses import dataclass, fields, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np

from gpsynth.errors import FileError
from gpsynth.files import make_folder, read_json, write_text

FORMAT = "gpsynth-checkpoint/1"
MOST_BYTES = 500_000_000
TYPES = ("<f8", "<i4", "<i8", "|b1")  # of arrays


@dataclass(frozen=True)
class Checkpoint:
    """A file with the latest state of a run; `settings` maps what makes it that run (problem, seed, ...) to texts."""

    path: Path
    settings: Mapping[str, str]

    def write(self, state: Any) -> None:
        """Put the state in place of the one before, whole or not at all; raises FileError if that is not possible.

        The folder is made if need be.
        """
        make_folder(self.path.parent)
        content = {"format": FORMAT, "settings": dict(self.settings), "state": plain(state)}
        write_text(self.path, json.dumps({**content, "hash": _digest(content)}, allow_nan=False))

    def read(self) -> Any:
        """The state that was written last; raises FileError if there is none, it is damaged, or of another run."""
        document = read_json(self.path, MOST_BYTES)
        if not isinstance(document, dict) or document.get("format") != FORMAT:
            raise FileError(f"{self.path} is no checkpoint of format {FORMAT!r}")
        content = {key: value for key, value in document.items() if key != "hash"}
        if document.get("hash") != _digest(content) or set(content) != {"format", "settings", "state"}:
            raise FileError(f"{self.path} does not match its hash; it was changed or damaged")
        theirs = content["settings"]
        other = [name for name in self.settings if theirs.get(name) != self.settings[name]]
        if other or set(theirs) != set(self.settings):
            raise FileError(
                f"{self.path} cannot be continued: it is of a run with another {' and another '.join(other)}"
            )
        try:
            return _restored(content["state"])
        except (TypeError, ValueError, KeyError, AttributeError, binascii.Error) as error:
            raise FileError(f"{self.path} holds no state of this version: {error}") from None


def fingerprint(value: Any) -> str:
    """SHA-256 of settings: numbers, texts, arrays, mappings and dataclasses of them; a function counts by its name."""
    return _digest(plain(value, functions=True))


def plain(value: Any, *, functions: bool = False) -> Any:
    """The value as JSON has it; raises FileError for what has no place there."""
    if value is None or isinstance(value, bool | int | str):
        return value
    if isinstance(value, float):
        return value if math.isfinite(value) else {"float": str(value)}
    if isinstance(value, np.ndarray) and value.dtype.str in TYPES:
        data = base64.b64encode(np.ascontiguousarray(value).tobytes()).decode("ascii")
        return {"array": value.dtype.str, "shape": list(value.shape), "data": data}
    if is_dataclass(value) and not isinstance(value, type):
        members = {item.name: getattr(value, item.name) for item in fields(value)}
        return _object(type(value), members, functions)
    if isinstance(value, tuple) and hasattr(value, "_fields"):
        return _object(type(value), dict(zip(value._fields, value, strict=True)), functions)
    if isinstance(value, tuple | list):
        return [plain(item, functions=functions) for item in value]
    if isinstance(value, Mapping):
        return {"map": [[key, plain(item, functions=functions)] for key, item in value.items()]}
    if functions and hasattr(value, "__qualname__"):
        return {"function": f"{value.__module__}:{value.__qualname__}"}
    raise FileError(f"a {type(value).__name__} cannot be kept in a checkpoint: {value!r}")


def _object(kind: type, members: Mapping[str, Any], functions: bool) -> dict[str, Any]:
    inner = {name: plain(item, functions=functions) for name, item in members.items()}
    return {"class": f"{kind.__module__}:{kind.__qualname__}", "fields": inner}


def _restored(document: Any) -> Any:
    if isinstance(document, list):
        return tuple(_restored(item) for item in document)
    if not isinstance(document, dict):
        return document
    if "float" in document:
        return float(document["float"])
    if "array" in document:
        return _array(document)
    if "map" in document:
        return {key: _restored(item) for key, item in document["map"]}
    inner = {name: _restored(item) for name, item in document["fields"].items()}
    return _class(document["class"])(**inner)


def _array(document: dict[str, Any]) -> Any:
    if document["array"] not in TYPES:
        raise ValueError(f"arrays of {document['array']!r} are not kept")
    content = base64.b64decode(document["data"], validate=True)
    return np.frombuffer(content, dtype=document["array"]).reshape(document["shape"])


def _class(reference: str) -> Any:
    module, _, name = reference.partition(":")
    found = getattr(sys.modules.get(module), name, None)
    if not isinstance(found, type) or not (is_dataclass(found) or hasattr(found, "_fields")):
        raise ValueError(f"there is no class {reference!r} for it")
    return found


def _digest(document: Any) -> str:
    return hashlib.sha256(json.dumps(document, sort_keys=True).encode()).hexdigest()
