"""The tangent graph of discs: every way a taut string can run between them, from start to goal.

A node is a touching point with a sense of rotation, an edge a free common tangent or a free arc between neighboring
touching points. Whatever goes along the edges is taut, so it is the one shortest path of its homotopy class.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.sparse import csr_array

from gpsynth.arrays import Floats

Integers = npt.NDArray[np.int64]
ROUNDING = 1e-9  # m; a tangent touches its own discs, and may touch a third
TINY = 1e-12  # m, added to every edge: one of length 0 would be none
BLOCK = 16  # discs that all tangents are tested against at once


@dataclass(frozen=True, eq=False)
class TangentGraph:
    """Nodes 0 (start) and 1 (goal), then the touching points; a directed graph of lengths in m."""

    points: Floats  # (n, 2)
    circles: Floats  # (n, 3) that are touched; radius 0 for start and goal
    senses: Integers  # (n,) +1 counterclockwise around them, -1 clockwise
    graph: csr_array  # (n, n)


@dataclass(frozen=True, eq=False)
class _Tangents:
    """Directed lines that leave one circle and arrive at another."""

    circles: Integers  # (m, 2) from, to; circles 0 and 1 are start and goal
    senses: Integers  # (m, 2)
    angles: Floats  # (m, 2) of the touching points on their circles
    ends: Floats  # (m, 2, 2)
    lengths: Floats  # (m,)


def tangent_graph(start: Floats, goal: Floats, discs: Floats, bounds: Floats) -> TangentGraph:
    """The graph for points (2,) outside of discs (c, 3), within bounds (4,)."""
    circles = np.vstack([[*start, 0.0], [*goal, 0.0], discs])
    tangents = _free(_tangents(circles), circles, bounds)
    tangents = _both_ways(tangents)
    count = len(tangents.lengths)
    circle, sense = np.concatenate(tangents.circles.T), np.concatenate(tangents.senses.T)
    angle = np.concatenate(tangents.angles.T)
    points = np.concatenate([tangents.ends[:, 0], tangents.ends[:, 1]])
    is_point = circle < 2
    number = np.where(is_point, circle, 1 + np.cumsum(~is_point))
    arcs = _arcs(circles, bounds, circle, sense, angle)
    heads = np.concatenate([number[:count], number[arcs[0]]])
    tails = np.concatenate([number[count:], number[arcs[1]]])
    weights = np.concatenate([tangents.lengths, arcs[2]]) + TINY
    size = 2 + int(np.sum(~is_point))
    return TangentGraph(
        points=np.vstack([start, goal, points[~is_point]]),
        circles=np.vstack([circles[:2], circles[circle[~is_point]]]),
        senses=np.concatenate([[1, 1], sense[~is_point]]),
        graph=csr_array((weights, (heads, tails)), shape=(size, size)),
    )


def _tangents(circles: Floats) -> _Tangents:
    """All common tangents of all pairs of circles, one direction of each."""
    first, second = np.triu_indices(len(circles), k=1)
    parts = []
    for a in (1, -1):
        for b in (1, -1):
            # a point has no sense of rotation: one of its two copies is enough
            kept = ((first > 1) | (a > 0)) & ((second > 1) | (b > 0))
            i, j = first[kept], second[kept]
            between = circles[j, :2] - circles[i, :2]
            offset = b * circles[j, 2] - a * circles[i, 2]
            square = np.sum(between**2, axis=1) - offset**2
            real = square > ROUNDING**2
            i, j, between, offset = i[real], j[real], between[real], offset[real]
            length = np.sqrt(square[real])
            heading = np.arctan2(between[:, 1], between[:, 0]) - np.arctan2(offset, length)
            angles = heading[:, None] - 0.5 * np.pi * np.array([a, b])
            parts.append((np.column_stack([i, j]), np.tile([a, b], (len(i), 1)), angles, length))
    pairs, senses, angles, length = (np.concatenate(part) for part in zip(*parts, strict=True))
    ends = circles[pairs, :2] + circles[pairs, 2:] * np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    return _Tangents(pairs, senses, angles, ends, length)


def _free(tangents: _Tangents, circles: Floats, bounds: Floats) -> _Tangents:
    """Those within the bounds and outside of all other discs."""
    low, high = bounds.reshape(2, 2).T
    kept = np.flatnonzero(np.all((tangents.ends >= low) & (tangents.ends <= high), axis=(1, 2)))
    for some in np.split(np.arange(2, len(circles)), range(BLOCK, len(circles) - 2, BLOCK)):
        kept = kept[~_obstructed(tangents, kept, circles, some)]  # the first few discs obstruct most tangents
    return _Tangents(*(getattr(tangents, name)[kept] for name in _Tangents.__dataclass_fields__))


def _obstructed(
    tangents: _Tangents, kept: Integers, circles: Floats, some: Integers
) -> npt.NDArray[np.bool_]:
    (x, y, radius), ends, length = circles[some].T, tangents.ends[kept], tangents.lengths[kept, None]
    along_x, along_y = ((ends[:, 1] - ends[:, 0]) / length).T[:, :, None]
    dx, dy = x - ends[:, :1, 0], y - ends[:, :1, 1]  # (m, c) from where the tangents begin to the centers
    ahead = dx * along_x + dy * along_y
    beyond = ahead - np.clip(ahead, 0.0, length)
    across = dx * along_y - dy * along_x
    hit = across**2 + beyond**2 < np.maximum(radius - ROUNDING, 0.0) ** 2
    obstructed: npt.NDArray[np.bool_] = np.any(hit, axis=1)
    return obstructed


def _both_ways(tangents: _Tangents) -> _Tangents:
    """Each tangent also from its end to its beginning; none leaves the goal or arrives at the start."""
    there, back = tangents.circles[:, 0] != 1, tangents.circles[:, 0] != 0
    return _Tangents(
        np.concatenate([tangents.circles[there], tangents.circles[back, ::-1]]),
        np.concatenate([tangents.senses[there], -tangents.senses[back, ::-1]]),
        np.concatenate([tangents.angles[there], tangents.angles[back, ::-1]]),
        np.concatenate([tangents.ends[there], tangents.ends[back, ::-1]]),
        np.concatenate([tangents.lengths[there], tangents.lengths[back]]),
    )


def _arcs(
    circles: Floats, bounds: Floats, circle: Integers, sense: Integers, angle: Floats
) -> tuple[Integers, Integers, Floats]:
    """From which touching point to which, and how long, the free arcs run between neighbors of one sense."""
    turn = np.remainder(angle, 2.0 * np.pi)
    ring = 2 * circle + (sense > 0)
    order = np.lexsort([turn, ring])
    order = order[circle[order] > 1]
    ends = np.flatnonzero(np.diff(ring[order], append=-1))  # the last point of each ring
    following = np.arange(1, len(order) + 1)
    following[ends] = np.concatenate([[0], ends[:-1] + 1])
    spans = np.remainder(turn[order[following]] - turn[order], 2.0 * np.pi)
    free = following != np.arange(len(order))
    free[_gaps_of(ring[order], turn[order], *_covered(circles, bounds))] = False
    heads, tails = order[free], order[following[free]]
    lengths = spans[free] * circles[circle[heads], 2]
    clockwise = sense[heads] < 0
    return np.where(clockwise, tails, heads), np.where(clockwise, heads, tails), lengths


def _gaps_of(ring: Integers, turn: Floats, covered: Integers, middle: Floats) -> Integers:
    """Places in sorted rings after which a covered stretch of their circle lies.

    Touching points are free, so a stretch lies between two neighbors as a whole, and where its middle does.
    """
    rings = np.concatenate([2 * covered, 2 * covered + 1])
    rings, middle = rings[np.isin(rings, ring)], np.tile(middle, 2)[np.isin(rings, ring)]
    key = 8.0 * ring + turn  # 8 > 2 pi: in order of ring, then angle
    place = np.searchsorted(key, 8.0 * rings + np.remainder(middle, 2.0 * np.pi), side="right") - 1
    before_first = place < np.searchsorted(ring, rings)
    return np.where(before_first, np.searchsorted(ring, rings, side="right") - 1, place)


def _covered(circles: Floats, bounds: Floats) -> tuple[Integers, Floats]:
    """Circles, and the angle of the middle of a stretch on them, that another disc or the outside covers."""
    centers, radii = circles[2:, :2], circles[2:, 2]
    between = centers[None] - centers[:, None]
    apart = np.hypot(between[..., 0], between[..., 1])
    one, other = np.nonzero((apart < radii[:, None] + radii - ROUNDING) & (apart > 0.0))
    found = [(one, np.arctan2(between[one, other, 1], between[one, other, 0]))]
    for side, (axis, sign) in enumerate([(0, -1.0), (0, 1.0), (1, -1.0), (1, 1.0)]):
        beyond = np.flatnonzero(sign * (centers[:, axis] - bounds[side]) + radii > ROUNDING)
        found.append((beyond, np.full(len(beyond), 0.5 * np.pi * axis + (np.pi if sign < 0.0 else 0.0))))
    covered, middle = (np.concatenate(part) for part in zip(*found, strict=True))
    return covered + 2, middle
