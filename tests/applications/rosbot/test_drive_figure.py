"""The figure of a drive shows what was so at its instants."""

import numpy as np
import pytest
from matplotlib.colors import to_hex
from matplotlib.patches import Circle

from applications.rosbot.drive_figure import INSTANTS, draw_drive
from applications.rosbot.loop import drive_scenario
from applications.rosbot.room import Room
from applications.rosbot.scenario import Scenario
from applications.rosbot.sensing import Sensor
from applications.rosbot.stabilizer import default_law
from gpsynth.plotting import ORANGE, PALE


def ways(drive):
    return [course.schedule.points for course in drive.courses]


LEAVING, RESTING = [0.0, 2.7, 0.0, 0.4, 0.25], [9.0, 0.0, 0.0, 0.0, 0.35]


def test_circles_are_where_they_then_are_and_pale_once_out_of_sight():
    scene = Scenario([0.0, 0.0, 0.0], [3.0, 0.0, 0.0], circles=[LEAVING, RESTING], time_limit=2.0)
    drive = drive_scenario(scene, default_law(), settings=None)
    figure = draw_drive(scene, drive.replay.trajectory, ways(drive), Sensor())
    colors = []
    for axes, instant in zip(figure.axes[:INSTANTS], np.linspace(0.0, 2.0, INSTANTS), strict=True):
        assert axes.get_title() == f"{instant:.1f} s"
        found = {patch.radius: patch for patch in axes.patches if isinstance(patch, Circle)}
        assert found[0.25].center == pytest.approx((0.0, 2.7 + 0.4 * instant))
        assert to_hex(found[0.35].get_facecolor()).upper() == ORANGE
        colors.append(to_hex(found[0.25].get_facecolor()).upper())
    assert (colors[0], colors[-1]) == (ORANGE, PALE)
    assert len(figure.axes) == INSTANTS + 1


def test_a_room_and_all_of_the_body_are_drawn_and_count():
    body, block = (
        np.array([[0.2, 0.0, 0.1], [-0.1, 0.0, 0.1]]),
        np.array([[0.5, 1.0], [1.0, 1.0], [1.0, 2.0]]),
    )
    room = Room(polygons=(block,), segments=np.array([[-1.0, -0.4, 2.0, -0.4]]))
    scene = Scenario([0.0, 0.0, 0.0], [3.0, 0.0, 0.0], footprint=body, room=room, time_limit=0.2)
    drive = drive_scenario(scene, default_law(), settings=None)
    axes, *_, below = draw_drive(scene, drive.replay.trajectory, ways(drive), Sensor()).axes
    centers = [patch.center for patch in axes.patches if getattr(patch, "radius", None) == pytest.approx(0.1)]
    assert np.allclose(centers, [[0.2, 0.0], [-0.1, 0.0]])
    assert any(patch.get_path().vertices[:3].tolist() == block.tolist() for patch in axes.patches)
    assert below.lines[0].get_ydata()[0] == pytest.approx(0.3)  # from the segment
