"""How far the robot's body is from what it must not touch: exact, for poses and the times at which they are taken."""

import numpy as np

from applications.rosbot.footprint import placed
from applications.rosbot.room import Room
from gpsynth.arrays import Floats


def gaps_at(body: Floats, circles: Floats, pose: Floats) -> Floats:
    """Distances (c,) of the circles (f, 3) of a robot at a pose (3,) from circles (c, 5) at time 0."""
    between = placed(body, pose[np.newaxis])[0, :, np.newaxis] - circles[:, :2]
    gaps: Floats = np.min(np.hypot(between[..., 0], between[..., 1]) - body[:, 2:], axis=0) - circles[:, 4]
    return gaps


def least_gap(body: Floats, circles: Floats, poses: Floats, times: Floats) -> float:
    """The least distance of a robot at poses (N, 3), taken at times (N,), from circles (c, 5); infinity without any."""
    gaps = (
        np.sqrt(np.min((x - cx - vx * times) ** 2 + (y - cy - vy * times) ** 2)) - radius - size
        for (x, y), size in zip(placed(body, poses).transpose(1, 2, 0), body[:, 2], strict=True)
        for cx, cy, vx, vy, radius in circles
    )
    return float(min(gaps, default=np.inf))


def gaps_to_room(body: Floats, room: Room, poses: Floats) -> Floats:
    """Distances (N,) of the circles (f, 3) of a robot at poses (N, 3) from a room."""
    centers = placed(body, poses)
    distances = room.gaps(centers.reshape(-1, 2)).reshape(centers.shape[:2])
    gaps: Floats = np.min(distances - body[:, 2], axis=1)
    return gaps
