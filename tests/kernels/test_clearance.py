"""Clearance along arcs, between the ticks as well, against 0.1 ms samples of the exact path."""

from collections.abc import Callable

import numpy as np
import pytest

from gpsynth.arrays import Floats
from gpsynth.distance_field import field_of_cells
from gpsynth.evaluate import Evaluator
from gpsynth.obstacles import Obstacles
from gpsynth.plant import Plant
from gpsynth.problem import Problem
from gpsynth.rollouts import Rollouts
from gpsynth.tracing import trace

HORIZON, PERIOD = 4.0, 0.1
SAMPLES = np.linspace(0.0, HORIZON, 40_001)  # every 0.1 ms
ABOVE = 1e-6  # m, by which a reported clearance may exceed the sampled one
NONE = np.empty((1, 0))


def _drive(v: float, omega: float, start: Floats, obstacles: Obstacles, margin: float = 0.0) -> Rollouts:
    """A unicycle at constant speed and turning rate for HORIZON seconds."""
    plant = Plant(
        lambda x, u: (u.v * np.cos(x.theta), u.v * np.sin(x.theta), u.omega),
        states={"x": "m", "y": "m", "theta": "rad"},
        controls={"v": ("m/s", -9.0, 9.0), "omega": ("rad/s", -9.0, 9.0)},
        angles=("theta",),
        name="unicycle",
    )
    problem = Problem(
        plant,
        [start],
        np.zeros(3),
        tolerance=1e-9,
        horizon=HORIZON,
        period=PERIOD,
        stop=False,
        obstacles=obstacles,
    )
    law = trace(lambda e: (v, omega), [("e", problem.features.names)])
    return Evaluator(problem, margin=margin).of_program(law, NONE)


def _path(v: float, omega: float, start: Floats) -> Floats:
    """The exact arc (2, samples)."""
    x, y, theta = start
    turned = omega * SAMPLES / 2
    chord = v * SAMPLES * np.sinc(turned / np.pi)
    return np.array([x + chord * np.cos(theta + turned), y + chord * np.sin(theta + turned)])


def _gaps(path: Floats, circles: Floats) -> Floats:
    """Distance to the nearest circle at each sample."""
    x = circles[:, :1] + circles[:, 2:3] * SAMPLES
    y = circles[:, 1:2] + circles[:, 3:4] * SAMPLES
    gaps: Floats = np.min(np.hypot(path[0] - x, path[1] - y) - circles[:, 4:], axis=0)
    return gaps


def _scenes(moving: bool) -> Callable[[int], tuple[float, float, Floats, Floats]]:
    def scene(seed: int) -> tuple[float, float, Floats, Floats]:
        rng = np.random.default_rng((seed, moving))
        velocity = rng.uniform(-0.7, 0.7, (4, 2)) * moving
        circles = np.hstack((rng.uniform(-2, 2, (4, 2)), velocity, rng.uniform(0.02, 0.3, (4, 1))))
        return rng.uniform(-1, 1), rng.uniform(-1.5, 1.5), rng.uniform(-2, 2, 3), circles

    return scene


@pytest.mark.parametrize("moving", [False, True], ids=["fixed", "moving"])
def test_clearance_is_the_sampled_minimum_or_a_little_less(moving: bool) -> None:
    below = 0.0
    for seed in range(60):
        v, omega, start, circles = _scenes(moving)(seed)
        gaps = _gaps(_path(v, omega, start), circles)
        if gaps[0] < 0.15:
            continue
        found = _drive(v, omega, start, Obstacles(circles, radius=0.1)).clearance[0, 0]
        exact = np.min(gaps) - 0.1
        sagitta = PERIOD**2 * abs(v * omega) / 8
        assert found <= exact + ABOVE
        assert (
            found >= exact - 2.0 * sagitta - 1e-6
        )  # the bend is deducted, and may point away from the circle
        below = max(below, exact - found)
    assert below > 1e-4  # some deduction was seen, so the bound above means something


def test_a_thin_obstacle_between_two_ticks_is_seen() -> None:
    circles = np.array([[0.15, 0.0, 0.0, 0.0, 0.001]])
    rolled = _drive(1.0, 0.0, np.zeros(3), Obstacles(circles))
    assert abs(rolled.clearance[0, 0] + 0.001) < 1e-12


def test_a_thin_obstacle_that_crosses_between_two_ticks_is_seen() -> None:
    """At 0.05 s, in the middle of the first step, both are at (0.05, 0)."""
    circles = np.array([[0.05, -2.0, 0.0, 40.0, 0.001]])
    rolled = _drive(1.0, 0.0, np.zeros(3), Obstacles(circles))
    assert abs(rolled.clearance[0, 0] + 0.001) < 1e-12


