from itertools import pairwise

import numpy as np
import pytest
from scipy.sparse.csgraph import dijkstra

from applications.rosbot.routes import routes, shortest_routes
from applications.rosbot.scenario import Scenario
from gpsynth.seeds import stream

OPEN = np.array([-np.inf, np.inf, -np.inf, np.inf])


def shortest_through_samples(start, goal, discs, bounds, spacing: float) -> float:
    """The shortest path over points sampled just outside of the discs: an upper bound, near for a fine spacing."""
    points = [[start], [goal]]
    for x, y, radius in discs:
        count = int(np.ceil(2.0 * np.pi * radius / spacing))
        angles = 2.0 * np.pi * np.arange(count) / count
        outside = radius / np.cos(np.pi / count) + 1e-9  # a polygon around the disc
        points.append(np.column_stack([x + outside * np.cos(angles), y + outside * np.sin(angles)]))
    points = np.vstack(points)
    points = points[np.all((points >= bounds[[0, 2]]) & (points <= bounds[[1, 3]]), axis=1)]
    i, j = np.triu_indices(len(points), k=1)
    line = points[j] - points[i]
    free = np.ones(len(i), bool)
    for x, y, radius in discs:
        share = np.clip(np.sum(([x, y] - points[i]) * line, axis=1) / np.sum(line**2, axis=1), 0.0, 1.0)
        free &= np.hypot(*(points[i] + share[:, None] * line - [x, y]).T) >= radius
    weights = np.zeros((len(points), len(points)))
    weights[i[free], j[free]] = np.hypot(*line[free].T)
    return dijkstra(weights, directed=False, indices=0)[1]


def clearance(points, discs) -> float:
    dense = np.concatenate([np.linspace(a, b, 50) for a, b in pairwise(points)])
    return min((np.min(np.hypot(*(dense - [x, y]).T)) - r for x, y, r in discs), default=np.inf)


def winding(points, discs) -> tuple[int, ...]:
    """Turns of the route around each center, less those of the straight line."""
    turns = []
    for x, y, _ in discs:
        angles = np.unwrap(np.arctan2(points[:, 1] - y, points[:, 0] - x))
        straight = np.unwrap(np.arctan2(*(np.linspace(points[0], points[-1], 1000) - [x, y]).T[::-1]))
        turns.append(round(((angles[-1] - angles[0]) - (straight[-1] - straight[0])) / (2.0 * np.pi)))
    return tuple(turns)


def test_public_routes_are_free_and_of_distinct_classes(public):
    found = routes(public)
    discs = public.discs
    assert bool(found) == public.expect_feasible
    assert [route.length for route in found] == sorted(route.length for route in found)
    for route in found:
        assert np.array_equal(route.points[[0, -1]], [public.start[:2], public.goal[:2]])
        assert clearance(route.points, discs) > -0.003  # chords of 7.5 degrees on discs of at most 0.6 m
        chords = np.sum(np.hypot(*np.diff(route.points, axis=0).T))
        assert 0.998 * route.length <= chords <= route.length + 1e-9
    assert len({winding(route.points, discs) for route in found}) == len(found)


def test_as_many_classes_are_found_as_are_known(public, reference):
    assert len(routes(public)) >= reference["n_homotopy"]


@pytest.mark.parametrize("seed", range(3))
def test_of_many_discs_those_far_off_change_nothing(seed, monkeypatch):
    rng = stream(seed)
    places = rng.uniform(-8.0, 8.0, (150, 2))
    discs = np.column_stack([places, rng.uniform(0.2, 0.6, 150)])
    start, goal = np.array([-2.0, 0.0]), np.array([2.0, 0.0])
    discs = discs[np.all([np.hypot(*(places - end).T) > 0.7 for end in (start, goal)], axis=0)]
    found = shortest_routes(start, goal, discs, OPEN, count=5)
    monkeypatch.setattr("applications.rosbot.routes.FEW", len(discs))
    expected = shortest_routes(start, goal, discs, OPEN, count=5)
    assert len(found) == len(expected) > 0
    for one, other in zip(found, expected, strict=True):
        assert one.length == pytest.approx(other.length, abs=1e-9)  # 1e-12 m is added to every edge
        ways = np.linspace(0.0, one.length, 50)
        apart = np.hypot(*(one.poses(ways) - other.poses(ways))[:, :2].T)
        assert np.max(apart) < 0.01  # arcs are drawn as chords from touching point to touching point


def test_one_disc_in_the_way_gives_two_mirrored_routes():
    start, goal = np.array([-2.0, 0.0]), np.array([2.0, 0.0])
    found = shortest_routes(start, goal, np.array([[0.0, 0.0, 1.0]]), OPEN, count=5)
    length = 2.0 * np.sqrt(3.0) + np.pi / 3.0
    assert [route.length for route in found] == pytest.approx([length, length], abs=1e-9)
    assert found[0].points[3, 1] == pytest.approx(-found[1].points[3, 1])


def test_an_s_curve_has_the_length_of_its_tangents_and_arcs():
    start, goal = np.array([-4.0, 0.0]), np.array([4.0, 0.0])
    discs = np.array([[-2.0, -0.5, 1.0], [2.0, 0.5, 1.0]])
    to_disc, between = (
        np.arctan2(-0.5, 2.0) + np.arcsin(1.0 / np.sqrt(4.25)),
        np.arctan2(1.0, 4.0) - np.arcsin(2.0 / np.sqrt(17.0)),
    )
    length = (
        2.0 * np.sqrt(3.25) + 2.0 * (to_disc - between) + np.sqrt(13.0)
    )  # over the first, under the second
    found = shortest_routes(start, goal, discs, OPEN, count=5)
    assert min(abs(route.length - length) for route in found) < 1e-9


