"""Distances in a room, against the simplest way to compute each."""

import numpy as np
import pytest
from matplotlib.path import Path as Outline

from applications.rosbot.gaps import gaps_to_room, least_gap_to_room
from applications.rosbot.room import Room
from gpsynth.errors import ScenarioError

HOUSE = np.array([[0.0, 0.0], [2.0, 0.3], [1.4, 1.0], [2.2, 2.0], [-0.3, 1.6]])  # with a notch
SEGMENTS = np.array([[-1.0, -1.0, 0.5, -0.8], [3.0, 3.0, 3.0, 3.0]])


def cells(seed: int) -> np.ndarray:
    return np.random.default_rng(seed).random((20, 30)) < 0.03


def samples(edges: np.ndarray) -> np.ndarray:
    shares = np.linspace(0.0, 1.0, 4001)[:, None]
    return np.concatenate([edge[:2] + shares * (edge[2:] - edge[:2]) for edge in edges])


def points(seed: int, count: int = 1500) -> np.ndarray:
    return np.random.default_rng(seed).uniform(-2.0, 4.0, (count, 2))


def test_distances_to_polygons_and_segments_are_those_of_dense_samples():
    room, places = Room(polygons=(HOUSE,), segments=SEGMENTS), points(1)
    dense = samples(room.edges)
    nearest = np.array([np.min(np.hypot(*(dense - place).T)) for place in places])
    inside = Outline(HOUSE).contains_points(places)
    found = room.gaps(places)
    assert np.array_equal(found < 0.0, inside)
    assert np.all(np.abs(np.abs(found) - nearest) < 1e-4)
    assert inside.sum() > 50


def test_distances_to_cells_are_those_to_squares():
    grid, places = cells(2), points(3)
    room = Room(grid, corner=(-0.5, 0.25), width=0.1)
    low = np.array([-0.5, 0.25]) + 0.1 * np.argwhere(grid)[:, ::-1]
    beyond = np.maximum(np.maximum(low - places[:, None], places[:, None] - low - 0.1), 0.0)
    exact = np.hypot(beyond[..., 0], beyond[..., 1]).min(axis=1)
    found = room.gaps(places)
    assert np.all(found <= exact + 1e-12)
    assert np.all(found >= np.sqrt(np.maximum(exact**2 - (0.1 / 16) ** 2, 0.0)) - 1e-9)


@pytest.mark.parametrize("spacing", [0.1, 0.03])
def test_a_field_bounds_the_distances_of_all_that_is_there(spacing):
    room = Room(cells(4), corner=(-0.5, 0.25), width=0.1, polygons=(HOUSE, HOUSE + 0.5), segments=SEGMENTS)
    field, places = room.field(spacing), points(5)
    exact, bound = room.gaps(places), field.at(places)
    apart = exact > 0.0
    assert field.spacing <= spacing + 1e-12
    sampled = (0.1 / 16) ** 2  # m^2 that may be missing of `exact`
    assert np.all(np.maximum(bound[apart], 0.0) ** 2 <= exact[apart] ** 2 + sampled + 1e-9)
    near = apart & (exact < 0.4)  # farther out there is no grid, and the bound is looser
    assert np.all(bound[near] >= exact[near] - 1.5 * field.spacing)
    assert np.all(bound[exact < -spacing] < 0.0)


def test_polygons_that_overlap_are_filled_each():
    room = Room(polygons=(HOUSE, HOUSE + 0.5))
    middle = np.array([[1.0, 1.0]])
    assert room.field(0.05).at(middle)[0] < 0.0
    assert room.gaps(middle)[0] < 0.0


def test_a_room_of_nothing_or_of_too_much_is_refused():
    with pytest.raises(ScenarioError, match="the room is empty"):
        Room(np.zeros((4, 4), dtype=bool))
    with pytest.raises(ScenarioError, match="reach over 9000 m x 8000 m; expected at most"):
        Room(segments=np.array([[0.0, 0.0, 9000.0, 8000.0]]))


def test_scenes_of_one_room_share_a_field():
    room = Room(segments=np.array([[0.0, 0.0, 1.0, 0.0]]))
    field = room.field(0.05, np.array([[2.1, 1.0]]))
    assert room.field(0.05, np.array([[2.9, 0.2]])) is field
    assert room.field(0.05, np.array([[3.1, 0.2]])) is not field


def test_whole_numbers_are_numbers():
    whole = Room(segments=np.array([[0, 0, 2, 0]]), polygons=(np.array([[0, 1], [1, 1], [1, 2]]),))
    same = Room(segments=1.0 * whole.segments, polygons=(1.0 * whole.polygons[0],))
    assert np.array_equal(whole.field(0.05).squares, same.field(0.05).squares)


@pytest.mark.parametrize("seed", range(6))
def test_the_least_gap_along_a_path_is_that_of_all_its_poses(seed):
    """Of bodies that turn, through and beside cells, polygons and segments."""
    rng = np.random.default_rng(seed)
    room = (
        Room(cells(seed), (-0.5, 0.25), 0.1, (HOUSE,), SEGMENTS)
        if seed % 2
        else Room(cells(seed), width=0.05)
    )
    body = np.array([[0.0, 0.0, 0.15], [0.3, -0.1, 0.1]])[: 1 + seed % 2]
    for count in (1, 2, 21, 1234):
        steps = rng.normal(size=(count, 3)) * [2e-3, 2e-3, 5e-3] + rng.normal(size=3) * 2e-3
        path = np.append(rng.uniform(-1.5, 3.5, 2), 0.0) + np.cumsum(steps, axis=0)
        assert least_gap_to_room(body, room, path) == gaps_to_room(body, room, path).min()
