"""How far the robot's body is from what it must not touch: exact, for poses and the times at which they are taken."""

import numpy as np

from applications.rosbot.footprint import placed
from applications.rosbot.room import Room
from gpsynth.arrays import Floats

SKIPPED = 20  # poses of a path at first


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


def least_gap_to_room(body: Floats, room: Room, poses: Floats) -> float:
    """The least of the gaps to a room along a path (N, 3), few of which need to be computed.

    A circle comes no nearer to anything than it moves: where two poses leave the poses between them no room to be the
    nearest, these are skipped.
    """
    least = np.inf
    for track, radius in zip(placed(body, poses).transpose(1, 0, 2), body[:, 2], strict=True):
        knots = np.append(np.arange(0, len(track) - 1, SKIPPED), len(track) - 1)
        gaps = room.gaps(track[knots]) - radius
        way = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(track, axis=0).T))])[knots]
        least = min(least, float(gaps.min()))
        lowest = 0.5 * (gaps[:-1] + gaps[1:] - np.diff(way)) - room.roughness
        near = np.repeat(lowest < least, np.diff(knots))
        least = min(least, float(np.min(room.gaps(track[:-1][near]) - radius, initial=np.inf)))
    return least
