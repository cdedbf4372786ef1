"""The YAML that ROS's map_server writes, read strictly: names and numbers, and one list of three."""

import math
import re
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Literal, cast

from gpsynth.errors import ScenarioError
from gpsynth.files import check_readable

LARGEST_FILE = 100_000  # bytes
LARGEST = 1e4  # m
FIELDS = ("image", "resolution", "origin", "negate", "occupied_thresh", "free_thresh", "mode")
FLAGS = MappingProxyType({"0": False, "1": True, "false": False, "true": True})
MODES = ("trinary", "scale", "raw")
LINE = re.compile(r"([A-Za-z_]+)\s*:(?:\s+(.*))?")
COMMENT = re.compile(r"(^|\s)#.*$")


@dataclass(frozen=True)
class MapSettings:
    """How a map's image is read."""

    image: str  # relative to the YAML file, or absolute
    resolution: float  # m
    origin: tuple[float, float]  # m
    negate: bool
    occupied_thresh: float
    free_thresh: float
    mode: Literal["trinary", "scale", "raw"]


def read_settings(path: Path) -> MapSettings:
    """The content of a map's YAML file; ScenarioError names the file, the field and what is wrong."""
    try:
        return _settings(_fields(_lines(path)))
    except ScenarioError as error:
        raise ScenarioError(f"{path}: {error}") from None


def _lines(path: Path) -> list[str]:
    try:
        check_readable(path)
        with path.open("rb") as file:
            content = file.read(LARGEST_FILE + 1)
        text = content.decode("utf-8")
    except OSError as error:
        raise ScenarioError(f"the map cannot be read: {error.strerror}") from None
    except ValueError:
        raise ScenarioError("is no text; expected the YAML file of a map") from None
    if len(content) > LARGEST_FILE:
        raise ScenarioError(f"is larger than {LARGEST_FILE} bytes, too large for the YAML file of a map")
    lines = [COMMENT.sub("", line).rstrip() for line in text.splitlines()]
    return [line for line in lines if line and line != "---"]


def _fields(lines: list[str]) -> dict[str, str]:
    """Name -> text; the items of a list, one a line, are joined as if they stood in brackets."""
    fields: dict[str, str] = {}
    name = ""
    for line in lines:
        if line.lstrip().startswith("- ") and name:
            item = line.lstrip()[2:].strip()
            fields[name] = f"{fields[name][:-1]}, {item}]" if fields[name] else f"[{item}]"
            continue
        match = LINE.fullmatch(line)
        if not match:
            raise ScenarioError(f"line {line[:60]!r} is no field of a map; expected a name, a colon, a value")
        name = match[1]
        if name not in FIELDS:
            raise ScenarioError(f"there is no field {name[:60]} in a map; expected {', '.join(FIELDS)}")
        if name in fields:
            raise ScenarioError(f"the field {name} stands twice")
        fields[name] = (match[2] or "").strip()
    missing = [name for name in FIELDS[:-1] if not fields.get(name)]
    if missing:
        raise ScenarioError(f"the field {missing[0]} is missing")
    return fields


def _settings(fields: dict[str, str]) -> MapSettings:
    resolution, low, high = (
        _number(name, fields[name]) for name in ("resolution", "free_thresh", "occupied_thresh")
    )
    if not 0.0 < resolution <= LARGEST:
        raise ScenarioError(f"resolution is {resolution:g}; expected a number of meters above 0")
    if not 0.0 <= low < high <= 1.0:
        raise ScenarioError(
            f"free_thresh is {low:g} and occupied_thresh {high:g}; expected 0 <= free_thresh < occupied_thresh <= 1"
        )
    negate, mode = FLAGS.get(fields["negate"].lower()), fields.get("mode") or MODES[0]
    if negate is None:
        raise ScenarioError(f"negate is {fields['negate'][:60]}; expected 0 or 1")
    if mode not in MODES:
        raise ScenarioError(f"mode is {mode[:60]}; expected {', '.join(MODES)}")
    return MapSettings(
        image=_image(fields["image"]),
        resolution=resolution,
        origin=_origin(fields["origin"]),
        negate=negate,
        occupied_thresh=high,
        free_thresh=low,
        mode=cast(Literal["trinary", "scale", "raw"], mode),
    )


def _image(text: str) -> str:
    quoted = len(text) > 1 and text[0] == text[-1] and text[0] in "\"'"
    name = text[1:-1] if quoted else text
    if not name or "\0" in name or ".." in Path(name).parts:
        raise ScenarioError(
            f"image is {text[:60]}; expected the name of a file in the map's folder, or a whole path"
        )
    return name


def _origin(text: str) -> tuple[float, float]:
    items = text[1:-1].split(",") if text.startswith("[") and text.endswith("]") else []
    if len(items) != 3:
        raise ScenarioError(f"origin is {text[:60]}; expected [x, y, yaw]")
    x, y, yaw = (_number("origin", item.strip()) for item in items)
    if max(abs(x), abs(y)) > LARGEST:
        raise ScenarioError(f"origin is {text[:60]}; expected x and y within ±{LARGEST:g} m")
    if yaw != 0.0:
        raise ScenarioError(f"origin has the yaw {yaw:g}; expected 0, a map whose rows lie along x")
    return x, y


def _number(name: str, text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        raise ScenarioError(f"{name} is {text[:60]}; expected a number") from None
    if not math.isfinite(value):
        raise ScenarioError(f"{name} is {text[:60]}; expected a finite number")
    return value
