"""Maps of ROS's map_server: a YAML file that names an image and says how its pixels are read.

Occupancy is p = 1 - shade, or the shade itself if `negate` is set; the shade is the mean of the color channels, 0 black
and 1 white, in mode `trinary` together with the alpha channel. More than `occupied_thresh` is occupied, less than
`free_thresh` free. What lies between is unknown in mode `trinary`, and a share of 100 in mode `scale`, where only what
is transparent is unknown; in mode `raw` a pixel's value is its occupancy, above 100 unknown (nav2_map_server, map_io).
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from applications.rosbot.map_yaml import read_settings
from gpsynth.arrays import Floats, frozen
from gpsynth.errors import ScenarioError
from gpsynth.files import check_readable

OCCUPIED, UNKNOWN = 100, -1
MOST_CELLS = 25_000_000
Occupancy = npt.NDArray[np.int8]


@dataclass(frozen=True, eq=False)
class OccupancyMap:
    """What map_server would publish."""

    cells: Occupancy  # (r, c) 0 free to 100 occupied, -1 unknown; the first row has the least y
    resolution: float  # m, width of a cell
    origin: tuple[float, float]  # m, the corner of the first cell

    def occupied(self, *, unknown_is_free: bool) -> npt.NDArray[np.bool_]:
        """The cells (r, c) to stay out of; those neither free nor occupied count as unknown."""
        occupied: npt.NDArray[np.bool_] = self.cells == OCCUPIED if unknown_is_free else self.cells != 0
        return occupied


def read_map(path: Path) -> OccupancyMap:
    """The map in a YAML file and its image; ScenarioError names the file and what is wrong with it."""
    settings = read_settings(path)
    shades, opaque = _pixels(path.parent / settings.image)
    color = shades[..., :3].mean(axis=-1)
    if settings.mode == "raw":
        values = np.rint(255.0 * color)
        cells = np.where(values <= OCCUPIED, values, UNKNOWN)
    else:
        shade = shades.mean(axis=-1) if settings.mode == "trinary" else color
        occupancy = shade if settings.negate else 1.0 - shade
        low, high = settings.free_thresh, settings.occupied_thresh
        between = np.full(occupancy.shape, float(UNKNOWN))
        if settings.mode == "scale":
            share = np.clip((occupancy - low) / (high - low), 0.0, 1.0)
            between = np.clip(np.rint(OCCUPIED * share), 1, OCCUPIED - 1)  # neither free nor occupied
        cells = np.where(occupancy > high, OCCUPIED, np.where(occupancy < low, 0.0, between))
        if settings.mode == "scale":
            cells = np.where(opaque, cells, UNKNOWN)
    return OccupancyMap(frozen(cells[::-1].astype(np.int8)), settings.resolution, settings.origin)


def _pixels(path: Path) -> tuple[Floats, npt.NDArray[np.bool_]]:
    """The channels (r, c, k) of an image, from 0 to 1, and which pixels are opaque (r, c)."""
    from PIL import Image, UnidentifiedImageError

    try:
        check_readable(path)
        with Image.open(path) as image:
            if image.width * image.height > MOST_CELLS:
                raise ScenarioError(
                    f"{path}: the image has {image.width} x {image.height} pixels; expected at most {MOST_CELLS}"
                )
            if image.mode.startswith(("I", "F")):
                values = np.asarray(image, dtype=np.float64)[..., np.newaxis] / 65535.0
            else:
                transparent = image.has_transparency_data
                colored = image.convert("RGBA" if transparent else "RGB")
                values = np.asarray(colored, dtype=np.float64) / 255.0
    except UnidentifiedImageError:
        raise ScenarioError(f"{path}: is not an image; expected PGM or PNG") from None
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise ScenarioError(f"{path}: the image cannot be read: {reason}") from None
    opaque = values[..., 3] == 1.0 if values.shape[2] == 4 else np.ones(values.shape[:2], dtype=np.bool_)
    return values, opaque
