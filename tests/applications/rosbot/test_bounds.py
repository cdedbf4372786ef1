import pytest

from applications.rosbot.bounds import lower_bound
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
