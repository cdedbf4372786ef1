"""How far the robot's body is from what it must not touch: exact, for poses and the times at which they are taken."""

import numpy as np

from applications.rosbot.footprint import placed
from applications.rosbot.room import Room
from gpsynth.arrays import Floats


def gaps_to_circles(body: Floats, circles: Floats, poses: Floats, times: Floats | float = 0.0) -> Floats:
    """Distances (N, c) of the circles (f, 3) of a robot at poses (N, 3) from circles (c, 5) that may move."""
    gaps = np.full((len(poses), len(circles)), np.inf)
    for center, radius in zip(np.moveaxis(placed(body, poses), 1, 0), body[:, 2], strict=True):
        for index, (x, y, vx, vy, size) in enumerate(circles):
            square = (center[:, 0] - x - vx * times) ** 2 + (center[:, 1] - y - vy * times) ** 2
            gaps[:, index] = np.minimum(gaps[:, index], np.sqrt(square) - size - radius)
    return gaps


def gaps_to_room(body: Floats, room: Room, poses: Floats) -> Floats:
    """Distances (N,) of the circles (f, 3) of a robot at poses (N, 3) from a room."""
    centers = placed(body, poses)
    distances = room.gaps(centers.reshape(-1, 2)).reshape(centers.shape[:2])
    gaps: Floats = np.min(distances - body[:, 2], axis=1)
    return gaps
