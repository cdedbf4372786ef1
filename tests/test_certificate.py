"""Clearance proved for the paths of any plant, against an adaptive integrator sampled between the ticks."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from applications.rosbot.certificate import certify
from applications.rosbot.model import dynamic_unicycle, unicycle
from applications.rosbot.scenario import Scenario
from gpsynth.distance_field import field_of_cells
from gpsynth.draws import Draws
from gpsynth.errors import ProblemError
from gpsynth.obstacles import Obstacles
from gpsynth.planning import certified_clearance
from gpsynth.plant import Plant
from gpsynth.problem import Problem
from gpsynth.simulation import Trajectory

PERIOD, PERIODS, FINE = 0.05, 60, 500
LIMITS = {"v": ("m/s", -0.5, 0.5), "omega": ("rad/s", -2.0, 2.0)}


def car() -> Plant:
    return Plant(
        lambda x, u: (u.v * np.cos(x.theta), u.v * np.sin(x.theta), u.v * np.tan(u.steering) / 0.4),
        states={"x": "m", "y": "m", "theta": "rad"},
        controls={"v": ("m/s", -1.0, 1.0), "steering": ("rad", -0.6, 0.6)},
        angles=("theta",),
    )


def driven(plant: Plant, seed: int) -> tuple[Trajectory, np.ndarray]:
    """A path under random controls at its ticks, and (t, x, y) every 0.1 ms, by an adaptive integrator."""
    rng = np.random.default_rng(seed)
    u = rng.uniform(plant.lower, plant.upper, (PERIODS, len(plant.controls)))
    states, fine = [np.zeros(len(plant.states))], [np.zeros((1, 3))]
    for k, control in enumerate(u):
        rates = lambda t, x, control=control: plant.dynamics(  # noqa: E731
            np.hstack([x, control, t])[np.newaxis], plant.nominal
        )[0]
        times = np.linspace(0.0, PERIOD, FINE + 1)
        found = solve_ivp(
            rates, (0.0, PERIOD), states[-1], method="DOP853", rtol=1e-10, atol=1e-12, t_eval=times
        )
        states.append(found.y[:, -1])
        fine.append(np.column_stack([k * PERIOD + times, found.y[0], found.y[1]]))
    x = np.array(states)
    x[:, 2] = np.remainder(x[:, 2] + np.pi, 2.0 * np.pi) - np.pi
    t = PERIOD * np.arange(PERIODS + 1)
    return Trajectory(plant, t, x, u, x, np.inf, 0.0, np.inf), np.concatenate(fine)


def problem_of(plant: Plant, circles, **changes) -> Problem:
    size = len(plant.states)
    obstacles = Obstacles(circles=circles, bounds=[-9.0, 9.0, -9.0, 9.0], radius=0.1)
    given = {"tolerance": 0.1, "horizon": 9.0, "period": PERIOD, "obstacles": obstacles} | changes
    return Problem(plant, np.zeros(size), np.ones(size), **given)


def clearance(circles, fine) -> float:
    t, x, y = fine.T
    return min(np.hypot(x - a - va * t, y - b - vb * t).min() - r - 0.1 for a, b, va, vb, r in circles)


@pytest.mark.parametrize("plant", [unicycle(), dynamic_unicycle(), car()], ids=["unicycle", "dynamic", "car"])
@pytest.mark.parametrize("fastest", [0.0, 0.3], ids=["at rest", "moving"])
def test_the_bound_holds_between_the_ticks_and_is_near(plant, fastest):
    trajectory, fine = driven(plant, seed=5)
    rng = np.random.default_rng(8)
    for _ in range(20):
        t, x, y = fine[rng.integers(len(fine))]
        velocity, angle = rng.uniform(-fastest, fastest, 2), rng.uniform(0.0, 2.0 * np.pi)
        center = np.array([x, y]) + 0.4 * np.array([np.cos(angle), np.sin(angle)]) - velocity * t
        circles = np.array([[*center, *velocity, 0.2]])
        if np.hypot(*center) < 0.31:  # over the start
            continue
        seen = clearance(circles, fine)
        proved = certified_clearance(problem_of(plant, circles), trajectory, error=1e-9)
        assert proved <= seen
        # a velocity of at most 1 m/s turns by at most 0.13 rad in a period: h/4 of that in x and in y
        assert seen - proved <= 0.25 * PERIOD * 0.13 * 1.5


def test_it_is_no_tighter_than_the_arcs():
    trajectory, _ = driven(unicycle(), seed=6)
    circles = [[0.3, -0.4, 0.0, 0.0, 0.1], [-0.2, 0.5, 0.1, -0.1, 0.1]]
    scenario = Scenario(
        np.zeros(3), [8.0, 0.0, 0.0], circles=circles, radius=0.1, bounds=[-9.0, 9.0, -9.0, 9.0]
    )
    arcs = certify(scenario, trajectory.u, PERIOD)
    general = certified_clearance(problem_of(unicycle(), circles), trajectory)
    assert min(arcs.clearance, arcs.room) - 2e-3 <= general <= min(arcs.clearance, arcs.room)


def test_what_is_uncertain_is_deducted():
    trajectory, _ = driven(unicycle(), seed=6)
    problem = problem_of(unicycle(), [[0.3, -0.4, 0.0, 0.0, 0.1]])
    sure = certified_clearance(problem, trajectory)
    assert sure - 1.2e-2 <= certified_clearance(problem, trajectory, error=0.01) <= sure - 0.01
    late = problem_of(
        unicycle(), problem.obstacles.circles, draws=Draws(delay=[0.02])
    )  # controls within limits
    assert sure - 0.02 <= certified_clearance(late, trajectory) < sure - 1e-3


def test_bounds_count_and_nothing_is_in_the_way_of_a_plant_without_obstacles():
    trajectory, fine = driven(unicycle(), seed=6)
    problem = problem_of(unicycle(), np.empty((0, 5)))
    room = Obstacles(bounds=[fine[:, 1].min() - 0.1, 9.0, -9.0, 9.0])
    proved = certified_clearance(problem_of(unicycle(), [], obstacles=room), trajectory)
    assert 0.1 - 2e-3 <= proved <= 0.1 + 1e-12
    assert certified_clearance(problem_of(unicycle(), [], obstacles=None), trajectory) == np.inf
    with pytest.raises(ProblemError, match="error must be finite and at least 0, not -1"):
        certified_clearance(problem, trajectory, error=-1.0)


def test_a_plant_of_which_nothing_is_known_has_no_certificate():
    odd = Plant(
        lambda x, u: (u.a / x.y, u.b),
        states={"x": "m", "y": "m"},
        controls={"a": ("m/s", -1, 1), "b": ("m/s", -1, 1)},
    )
    x = np.column_stack([np.zeros(3), [-0.01, 0.0, 0.01]])
    trajectory = Trajectory(odd, PERIOD * np.arange(3), x, np.zeros((2, 2)), x, np.inf, 0.0, np.inf)
    assert certified_clearance(problem_of(odd, [[1.0, 1.0, 0.0, 0.0, 0.1]]), trajectory) == -np.inf


def test_a_body_and_a_distance_field_are_proved_clear_too():
    body = np.array([[0.2, 0.0, 0.08], [-0.1, 0.1, 0.1]])
    for seed in range(6):
        trajectory, fine = driven(unicycle((-0.5, 0.5), (-2.0, 2.0)), seed)
        turned = trajectory.x[:-1, 2:] + trajectory.u[:, 1:] * np.linspace(0.0, PERIOD, FINE + 1)
        theta = np.concatenate([[0.0], turned.ravel()])
        cells = np.random.default_rng(seed).random((80, 80)) < 0.01
        cells[30:50, 30:50] = False
        low = -2.0 + 0.05 * np.argwhere(cells)[:, ::-1]
        exact = np.inf
        for ahead, left, radius in body:
            x = fine[::20, 1] + (ahead * np.cos(theta) - left * np.sin(theta))[::20]
            y = fine[::20, 2] + (ahead * np.sin(theta) + left * np.cos(theta))[::20]
            places = np.column_stack([x, y])[:, np.newaxis]
            beyond = np.maximum(np.maximum(low - places, places - low - 0.05), 0.0)
            exact = min(exact, np.min(np.hypot(beyond[..., 0], beyond[..., 1])) - radius)
        field = field_of_cells(cells, (-2.0, -2.0), 0.05, parts=2)
        obstacles = Obstacles(footprint=body, position=("x", "y", "theta"), field=field)
        problem = problem_of(trajectory.plant, [], obstacles=replace(obstacles, field=None))
        object.__setattr__(problem, "obstacles", obstacles)  # also where the start is not free
        proved = certified_clearance(problem, trajectory)
        assert proved <= exact + 1e-6
        assert exact < 0.0 or exact - proved < 0.03


def standing(pose, *, omega: float = 0.0, period: float = PERIOD, periods: int = 40, **obstacles) -> float:
    """What is proved of a robot that stands somewhere, or turns there."""
    plant = unicycle((-1.0, 1.0), (-20.0, 20.0))
    x = np.tile(np.asarray(pose, dtype=np.float64), (periods + 1, 1))
    x[:, 2] = np.remainder(x[:, 2] + omega * period * np.arange(periods + 1) + np.pi, 2.0 * np.pi) - np.pi
    u = np.tile([0.0, omega], (periods, 1))
    trajectory = Trajectory(plant, period * np.arange(periods + 1), x, u, x, np.inf, 0.0, np.inf)
    problem = Problem(plant, np.zeros(3), np.ones(3), tolerance=0.1, period=period, horizon=9.0)
    object.__setattr__(problem, "obstacles", Obstacles(**obstacles))  # also where the start is not free
    return certified_clearance(problem, trajectory)


def test_rounding_is_deducted_where_circles_come_from_afar():
    rng = np.random.default_rng(12)
    for _ in range(200):
        angle, pose = rng.uniform(0.0, 2.0 * np.pi), np.append(rng.normal(size=2), 0.0)
        velocity = 10.0 ** rng.uniform(2.0, 8.0) * np.array([np.cos(angle), np.sin(angle)])
        center = pose[:2] - rng.uniform(0.2, 1.8) * velocity + rng.normal(size=2)
        circles = [[*center, *velocity, 0.0]]
        (a, b), (c, d) = map(Fraction, center), map(Fraction, velocity)
        x, y = Fraction(pose[0]) - a, Fraction(pose[1]) - b
        square = (x * d - y * c) ** 2 / (c * c + d * d)  # of the least distance, which is met on the way
        proved = standing(pose, circles=circles)
        assert proved < 0.0 or Fraction(proved) ** 2 <= square


def test_whole_turns_within_a_period_are_seen():
    body = {"footprint": [[0.5, 0.0, 0.05]], "position": ("x", "y", "theta")}
    behind = {"circles": [[-0.5, 0.0, 0.0, 0.0, 0.1]]}
    assert standing([0.0, 0.0, 0.0], **body, **behind) == pytest.approx(0.85)
    assert standing([0.0, 0.0, 0.0], omega=4.0 * np.pi, period=0.5, **body, **behind) < -0.15


def test_a_path_that_is_no_number_is_not_proved():
    assert standing([np.nan, 0.0, 0.0], circles=[[3.0, 0.0, 0.0, 0.0, 0.1]]) == -np.inf