def test_bounds_are_obstacles_too() -> None:
    obstacles = Obstacles(bounds=np.array([-1.0, 5.0, -0.75, 3.0]))
    assert abs(_drive(1.0, 0.0, np.zeros(3), obstacles).clearance[0, 0] - 0.75) < 1e-12
    assert abs(_drive(-0.5, 0.0, np.zeros(3), obstacles).clearance[0, 0] + 1.0) < 1e-12
    circle = _drive(1.0, 1.0, np.array([1.0, 1.0, 0.0]), obstacles).clearance[0, 0]
    exact = min(3.0 - np.max(_path(1.0, 1.0, np.array([1.0, 1.0, 0.0]))[1]), 1.75)
    assert exact - PERIOD**2 / 4 <= circle <= exact + ABOVE


@pytest.mark.parametrize("moving", [0.0, 0.3], ids=["fixed", "moving"])
@pytest.mark.parametrize("count", [1, 60], ids=["one", "many"])  # many are looked at by the cells of a grid
def test_what_is_touched_can_be_left(count: int, moving: float) -> None:
    """Where the distance grows from an end of the chord on, nothing is deducted for a bend; if not, all of it."""
    gap = 1e-9
    for angle in np.linspace(-np.pi, np.pi, 9):
        along = np.array([np.cos(angle), np.sin(angle)])
        circle = np.array([*((-0.4 - gap) * along), *(-moving * along), 0.3])
        far = np.array([[20.0 + k, 9.0, 0.0, 0.0, 0.1] for k in range(count - 1)]).reshape(-1, 5)
        circles = np.vstack([circle, far])
        exact = np.min(_gaps(_path(0.5, 0.5, np.zeros(3)), circles)) - 0.1
        found = _drive(0.5, 0.5, np.zeros(3), Obstacles(circles, radius=0.1)).clearance[0, 0]
        assert found <= exact + ABOVE
        if np.cos(angle) > 0.1:
            assert abs(found - gap) < 1e-12


def test_a_bound_that_is_touched_can_be_left() -> None:
    obstacles = Obstacles(bounds=np.array([0.0, 5.0, -9.0, 9.0]))
    assert _drive(0.5, 0.5, np.array([0.0, 0.0, 0.5]), obstacles).clearance[0, 0] == 0.0
    beside = Obstacles(bounds=np.array([-9.0, 9.0, 0.0, 9.0]))
    assert abs(_drive(0.5, 0.5, np.zeros(3), beside).clearance[0, 0]) < 1e-12
    toward = _drive(0.5, 0.2, np.array([0.0, 0.0, -0.01]), beside).clearance[0, 0]
    assert toward <= np.min(_path(0.5, 0.2, np.array([0.0, 0.0, -0.01]))[1]) + ABOVE < 0.0


def test_no_obstacles_leave_infinite_clearance_and_no_exposure() -> None:
    rolled = _drive(1.0, 1.0, np.zeros(3), Obstacles())
    assert rolled.clearance[0, 0] == np.inf
    assert rolled.exposure[0, 0] == rolled.depth[0, 0] == 0.0


def test_exposure_and_depth_are_integrals_over_the_path() -> None:
    """Straight past a circle; a step counts whole, with the least clearance in it, so both are upper sums."""
    circles = np.array([[2.0, 0.3, 0.0, 0.0, 0.4]])
    gaps = _gaps(_path(1.0, 0.0, np.zeros(3)), circles)
    for margin in (0.0, 0.2):
        rolled = _drive(1.0, 0.0, np.zeros(3), Obstacles(circles), margin)
        missing = np.maximum(margin - gaps, 0.0)
        exposure, depth = np.mean(missing > 0.0) * HORIZON, np.mean(missing) * HORIZON
        assert exposure <= rolled.exposure[0, 0] + 1e-3
        assert rolled.exposure[0, 0] <= exposure + 2 * PERIOD
        assert depth <= rolled.depth[0, 0] + 1e-6
        assert rolled.depth[0, 0] <= depth + 2 * PERIOD * np.max(missing)


