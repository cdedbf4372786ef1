"""The figure of a plan shows what the plan is, in the place where it is."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib import rc_context
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from applications.rosbot.figures import FOOTPRINTS, draw_controls, draw_path, draw_plan, save_figure
from applications.rosbot.room import Room
from applications.rosbot.scenario import Scenario
from gpsynth.errors import FileError
from gpsynth.plotting import STYLE

PERIOD = 0.1
SCENARIO = Scenario(
    start=np.zeros(3),
    goal=np.array([1.0, 0.0, 0.0]),
    speed_limits=(-0.2, 0.5),
    turn_limits=(-1.0, 1.5),
    circles=np.array([[0.5, 1.0, 0.1, 0.0, 0.2], [0.5, -1.0, 0.0, 0.0, 0.3]]),
    radius=0.1,
)
TRAJECTORY = np.column_stack([np.linspace(0.0, 2.0, 21), np.linspace(0.0, 1.0, 21), np.zeros((21, 2))])
CONTROLS = np.column_stack([np.full(20, 0.5), np.linspace(0.1, -0.1, 20)])
WAYPOINTS = np.array([[0.4, 0.2, 0.0], [1.2, 0.0, 1.0]])


@pytest.fixture
def ax():
    return Figure().add_subplot()


def _lines(ax):
    return {line.get_label(): line for line in ax.lines}


def _circles(ax, radius):
    patches = [patch for patch in ax.patches if isinstance(patch, Circle)]
    return {tuple(map(float, patch.center)) for patch in patches if patch.radius == pytest.approx(radius)}


def test_the_path_runs_through_the_trajectory_from_start_to_goal(ax):
    lines = _lines(draw_path(ax, SCENARIO, TRAJECTORY, WAYPOINTS))
    assert np.array_equal(lines["path"].get_xydata(), TRAJECTORY[:, 1:3])
    assert np.array_equal(lines["equilibrium points"].get_xydata(), WAYPOINTS[:, :2])
    assert lines["start"].get_xydata().tolist() == [[0.0, 0.0]]
    assert lines["goal"].get_xydata().tolist() == [[1.0, 0.0]]
    assert [text.get_text() for text in ax.texts] == ["1", "2"]


def test_obstacles_are_drawn_as_they_are_grown_by_the_robot_and_where_they_have_moved(ax):
    draw_path(ax, SCENARIO, TRAJECTORY, WAYPOINTS)
    assert _circles(ax, 0.2) == {(0.5, 1.0), (0.7, 1.0)}  # 0.1 m/s for 2 s
    assert _circles(ax, 0.3) == {(0.5, 1.0), (0.5, -1.0)}  # the first one grown, the second as it is
    assert _circles(ax, 0.4) == {(0.5, -1.0)}
    assert len(_circles(ax, 0.1)) == FOOTPRINTS


def test_meters_are_equally_long_on_both_axes(ax):
    assert draw_path(ax, SCENARIO, TRAJECTORY, WAYPOINTS).get_aspect() == 1.0
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("$x$ (m)", "$y$ (m)")


def test_controls_are_held_over_their_periods_between_their_limits(ax):
    draw_controls(ax, SCENARIO, CONTROLS, PERIOD)
    for patch, values in zip(ax.patches, CONTROLS.T, strict=True):
        drawn, edges, _ = patch.get_data()
        assert np.array_equal(drawn, values)
        assert np.array_equal(edges, PERIOD * np.arange(21))
    assert {line.get_ydata()[0] for line in ax.lines} == {-0.2, 0.5, -1.0, 1.5, 0.0}


def test_nothing_is_drawn_for_what_is_not_there(ax):
    empty = replace(SCENARIO, circles=np.empty((0, 5)))
    labels = _lines(draw_path(ax, empty, TRAJECTORY, np.empty((0, 3))))
    assert not {"obstacle", "equilibrium points"} & set(labels)


@pytest.mark.parametrize("circles", [SCENARIO.circles, np.empty((0, 5))], ids=["circles", "none"])
@pytest.mark.parametrize("room", [None, Room(np.ones((1, 2), dtype=bool))], ids=["open", "room"])
def test_the_legend_has_all_and_is_within_the_figure(circles, room):
    scenario = replace(SCENARIO, circles=circles, start=np.array([-1.0, 0.0, 0.0]), room=room)
    figure = draw_plan(scenario, TRAJECTORY, CONTROLS, PERIOD, WAYPOINTS, np.array([[0.5, 0.0, 0.1]]))
    [legend] = figure.legends
    labels = {text.get_text() for text in legend.get_texts()}
    assert "via" in labels
    assert ("obstacle" in labels) == (len(circles) > 0 or room is not None)
    figure.set_dpi(300)  # as it is written; glyphs are wider on coarser grids
    with rc_context(dict(STYLE)):
        figure.draw_without_rendering()
        box = legend.get_window_extent()
    assert figure.bbox.x0 <= box.x0 < box.x1 <= figure.bbox.x1


def test_places_on_the_way_are_as_large_as_their_tolerance():
    figure = draw_plan(SCENARIO, TRAJECTORY, CONTROLS, PERIOD, WAYPOINTS, np.array([[0.7, 0.1, 0.05]]))
    assert _circles(figure.axes[0], 0.05) == {(0.7, 0.1)}


def test_the_outermost_cells_of_a_room_are_not_cut_off(ax):
    room = Room(np.ones((4, 6), dtype=bool), corner=(-3.0, 2.0), width=0.5)
    draw_path(ax, replace(SCENARIO, room=room), TRAJECTORY, WAYPOINTS)
    ax.apply_aspect()
    (left, right), (low, high) = ax.get_xlim(), ax.get_ylim()
    assert left < -3.0
    assert right > 0.0
    assert low < -1.0
    assert high > 4.0


def test_a_figure_is_written_as_png(tmp_path):
    figure = draw_plan(SCENARIO, TRAJECTORY, CONTROLS, PERIOD, WAYPOINTS)
    save_figure(figure, tmp_path / "plan.png")
    assert (tmp_path / "plan.png").read_bytes().startswith(b"\x89PNG")
    with pytest.raises(FileError, match="cannot be written"):
        save_figure(figure, tmp_path / "nowhere" / "plan.png")
