"""The broad phase leaves out no circle that counts."""

from dataclasses import replace

import numpy as np
import pytest

from gpsynth import loop_arrays
from gpsynth.evaluate import Evaluator
from gpsynth.kernels import buckets as broad
from gpsynth.obstacles import Obstacles
from gpsynth.problem import Problem
from gpsynth.seeds import stream
from tests.test_planning import point_robot


def scattered(count: int, seed: int) -> np.ndarray:
    """Circles at rest of any sizes, some of them inside of others."""
    rng = stream(seed)
    places = rng.uniform(0.0, 10.0, (count, 2))
    return np.column_stack([places, np.zeros((count, 2)), rng.uniform(0.0, 0.6, count)])


@pytest.mark.parametrize("count", [48, 200])
def test_the_nearest_circle_is_in_the_bucket(count):
    circles, rng = scattered(count, 1), stream(2)
    cells = broad.buckets(circles)
    left, low, side, columns, rows, reach = cells.lattice
    size = side * np.array([columns, rows])
    starts = np.array([left, low]) + rng.uniform(0.0, 1.0, (5000, 2)) * size
    turn = rng.uniform(-np.pi, np.pi, 5000)
    ends = starts + reach * np.column_stack([np.cos(turn), np.sin(turn)])
    seen = np.zeros(3)
    for start, end in zip(starts, ends, strict=True):
        column, row = ((start - [left, low]) // side).astype(int)
        cell = row * int(columns) + column
        listed = cells.members[cells.firsts[cell] : cells.firsts[cell + 1]]
        along = start + np.linspace(0.0, 1.0, 9)[:, np.newaxis] * (end - start)
        gaps = np.hypot(*np.moveaxis(along[:, np.newaxis] - circles[:, :2], -1, 0)) - circles[:, 4]
        assert np.isin(gaps.argmin(axis=1), listed).all()
        seen += [1, len(listed), len(np.unique(listed))]
    assert seen[1] == seen[2]  # none is listed twice
    assert seen[1] / seen[0] < 0.25 * count


def test_few_circles_have_no_buckets():
    assert len(broad.buckets(scattered(broad.MANY - 1, 3)).firsts) == 0
    assert len(broad.buckets(np.tile([1.0, 1.0, 0.0, 0.0, 0.5], (50, 1))).firsts) == 0


@pytest.mark.parametrize("movers", [0, 7])
def test_rollouts_are_the_same_to_the_last_bit_as_without(movers, monkeypatch):
    problem, law = point_robot()
    circles, rng = scattered(120, 4), stream(5)
    circles[rng.choice(120, movers, replace=False), 2:4] = rng.uniform(-0.3, 0.3, (movers, 2))
    circles = circles[np.hypot(circles[:, 0] - 5.0, circles[:, 1] - 5.0) > 1.0]
    problem = Problem(
        problem.plant,
        [5.0, 5.0],
        [9.0, 9.0],
        tolerance=0.05,
        horizon=12.0,
        period=0.05,
        obstacles=Obstacles(circles=circles, radius=0.1),
    )
    law = replace(law, features=problem.features)
    points = rng.uniform(-4.0, 14.0, (300, 3, 2))  # beyond the grid as well
    dwell = rng.uniform(0.0, 3.0, (300, 3))
    found = Evaluator(problem, margin=0.05).of_schedules(law, points, dwell)
    monkeypatch.setattr(loop_arrays, "buckets", lambda circles: broad.NONE)
    loop_arrays._sorted_circles.cache_clear()
    try:
        everywhere = Evaluator(problem, margin=0.05)
        assert len(everywhere.world.buckets.firsts) == 0
        expected = everywhere.of_schedules(law, points, dwell)
    finally:
        loop_arrays._sorted_circles.cache_clear()
    assert (found.exposure > 0.0).any()
    for name in ("clearance", "exposure", "depth", "final"):
        assert np.array_equal(getattr(found, name), getattr(expected, name))
