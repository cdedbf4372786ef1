"""A stream is a function of seed and path."""

import numpy as np
import pytest

from gpsynth.seeds import stream


def test_same_path_gives_same_numbers():
    assert np.array_equal(stream(7, 1, 2).random(100), stream(7, 1, 2).random(100))


@pytest.mark.parametrize("path", [(), (1,), (2, 1), (1, 2, 0), (1, 3)])
def test_another_path_gives_other_numbers(path):
    assert not np.any(stream(7, 1, 2).random(100) == stream(7, *path).random(100))


def test_another_seed_gives_other_numbers():
    assert not np.any(stream(7, 1).random(100) == stream(8, 1).random(100))


def test_a_stream_does_not_depend_on_draws_elsewhere():
    expected = stream(7, 2).random(10)
    stream(7, 1).random(1000)
    np.random.default_rng(7).random(1000)
    assert np.array_equal(stream(7, 2).random(10), expected)


def test_the_numbers_stay_the_same_from_release_to_release():
    # PCG64 and SeedSequence are kept stable by numpy (NEP 19).
    assert stream(2022, 1, 5).integers(0, 2**32, 4).tolist() == [
        2786182512,
        3182236649,
        1799523613,
        4122647354,
    ]
