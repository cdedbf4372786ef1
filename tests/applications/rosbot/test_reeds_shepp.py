import numpy as np
import pytest

from applications.rosbot.reeds_shepp import distance, paths, shortest_path


def wrapped(angle):
    return np.remainder(angle + np.pi, 2.0 * np.pi) - np.pi


def random_poses(seed: int, count: int, reach: float = 3.0) -> np.ndarray:
    return np.random.default_rng(seed).uniform([-reach, -reach, -np.pi], [reach, reach, np.pi], (count, 3))


def test_public_distances_to_the_goal_are_met(public, reference):
    path = shortest_path(public.start, public.goal, 1.0)
    assert path.length / 0.5 == pytest.approx(reference["rs_exact"], abs=5e-5)  # its last digit


def test_every_path_ends_at_its_goal():
    for start, goal in zip(random_poses(1, 200), random_poses(2, 200), strict=True):
        for path in paths(start, goal, 0.7):
            end = path.poses(np.array([path.length]))[0]
            assert end[:2] == pytest.approx(goal[:2], abs=1e-9)
            assert wrapped(end[2] - goal[2]) == pytest.approx(0.0, abs=1e-9)


def test_poses_obey_the_turning_radius():
    path = shortest_path(np.zeros(3), np.array([0.2, 1.0, 0.5]), 0.7)
    ways = np.linspace(0.0, path.length, 20001)
    steps = np.diff(path.poses(ways), axis=0)
    travel, spacing = np.hypot(steps[:, 0], steps[:, 1]), ways[1] - ways[0]
    smooth = travel > 0.999 * spacing  # all but the steps over a cusp
    assert np.sum(~smooth) == len(path.cusps)
    assert np.max(np.abs(steps[:, 2])) <= spacing / 0.7 + 1e-9
    assert np.max(np.abs(travel - spacing)[smooth]) < 1e-9


def test_parallel_parking_has_cusps_and_a_straight_line_has_none():
    assert len(shortest_path(np.zeros(3), np.array([0.0, 0.5, 0.0]), 1.0).cusps) > 0
    straight = shortest_path(np.zeros(3), np.array([-2.0, 0.0, 0.0]), 1.0)
    assert len(straight.cusps) == 0
    assert straight.turns == (0,)
    assert straight.lengths == pytest.approx([-2.0])


def test_no_way_to_where_one_is():
    path = shortest_path(np.array([1.0, 2.0, 3.0]), np.array([1.0, 2.0, 3.0]), 1.0)
    assert path.length == pytest.approx(0.0, abs=1e-9)
    assert path.poses(np.array([0.0]))[0] == pytest.approx([1.0, 2.0, 3.0])


def test_distance_is_the_shortest_path_for_many_goals_at_once():
    start, goals = np.array([0.3, -0.2, 1.0]), random_poses(3, 40)
    expected = [shortest_path(start, goal, 0.8).length for goal in goals]
    assert distance(start, goals, 0.8) == pytest.approx(expected, abs=1e-12)


def test_distance_is_symmetric_in_time_in_the_mirror_and_in_scale():
    goals = random_poses(4, 300)
    forth = distance(np.zeros(3), goals, 1.0)
    back = [distance(goal, np.zeros((1, 3)), 1.0)[0] for goal in goals]
    assert forth == pytest.approx(np.array(back), abs=1e-8)
    assert forth == pytest.approx(distance(np.zeros(3), goals * [1.0, -1.0, -1.0], 1.0), abs=1e-8)
    assert forth == pytest.approx(distance(np.zeros(3), goals * [2.0, 2.0, 1.0], 2.0) / 2.0, abs=1e-8)


def test_distance_satisfies_the_equation_of_least_time():
    # |d(distance)/ds straight ahead| + |d(distance)/d(heading)| = 1: Hamilton-Jacobi-Bellman for |v|, |omega| <= 1
    goals, step = random_poses(5, 4000), 1e-6
    ahead = step * np.column_stack([np.cos(goals[:, 2]), np.sin(goals[:, 2]), np.zeros(len(goals))])
    aside = np.array([0.0, 0.0, step])
    rates = [
        (distance(np.zeros(3), goals + move, 1.0) - distance(np.zeros(3), goals - move, 1.0)) / (2.0 * step)
        for move in (ahead, aside)
    ]
    residual = np.abs(rates[0]) + np.abs(rates[1]) - 1.0
    smooth = np.abs(residual) < 1e-4
    assert np.mean(smooth) > 0.99  # the rest straddles a line where two words are equally long
    assert np.max(residual) < 1e-4 or np.mean(residual > 1e-4) < 0.01


def test_distance_does_not_jump():
    # a missing word shows as a jump at the edge of its region: moving for 0.02 changes the distance by 0.02 at most
    goals = random_poses(6, 40000, reach=4.5)
    rng = np.random.default_rng(7)
    ahead = rng.choice([-0.02, 0.02], len(goals))
    moved = goals + np.column_stack(
        [ahead * np.cos(goals[:, 2]), ahead * np.sin(goals[:, 2]), np.zeros(len(goals))]
    )
    turned = goals + np.column_stack([np.zeros((len(goals), 2)), ahead])
    before = distance(np.zeros(3), goals, 1.0)
    assert np.max(np.abs(distance(np.zeros(3), moved, 1.0) - before)) <= 0.02 + 1e-8
    assert np.max(np.abs(distance(np.zeros(3), turned, 1.0) - before)) <= 0.02 + 1e-8


def test_no_random_sequence_of_arcs_is_shorter():
    rng = np.random.default_rng(8)
    turns, lengths = rng.integers(-1, 2, (20000, 4)), rng.uniform(-1.5, 1.5, (20000, 4))
    poses = np.zeros((20000, 3))
    for turn, length in zip(turns.T, lengths.T, strict=True):
        middle = poses[:, 2] + 0.5 * turn * length
        chord = np.where(turn == 0, length, 2.0 * np.sin(0.5 * length))
        poses += np.column_stack([chord * np.cos(middle), chord * np.sin(middle), turn * length])
    assert np.all(distance(np.zeros(3), poses, 1.0) <= np.sum(np.abs(lengths), axis=1) + 1e-9)
