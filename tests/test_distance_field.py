"""Distances from occupied cells: exact at nodes, never too great between them."""

from fractions import Fraction

import numpy as np
import pytest

from gpsynth.distance_field import DistanceField, field_of_cells
from gpsynth.errors import ProblemError

CORNER, WIDTH = np.array([-1.0, 0.5]), 0.05


def scattered(seed: int, share: float = 0.02, shape: tuple[int, int] = (24, 31)) -> np.ndarray:
    return np.random.default_rng(seed).random(shape) < share


def distances(points: np.ndarray, cells: np.ndarray) -> np.ndarray:
    """Of each point (N, 2) to the nearest of the cells, squares of WIDTH, one by one."""
    rows, columns = np.nonzero(cells)
    low = CORNER + WIDTH * np.column_stack([columns, rows])
    beyond = np.maximum(np.maximum(low - points[:, None], points[:, None] - low - WIDTH), 0.0)
    return np.hypot(beyond[..., 0], beyond[..., 1]).min(axis=1)


@pytest.mark.parametrize("parts", [1, 3])
def test_distances_of_nodes_are_exact(parts):
    cells = scattered(1)
    field = field_of_cells(cells, CORNER, WIDTH, parts=parts)
    nodes = field.nodes.reshape(-1, 2)
    outside, inside = distances(nodes, cells), distances(nodes, ~np.pad(cells, 1)[1:-1, 1:-1])
    found = field.at(field.nodes).ravel()
    assert field.squares.shape == (24 * parts + 1, 31 * parts + 1)
    assert np.max(np.abs(np.maximum(found, 0.0) - outside)) < 1e-7  # roots of rounding errors near zero
    interior = np.all((nodes > CORNER + 0.06) & (nodes < CORNER + WIDTH * np.array([31, 24]) - 0.06), axis=1)
    assert np.max(np.abs(np.maximum(-found, 0.0) - inside)[interior]) < 1e-7


def test_a_bound_is_never_above_the_distance_and_little_below():
    cells, rng = scattered(2), np.random.default_rng(3)
    field = field_of_cells(cells, CORNER, WIDTH)
    points = CORNER + rng.random((20_000, 2)) * WIDTH * np.array([31, 24])
    exact, bound = distances(points, cells), field.at(points)
    assert np.all(bound <= exact + 1e-9)
    assert np.quantile(exact - bound, 0.5) < WIDTH**2 / (4.0 * np.median(exact)) + 0.005
    assert np.max(exact - bound) < 1.5 * WIDTH


def test_beside_a_wall_only_the_curvature_of_the_square_is_missing():
    cells = np.zeros((40, 40), dtype=bool)
    cells[:, :4] = True
    field = field_of_cells(cells, (0.0, 0.0), WIDTH)
    x = np.linspace(0.3, 0.9, 200)
    bound = field.at(np.column_stack([x, np.full(200, 1.0137)]))
    exact = x - 0.2
    assert np.all(bound <= exact + 1e-12)
    assert np.all(bound >= np.sqrt(exact**2 - WIDTH**2 / 2) - 1e-12)


def test_along_a_line_no_point_is_nearer():
    cells, rng = scattered(4), np.random.default_rng(5)
    field = field_of_cells(cells, CORNER, WIDTH)
    heads = CORNER + rng.random((3_000, 2)) * WIDTH * np.array([31, 24])
    tails = heads + rng.normal(size=heads.shape) * 0.04
    bound = field.along(heads, tails)
    for share in np.linspace(0.0, 1.0, 21):
        assert np.all(bound <= distances(heads + share * (tails - heads), cells) + 1e-9)
    assert np.median(field.at(heads) - bound) < 0.02


# corner (m), spacing (m), nodes across; how far from the thin wall and from the grid places are taken (m)
SCALES = [(0.0, 0.05, 40, 1e-9, 0.0), (-3.3, 0.7, 40, 1e-6, 0.0), (1e4, 0.01, 30, 1e-7, 0.0)]
SCALES += [(-7e3, 1e-3, 200, 1e-12, 0.0), (0.1, 13.0, 900, 1e-4, 0.0), (5e6, 0.05, 9, 1e-8, 3e3)]


@pytest.mark.parametrize(("corner", "spacing", "across", "near", "beyond"), SCALES)
def test_rounding_lets_no_bound_rise_above_the_distance(corner, spacing, across, near, beyond):
    rng = np.random.default_rng(11)
    low, width = Fraction(corner), Fraction(spacing)
    for _ in range(8):
        wall = float(low + width * Fraction(rng.uniform(0.2, 0.8)) * (across - 1))  # x of a thin wall
        squares = [float((low + width * j - Fraction(wall)) ** 2) for j in range(across)]
        field = DistanceField(np.tile(squares, (3, 1)), (corner, corner), spacing)
        # on a row of nodes nothing but rounding is missing, and of a line to the wall nothing at its end
        row = np.full(200, corner + spacing * float(across > 100))
        x = wall + near * rng.normal(size=200) * 10.0 ** rng.uniform(-8.0, 0.0, 200)
        x[150:] = wall + (beyond + 3.0 * spacing) * rng.normal(size=50)
        points = np.column_stack([x, row])
        back = np.column_stack([np.where(x > wall, 1.0, -1.0) * 10.0 ** rng.uniform(-9.0, 1.0, 200), 0.0 * x])
        for found in (
            field.proved_along(points, points),
            field.proved_along(points, points + spacing * back),
        ):
            distances = [abs(Fraction(each) - Fraction(wall)) for each in x.tolist()]
            assert all(
                Fraction(bound) <= exact for bound, exact in zip(found.tolist(), distances, strict=True)
            )


def test_outside_of_the_grid_a_bound_holds_too():
    cells = scattered(6)
    field = field_of_cells(cells, CORNER, WIDTH)
    points = CORNER + np.random.default_rng(7).uniform(-2.0, 4.0, (2_000, 2))
    assert np.all(field.at(points) <= distances(points, cells) + 1e-9)


def test_without_anything_occupied_all_is_far():
    field = field_of_cells(np.zeros((3, 3), dtype=bool), (0.0, 0.0), 0.1)
    assert np.all(field.at(np.zeros((4, 2))) > 1e5)
    assert np.all(
        field_of_cells(np.ones((5, 5), dtype=bool), (0.0, 0.0), 0.1).at(np.full((1, 2), 0.25)) < -0.15
    )


def test_joined_fields_are_of_what_either_is_of():
    one, other = scattered(8), scattered(9)
    joined = field_of_cells(one, CORNER, WIDTH).joined(field_of_cells(other, CORNER, WIDTH).squares)
    nodes = joined.nodes.reshape(-1, 2)
    assert np.max(np.abs(np.maximum(joined.at(nodes), 0.0) - distances(nodes, one | other))) < 1e-7


def test_a_field_of_nonsense_is_refused():
    with pytest.raises(ProblemError, match="at least two rows and columns"):
        DistanceField(np.zeros((1, 4)), (0.0, 0.0), 0.1)
    with pytest.raises(ProblemError, match="spacing of a distance field must be positive, got 0"):
        DistanceField(np.zeros((2, 4)), (0.0, 0.0), 0)
    with pytest.raises(ProblemError, match="squares holds NaN"):
        DistanceField(np.full((2, 4), np.nan), (0.0, 0.0), 0.1)
