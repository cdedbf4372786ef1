"""A mapped room in the plane: occupied cells, polygons and segments."""

from typing import TYPE_CHECKING

import numpy as np

from applications.rosbot.room import Room
from gpsynth.plotting import BLACK, GRAY, PALE

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def draw_room(axes: "Axes", room: Room, label: str = "") -> None:
    """Cells and polygons filled, segments as lines, under a label of the legend if one is given."""
    from matplotlib.collections import LineCollection
    from matplotlib.colors import ListedColormap
    from matplotlib.patches import Polygon

    if room.cells.any():
        (left, below), (rows, columns) = room.corner, room.cells.shape
        axes.use_sticky_edges = False  # or the outermost cells are cut off
        axes.imshow(
            np.ma.masked_equal(room.cells, False),
            cmap=ListedColormap([GRAY]),
            origin="lower",
            extent=(left, left + room.width * columns, below, below + room.width * rows),
            interpolation="nearest",
            zorder=2,
        )
    for corners in room.polygons:
        axes.add_patch(Polygon(corners, facecolor=PALE, edgecolor=BLACK, linewidth=0.8, zorder=2))
    axes.add_collection(
        LineCollection(list(room.segments.reshape(-1, 2, 2)), colors=BLACK, linewidths=1.2, zorder=2)
    )
    if label:
        axes.plot([], [], "s", color=GRAY if room.cells.any() else PALE, markeredgecolor=BLACK, label=label)
