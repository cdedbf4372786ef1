import numpy as np
import pytest

from applications.rosbot.bounds import lower_bound
from applications.rosbot.replay import drive, replay
from applications.rosbot.scenario import Scenario


def scene(**changes) -> Scenario:
    return Scenario(**{"start": [0.0, 0.0, 0.0], "goal": [2.0, 2.0, 0.0]} | changes)


def test_published_bounds_are_met(public, reference):
    # the published route goes around polygons that circumscribe the discs: at most 0.6 % longer, never shorter
    best = max(reference[name] for name in ("euclid", "geo", "rs_tol"))
    assert 0.994 * best <= lower_bound(public) <= best + 2e-4  # and rs_tol is a grid minimum


def test_no_bound_exceeds_the_best_known_time(public, reference):
    assert lower_bound(public) <= reference["T_ref"]


def test_the_faster_direction_counts():
    slow, fast = scene(goal=[-2.0, 0.0, 0.0]), scene(goal=[-2.0, 0.0, 0.0], speed_limits=(-1.0, 0.5))
    assert lower_bound(slow) == pytest.approx(3.9)
    assert lower_bound(fast) == pytest.approx(1.95)


def test_an_obstacle_in_the_tolerance_does_not_count():
    covered = scene(goal=[2.0, 0.0, 0.0], circles=[[2.0, 0.0, 0.0, 0.0, 0.01]], radius=0.01)
    assert lower_bound(covered) == pytest.approx(1.95 / 0.5)


def test_a_start_within_the_tolerance_is_bounded_by_0():
    assert lower_bound(scene(goal=[0.3, 0.2, 3.0], position_tolerance=0.5, heading_tolerance=3.2)) == 0.0
    assert lower_bound(scene(goal=[0.03, 0.02, 2.0 * np.pi])) == 0.0


def test_no_controls_beat_the_bound():
    rng = np.random.default_rng(5)
    for _ in range(200):
        start, sign = rng.uniform(-3.0, 3.0, 3), rng.choice([-1.0, 1.0], (rng.integers(1, 5), 2))
        controls, durations = (
            0.5 * sign * rng.choice([1.0, 0.0], sign.shape, p=[0.8, 0.2]),
            rng.uniform(0.0, 1.5),
        )
        position, heading = rng.choice([0.01, 0.05, 0.5]), rng.choice([0.05, 0.5, 3.2])
        end = drive(start, controls, np.full(len(controls), durations))[-1, 1:]
        away, turn = position * rng.uniform(), rng.uniform(-heading, heading)
        direction = rng.uniform(-np.pi, np.pi)
        goal = end + np.array([away * np.cos(direction), away * np.sin(direction), turn])
        small = Scenario(start, goal, position_tolerance=position, heading_tolerance=heading)
        driven = replay(small, controls, durations)
        assert np.isfinite(driven.arrival_time)
        assert lower_bound(small) <= driven.arrival_time


def test_the_bound_of_a_wide_tolerance_is_not_that_of_samples_of_its_edge():
    # straight on the tolerance is entered at 1.288 s, where samples of its edge gave 1.28903 s
    wide = scene(goal=[1.0, 0.5, 0.5], position_tolerance=0.5, heading_tolerance=3.2)
    assert (
        1.2
        < lower_bound(wide)
        <= min(
            replay(wide, np.array([[0.5, omega]]), 2.0).arrival_time for omega in np.linspace(0.0, 0.5, 51)
        )
    )