def test_what_comes_after_arrival_is_not_counted() -> None:
    plant = Plant(
        lambda x, u: (u.v, 0.0), states={"x": "m", "y": "m"}, controls={"v": ("m/s", -1.0, 1.0)}, name="line"
    )
    starts = [[0.0, 0.0], [-3.0, 0.0]]  # the second keeps the block running
    obstacles = Obstacles(np.array([[1.0, 2.0, 0.0, -1.0, 0.5]]))  # runs over the goal from t = 1.5 s on
    problem = Problem(
        plant, starts, [1.0, 0.0], tolerance=0.06, period=0.05, horizon=3.0, obstacles=obstacles
    )
    rolled = Evaluator(problem).of_program(trace(lambda e: 1.0, [("e", problem.features.names)]), NONE)
    assert abs(rolled.arrival[0, 0] - 0.95) < 1e-12
    assert rolled.clearance[0, 0] > 0.5
    assert rolled.exposure[0, 0] == 0.0


def test_a_body_of_circles_turns_with_the_robot() -> None:
    """Against the exact arcs of its circles; one that is two steps ahead bends more than the origin does."""
    body = np.array([[0.3, 0.0, 0.1], [-0.2, 0.1, 0.15]])
    below = 0.0
    for seed in range(60):
        v, omega, start, circles = _scenes(True)(seed)
        origin, theta = _path(v, omega, start), start[2] + omega * SAMPLES
        places = [
            origin + np.array([a * np.cos(theta) - b * np.sin(theta), a * np.sin(theta) + b * np.cos(theta)])
            for a, b, _ in body
        ]
        gaps = [_gaps(place, circles) - radius for place, (_, _, radius) in zip(places, body, strict=True)]
        if min(gap[0] for gap in gaps) < 0.01:
            continue
        obstacles = Obstacles(circles, footprint=body, position=("x", "y", "theta"))
        found, exact = _drive(v, omega, start, obstacles).clearance[0, 0], np.min(gaps)
        sagitta = PERIOD**2 * (abs(v * omega) + 0.3 * omega**2) / 8
        assert exact - 2.0 * sagitta - 1e-6 <= found <= exact + ABOVE + 1e-3 * sagitta
        below = max(below, exact - found)
    assert below > 1e-4


def test_a_centered_circle_is_a_body_as_well() -> None:
    for seed in range(5):
        v, omega, start, circles = _scenes(True)(seed)
        start[0] += 5.0
        one, other = Obstacles(circles, radius=0.1), Obstacles(circles, footprint=np.array([[0.0, 0.0, 0.1]]))
        assert np.array_equal(
            _drive(v, omega, start, one).clearance, _drive(v, omega, start, other).clearance
        )


def test_a_distance_field_is_an_obstacle_that_is_never_farther_than_it_seems() -> None:
    """Random cells, against the exact distance from the squares at samples of the path."""
    short = 0.0
    for seed in range(40):
        rng = np.random.default_rng((seed, 7))
        cells = rng.random((60, 60)) < 0.004
        low = -3.0 + 0.1 * np.argwhere(cells)[:, ::-1]
        v, omega, start = rng.uniform(-0.7, 0.7), rng.uniform(-1.0, 1.0), rng.uniform(-1.0, 1.0, 3)
        path = _path(v, omega, start)[:, ::40].T
        beyond = np.maximum(np.maximum(low - path[:, None], path[:, None] - low - 0.1), 0.0)
        exact = np.min(np.hypot(beyond[..., 0], beyond[..., 1]))
        if exact < 0.1:
            continue
        field = field_of_cells(cells, (-3.0, -3.0), 0.1, parts=2)
        found = _drive(v, omega, start, Obstacles(field=field, radius=0.1)).clearance[0, 0]
        assert found <= exact - 0.1 + 1e-6 + 4e-3 * abs(v)  # the samples are 4 ms apart
        assert found >= exact - 0.1 - 0.06
        short = max(short, exact - 0.1 - found)
    assert short > 1e-4


def test_a_field_of_one_cell_between_two_ticks_is_seen() -> None:
    cells = np.zeros((40, 40), dtype=bool)
    cells[20, 20] = True
    field = field_of_cells(cells, (-0.2, -0.2), 0.01)  # the cell from (0, 0) to (0.01, 0.01)
    rolled = _drive(1.0, 0.0, np.array([-0.15, 0.005, 0.0]), Obstacles(field=field))
    assert rolled.clearance[0, 0] < 0.0


def test_a_diverged_state_reads_no_memory_beside_the_field() -> None:
    field = field_of_cells(np.eye(8, dtype=bool), (0.0, 0.0), 0.1)
    for start in ([1e9, -1e9, 0.0], [-1e9, 1e9, 1e7]):
        assert np.isfinite(_drive(9.0, 9.0, np.array(start), Obstacles(field=field)).clearance[0, 0])
