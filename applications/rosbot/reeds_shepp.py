"""Shortest paths of a car that drives both ways and turns no tighter than a radius (Reeds & Shepp 1990).

With |v| and |omega| bounded separately, length over top speed is also the least time of the unicycle without obstacles,
the radius being top speed over top turn rate (Sussmann & Tang 1991). A word is a row of turns (+1 left, 0 straight,
-1 right) with signed lengths (negative: backwards), in units of the radius. Eight formulas of the article, each read
forwards, backwards in time, mirrored and both, three of them also from goal to start, give all words.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from gpsynth.arrays import Floats, frozen

Formula = Callable[[Floats, Floats, Floats], tuple[Floats, ...]]
ZERO = 1e-10  # a length of the wrong sign by no more than this is rounding


@dataclass(frozen=True, eq=False)
class ReedsSheppPath:
    """Arcs and straight lines from `start`."""

    start: Floats  # (3,) m, m, rad
    turns: tuple[int, ...]  # +1 left, 0 straight, -1 right
    lengths: Floats  # (s,) m, negative when driven backwards
    radius: float  # m

    @property
    def length(self) -> float:
        """The whole way driven, in m."""
        return float(np.sum(np.abs(self.lengths)))

    @property
    def cusps(self) -> Floats:
        """Ways driven (m) at which the direction of travel changes."""
        ends = np.cumsum(np.abs(self.lengths))[:-1]
        cusps: Floats = ends[np.sign(self.lengths[1:]) != np.sign(self.lengths[:-1])]
        return cusps

    def poses(self, ways: Floats) -> Floats:
        """The poses (N, 3) after so many meters driven, (N,)."""
        corners = [self.start]
        for turn, length in zip(self.turns, self.lengths, strict=True):
            corners.append(advance(corners[-1], np.array(turn), length, self.radius))
        ends = np.cumsum(np.abs(self.lengths))
        segment = np.minimum(np.searchsorted(ends, ways, side="right"), len(ends) - 1)
        into = (np.asarray(ways) - (ends - np.abs(self.lengths))[segment]) * np.sign(self.lengths)[segment]
        return advance(np.array(corners)[segment], np.array(self.turns)[segment], into, self.radius)


def shortest_path(start: Floats, goal: Floats, radius: float) -> ReedsSheppPath:
    """The shortest path between two poses."""
    return paths(start, goal, radius)[0]


def paths(start: Floats, goal: Floats, radius: float) -> list[ReedsSheppPath]:
    """One path for every word that leads from start to goal, the shortest first."""
    x, y, turn = _relative(np.asarray(start, dtype=float), np.asarray(goal, dtype=float), radius)
    found: dict[tuple[tuple[int, ...], bytes], ReedsSheppPath] = {}
    for turns, lengths in _words(x, y, turn):
        if not np.any(np.isnan(lengths)):
            kept = np.abs(lengths) > ZERO
            kept[0] |= not np.any(kept)  # a path of length zero keeps one segment
            word = tuple(int(t) for t in np.array(turns)[kept])
            path = ReedsSheppPath(
                frozen(np.asarray(start, dtype=float)), word, frozen(lengths[kept] * radius), radius
            )
            found.setdefault((word, np.round(path.lengths, 9).tobytes()), path)
    return sorted(found.values(), key=lambda path: path.length)


def shortest_words(starts: Floats, goals: Floats, radius: float) -> tuple[npt.NDArray[np.int64], Floats]:
    """Turns and signed lengths (m), (N, 5) both, of the shortest paths between poses (N, 3); 0 after the last segment.

    A path of length zero keeps segments of length zero alone.
    """
    words = _words(*_relative(starts, goals, radius))
    turns, lengths = np.zeros((len(words), 5), dtype=np.int64), np.zeros((len(words), 5, len(goals)))
    for number, (word, segments) in enumerate(words):
        turns[number, : len(word)], lengths[number, : len(word)] = word, segments
    best = np.nanargmin(np.sum(np.abs(lengths), axis=1), axis=0)
    chosen = lengths[best, :, np.arange(len(goals))]
    order = np.argsort(np.abs(chosen) <= ZERO, axis=1, kind="stable")
    chosen = np.take_along_axis(np.where(np.abs(chosen) > ZERO, chosen, 0.0), order, axis=1)
    return np.take_along_axis(turns[best], order, axis=1), radius * chosen


def distance(start: Floats, goals: Floats, radius: float) -> Floats:
    """Lengths (N,) of the shortest paths from one pose (3,) to many (N, 3)."""
    x, y, turn = _relative(np.asarray(start, dtype=float), np.asarray(goals, dtype=float), radius)
    lengths = [np.sum(np.abs(lengths), axis=0) for _, lengths in _words(x, y, turn)]
    shortest: Floats = radius * np.nanmin(lengths, axis=0)
    return shortest


def _relative(start: Floats, goal: Floats, radius: float) -> tuple[Floats, Floats, Floats]:
    dx, dy, turn = np.moveaxis(goal - start, -1, 0)
    cos, sin = np.cos(start[..., 2]), np.sin(start[..., 2])
    return (cos * dx + sin * dy) / radius, (cos * dy - sin * dx) / radius, turn


def advance(pose: Floats, turn: npt.NDArray[Any], length: Floats, radius: float) -> Floats:
    """Poses (N, 3) moved by lengths (N,), in m, along arcs of a radius; turns (N,) are +1 left, 0, -1 right."""
    x, y, heading = np.moveaxis(np.asarray(pose), -1, 0)
    half = 0.5 * turn * length / radius
    chord = length * np.sinc(half / np.pi)
    return np.stack(
        [x + chord * np.cos(heading + half), y + chord * np.sin(heading + half), heading + 2.0 * half], -1
    )


def _words(x: Floats, y: Floats, turn: Floats) -> list[tuple[tuple[int, ...], Floats]]:
    """Turns and signed lengths (segments, N) of every word, NaN where it does not lead there."""
    words = []
    for formula, turns, reversible in FORMULAS:
        for sense in (1, -1):
            for side in (1, -1):
                mirrored = tuple(side * t for t in turns)
                lengths = formula(sense * x, side * y, sense * side * turn)
                words.append((mirrored, sense * _stacked(lengths)))
                if reversible:
                    back_x = x * np.cos(turn) + y * np.sin(turn)
                    back_y = x * np.sin(turn) - y * np.cos(turn)
                    lengths = formula(sense * back_x, side * back_y, sense * side * turn)
                    words.append((mirrored[::-1], sense * _stacked(lengths)[::-1]))
    return words


def _stacked(lengths: tuple[Floats, ...]) -> Floats:
    return np.stack(np.broadcast_arrays(*lengths))


def _wrap(angle: Floats) -> Floats:
    return np.remainder(angle + np.pi, 2.0 * np.pi) - np.pi


def _polar(x: Floats, y: Floats) -> tuple[Floats, Floats]:
    return np.hypot(x, y), np.arctan2(y, x)


def _root(square: Floats) -> Floats:
    return np.sqrt(np.where(square >= 0.0, square, np.nan))


def _where(valid: npt.NDArray[np.bool_], *lengths: Floats | float) -> tuple[Floats, ...]:
    return tuple(np.where(valid, length, np.nan) for length in lengths)


def _left_straight_left(x: Floats, y: Floats, phi: Floats) -> tuple[Floats, ...]:
    u, t = _polar(x - np.sin(phi), y - 1.0 + np.cos(phi))  # eq. 8.1
    v = _wrap(phi - t)
    return _where((t >= -ZERO) & (v >= -ZERO), t, u, v)


def _left_straight_right(x: Floats, y: Floats, phi: Floats) -> tuple[Floats, ...]:
    rho, theta = _polar(x + np.sin(phi), y - 1.0 - np.cos(phi))
    u = _root(rho * rho - 4.0)  # eq. 8.2
    t = _wrap(theta + np.arctan2(2.0, u))
    v = _wrap(t - phi)
    return _where((t >= -ZERO) & (v >= -ZERO), t, u, v)


def _left_right_left(x: Floats, y: Floats, phi: Floats) -> tuple[Floats, ...]:
    rho, theta = _polar(x - np.sin(phi), y - 1.0 + np.cos(phi))
    u = -2.0 * np.arcsin(np.where(rho <= 4.0, rho / 4.0, np.nan))  # eqs. 8.3 and 8.4
    t = _wrap(theta + 0.5 * u + np.pi)
    v = _wrap(phi - t + u)
    return _where(t >= -ZERO, t, u, v)


def _outer_turns(u: Floats, v: Floats, xi: Floats, eta: Floats, phi: Floats) -> tuple[Floats, Floats]:
    delta = _wrap(u - v)
    a, b = np.sin(u) - np.sin(delta), np.cos(u) - np.cos(delta) - 1.0
    angle = np.arctan2(eta * a - xi * b, xi * a + eta * b)
    opposite = 2.0 * (np.cos(delta) - np.cos(v) - np.cos(u)) + 3.0 < 0.0
    tau = _wrap(np.where(opposite, angle + np.pi, angle))
    return tau, _wrap(tau - u + v - phi)


def _four_arcs_inner_cusp(x: Floats, y: Floats, phi: Floats) -> tuple[Floats, ...]:
    xi, eta = x + np.sin(phi), y - 1.0 - np.cos(phi)
    rho = (2.0 + np.hypot(xi, eta)) / 4.0
    u = np.arccos(np.where(rho <= 1.0, rho, np.nan))  # eq. 8.7
    t, v = _outer_turns(u, -u, xi, eta, phi)
    return _where((t >= -ZERO) & (v <= ZERO), t, u, -u, v)


def _four_arcs_outer_cusps(x: Floats, y: Floats, phi: Floats) -> tuple[Floats, ...]:
    xi, eta = x + np.sin(phi), y - 1.0 - np.cos(phi)
    rho = (20.0 - xi * xi - eta * eta) / 16.0
    u = -np.arccos(np.where((rho >= 0.0) & (rho <= 1.0), rho, np.nan))  # eq. 8.8
    t, v = _outer_turns(u, u, xi, eta, phi)
    return _where((t >= -ZERO) & (v >= -ZERO), t, u, u, v)


def _one_quarter_then_left(x: Floats, y: Floats, phi: Floats) -> tuple[Floats, ...]:
    rho, theta = _polar(x - np.sin(phi), y - 1.0 + np.cos(phi))
    root = _root(rho * rho - 4.0)
    u = 2.0 - root  # eq. 8.9
    t = _wrap(theta + np.arctan2(root, -2.0))
    v = _wrap(phi - 0.5 * np.pi - t)
    return _where((t >= -ZERO) & (u <= ZERO) & (v <= ZERO), t, -0.5 * np.pi, u, v)


def _one_quarter_then_right(x: Floats, y: Floats, phi: Floats) -> tuple[Floats, ...]:
    rho, t = _polar(1.0 + np.cos(phi) - y, x + np.sin(phi))
    u = 2.0 - rho  # eq. 8.10
    v = _wrap(t + 0.5 * np.pi - phi)
    return _where((t >= -ZERO) & (u <= ZERO) & (v <= ZERO), t, -0.5 * np.pi, u, v)


def _two_quarters(x: Floats, y: Floats, phi: Floats) -> tuple[Floats, ...]:
    xi, eta = x + np.sin(phi), y - 1.0 - np.cos(phi)
    u = 4.0 - _root(xi * xi + eta * eta - 4.0)  # eq. 8.11
    t = _wrap(np.arctan2((4.0 - u) * xi - 2.0 * eta, -2.0 * xi + (u - 4.0) * eta))
    v = _wrap(t - phi)
    return _where((t >= -ZERO) & (u <= ZERO) & (v >= -ZERO), t, -0.5 * np.pi, u, -0.5 * np.pi, v)


# formula, turns of its segments, and whether the same word read from goal to start is another word
FORMULAS: tuple[tuple[Formula, tuple[int, ...], bool], ...] = (
    (_left_straight_left, (1, 0, 1), False),
    (_left_straight_right, (1, 0, -1), False),
    (_left_right_left, (1, -1, 1), True),
    (_four_arcs_inner_cusp, (1, -1, 1, -1), False),
    (_four_arcs_outer_cusps, (1, -1, 1, -1), False),
    (_one_quarter_then_left, (1, -1, 0, 1), True),
    (_one_quarter_then_right, (1, -1, 0, -1), True),
    (_two_quarters, (1, -1, 0, 1, -1), False),
)
