from dataclasses import replace

import numpy as np
import pytest
from scipy.ndimage import label

from applications.rosbot.bounds import lower_bound
from applications.rosbot.certificate import certify
from applications.rosbot.reachability import reachability
from applications.rosbot.scenario import Scenario

BOUNDS = [-1.0, 4.0, -1.0, 4.0]


def ring(count: int, size: float, radius: float, center=(2.0, 2.0)) -> np.ndarray:
    angles = 2.0 * np.pi * np.arange(count) / count
    x, y = center[0] + size * np.cos(angles), center[1] + size * np.sin(angles)
    return np.column_stack([x, y, 0.0 * x, 0.0 * x, np.full(count, radius)])


def scene(circles, **changes) -> Scenario:
    given = {"start": [0.0, 0.0, 0.0], "goal": [2.0, 2.0, 0.0], "bounds": BOUNDS, "circles": circles}
    return Scenario(**given | changes)


def flooded(scenario: Scenario, cell: float) -> tuple[bool, bool]:
    """Whether a flood reaches the goal through cells not wholly inside one disc, and through cells wholly free."""
    x_low, x_high, y_low, y_high = scenario.bounds
    columns, rows = round((x_high - x_low) / cell), round((y_high - y_low) / cell)
    x = x_low + cell * (np.arange(columns) + 0.5)
    y = y_low + cell * (np.arange(rows) + 0.5)

    def spans(px, py):
        dx, dy = np.abs(x - px)[:, None], np.abs(y - py)[None, :]
        near = np.hypot(np.maximum(dx - cell / 2, 0.0), np.maximum(dy - cell / 2, 0.0))
        return near, np.hypot(dx + cell / 2, dy + cell / 2)

    maybe, free = np.ones((columns, rows), bool), np.ones((columns, rows), bool)
    for px, py, radius in scenario.discs:
        near, far = spans(px, py)
        maybe &= far >= radius
        free &= near >= radius
    near, far = spans(*scenario.goal[:2])
    at_goal = near <= scenario.position_tolerance
    at_start = spans(*scenario.start[:2])[0] <= 1e-9
    results = []
    for cells, structure in ((maybe, np.ones((3, 3))), (free, None)):
        parts, _ = label(cells, structure)
        starts = set(parts[at_start & cells]) if cells is maybe or np.all(cells[at_start]) else set()
        results.append(bool(starts & set(parts[at_goal & cells])))
    return results[0], results[1]


def test_public_scenarios_are_decided(public):
    assert (reachability(public).status == "reachable") == public.expect_feasible


def test_it_agrees_with_floods_on_a_grid():
    rng = np.random.default_rng(11)
    decided = {"reachable": 0, "unreachable": 0}
    while min(decided.values()) < 25 and sum(decided.values()) < 200:
        xy = rng.uniform(-1.0, 4.0, (rng.integers(5, 45), 2))
        circles = np.column_stack([xy, 0.0 * xy, rng.uniform(0.1, 0.5, len(xy))])
        circles = circles[np.hypot(xy[:, 0], xy[:, 1]) > circles[:, 4] + 0.25]
        scenario = scene(circles, goal=[*rng.uniform(-0.8, 3.8, 2), 0.0], position_tolerance=0.2)
        status = reachability(scenario).status
        maybe, surely = flooded(scenario, 0.02)
        decided[status] += 1
        assert maybe or status == "unreachable"
        assert not surely or status == "reachable"
    assert min(decided.values()) >= 25


@pytest.mark.parametrize("excess", [0.001, -0.001])
def test_a_gap_counts_to_the_millimeter(excess):
    size, radius = 0.75, 0.18
    needed = 2.0 * (radius + 0.15)
    gap_angle = 2.0 * np.arcsin((needed + excess) / 2.0 / size)
    angles = np.linspace(0.0, 2.0 * np.pi - gap_angle, 14)
    circles = np.column_stack(
        [2 + size * np.cos(angles), 2 + size * np.sin(angles), *np.zeros((2, 14)), [radius] * 14]
    )
    result = reachability(scene(circles))
    assert result.status == ("reachable" if excess > 0.0 else "unreachable")
    assert excess > 0.0 or {0, 13} <= set(result.barrier)


def test_the_reason_names_the_ring_and_its_widest_gap():
    result = reachability(scene(ring(11, 0.75, 0.18)))
    gap = 2.0 * 0.75 * np.sin(np.pi / 11) - 2.0 * 0.18
    assert sorted(result.barrier) == list(range(11))
    assert f"the widest gap between them is {gap:.3g} m, the robot needs 0.3 m" in result.reason


def test_the_start_may_be_the_one_that_is_shut_in():
    assert reachability(scene(ring(11, 0.75, 0.18, center=(0.0, 0.0)))).status == "unreachable"


