"""A synthetic office of 20 x 15 m as a map of map_server: rooms along a corridor, desks, chairs, one room unmapped.

    python -m applications.rosbot.office FOLDER

writes office.png and office.yaml, as they stand in `applications/rosbot/scenarios`.
"""

import io
import sys
from itertools import pairwise
from pathlib import Path

import numpy as np
import numpy.typing as npt

from gpsynth.arrays import Floats
from gpsynth.files import write_bytes, write_text
from gpsynth.seeds import stream

SEED = 1
WIDTH, HEIGHT, RESOLUTION = 20.0, 15.0, 0.05  # m
CORRIDOR = (6.5, 8.5)  # m, its lowest and highest y
WALL, DOOR = 0.15, 1.0  # m
CROSSWALLS = (5.0, 10.0, 15.0)  # m, x of the walls between rooms
INNER_DOORS = ((0, 3.2), (2, 12.0))  # wall between rooms, y of a door in it
DESKS, CHAIRS = 3, 3  # in a room
UNMAPPED = (1, 1)  # column and row of a room
FREE, UNKNOWN, BLACK = 254, 205, 0  # shades as map_saver writes them

Shades = npt.NDArray[np.uint8]


def office(seed: int = SEED) -> Shades:
    """The shades of the map (300, 400), the first row at the greatest y."""
    rng = stream(seed)
    shades = np.full((round(HEIGHT / RESOLUTION), round(WIDTH / RESOLUTION)), FREE, dtype=np.uint8)
    for x, y, length, depth in _walls():
        _fill(shades, (x, y, length, depth), BLACK)
    columns = [0.0, *CROSSWALLS, WIDTH]
    for row, (low, high) in enumerate(((0.0, CORRIDOR[0]), (CORRIDOR[1], HEIGHT))):
        for column, (left, right) in enumerate(pairwise(columns)):
            door = rng.uniform(left + 1.0, right - 1.0)
            _fill(shades, (door - 0.5 * DOOR, (high if row == 0 else low) - 0.5 * WALL, DOOR, WALL), FREE)
            if (column, row) == UNMAPPED:
                _fill(
                    shades, (left + WALL, low + WALL, right - left - 2 * WALL, high - low - 2 * WALL), UNKNOWN
                )
            else:
                _furnish(shades, np.array([left, low, right, high]), door, row, rng)
    for wall, y in INNER_DOORS:
        x = CROSSWALLS[wall]
        _fill(shades, (x - 0.5 * WALL, y - 0.5 * DOOR, WALL, DOOR), FREE)
    return shades[::-1]


def _walls() -> list[tuple[float, float, float, float]]:
    """Rectangles: x and y of the lower left corner, extent along x and y."""
    outer = [(0.0, 0.0, WIDTH, WALL), (0.0, HEIGHT - WALL, WIDTH, WALL)]
    outer += [(0.0, 0.0, WALL, HEIGHT), (WIDTH - WALL, 0.0, WALL, HEIGHT)]
    along = [(0.0, y - 0.5 * WALL, WIDTH, WALL) for y in CORRIDOR]
    across = [
        (x - 0.5 * WALL, low, WALL, high - low)
        for x in CROSSWALLS
        for low, high in ((0.0, CORRIDOR[0]), (CORRIDOR[1], HEIGHT))
    ]
    return outer + along + across


def _furnish(shades: Shades, room: Floats, door: float, row: int, rng: np.random.Generator) -> None:
    """Desks along the outer wall, chairs anywhere but before the door."""
    left, low, right, high = room
    for number in range(DESKS):
        x = left + 0.3 + (right - left - 1.8) * number / (DESKS - 1) + rng.uniform(0.0, 0.2)
        y = low + 0.25 if row == 0 else high - 0.95
        _fill(shades, (x, y + rng.uniform(-0.05, 0.3) * (1 if row == 0 else -1), 1.2, 0.7), BLACK)
    for _ in range(CHAIRS):
        x, y = rng.uniform(left + 0.9, right - 1.3), rng.uniform(low + 1.6, high - 2.0)
        if row == 1:
            y = rng.uniform(low + 1.8, high - 2.0)
        if abs(x + 0.2 - door) > 0.3 or abs(y - (high if row == 0 else low)) > 2.5:
            _fill(shades, (x, y, 0.4, 0.4), BLACK)


def _fill(shades: Shades, rectangle: tuple[float, float, float, float], shade: int) -> None:
    x, y, length, depth = rectangle
    first, last = (
        np.rint(np.array(ends) / RESOLUTION).astype(int) for ends in ((y, x), (y + depth, x + length))
    )
    shades[first[0] : last[0], first[1] : last[1]] = shade


def write_office(folder: Path, seed: int = SEED) -> None:
    """The map as office.png and office.yaml; raises FileError if they cannot be written."""
    from PIL import Image

    content = io.BytesIO()
    Image.fromarray(office(seed)).save(content, "PNG", optimize=True)
    write_bytes(folder / "office.png", content.getvalue())
    write_text(
        folder / "office.yaml",
        f"image: office.png\nmode: trinary\nresolution: {RESOLUTION}\norigin: [0.0, 0.0, 0.0]\n"
        "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n",
    )


if __name__ == "__main__":
    write_office(Path(sys.argv[1]))
