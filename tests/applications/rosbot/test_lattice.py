"""Routes through rooms whose shortest ways are known."""

import numpy as np
import pytest

from applications.rosbot.lattice import ways
from applications.rosbot.room import Room
from applications.rosbot.routes import routes
from applications.rosbot.scenario import Scenario

START, GOAL = np.array([0.0, 0.0]), np.array([4.0, 0.0])


def length(way: np.ndarray) -> float:
    return float(np.hypot(*np.diff(way, axis=0).T).sum())


def square(x: float, y: float, side: float) -> np.ndarray:
    return np.array([[x, y], [x + side, y], [x + side, y + side], [x, y + side]])


def test_a_way_around_a_wall_is_as_long_as_a_taut_string():
    """A thin wall across the straight line; the string bends around its end, an arc with the robot's clearance."""
    room = Room(segments=np.array([[2.0, -3.0, 2.0, 1.0], [-1.0, -3.0, 5.0, -3.0]]))
    found = ways(START, GOAL, room.field(0.025), 0.2, count=1)[0]
    far = np.hypot(2.0, 1.0)
    tangent = np.sqrt(far**2 - 0.2**2)
    turn = np.pi / 2 - np.arctan2(2.0, 1.0) + np.arcsin(0.2 / far)  # of the string, beside the wall
    taut = 2.0 * (tangent + 0.2 * turn)
    assert taut - 1e-3 <= length(found) <= 1.02 * taut
    assert np.array_equal(found[[0, -1]], [START, GOAL])


def test_all_of_a_way_keeps_its_clearance():
    rng = np.random.default_rng(1)
    room = Room(polygons=tuple(square(x, y, 0.3) for x, y in rng.uniform([0.4, -1.5], [3.3, 1.2], (9, 2))))
    field = room.field(0.03, np.array([START, GOAL]))
    for way in ways(START, GOAL, field, 0.18, count=4):
        shares = np.linspace(0.0, 1.0, 50)[:, None, None]
        places = (way[:-1] + shares * np.diff(way, axis=0)).reshape(-1, 2)
        assert room.gaps(places).min() >= 0.18 - 1e-9


def test_ways_pass_islands_on_either_side_and_the_shortest_comes_first():
    islands = (square(1.0, -0.3, 0.7), square(2.5, -0.5, 0.7))
    found = ways(START, GOAL, Room(polygons=islands).field(0.05, np.array([START, GOAL])), 0.15, count=4)
    sides = {
        tuple(np.interp(1.35 + 1.5 * number, *way[np.argsort(way[:, 0])].T) > 0.0 for number in range(2))
        for way in found
    }
    assert len(sides) >= 3
    lengths = [length(way) for way in found]
    assert lengths[0] == min(lengths)


def test_a_narrow_gap_is_found_by_a_finer_lattice():
    walls = np.array(
        [[2.0, -2.0, 2.0, -0.03], [2.0, 0.31, 2.0, 2.0], [-1.0, -2.0, 5.0, -2.0], [5.0, -2.0, 5.0, 2.0]]
    )
    closed = np.vstack([walls, [[5.0, 2.0, -1.0, 2.0], [-1.0, 2.0, -1.0, -2.0]]])
    field = Room(segments=closed).field(0.0125)
    assert len(ways(START, GOAL, field, 0.15, count=1)) == 1
    assert ways(START, GOAL, field, 0.18, count=1) == []


def test_routes_of_a_scenario_stay_clear_of_its_room_and_circles():
    room = Room(polygons=(square(1.0, -0.3, 0.7),))
    scenario = Scenario(
        start=[0.0, 0.0, 0.0], goal=[4.0, 0.0, 0.0], room=room, circles=[[2.6, 0.1, 0.0, 0.0, 0.4]]
    )
    for route in routes(scenario, margin=0.01):
        assert room.gaps(route.points).min() >= 0.15
        assert np.hypot(*(route.points - [2.6, 0.1]).T).min() >= 0.55
        assert route.length == pytest.approx(length(route.points))