def test_a_wall_between_the_bounds_is_a_barrier():
    wall = np.column_stack(
        [np.full(11, 1.0), np.linspace(-1.0, 4.0, 11), *np.zeros((2, 11)), np.full(11, 0.2)]
    )
    result = reachability(scene(wall))
    assert result.status == "unreachable"
    assert sorted(result.barrier) == list(range(11))
    assert "and the bounds" in result.reason
    assert reachability(scene(wall, bounds=[-1.0, 4.0, -1.6, 4.0])).status == "reachable"
    assert reachability(scene(wall[:-1], bounds=[-1.0, 4.0, -1.0, np.inf])).status == "reachable"


def test_a_single_obstacle_can_shut_a_corridor():
    circle = [[1.0, 0.0, 0.0, 0.0, 0.5]]
    assert (
        reachability(scene(circle, bounds=[-1.0, 4.0, -0.6, 0.6], goal=[3.0, 0.0, 0.0])).status
        == "unreachable"
    )
    assert (
        reachability(scene(circle, bounds=[-1.0, 4.0, -0.7, 0.7], goal=[3.0, 0.0, 0.0])).status == "reachable"
    )


def test_a_covered_goal_is_reported_with_the_obstacle():
    result = reachability(scene([[3.0, 0.0, 0.0, 0.0, 0.1], [2.0, 2.1, 0.0, 0.0, 0.3]]))
    assert result.status == "unreachable"
    assert result.barrier == (1,)
    assert "the goal is in collision" in result.reason


def test_a_covered_goal_is_reachable_if_its_tolerance_is_not():
    circle = [[2.0, 2.4, 0.0, 0.0, 0.28]]  # 0.03 m over the goal
    assert reachability(scene(circle)).status == "reachable"
    assert reachability(scene(circle, position_tolerance=0.02)).status == "unreachable"


def test_every_piece_of_a_divided_tolerance_counts():
    shut_in = ring(11, 0.75, 0.18)
    gate = [[2.75 + 0.15 + 0.181, 2.0, 0.0, 0.0, 0.01]]
    for goal, status in (([2.0, 2.0, 0.0], "unreachable"), ([2.75, 2.0, 0.0], "reachable")):
        scenario = scene(np.vstack([shut_in, gate]), goal=goal, position_tolerance=0.4)
        assert reachability(scenario).status == status


def test_moving_obstacles_prove_nothing_but_those_at_rest_do():
    moving = ring(11, 0.75, 0.18)
    moving[0, 2] = 0.1
    assert reachability(scene(moving)).status == "undecided"
    both = np.vstack([ring(11, 0.75, 0.18), [[0.0, 3.0, 0.1, 0.0, 0.1]]])
    assert reachability(scene(both)).status == "unreachable"


@pytest.mark.parametrize("limits", [{"speed_limits": (0.1, 0.5)}, {"turn_limits": (0.1, 0.5)}])
def test_a_robot_that_cannot_turn_in_place_is_only_proved_shut_out(limits):
    assert reachability(scene([], **limits)).status == "undecided"
    assert reachability(scene(ring(11, 0.75, 0.18), **limits)).status == "unreachable"


def test_turning_to_one_side_is_enough():
    assert reachability(scene([], turn_limits=(0.0, 0.5))).status == "reachable"


@pytest.mark.parametrize("shift", [0.0, 4e-7, -4e-7])
def test_a_passage_of_exactly_the_robots_width_is_left_undecided(shift):
    pair = [[1.0, -0.65 - shift, 0.0, 0.0, 0.5], [1.0, 0.65, 0.0, 0.0, 0.5]]
    corridor = {"bounds": [-1.0, 4.0, -0.5, 0.5], "goal": [3.0, 0.0, 0.0]}
    assert reachability(scene(pair, **corridor)).status == "undecided"


@pytest.mark.parametrize("other", [{"model": "car", "turning_radius": 3.0}, {"model": "dynamic_unicycle"}])
def test_a_route_is_no_proof_for_a_robot_that_does_not_turn_in_place(other):
    circle = [[1.0, 1.0, 0.0, 0.0, 0.2]]
    assert reachability(scene(circle)).status == "reachable"
    assert reachability(scene(circle, **other)).status == "undecided"


def test_an_origin_that_is_no_part_of_the_body_may_be_in_an_obstacle():
    arm = scene(
        [[2.0, 0.0, 0.0, 0.0, 0.3]],
        goal=[4.0, 0.0, 0.0],
        bounds=[-1.0, 5.0, 0.0, 0.2],
        footprint=[[0.0, 0.5, 0.1]],
    )
    assert certify(arm, np.tile([0.5, 0.0], (160, 1)), 0.05).clearance == pytest.approx(0.1)
    assert reachability(arm).status == "undecided"
    assert lower_bound(replace(arm, bounds=BOUNDS)) == pytest.approx((4.0 - 0.05) / 0.5, abs=1e-5)
    held = replace(arm, footprint=[[0.0, 0.5, 0.1], [0.0, 0.0, 0.1]])
    assert reachability(held).status == "unreachable"
