"""Discs whose places over time are known: where they are, and how near rollouts and plans come to them."""

import numpy as np
import pytest

from applications.rosbot.model import unicycle
from gpsynth.errors import ProblemError
from gpsynth.evaluate import Evaluator
from gpsynth.obstacles import Obstacles
from gpsynth.planning import Weights, certified_clearance
from gpsynth.planning.weights import weighted
from gpsynth.problem import Problem
from gpsynth.simulation import Trajectory
from gpsynth.tracing import trace
from gpsynth.tracks import Tracks

PERIOD, HORIZON = 0.1, 4.0
FINE = np.linspace(0.0, HORIZON, 40_001)  # every 0.1 ms


def problem(tracks, **changes):
    return Problem(
        unicycle((-2.0, 2.0), (-2.0, 2.0)),
        np.zeros(3),
        [9.0, 9.0, 0.0],
        tolerance=1e-3,
        period=PERIOD,
        horizon=HORIZON,
        stop=False,
        obstacles=Obstacles(radius=0.1, tracks=tracks),
        **changes,
    )


def random_tracks(seed, ticks=15, stride=2):
    """Three discs that go to and fro at up to 0.7 m/s, and stand in the end, before the rollout is over."""
    rng = np.random.default_rng(seed)
    steps = rng.uniform(-0.7, 0.7, (3, ticks, 2)) * stride * PERIOD
    return Tracks(
        rng.uniform(-2.0, 2.0, (3, 1, 2)) + np.cumsum(steps, axis=1),
        rng.uniform(0.05, 0.3, 3),
        stride * PERIOD,
    )


def arc(v, omega, times):
    chord = v * times * np.sinc(0.5 * omega * times / np.pi)
    return np.column_stack([chord * np.cos(0.5 * omega * times), chord * np.sin(0.5 * omega * times)])


def sampled(tracks, path, times):
    """The least gap at the samples, tracks interpolated anew."""
    ticks = tracks.period * np.arange(tracks.places.shape[1])
    gaps = []
    for places, radius in zip(tracks.places, tracks.radii, strict=True):
        x, y = (np.interp(times, ticks, values) for values in places.T)
        gaps.append(np.hypot(path[:, 0] - x, path[:, 1] - y).min() - radius - 0.1)
    return min(gaps)


def test_rollouts_come_as_near_as_samples_say_or_a_little_nearer():
    losses = []
    for seed in range(30):
        v, omega = np.random.default_rng((1, seed)).uniform(-1.0, 1.0, 2)
        tracks = random_tracks(seed)
        given = problem(tracks)
        law = trace(lambda e, u=(v, omega): u, [("e", given.features.names)])
        found = Evaluator(given).of_program(law, np.empty((1, 0))).clearance[0, 0]
        losses.append(sampled(tracks, arc(v, omega, FINE), FINE) - found)
    assert min(losses) >= -1e-6  # the samples miss the foot by that
    assert max(losses) <= 2.0 * PERIOD**2 / 8.0 + 1e-6  # the bend of the path, deducted, may point away


def test_certified_clearance_knows_them():
    for seed in range(10):
        rng = np.random.default_rng((2, seed))
        v, omega = rng.uniform(-1.0, 1.0, 2)
        t = PERIOD * np.arange(41)
        x = np.column_stack([arc(v, omega, t), omega * t])
        tracks, plant = random_tracks(seed), unicycle((-2.0, 2.0), (-2.0, 2.0))
        path = Trajectory(plant, t, x, np.tile([v, omega], (40, 1)), x, np.inf, 0.0, np.inf)
        proved, seen = (
            certified_clearance(problem(tracks), path, error=1e-9),
            sampled(tracks, arc(v, omega, FINE), FINE),
        )
        assert seen - 0.02 <= proved <= seen


def test_a_disc_stands_at_its_last_place():
    tracks = Tracks([[[0.0, 0.0], [1.0, 0.0]], [[2.0, 2.0], [2.0, 3.0]]], [0.1, 0.2], 0.5)
    found = tracks.at(np.array([0.0, 0.25, 0.5, 7.0]))
    assert found.tolist() == [
        [[0.0, 0.0], [0.5, 0.0], [1.0, 0.0], [1.0, 0.0]],
        [[2.0, 2.0], [2.0, 2.5], [2.0, 3.0], [2.0, 3.0]],
    ]


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        (([[[0.0, 0.0]]], [0.1], 0.0), "must be positive, got 0.0"),
        (([[[0.0, 0.0]]], [-0.1], 0.1), "at least 0"),
        (([[[0.0, 0.0]]], [0.1, 0.2], 0.1), r"radii of tracks .*\(1,\)"),
        ((np.empty((1, 0, 2)), [0.1], 0.1), "at least one place"),
        (([[[0.0, np.nan]]], [0.1], 0.1), "places of tracks"),
    ],
)
def test_wrong_tracks_are_refused(given, sentence):
    with pytest.raises(ProblemError, match=sentence):
        Tracks(*given)


def test_a_problem_refuses_what_does_not_fit():
    with pytest.raises(ProblemError, match=r"must be a multiple of the problem's, 0.1 s"):
        problem(Tracks([[[5.0, 5.0]]], [0.1], 0.15))
    with pytest.raises(ProblemError, match="the tracks must be Tracks or None"):
        Obstacles(tracks=[[0.0, 0.0]])
    with pytest.raises(ProblemError, match="weigh"):
        weighted(problem(Tracks([[[5.0, 5.0]]], [0.1], 0.1)), Weights(clearance=1.0))
