"""Obstacles: how far a body is from them, and what is refused with a sentence."""

import numpy as np
import pytest

from gpsynth.distance_field import field_of_cells
from gpsynth.errors import ProblemError
from gpsynth.obstacles import Obstacles
from gpsynth.plant import Plant
from gpsynth.problem import Problem

NAN = float("nan")


WRONG_OBSTACLES = {
    "circles_shape": (
        {"circles": [[0.0, 0.0, 1.0]]},
        r"circles has shape \(1, 3\); expected \(any number, 5\)",
    ),
    "circles_nan": ({"circles": [[0.0, NAN, 0.0, 0.0, 1.0]]}, "circles holds NaN"),
    "radius_of_circle": (
        {"circles": [[0, 0, 0, 0, 1], [0, 0, 0, 0, -1]]},
        "circle 1 has the negative radius -1.0",
    ),
    "radius_of_robot": ({"radius": -0.1}, "the robot's radius must be finite and at least 0, got -0.1"),
    "radius_nan": ({"radius": NAN}, "the robot's radius holds NaN"),
    "bounds_reversed": ({"bounds": [1.0, 0.0, 0.0, 1.0]}, "bounds are x low, x high, y low, y high"),
    "bounds_shape": ({"bounds": [[0, 1], [0, 1]]}, r"bounds has shape \(2, 2\); expected \(4,\)"),
    "bounds_nan": ({"bounds": [0.0, NAN, 0.0, 1.0]}, "bounds holds NaN"),
    "position_same": ({"position": ("x", "x")}, "position names two different states"),
    "position_one": ({"position": ["x"]}, "position names two different states"),
    "position_four": ({"position": ("x", "y", "theta", "t")}, "position names two different states"),
    "position_text": ({"position": "xy"}, "position names two different states"),
}


@pytest.mark.parametrize(("change", "message"), WRONG_OBSTACLES.values(), ids=WRONG_OBSTACLES)
def test_wrong_obstacles_are_an_error(change, message):
    with pytest.raises(ProblemError, match=message):
        Obstacles(**change)


def test_no_obstacles_may_be_an_empty_list():
    assert Obstacles(circles=[]).circles.shape == (0, 5)


def test_a_start_in_the_way_of_a_footprint_or_in_a_field_is_an_error():
    body, cells = np.array([[0.5, 0.0, 0.1]]), np.zeros((9, 9), dtype=bool)
    cells[4, 4] = True
    field = field_of_cells(cells, (-0.45, -0.45), 0.1)
    turned = {"position": ("x", "y", "theta"), "footprint": body}
    assert Obstacles(**turned).gaps(np.array([[0.0, 0.0, 0.0]])).tolist() == [np.inf]
    ahead = Obstacles([[0.0, 0.7, 0.0, 0.0, 0.15]], **turned)
    found = ahead.gaps(np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 0.5 * np.pi]]))
    assert found == pytest.approx([np.hypot(0.5, 0.7) - 0.25, -0.05])
    assert Obstacles(field=field, radius=0.1).gaps(np.array([[0.35, 0.05]])) == pytest.approx([0.2], abs=0.02)
    with pytest.raises(
        ProblemError, match=r"start 0 at \(0.0, 0.0\) is inside what the distance field is of"
    ):
        posed(Obstacles(field=field, radius=0.3))
    with pytest.raises(ProblemError, match=r"start 0 at .* is inside obstacle 0, .* grown by its footprint"):
        posed(Obstacles([[0.5, 0.0, 0.0, 0.0, 0.1]], **turned))
    for wrong, sentence in (
        ({"footprint": body}, "position must name its heading"),
        ({"footprint": body, "radius": 0.1}, "a robot has a radius or a footprint"),
        ({"footprint": -body}, "a footprint has circles of radius at least 0"),
        ({"field": 3}, "the field must be a DistanceField or None, got 3"),
    ):
        with pytest.raises(ProblemError, match=sentence):
            Obstacles(**wrong)


def posed(obstacles: Obstacles) -> Problem:
    plant = Plant(
        lambda x, u: (u.v * np.cos(x.theta), u.v * np.sin(x.theta), u.v),
        states={"x": "m", "y": "m", "theta": "rad"},
        controls={"v": ("m/s", -1.0, 1.0)},
        angles=("theta",),
    )
    return Problem(plant, np.zeros(3), np.ones(3), tolerance=0.1, obstacles=obstacles)
