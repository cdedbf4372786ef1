"""Scenario files of format `rosbot-scenario/1`: JSON, read strictly, every complaint one sentence."""

import json
import math
import re
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from types import MappingProxyType
from typing import Literal, TypeVar

import msgspec
import numpy as np

from applications.rosbot.scenario import MODELS, Scenario
from applications.rosbot.scenario_parts import (
    Circle,
    Footprint,
    MapPart,
    Obstacle,
    Strict,
    body_of,
    room_of,
)
from gpsynth.errors import ScenarioError
from gpsynth.files import SURROGATES, check_readable

FORMAT = "rosbot-scenario/1"
Parsed = TypeVar("Parsed")
LARGEST_FILE = 4_000_000  # bytes
NAME = re.compile("[A-Za-z_]{1,60}")  # what fields are called: nothing that a complaint could not repeat
CHOICES = MappingProxyType(
    {
        "format": FORMAT,
        "model": ", ".join(MODELS),
        "type": "circle, segment, polygon",
        "robot.footprint.type": "circle, circles, rectangle",
        "map.unknown": "occupied, free",
        "applies_to": "robot_centre",
    }
)  # what a text may be, by the place or the name of its field


class _Limits(Strict):
    v: tuple[float, float]
    omega: tuple[float, float]


class _Robot(Strict):
    footprint: Footprint
    turning_radius: float = 0.0
    name: str = "rosbot"


class _Bounds(Strict):
    x: tuple[float, float]
    y: tuple[float, float]
    applies_to: Literal["robot_centre"] = "robot_centre"


class _Tolerance(Strict):
    position: float
    heading: float


class _Document(Strict):
    format: Literal["rosbot-scenario/1"]
    limits: _Limits
    robot: _Robot
    bounds: _Bounds
    start: tuple[float, float, float]
    goal: tuple[float, float, float]
    goal_tolerance: _Tolerance
    time_limit: float
    obstacles: list[Obstacle]
    map: MapPart | None = None
    name: str = ""
    family: str = ""
    note: str = ""
    model: Literal["unicycle", "dynamic_unicycle", "car"] = "unicycle"
    expect_feasible: bool | None = None


def read_scenario(path: str | Path) -> Scenario:
    """The scenario in a file; ScenarioError names the file, the field and the value that is wrong."""
    return read_with(parse_scenario, path, "a scenario")


def read_with(parse: Callable[..., Parsed], path: str | Path, what: str) -> Parsed:
    """What `parse` makes of a file's text, name and folder; ScenarioError names the file."""
    if not isinstance(path, str | Path):
        raise ScenarioError(f"{what} is read from a str or a Path, got {path!r}")
    try:
        return parse(_text_of(Path(path)), name=Path(path).stem, folder=Path(path).parent)
    except ScenarioError as error:
        raise ScenarioError(f"{path}: {error}") from None


def parse_scenario(text: str | bytes, *, name: str = "", folder: Path = Path()) -> Scenario:
    """The scenario in a JSON text, called `name` if the text does not name it; its map is looked for in `folder`."""
    return scenario_of(json_of(text), name=name, folder=folder)


def scenario_of(data: object, *, name: str = "", folder: Path = Path()) -> Scenario:
    """The same of what `json_of` has read."""
    try:
        document = msgspec.convert(data, _Document)
    except msgspec.ValidationError as error:
        raise ScenarioError(_sentence(str(error), data)) from None
    return _scenario(document, name, folder)


def _scenario(document: _Document, name: str, folder: Path) -> Scenario:
    circles = [each for each in document.obstacles if isinstance(each, Circle)]
    return Scenario(
        start=np.array(document.start),
        goal=np.array(document.goal),
        speed_limits=document.limits.v,
        turn_limits=document.limits.omega,
        bounds=np.array([*document.bounds.x, *document.bounds.y]),
        circles=np.array([(c.x, c.y, c.vx, c.vy, c.r) for c in circles]).reshape(-1, 5),
        **body_of(document.robot.footprint),
        room=room_of(document.obstacles, document.map, folder),
        model=document.model,
        turning_radius=document.robot.turning_radius,
        position_tolerance=document.goal_tolerance.position,
        heading_tolerance=document.goal_tolerance.heading,
        time_limit=document.time_limit,
        name=document.name or name,
        note=document.note,
        expect_feasible=document.expect_feasible,
    )


def _text_of(path: Path) -> bytes:
    """What stands in a file; ScenarioError if it cannot be read or is too large."""
    try:
        check_readable(path)
        with path.open("rb") as file:
            content = file.read(LARGEST_FILE + 1)
    except OSError as error:
        raise ScenarioError(f"cannot be read: {error.strerror}") from None
    if len(content) > LARGEST_FILE:
        raise ScenarioError(f"is larger than {LARGEST_FILE} bytes, too large for a scenario")
    return content


def json_of(text: str | bytes) -> object:
    """The value of a JSON text without duplicate fields, NaN or infinity; ScenarioError says what is wrong."""
    try:
        data = json.loads(text, object_pairs_hook=_without_duplicates)
        _check_values(data, "")
    except RecursionError:
        raise ScenarioError("is nested too deeply for a scenario") from None
    except ValueError as error:
        raise ScenarioError(f"is not JSON: {error}") from None
    return data


def _without_duplicates(pairs: list[tuple[str, object]]) -> dict[str, object]:
    unique = dict(pairs)
    if len(unique) < len(pairs):
        name = Counter(name for name, _ in pairs).most_common(1)[0][0]
        raise ScenarioError(f"field {_short(name)} stands twice in one object")
    return unique


def _check_values(data: object, place: str) -> None:
    """Raise ScenarioError for what a number, a text or the name of a field cannot be."""
    if isinstance(data, float) and not math.isfinite(data):
        raise ScenarioError(f"{place} is {data}; expected a finite number")
    if isinstance(data, str) and SURROGATES.search(data):
        raise ScenarioError(
            f"{place or 'the document'} is {_short(data)}; half of a surrogate pair is no text"
        )
    if isinstance(data, dict):
        for name, value in data.items():
            if not NAME.fullmatch(name):
                where = _joined(place, _short(name))
                raise ScenarioError(f"{where} is {_short(value)}; the format has no such field")
            _check_values(value, _joined(place, name))
    if isinstance(data, list):
        for index, value in enumerate(data):
            _check_values(value, f"{place}[{index}]")


def _sentence(complaint: str, data: object) -> str:
    """msgspec's complaint with the value it is about, e.g. `limits.v[0] is "fast"; expected float, got str`."""
    reason, _, place = complaint.partition(" - at `$")
    place = place.rstrip("`").lstrip(".")
    field = re.search(r"(unknown|missing required) field `(.*)`", reason)
    value = data
    for name, index in re.findall(r"([^.\[\]]+)|\[(\d+)\]", place):
        if isinstance(value, dict):
            value = value[name]
        elif isinstance(value, list):
            value = value[int(index)]
    if field and field[1] == "unknown" and isinstance(value, dict):
        return f"{_joined(place, field[2])} is {_short(value[field[2]])}; the format has no such field"
    if field:
        return f"{_joined(place, field[2])} is missing"
    expected = CHOICES.get(place) or CHOICES.get(place.rpartition(".")[2])
    reason = f"expected {expected}" if expected else reason[:1].lower() + reason[1:].replace("`", "")
    return f"{place or 'the document'} is {_short(value)}; {reason}"


def _joined(place: str, name: str) -> str:
    return f"{place}.{name}" if place else name


def _short(value: object) -> str:
    text = json.dumps(value)
    return text if len(text) <= 60 else text[:57] + "..."