@pytest.mark.parametrize("height", [1.2, 3.0])
def test_lengths_equal_a_search_over_sampled_points(height):
    rng = np.random.default_rng(13)
    bounds = np.array([0.0, 3.0, 0.0, height])
    start, goal = np.array([0.1, 0.5 * height]), np.array([2.9, 0.5 * height])
    reached = 0
    for _ in range(20):
        discs = np.column_stack([rng.uniform([0.3, 0.0], [2.7, height], (7, 2)), rng.uniform(0.1, 0.45, 7)])
        apart = np.minimum(np.hypot(*(discs[:, :2] - start).T), np.hypot(*(discs[:, :2] - goal).T))
        discs = discs[apart > discs[:, 2] + 0.01]
        expected = shortest_through_samples(start, goal, discs, bounds, spacing=0.05)
        found = shortest_routes(start, goal, discs, bounds, count=1)
        assert bool(found) == np.isfinite(expected)
        if found:
            reached += 1
            assert 0.997 * expected <= found[0].length <= expected + 1e-9
    assert reached >= 8


def test_a_wall_of_discs_is_passed_outside_and_never_through():
    wall = np.column_stack([np.zeros(9), np.linspace(-1.2, 1.2, 9), np.full(9, 0.2)])
    found = shortest_routes(np.array([-1.0, 0.1]), np.array([1.0, 0.0]), wall, OPEN, count=5)
    assert len(found) == 2
    for route in found:
        assert np.max(np.abs(route.points[:, 1])) > 1.39


def test_bounds_close_a_way():
    wall = np.column_stack([np.zeros(9), np.linspace(-1.2, 1.2, 9), np.full(9, 0.2)])
    start, goal = np.array([-1.0, 0.1]), np.array([1.0, 0.0])
    above = shortest_routes(start, goal, wall, np.array([-2.0, 2.0, -1.3, 2.0]), count=5)
    assert len(above) == 1
    assert np.max(above[0].points[:, 1]) > 1.39
    assert shortest_routes(start, goal, wall, np.array([-2.0, 2.0, -1.3, 1.3]), count=5) == []


def test_an_arc_may_not_leave_the_bounds_between_points_within():
    start, goal, disc = np.array([-2.0, 0.0]), np.array([2.0, 0.0]), np.array([[0.0, 0.0, 1.0]])
    found = shortest_routes(
        start, goal, disc, np.array([-3.0, 3.0, -3.0, 0.95]), count=5
    )  # it touches at 0.866
    assert len(found) == 1
    assert np.min(found[0].points[:, 1]) < -0.99


def test_an_arc_may_not_run_inside_of_another_disc():
    discs = np.array(
        [[0.0, 0.0, 0.5], [0.6, 0.0, 0.5]]
    )  # the second covers the first at angle 0, where angles wrap
    found = shortest_routes(np.array([-0.58, -0.74]), np.array([-0.58, 0.74]), discs, OPEN, count=9)
    assert all(clearance(route.points, discs) > -0.002 for route in found)


def test_no_route_leaves_for_a_loop():
    disc = np.array([[0.0, 0.3, 0.25]])
    assert len(shortest_routes(np.array([-3.0, 0.0]), np.array([3.0, 0.0]), disc, OPEN, count=9)) == 2
    discs = np.array([[-0.9, 0.08, 0.35], [-0.9, 1.0, 0.45], [-0.6, -0.95, 0.45]])
    found = shortest_routes(np.zeros(2), np.array([-1.8, 0.0]), discs, OPEN, count=9)
    assert len({winding(route.points, discs) for route in found}) == len(found)
    assert all(turn in (-1, 0, 1) for route in found for turn in winding(route.points, discs))


def test_long_detours_are_left_out():
    wall = np.column_stack([np.zeros(30), np.linspace(-0.5, 5.3, 30), np.full(30, 0.2)])
    assert len(shortest_routes(np.array([-1.0, 0.0]), np.array([1.0, 0.0]), wall, OPEN, count=5)) == 1


def test_a_margin_is_kept_where_start_and_goal_allow_it():
    near_start = [-0.9, 0.3, 0.0, 0.0, 0.1]
    scenario = Scenario(
        [-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], circles=[[0.0, 0.0, 0.0, 0.0, 0.2], near_start], radius=0.2
    )
    shortest = routes(scenario, margin=0.1)[0]
    assert clearance(shortest.points, [[0.0, 0.0, 0.5]]) > -0.002
    assert np.array_equal(shortest.points[0], [-1.0, 0.0])


def test_poses_look_along_the_route():
    route = shortest_routes(
        np.array([-2.0, 0.0]), np.array([2.0, 0.0]), np.array([[0.0, 0.0, 1.0]]), OPEN, count=1
    )[0]
    poses = route.poses(np.linspace(0.0, route.length, 50))
    assert poses[0, :2] == pytest.approx([-2.0, 0.0])
    assert poses[-1, :2] == pytest.approx([2.0, 0.0])
    assert abs(poses[0, 2]) == pytest.approx(np.pi / 6.0, abs=1e-6)
    assert poses[-1, 2] == pytest.approx(-poses[0, 2], abs=1e-6)


def test_start_at_the_goal_is_a_route_of_no_length():
    route = shortest_routes(np.zeros(2), np.zeros(2), np.empty((0, 3)), OPEN, count=5)[0]
    assert route.length == 0.0
    assert route.poses(np.array([0.0, 1.0])) == pytest.approx(np.zeros((2, 3)))
