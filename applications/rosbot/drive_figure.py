"""A drive as a figure: what was so at a few instants, and how far the robot was from everything all the time."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from applications.rosbot.footprint import outer_radius, placed
from applications.rosbot.gaps import gaps_to_room
from applications.rosbot.loop import CYCLE
from applications.rosbot.room_figure import draw_room
from applications.rosbot.scenario import Scenario
from applications.rosbot.sensing import Flags, Sensor, moved
from gpsynth.arrays import Floats
from gpsynth.plotting import BLACK, BLUE, GRAY, GREEN, ORANGE, PALE, RED, SKY, STYLE

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

INSTANTS = 6
WIDTH = 7.2  # inches, of a page of a paper
BEYOND = 0.6  # m, shown around the way


def draw_drive(scenario: Scenario, trajectory: Floats, ways: Sequence[Floats], sensor: Sensor) -> "Figure":
    """Six instants of a trajectory (N, 4) t, x, y, theta, and the clearance over time.

    `ways` are the points (k, 3) of the course of each cycle.
    """
    from matplotlib import rc_context
    from matplotlib.figure import Figure

    with rc_context(dict(STYLE)):
        figure = Figure(figsize=(WIDTH, 0.85 * WIDTH), layout="constrained")
        places = figure.subplot_mosaic("012;345;ggg", height_ratios=(1.0, 1.0, 0.6))
        instants = np.linspace(0.0, trajectory[-1, 0], INSTANTS)
        for number, instant in enumerate(instants):
            way = ways[min(int(instant / CYCLE + 1e-9), len(ways) - 1)] if ways else np.empty((0, 3))
            so_far = trajectory[trajectory[:, 0] <= instant + 1e-9]
            _draw_instant(places[str(number)], scenario, so_far, way, sensor)
        _draw_gaps(places["g"], scenario, trajectory, instants)
        figure.legend(*places["0"].get_legend_handles_labels(), loc="outside upper center", ncols=6)
    return figure


def _draw_instant(axes: "Axes", scenario: Scenario, trajectory: Floats, way: Floats, sensor: Sensor) -> None:
    """The plane at the end of a trajectory (N, 4): what the robot sees, where it was, and its course."""
    axes.plot(*scenario.goal[:2], "*", color=RED, markersize=8.0, label="goal", zorder=5)
    axes.plot(*trajectory[:, 1:3].T, color=BLACK, linewidth=1.2, label="path", zorder=4)
    axes.plot(*way[:, :2].T, ".", color=BLUE, markersize=3.0, label="equilibrium points", zorder=4)
    _draw_robot(axes, trajectory[-1, 1:], scenario.body, sensor.reach)
    if scenario.room is not None:
        draw_room(axes, scenario.room)
    circles = moved(scenario.circles, trajectory[-1, 0])
    _draw_circles(axes, circles, sensor.knows(circles, trajectory[-1, 1:3]))
    ends = np.vstack([scenario.start, scenario.goal])[:, :2]
    middle, half = 0.5 * np.sum(ends, axis=0), 0.5 * float(np.ptp(ends, axis=0).max()) + BEYOND
    axes.set_xlim(middle[0] - half, middle[0] + half)
    axes.set_ylim(middle[1] - half, middle[1] + half)
    axes.set_aspect("equal")
    axes.set_title(f"{trajectory[-1, 0]:.1f} s", fontsize=9.0)


def _draw_robot(axes: "Axes", pose: Floats, body: Floats, reach: float) -> None:
    """The robot with its heading, and how far it sees."""
    from matplotlib.patches import Circle

    (x, y, heading), length = pose, outer_radius(body)
    nose = x + length * np.cos(heading), y + length * np.sin(heading)
    for center, radius in zip(placed(body, pose[np.newaxis])[0], body[:, 2], strict=True):
        axes.add_patch(Circle(center, radius, facecolor=SKY, edgecolor=BLACK, linewidth=0.6, zorder=5))
    axes.plot(*np.transpose([(x, y), nose]), color=BLACK, linewidth=0.8, zorder=6)
    if np.isfinite(reach):
        axes.add_patch(Circle((x, y), reach, fill=False, edgecolor=GRAY, linestyle=":", linewidth=0.6))
    axes.plot([], [], "o", color=SKY, markeredgecolor=BLACK, markeredgewidth=0.6, label="robot")


def _draw_circles(axes: "Axes", circles: Floats, known: Flags) -> None:
    """The obstacles, and where those that move will be in a second."""
    from matplotlib.patches import Circle

    for (x, y, vx, vy, radius), is_known in zip(circles, known, strict=True):
        color = ORANGE if is_known else PALE
        axes.add_patch(Circle((x, y), radius, facecolor=color, edgecolor=GRAY, linewidth=0.5))
        axes.plot((x, x + vx), (y, y + vy), color=GRAY, linewidth=0.8)
    for color, label in ((ORANGE, "obstacle, known"), (PALE, "unknown")):
        axes.plot([], [], "o", color=color, markeredgecolor=GRAY, markeredgewidth=0.5, label=label)


def _draw_gaps(axes: "Axes", scenario: Scenario, trajectory: Floats, instants: Floats) -> None:
    """The distance to the nearest obstacle over time, with the instants above marked."""
    gaps = _gaps(scenario, trajectory)
    if np.all(np.isfinite(gaps)):
        axes.plot(trajectory[:, 0], gaps, color=GREEN, linewidth=1.2)
    axes.axhline(0.0, color=RED, linewidth=0.8)
    for instant in instants:
        axes.axvline(instant, color=PALE, linewidth=0.6, zorder=0)
    axes.set_xlabel("$t$ (s)")
    axes.set_ylabel("clearance (m)")


def _gaps(scenario: Scenario, trajectory: Floats) -> Floats:
    """The distances (N,) along a trajectory (N, 4); infinity without obstacles."""
    time, poses, body = trajectory[:, 0], trajectory[:, 1:], scenario.body
    gaps = np.full(len(time), np.inf)
    for (x, y), size in zip(placed(body, poses).transpose(1, 2, 0), body[:, 2], strict=True):
        for cx, cy, vx, vy, radius in scenario.circles:
            gaps = np.minimum(gaps, np.hypot(x - cx - vx * time, y - cy - vy * time) - radius - size)
    if scenario.room is not None:
        gaps = np.minimum(gaps, gaps_to_room(body, scenario.room, poses))
    return gaps
