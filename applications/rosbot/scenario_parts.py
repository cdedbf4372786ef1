"""The parts of a scenario file that have several kinds: obstacles, the map, and the robot's footprint."""

from pathlib import Path
from typing import Literal, TypedDict

import msgspec
import numpy as np

from applications.rosbot.footprint import rectangle_circles
from applications.rosbot.map_file import read_map
from applications.rosbot.room import Room
from gpsynth.arrays import Floats
from gpsynth.errors import ScenarioError

MOST = 1e4  # m
MOST_PARTS = 100  # circles of a footprint


class Strict(msgspec.Struct, forbid_unknown_fields=True):
    """An object of a scenario file: no fields but these."""


class Circle(Strict, tag_field="type", tag="circle"):
    """A disc that may move."""

    x: float
    y: float
    r: float
    vx: float = 0.0
    vy: float = 0.0


class Segment(Strict, tag_field="type", tag="segment"):
    """A thin wall."""

    start: tuple[float, float]
    end: tuple[float, float]


class Polygon(Strict, tag_field="type", tag="polygon"):
    """A filled polygon."""

    corners: list[tuple[float, float]]


class MapPart(Strict):
    """A map of ROS's map_server, its YAML file relative to the scenario's."""

    file: str
    unknown: Literal["occupied", "free"] = "occupied"


class RoundFootprint(Strict, tag_field="type", tag="circle"):
    """A disc around the robot's center."""

    radius: float


class CirclesFootprint(Strict, tag_field="type", tag="circles"):
    """Several discs in the robot's frame."""

    circles: list[tuple[float, float, float]]


class RectangleFootprint(Strict, tag_field="type", tag="rectangle"):
    """A rectangle in the robot's frame, length along its axis."""

    length: float
    width: float
    center: tuple[float, float] = (0.0, 0.0)


class Body(TypedDict, total=False):
    """What a scenario knows of the robot's body."""

    radius: float
    footprint: Floats


Obstacle = Circle | Segment | Polygon
Footprint = RoundFootprint | CirclesFootprint | RectangleFootprint


def room_of(obstacles: list[Obstacle], given: MapPart | None, folder: Path) -> Room | None:
    """The map, polygons and segments of a scenario whose file lies in `folder`; None if there are none."""
    polygons, segments = [], []
    for index, each in enumerate(obstacles):
        if isinstance(each, Polygon):
            polygons.append(_corners(index, each))
        if isinstance(each, Segment):
            segments.append(_within(index, np.array([*each.start, *each.end])))
    walls = np.array(segments).reshape(-1, 4)
    if given is None:
        return Room(polygons=tuple(polygons), segments=walls) if polygons or segments else None
    if not given.file or ".." in Path(given.file).parts or "\0" in given.file:
        raise ScenarioError(
            f'map.file is "{given.file[:60]}"; expected the name of a file in the scenario\'s folder, or a whole path'
        )
    found = read_map(folder / given.file)
    cells = found.occupied(unknown_is_free=given.unknown == "free")
    beyond = 0 if given.unknown == "free" else 1  # what lies around the map is unknown as well
    return Room(
        np.pad(cells, beyond, constant_values=True),
        corner=(found.origin[0] - beyond * found.resolution, found.origin[1] - beyond * found.resolution),
        width=found.resolution,
        polygons=tuple(polygons),
        segments=walls,
    )


def body_of(footprint: Footprint) -> Body:
    """The body of the robot."""
    if isinstance(footprint, RoundFootprint):
        return {"radius": footprint.radius}
    if isinstance(footprint, CirclesFootprint):
        if not 1 <= len(footprint.circles) <= MOST_PARTS:
            raise ScenarioError(
                f"robot.footprint.circles are {len(footprint.circles)}; expected 1 to {MOST_PARTS}"
            )
        return {"footprint": np.array(footprint.circles)}
    for name in ("length", "width"):
        side = getattr(footprint, name)
        if not 0.0 < side <= 1.0:
            raise ScenarioError(f"robot.footprint.{name} is {side:g}; expected a number above 0, at most 1 m")
    return {"footprint": rectangle_circles(footprint.length, footprint.width, footprint.center)}


def _corners(index: int, polygon: Polygon) -> Floats:
    if len(polygon.corners) < 3:
        raise ScenarioError(
            f"obstacles[{index}] has {len(polygon.corners)} corners; expected at least 3 of a polygon"
        )
    return _within(index, np.array(polygon.corners))


def _within(index: int, numbers: Floats) -> Floats:
    if not np.all(np.abs(numbers) <= MOST):
        raise ScenarioError(
            f"obstacles[{index}] is {numbers.tolist()}; expected finite numbers within ±{MOST:g}"
        )
    return numbers
