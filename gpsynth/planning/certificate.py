"""Clearance of any plant's path between its ticks, by an enclosure of the flow over each control period.

Over a period the states stay in a box B that the step with interval arithmetic leads into itself (Picard and Lindelof;
Moore, Kearfott & Cloud 2009, section 10.2), so the velocity stays in the box F = f(B). A path between two given ends
whose velocity stays in F is never farther from the chord between them, uniformly driven, than a quarter of the period
times the width of F: with slopes in [l, u] it lies below two lines that meet at most h (u - m) (m - l) / (u - l) above
the chord of slope m.
"""

from collections.abc import Iterator

import numpy as np

from gpsynth.arrays import Floats
from gpsynth.checks import check_kind, check_number, check_whole
from gpsynth.errors import ProblemError
from gpsynth.intervals import enclose
from gpsynth.obstacles import Obstacles
from gpsynth.problem import Problem
from gpsynth.simulation import Trajectory

Box = tuple[Floats, Floats]  # lowest and highest values, (N, n) each

TRIES = 12  # at a box that the flow stays in
SMALL = 1e-9  # what a box is widened by at least from one try to the next
ROUNDING = 64.0 * 2.0**-53  # of places and distances, as a share of their size


def certified_clearance(
    problem: Problem, trajectory: Trajectory, *, error: float = 0.0, row: int = 0
) -> float:
    """A lower bound (m) on the clearance along the continuous path, obstacles and bounds both; infinity without any.

    Proved for every motion of the plant that is within `error` (m, and as much in the units of the other states) of the
    trajectory at its ticks, under the controls of the trajectory, circles moving as the problem says. How far the ticks
    are off is not proved: it is the error of the integrator, which half the step shows. Minus infinity where nothing
    can be said: the plant has operations without a rule, or no box holds its flow. `row` is that of the plant's
    parameters. Raises ProblemError if the error is no number of at least 0, or there is no such row.
    """
    check_kind("problem", problem, Problem)
    check_kind("trajectory", trajectory, Trajectory)
    check_whole("row", row, 0)
    if row >= len(problem.plant_parameters):
        raise ProblemError(f"row is {row}; the problem has {len(problem.plant_parameters)} rows")
    check_number("error", error)
    if not 0.0 <= error < np.inf:
        raise ProblemError(f"error must be finite and at least 0, not {error}")
    if problem.obstacles is None:
        return np.inf
    obstacles, names = problem.obstacles, problem.plant.state_names
    position = [names.index(name) for name in obstacles.position]
    poses = trajectory.x[:, position]
    low, high = (slope[:, position] for slope in _slopes(problem, trajectory, error, row))
    bend, most = 0.25 * problem.period * (high - low), problem.period * np.maximum(np.abs(low), np.abs(high))
    rounding = ROUNDING * (np.abs(poses).sum(axis=1) + 1.0)
    lost = error + np.append(np.hypot(bend[:, 0], bend[:, 1]), 0.0) + rounding
    gaps = [_room(obstacles.bounds, poses[:, :2], lost)]
    for circle in obstacles.body:
        centers, turned = _turned(circle, poses, bend, most, error)
        gaps += [
            _gap(*other, centers, lost + turned) - circle[2] for other in _discs(obstacles, trajectory.t)
        ]
        if obstacles.field is not None:
            tails = np.vstack([centers[1:], centers[-1:]])
            gaps.append(
                float(np.min(obstacles.field.proved_along(centers, tails) - lost - turned)) - circle[2]
            )
    nearest = float(np.min(gaps))
    return -np.inf if np.isnan(nearest) else nearest


def _turned(circle: Floats, poses: Floats, bend: Floats, most: Floats, error: float) -> tuple[Floats, Floats]:
    """The centers (N + 1, 2) of a circle of the body, and how much farther than its origin they are from their chords.

    What turns uniformly by an angle of at most a is within a^2 / 8 of its chord, a share of its distance from the
    origin; a heading that is off by its bend moves it by as much again. How far it turns is told by the slopes, not by
    the ends: there whole turns are not seen.
    """
    ahead, left, _ = circle
    arm = float(np.hypot(ahead, left))
    if arm == 0.0:
        return poses[:, :2], np.zeros(len(poses))
    sine, cosine = np.sin(poses[:, 2]), np.cos(poses[:, 2])
    centers = poses[:, :2] + np.column_stack([ahead * cosine - left * sine, ahead * sine + left * cosine])
    bent = np.append(bend[:, 2] + 0.125 * most[:, 2] ** 2, 0.0)
    return centers, arm * (bent + error + ROUNDING * (1.0 + np.abs(poses[:, 2])))


