"""Bodies of circles: rectangles are covered, and the circles go where the robot goes."""

import numpy as np
import pytest

from applications.rosbot.footprint import EXCESS, inner_radius, outer_radius, placed, rectangle_circles
from applications.rosbot.scenario import Scenario
from gpsynth.errors import ScenarioError


@pytest.mark.parametrize(
    ("length", "width", "center"),
    [(0.2, 0.235, (0.0, 0.0)), (0.6, 0.3, (0.1, 0.0)), (0.05, 0.9, (0.0, -0.2)), (1.0, 1.0, (0.0, 0.0))],
)
def test_a_rectangle_is_covered_and_little_more(length, width, center):
    body = rectangle_circles(length, width, center)
    corner = np.array(center) - 0.5 * np.array([length, width])
    x, y = np.meshgrid(np.linspace(0.0, length, 301), np.linspace(0.0, width, 301))
    inside = corner + np.column_stack([x.ravel(), y.ravel()])
    gaps = np.hypot(*(inside[:, None] - body[:, :2]).transpose(2, 0, 1)) - body[:, 2]
    assert gaps.min(axis=1).max() <= 1e-12
    edges = np.abs(body[:, :2] - center) + body[:, 2:] - 0.5 * np.array([length, width])
    assert edges.max() <= EXCESS + 1e-12


def test_a_square_that_one_circle_covers_gets_one():
    assert rectangle_circles(0.1, 0.1) == pytest.approx(np.array([[0.0, 0.0, 0.05 * np.sqrt(2.0)]]))
    assert len(rectangle_circles(0.3, 0.2)) == 6


def test_circles_turn_and_move_with_the_pose():
    body = np.array([[0.3, 0.0, 0.1], [0.0, 0.2, 0.2]])
    centers = placed(body, np.array([[1.0, 2.0, 0.5 * np.pi], [0.0, 0.0, np.pi]]))
    assert centers == pytest.approx(
        np.array([[[1.0, 2.3], [0.8, 2.0]], [[-0.3, 0.0], [0.0, -0.2]]]), abs=1e-12
    )


def test_inner_and_outer_discs_bound_the_body():
    body = np.array([[0.1, 0.0, 0.3], [0.4, 0.3, 0.2]])
    assert inner_radius(body) == pytest.approx(0.2)
    assert outer_radius(body) == pytest.approx(0.7)
    assert inner_radius(np.array([[0.5, 0.0, 0.2]])) == 0.0


def test_a_scenario_takes_a_body_and_checks_it():
    start, goal = [0.0, 0.0, 0.5 * np.pi], [3.0, 0.0, 0.0]
    body, wall = np.array([[0.3, 0.0, 0.1], [0.0, 0.0, 0.1]]), [[0.0, 0.45, 0.0, 0.0, 0.1]]
    assert Scenario(start, goal, footprint=body).radius == pytest.approx(0.1)
    with pytest.raises(ScenarioError, match=r"overlaps obstacles\[0\] by 0.05 m with the robot's footprint"):
        Scenario(start, goal, footprint=body, circles=wall)
    with pytest.raises(ScenarioError, match=r"circle 1 of the robot is \[0, 0, -1\]"):
        Scenario(start, goal, footprint=np.array([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]))


@pytest.mark.parametrize("thin", [1e-12, 1e-3])
def test_a_thin_rectangle_takes_no_longer(thin):
    circles = rectangle_circles(thin, 1.0)
    assert len(circles) == 17
    assert np.all(circles[:, 2] <= 0.5 * thin + 0.03)
