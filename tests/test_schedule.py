"""Schedules are checked once, where they are made."""

import numpy as np
import pytest

from gpsynth.errors import ProblemError
from gpsynth.schedule import Schedule


def test_ends_are_sums_of_the_dwell_times():
    schedule = Schedule([[0.0, 1.0], [2.0, 3.0], [4.0, 5.0]], [0.5, 0.0, 2.0])
    assert schedule.ends.tolist() == [0.5, 0.5, 2.5]
    assert schedule.points.shape == (3, 2)


def test_a_schedule_may_have_no_points():
    assert Schedule(np.empty((0, 3)), np.empty(0)).ends.shape == (0,)


def test_arrays_are_read_only_copies():
    points = np.zeros((1, 2))
    schedule = Schedule(points, np.ones(1))
    points[0] = 9.0
    assert schedule.points.tolist() == [[0.0, 0.0]]
    with pytest.raises(ValueError, match="read-only"):
        schedule.dwell[0] = 2.0


def test_what_is_left_after_a_while():
    schedule = Schedule([[0.0], [1.0], [2.0]], [0.5, 1.0, 2.0])
    left = schedule.after(0.75)
    assert left.points.tolist() == [[1.0], [2.0]]
    assert left.dwell.tolist() == [0.75, 2.0]
    over = schedule.after(4.0)
    assert (over.points.tolist(), over.dwell.tolist()) == ([[2.0]], [0.0])


def test_a_split_schedule_has_the_same_target_at_every_time():
    schedule = Schedule([[0.0], [1.0]], [0.5, 3.0])
    split = schedule.split(4)
    assert len(split.dwell) == 4
    for time in np.arange(0.01, 3.5, 0.02):
        before, after = (each.points[np.searchsorted(each.ends, time)] for each in (schedule, split))
        assert before == after


@pytest.mark.parametrize(
    ("points", "dwell", "message"),
    [
        ([0.0, 1.0], [1.0, 1.0], r"shapes \(2,\) and \(2,\)"),
        ([[0.0, 1.0]], [1.0, 1.0], r"shapes \(1, 2\) and \(2,\)"),
        ([[0.0, np.nan]], [1.0], "points of a schedule hold NaN"),
        ([[0.0, 1.0]], [-0.1], r"at least 0 s, got \[-0.1\]"),
        ([[0.0, 1.0]], [np.inf], "finite"),
        ([[0.0, 1.0], [2.0]], [1.0, 1.0], "numbers"),
        ([["a", "b"]], [1.0], "numbers"),
    ],
)
def test_a_wrong_schedule_is_an_error(points, dwell, message):
    with pytest.raises(ProblemError, match=message):
        Schedule(points, dwell)
