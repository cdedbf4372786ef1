"""Certificates hold against dense samples, and are no more careful than they need to be."""

from dataclasses import replace

import mpmath
import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from applications.rosbot import planner
from applications.rosbot.approaches import TIGHT
from applications.rosbot.arcs import arcs
from applications.rosbot.certificate import certify
from applications.rosbot.model import unicycle
from applications.rosbot.plan_file import plan_document
from applications.rosbot.planner import Effort, plan_scenario
from applications.rosbot.polar_law import SATURATING, polar_law
from applications.rosbot.replay import replay
from applications.rosbot.room import Room
from applications.rosbot.scenario import Scenario
from gpsynth.planning import PlanSettings
from tests.bench.certificates import ROUNDED, judged

QUICK = Effort(scouts=PlanSettings(particles=16, iterations=8, rounds=2), attempts=1)


def scene(*circles, **changes) -> Scenario:
    return Scenario(
        **{"start": [0.0, 0.0, 0.0], "goal": [9.0, 0.0, 0.0], "radius": 0.1, "circles": circles} | changes
    )


@pytest.mark.parametrize("moving", [False, True], ids=["at rest", "moving"])
def test_no_certificate_is_false_and_none_is_loose(moving):
    proved, samples = np.array(
        [(each.clearance, seen) for each, seen in judged(400, moving=moving, seed=2)]
    ).T
    assert np.all(proved <= samples + ROUNDED)
    # the nearest of samples 0.1 ms apart is at most 5e-5 m from a foot 0.05 m away or farther: 2.5e-8 m
    assert np.max(samples - proved) <= 2.5e-8 + TIGHT * moving
    assert np.mean(samples < 0.0) > 0.2


@pytest.mark.parametrize(
    ("v", "omega", "time", "center", "distance"),
    [
        (1.0, 1.0, 7.0, (0.0, 1.0), 1.0),  # about the center, once and more
        (1.0, 1.0, 7.0, (0.0, 3.0), 1.0),
        (1.0, 1.0, 7.0, (0.3, 1.0), 0.7),
        (1.0, 1.0, 1.0, (0.0, 3.0), np.hypot(np.sin(1.0), 2.0 + np.cos(1.0))),  # the end is nearest
        (1.0, -1.0, 1.0, (0.0, 3.0), 3.0),  # the beginning is
        (-1.0, 0.5, 1.0, (-0.4, 0.2), 0.0),  # backwards, see below
        (0.5, 0.0, 2.0, (0.3, -0.2), 0.2),
        (0.5, 0.0, 2.0, (1.3, 0.4), 0.5),
        (0.5, 1e-12, 2.0, (0.3, -0.2), 0.2),
        (0.0, 0.7, 9.0, (0.3, 0.4), 0.5),
        (1e-13, 0.7, 9.0, (0.3, 0.4), 0.5),
        (1e-320, 0.7, 9.0, (0.3, 0.4), 0.5),
    ],
)
def test_the_distance_of_one_piece_is_that_of_plane_geometry(v, omega, time, center, distance):
    if v == -1.0:
        x, y = lambda t: -np.sin(0.5 * t) / 0.5, lambda t: (np.cos(0.5 * t) - 1.0) / 0.5
        gap = lambda t: np.hypot(x(t) - center[0], y(t) - center[1])  # noqa: E731
        distance = minimize_scalar(gap, bounds=(0.0, time), method="bounded", options={"xatol": 1e-10}).fun
    found = certify(scene([*center, 0.0, 0.0, 0.15], radius=0.0), [[v, omega]], time)
    assert found.clearance <= distance - 0.15 + 1e-12  # a curvature of 2e-12 / m is worth 1e-13 m
    assert found.clearance == pytest.approx(distance - 0.15, abs=1e-11)


def test_what_samples_miss_is_seen():
    fast = scene(
        [4.05, 0.0, 0.0, 0.0, 0.01], radius=0.01, speed_limits=(-100.0, 100.0)
    )  # 0.1 m a millisecond
    controls = np.array([[100.0, 0.0]])
    assert replay(fast, controls, 0.09).solves
    assert certify(fast, controls, 0.09).clearance == pytest.approx(-0.02, abs=1e-12)
    thin = replace(fast, circles=np.array([[4.05, -1.0, 0.0, 1.0 / 0.0405, 0.01]]))
    assert replay(thin, controls, 0.09).solves
    assert certify(thin, controls, 0.09).clearance == pytest.approx(-0.02, abs=2.0 * TIGHT)


def test_the_nearest_obstacle_and_its_time_are_the_witness():
    circles = [[1.0, 0.4, 0.0, 0.0, 0.2], [0.5, 0.6, 0.0, 0.0, 0.2], [3.0, -0.5, 0.0, 0.1, 0.2]]
    found = certify(scene(*circles), np.array([[0.5, 0.0]] * 40), 0.05)
    assert (found.obstacle, found.clearance) == (0, pytest.approx(0.1, abs=1e-12))
    assert found.time == pytest.approx(1.95, abs=0.05 + 1e-9)
    later = certify(scene(*circles), np.array([[0.5, 0.0]] * 120), 0.05)
    assert later.obstacle == 2
    assert certify(scene(), np.array([[0.5, 0.0]]), 1.0).obstacle is None


