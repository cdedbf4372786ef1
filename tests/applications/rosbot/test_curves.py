"""Many curves at once are what each of them is alone."""

import numpy as np
import pytest

from applications.rosbot.curves import Curves
from applications.rosbot.reeds_shepp import ReedsSheppPath, paths, shortest_path


def random_poses(seed: int, count: int) -> np.ndarray:
    return np.random.default_rng(seed).uniform([-3.0, -3.0, -np.pi], [3.0, 3.0, np.pi], (count, 3))


@pytest.fixture(name="ends", scope="module")
def _ends():
    return random_poses(1, 60), random_poses(2, 60)


def test_the_shortest_of_many_are_the_shortest_of_each(ends):
    curves = Curves.shortest(*ends, 0.7)
    each = [shortest_path(start, goal, 0.7) for start, goal in zip(*ends, strict=True)]
    assert np.abs(curves.lengths).sum(axis=1) == pytest.approx([path.length for path in each], abs=1e-12)


def test_samples_lie_on_their_curves_and_lead_from_start_to_goal(ends):
    curves = Curves.shortest(*ends, 0.7)
    samples = curves.sampled(0.05)
    for row, (start, goal) in enumerate(zip(*ends, strict=True)):
        driven = curves.lengths[row] != 0.0
        path = ReedsSheppPath(start, tuple(curves.turns[row, driven]), curves.lengths[row, driven], 0.7)
        poses, senses = samples.piece(row)
        corners = np.concatenate([[0.0], np.cumsum(np.abs(path.lengths))])
        ways = np.unique(np.concatenate([np.arange(0.0, path.length, 0.05), corners]))
        assert poses == pytest.approx(path.poses(ways), abs=1e-9)
        assert poses[-1, :2] == pytest.approx(goal[:2], abs=1e-9)
        steps = np.diff(poses[:, :2], axis=0)
        middle = 0.5 * (poses[1:, 2] + poses[:-1, 2])
        ahead = np.sum(steps * np.column_stack([np.cos(middle), np.sin(middle)]), axis=1)
        assert np.all(ahead * senses[1:] >= -1e-12)


def test_paths_of_several_words_and_of_no_length():
    start = np.array([1.0, 2.0, 3.0])
    found = paths(start, np.array([1.5, 2.0, 3.0]), 0.5)
    samples = Curves.of(found).sampled(0.1)
    for row in range(len(found)):
        assert samples.piece(row)[0][-1, :2] == pytest.approx([1.5, 2.0], abs=1e-9)
    still = Curves.shortest(start[None], start[None], 0.5)
    assert not np.any(still.lengths)
    assert still.sampled(0.1).piece(0)[0] == pytest.approx(start[None])