def _discs(obstacles: Obstacles, times: Floats) -> Iterator[tuple[Floats, float, Floats]]:
    """Of everything round the centers (N + 1, 2) at the ticks, in between which it goes straight, and the radius.

    Besides the size (N + 1,) of what the centers are computed of, of which rounding takes a share.
    """
    for x, y, vx, vy, radius in obstacles.circles:
        size = abs(x) + abs(y) + times * (abs(vx) + abs(vy))
        yield [x, y] + times[:, np.newaxis] * [vx, vy], radius, size
    if obstacles.tracks is not None:
        tracks = obstacles.tracks
        for places, centers, radius in zip(tracks.places, tracks.at(times), tracks.radii, strict=True):
            fastest = np.abs(np.diff(places, axis=0)).max(initial=0.0) / tracks.period
            yield centers, radius, np.abs(centers).sum(axis=1) + 2.0 * times * fastest


def _gap(others: Floats, radius: float, size: Floats, places: Floats, lost: Floats) -> float:
    """The least distance of the chords from a disc, less what is lost, (N + 1,) for N periods and the last tick."""
    seen = places - others
    motion = np.vstack([np.diff(seen, axis=0), [[0.0, 0.0]]])
    square = np.sum(motion * motion, axis=1)
    share = -np.sum(seen * motion, axis=1) / np.where(square > 0.0, square, 1.0)
    nearest = seen + np.clip(share, 0.0, 1.0)[:, np.newaxis] * motion
    rounding = ROUNDING * (np.abs(seen).sum(axis=1) + size + radius)
    return float(np.min(np.hypot(nearest[:, 0], nearest[:, 1]) - radius - lost - rounding))


def _room(bounds: Floats, places: Floats, lost: Floats) -> float:
    """The least distance of the chords from the bounds; both ends of a chord lose what is lost on it."""
    lost = np.maximum(lost, np.concatenate([[0.0], lost[:-1]]))
    low, high = places - bounds[[0, 2]], bounds[[1, 3]] - places
    room = float(np.min(np.minimum(low, high).min(axis=1) - lost))
    return room - ROUNDING * abs(room) if np.isfinite(room) else room


def _slopes(problem: Problem, trajectory: Trajectory, error: float, row: int) -> Box:
    """The lowest and highest slope (N, n) of each state over each period; infinite where no box holds the flow."""
    plant, step = problem.plant, problem.period
    states, times = trajectory.x[:-1], trajectory.t[:-1, np.newaxis]
    is_known = problem.hold and (problem.draws is None or not np.any(problem.draws.delay))
    limits = plant.lower + 0.0 * trajectory.u, plant.upper + 0.0 * trajectory.u
    controls = (trajectory.u, trajectory.u) if is_known else limits
    parameters = problem.plant_parameters[row]

    def slopes(box: Box) -> Box:
        low, high = (np.hstack(given) for given in zip(box, controls, (times, times + step), strict=True))
        return enclose(plant.dynamics, low, high, parameters)

    begin = states - error, states + error
    box, holds = begin, np.zeros(len(states), dtype=np.bool_)
    for _ in range(TRIES):
        slope = slopes(box)
        low, high = begin[0] + step * np.minimum(slope[0], 0.0), begin[1] + step * np.maximum(slope[1], 0.0)
        low, high = low - ROUNDING * (1.0 + np.abs(low)), high + ROUNDING * (1.0 + np.abs(high))
        holds = np.all((low >= box[0]) & (high <= box[1]), axis=1)
        if np.all(holds):
            break
        wider = np.where(holds[:, np.newaxis], 0.0, 0.1 * (high - low) + SMALL)
        box = np.minimum(box[0], low - wider), np.maximum(box[1], high + wider)
    slope, held = slopes(box), holds[:, np.newaxis]
    return np.where(held, slope[0], -np.inf), np.where(held, slope[1], np.inf)