def test_what_happens_after_the_arrival_does_not_count():
    wall = scene([1.4, 0.0, 0.0, 0.0, 0.2])
    assert not certify(wall, np.array([[0.5, 0.0]] * 80), 0.05).is_clear
    assert certify(wall, np.array([[0.5, 0.0]] * 80), 0.05, until=1.98).clearance == pytest.approx(
        0.11, abs=1e-11
    )
    assert certify(wall, np.empty((0, 2)), 0.05).clearance == pytest.approx(1.1, abs=1e-12)


def test_the_room_counts_the_bulge_of_an_arc_and_no_more():
    controls = np.array([[1.0, 1.0]])  # half a circle of radius 1 about (0, 1), out to x = 1
    found = certify(scene(bounds=[-1.0, 1.5, -1.0, 3.0], goal=[0.0, 2.0, 3.0]), controls, np.pi)
    assert 0.5 - 0.125 <= found.room <= 0.5  # a piece of 1 rad bends by at most 1/8 m
    eighth = np.pi / 4.0  # x grows all along, so the end counts
    found = certify(scene(bounds=[-1.0, 1.0, -1.0, 3.0], goal=[0.0, 2.0, 3.0]), controls, eighth)
    assert found.room == pytest.approx(1.0 - np.sin(eighth), abs=1e-12)
    assert not certify(scene(bounds=[-1.0, 0.9, -1.0, 3.0], goal=[0.0, 2.0, 3.0]), controls, np.pi).is_clear


def test_the_computed_poses_are_within_their_error():
    rng, mpmath.mp.dps = np.random.default_rng(3), 40
    controls, steps = rng.uniform(-0.5, 0.5, (200, 2)), rng.uniform(0.0, 0.2, 200)
    found = arcs(np.array([1.0, -2.0, 700.0]), controls, steps)
    x, y, theta = map(mpmath.mpf, (1.0, -2.0, 700.0))
    for (v, omega), step in zip(controls.tolist(), steps.tolist(), strict=True):
        after = theta + mpmath.mpf(omega) * mpmath.mpf(step)
        radius = mpmath.mpf(v) / mpmath.mpf(omega)
        x, y = (
            x + radius * (mpmath.sin(after) - mpmath.sin(theta)),
            y + radius * (mpmath.cos(theta) - mpmath.cos(after)),
        )
        theta = after
    off = mpmath.hypot(x - found.poses[-1, 0], y - found.poses[-1, 1])
    assert off <= found.error < 1e-9
    assert abs(theta - found.poses[-1, 2]) <= found.turn_error < 1e-10


def test_numpy_is_as_accurate_as_the_proof_needs():
    angles = np.concatenate([np.random.default_rng(4).uniform(-s, s, 500) for s in (1e-3, 3.0, 1e2, 1e4)])
    mpmath.mp.dps = 40
    for ours, exact in ((np.sin, mpmath.sin), (np.cos, mpmath.cos)):
        off = [
            abs(value - exact(angle))
            for value, angle in zip(ours(angles).tolist(), angles.tolist(), strict=True)
        ]
        assert np.all(np.array(off, dtype=np.float64) <= 4.0 * np.spacing(np.abs(ours(angles))))


def test_nothing_that_is_not_proved_is_called_planned(monkeypatch):
    law, block = polar_law(unicycle(), SATURATING), scene([4.5, 0.1, 0.0, 0.0, 0.3])
    monkeypatch.setattr(
        planner, "certify", lambda *given, **options: replace(certify(*given, **options), clearance=-1e-6)
    )
    report = plan_scenario(block, [law], seed=1, effort=QUICK)
    assert (report.status, report.plan, report.certificate) == ("not_found", None, None)
    assert plan_document(report)["certificate"] is None


def test_a_robot_that_stays_is_as_far_from_what_moves_as_it_is_now():
    found = certify(scene([1.0, 0.0, 0.1, 0.0, 0.2], radius=0.15), np.empty((0, 2)), 0.05)
    assert found.clearance == pytest.approx(0.65, abs=1e-12)
    assert found.obstacle == 0


@pytest.mark.parametrize("radius", [0.0, 1e-9, 1e-7])
@pytest.mark.parametrize("speed", [0.5, 0.49, 0.4])
def test_however_small_a_robot_it_does_not_pass_a_wall(radius, speed):
    wall = Room(segments=np.array([[1.0, -1.0, 1.0, 1.0]]))
    found = certify(scene(room=wall, radius=radius), np.tile([speed, 0.0], (80, 1)), 0.05)
    assert not found.is_clear
