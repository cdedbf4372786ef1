"""How much clearance a search asks for where start or passages leave little."""

from dataclasses import replace

import numpy as np
import pytest

from applications.rosbot.margins import start_gap, ways_within
from applications.rosbot.scenario import Scenario

WANTED = 0.004


def walled(gap: float) -> Scenario:
    """A wall of discs 8 m long across the straight way, with a passage (m) in its middle."""
    places = np.arange(0.2 + 0.5 * gap, 4.0, 0.3)
    circles = [[1.5, y, 0.0, 0.0, 0.2] for place in places for y in (place, -place)]
    return Scenario(start=[0.0, 0.0, 0.0], goal=[3.0, 0.0, 0.0], circles=circles)


def test_where_there_is_room_the_margin_is_the_wanted_one():
    margin, ways = ways_within(walled(0.42), WANTED)
    assert margin == WANTED
    assert ways[0].length == pytest.approx(3.0)


@pytest.mark.parametrize("gap", [0.307, 0.302, 0.3002])
def test_the_shortest_way_is_not_shut_by_the_margin(gap):
    margin, ways = ways_within(walled(gap), WANTED)
    assert 0.3 + 2.0 * margin < gap
    assert ways[0].length == pytest.approx(3.0)


def test_a_passage_that_no_short_way_needs_costs_no_margin():
    aside = replace(
        walled(0.42),
        circles=np.vstack([walled(0.42).circles, [[0.0, 3.0, 0, 0, 0.1], [0.502, 3.0, 0, 0, 0.1]]]),
    )
    assert ways_within(aside, WANTED)[0] == WANTED


def test_the_margin_is_half_of_what_the_start_leaves():
    touching = replace(walled(0.42), start=[1.5 - 0.35 - 0.001, 0.41, 0.0])
    assert start_gap(touching) == pytest.approx(0.001)
    assert ways_within(touching, WANTED)[0] == pytest.approx(0.0005)
    assert start_gap(replace(walled(0.42), bounds=[-0.002, 4.0, -5.0, 5.0])) == pytest.approx(0.002)
