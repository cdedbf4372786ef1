"""Bounds on the distance of two robots hold against another simulator's samples, and are hardly below them."""

import numpy as np
import pytest

from applications.rosbot.approaches import TIGHT
from applications.rosbot.arcs import arcs
from applications.rosbot.encounters import least_distance
from applications.rosbot.others import Other, held_until, poses_at, tracks_of
from applications.rosbot.replay import drive
from tests.bench.fleets import path_of, random_pairs, sampled

STEP = 1e-3  # s, between samples


def test_no_bound_is_false_and_none_is_loose():
    losses = []
    for first, second in random_pairs(150, seed=2):
        bound, _ = least_distance(path_of(first), path_of(second))
        losses.append(sampled(first, second) - bound)
    assert min(losses) >= -1e-9  # rounding of the samples
    # the nearest sample is at most half a step off in time, at a relative speed of at most 1 m/s: far less where
    # the robots do not meet, for there the distance is flat
    assert max(losses) <= 0.5 * STEP + TIGHT
    assert np.median(losses) <= 2.0 * TIGHT


@pytest.mark.parametrize(
    ("first", "second", "distance", "time", "later"),  # when the nearest piece may begin
    [
        ((0.0, 0.0, 0.0, 0.5, 0.0, 8.0), (4.0, 0.3, np.pi, 0.5, 0.0, 8.0), 0.3, 0.0, 4.0),  # pass each other
        (
            (0.0, 0.0, 0.0, 0.5, 0.0, 2.0),
            (4.0, 0.0, np.pi, 0.5, 0.0, 2.0),
            2.0,
            0.0,
            2.0,
        ),  # stop face to face
        ((0.0, 0.0, 0.0, 0.5, 0.0, 2.0), (1.0, 3.0, -np.pi / 2, 0.5, 0.0, 8.0), 0.0, 2.0, 6.0),  # one stands
        (
            (0.0, -1.0, 0.0, 1.0, 1.0, 7.0),
            (0.0, 1.0, np.pi, 1.0, 1.0, 7.0),
            2.0,
            0.0,
            7.0,
        ),  # round one center
        ((0.0, -1.0, 0.0, 1.0, 1.0, 7.0), (0.0, 0.0, 0.0, 0.0, 0.0, 0.0), 1.0, 0.0, 7.0),
    ],
)
def test_what_plane_geometry_says(first, second, distance, time, later):
    one, two = (
        arcs(np.array(each[:3]), np.array([each[3:5]]), np.array(each[5:])) for each in (first, second)
    )
    for bound, when in (least_distance(one, two), least_distance(two, one)):
        assert distance - TIGHT - 1e-12 <= bound <= distance
        assert time - 1e-9 <= when <= later


def test_poses_lie_on_the_path_another_simulator_drives():
    rng = np.random.default_rng(3)
    start, controls, durations = rng.uniform(-1, 1, 3), rng.uniform(-1, 1, (5, 2)), rng.uniform(0.1, 1.0, 5)
    driven = drive(start, controls, durations)
    path = arcs(start, controls, durations)
    assert poses_at(path, driven[:, 0]) == pytest.approx(driven[:, 1:], abs=1e-12)
    assert poses_at(path, np.array([99.0])) == pytest.approx(driven[-1:, 1:], abs=1e-12)


def test_controls_are_held_until_the_arrival():
    controls, durations = held_until(np.array([[1.0, 0.0], [0.5, 0.1], [0.2, 0.3]]), 0.5, 0.75)
    assert controls.tolist() == [[1.0, 0.0], [0.5, 0.1]]
    assert durations.tolist() == [0.5, 0.25]


def test_tracks_hold_the_arcs():
    one = Other(np.zeros(3), [[0.5, 0.5]] * 4, [0.1] * 4, 0.2)
    two = Other(np.ones(3), np.empty((0, 2)), np.empty(0), 0.1)
    tracks = tracks_of([one, two], 0.1)
    times = np.linspace(0.0, 0.6, 601)
    apart = np.hypot(*(poses_at(one.path, times)[:, :2] - tracks.at(times)[0]).T)
    assert 0.0 < apart.max() <= tracks.radii[0] - one.radius + 1e-15
    assert np.all(tracks.at(times)[1] == [1.0, 1.0])
    assert tracks_of([], 0.1) is None
