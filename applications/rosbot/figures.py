"""A plan as a figure in the manner of the paper's figures 3 and 4: the path above, v and omega over time below."""

import io
from typing import TYPE_CHECKING

import numpy as np

from applications.rosbot.footprint import outer_radius, placed
from applications.rosbot.room_figure import draw_room
from applications.rosbot.scenario import Scenario
from gpsynth.arrays import Floats
from gpsynth.files import write_bytes
from gpsynth.plotting import BLACK, BLUE, GRAY, GREEN, ORANGE, PALE, RED, SKY, STYLE, with_legend

if TYPE_CHECKING:
    from os import PathLike

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

FOOTPRINTS = 8  # how many times the robot is drawn on its way
PALER = "#D6EBF8"  # SKY as it looks on white where it is transparent
COLUMN = 3.5  # inches, width of a column of a paper


def draw_plan(
    scenario: Scenario,
    trajectory: Floats,
    controls: Floats,
    period: float,
    waypoints: Floats,
    via: Floats = np.empty((0, 3)),
) -> "Figure":
    """The figure of a plan: trajectory (N, 4) t, x, y, theta; controls (M, 2), one pair a period; waypoints (k, 3).

    `via` (m, 3) are places passed on the way: x, y and tolerance in m.
    """
    from matplotlib import rc_context
    from matplotlib.figure import Figure

    with rc_context(dict(STYLE)):
        figure = Figure(figsize=(COLUMN, 1.5 * COLUMN), layout="constrained")
        above, below = figure.subplots(2, 1, height_ratios=(2.6, 1.0))
        draw_path(above, scenario, trajectory, waypoints)
        _draw_via(above, via)
        handles, labels = above.get_legend_handles_labels()
        columns = 4 if len(labels) > 6 else 3
        figure.legend(
            handles, labels, loc="outside upper center", ncols=columns, columnspacing=1.2, handlelength=1.6
        )
        with_legend(draw_controls(below, scenario, controls, period))
    return figure


def save_figure(figure: "Figure", path: "str | PathLike[str]") -> None:
    """Write a figure as PNG, whole or not at all; raises FileError if that fails."""
    from matplotlib import rc_context

    content = io.BytesIO()
    with rc_context(dict(STYLE)):
        figure.savefig(content, format="png", dpi=300)
    write_bytes(path, content.getvalue())


def draw_path(axes: "Axes", scenario: Scenario, trajectory: Floats, waypoints: Floats) -> "Axes":
    """The plane: obstacles as they are and grown by the robot, the path with the robot on it, and the waypoints."""
    axes.plot(*scenario.start[:2], "s", color=GREEN, markersize=5.0, label="start", zorder=5)
    axes.plot(*scenario.goal[:2], "*", color=RED, markersize=10.0, label="goal", zorder=5)
    axes.plot(trajectory[:, 1], trajectory[:, 2], color=BLACK, linewidth=1.3, label="path", zorder=4)
    _draw_robot(axes, scenario, trajectory)
    _draw_waypoints(axes, scenario, waypoints)
    _draw_obstacles(axes, scenario, trajectory[-1, 0])
    if scenario.room is not None:
        draw_room(axes, scenario.room, label="" if len(scenario.circles) else "obstacle")
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(0.1)
    axes.set_xlabel("$x$ (m)")
    axes.set_ylabel("$y$ (m)")
    return axes


def draw_controls(axes: "Axes", scenario: Scenario, controls: Floats, period: float) -> "Axes":
    """The controls over time, held over each period, with their limits dashed."""
    times = period * np.arange(len(controls) + 1)
    speed = (BLUE, "$v$ (m/s)", scenario.speed_limits, 0)
    turn = (ORANGE, r"$\omega$ (rad/s)", scenario.turn_limits, 4)
    for (color, label, limits, offset), values in zip((speed, turn), controls.T, strict=True):
        axes.stairs(values, times, baseline=None, color=color, label=label, linewidth=1.3, zorder=3)
        for limit in limits:  # with gaps in turn, so that equal limits show both colors
            axes.axhline(limit, color=color, linewidth=0.8, linestyle=(offset, (4, 4)), zorder=2)
    axes.axhline(0.0, color=PALE, linewidth=0.6, zorder=1)
    axes.set_xlim(0.0, times[-1])
    axes.margins(y=0.12)
    axes.set_xlabel("$t$ (s)")
    axes.set_ylabel("control (limits dashed)")
    return axes


def _draw_robot(axes: "Axes", scenario: Scenario, trajectory: Floats) -> None:
    """The robot's footprint and heading at equal intervals of time."""
    from matplotlib.patches import Circle

    instants = np.linspace(0.0, trajectory[-1, 0], FOOTPRINTS)
    poses = trajectory[np.searchsorted(trajectory[:, 0], instants).clip(max=len(trajectory) - 1), 1:]
    for pose in poses:
        for center, radius in zip(
            placed(scenario.body, pose[np.newaxis])[0], scenario.body[:, 2], strict=True
        ):
            axes.add_patch(Circle(center, radius, facecolor=SKY, alpha=0.25, linewidth=0.0, zorder=1))
            axes.add_patch(Circle(center, radius, fill=False, edgecolor=SKY, linewidth=0.8, zorder=3))
        _draw_heading(axes, pose, outer_radius(scenario.body), SKY)
    axes.plot([], [], "o", color="none", markeredgecolor=SKY, markerfacecolor=PALER, label="robot")


def _draw_waypoints(axes: "Axes", scenario: Scenario, waypoints: Floats) -> None:
    """The equilibrium points with their headings, numbered in the order of their turns."""
    if not len(waypoints):
        return
    axes.plot(*waypoints[:, :2].T, "o", color=BLUE, markersize=4.0, label="equilibrium points", zorder=6)
    for number, pose in enumerate(waypoints, start=1):
        _draw_heading(axes, pose, 1.5 * outer_radius(scenario.body), BLUE)
        behind = (
            -7.0 * np.cos(pose[2]),
            -7.0 * np.sin(pose[2]),
        )  # points; where its heading does not cross it
        axes.annotate(
            *(f"{number}", pose[:2], behind),
            textcoords="offset points",
            ha="center",
            va="center",
            color=BLUE,
            fontsize=7,
        )


def _draw_via(axes: "Axes", via: Floats) -> None:
    """The places passed on the way, each as large as its tolerance."""
    from matplotlib.patches import Circle

    for x, y, tolerance in via:
        axes.add_patch(Circle((x, y), tolerance, fill=False, edgecolor=RED, linewidth=0.9, zorder=5))
    if len(via):
        axes.plot([], [], "o", color="none", markeredgecolor=RED, label="via")


def _draw_obstacles(axes: "Axes", scenario: Scenario, end: float) -> None:
    """Circles at time 0, and those that move once more, empty, at the end."""
    from matplotlib.patches import Circle, FancyArrowPatch

    for x, y, vx, vy, radius in scenario.circles:
        place, later = (x, y), (x + vx * end, y + vy * end)
        grown = radius + outer_radius(scenario.body)
        axes.add_patch(Circle(place, radius, facecolor=PALE, edgecolor=BLACK, linewidth=0.8, zorder=2))
        axes.add_patch(
            Circle(place, grown, fill=False, edgecolor=GRAY, linestyle=":", linewidth=0.9, zorder=2)
        )
        if later != place:
            axes.add_patch(Circle(later, radius, fill=False, edgecolor=GRAY, linewidth=0.8, zorder=2))
            arrow = FancyArrowPatch(place, later, arrowstyle="->", mutation_scale=8.0, color=GRAY, zorder=2)
            axes.add_patch(arrow)
    if len(scenario.circles):
        axes.plot([], [], "o", color=PALE, markeredgecolor=BLACK, markeredgewidth=0.8, label="obstacle")
        axes.plot([], [], ":", color=GRAY, linewidth=0.9, label="+ robot radius")


def _draw_heading(axes: "Axes", pose: Floats, length: float, color: str) -> None:
    x, y, theta = pose
    axes.plot(
        (x, x + length * np.cos(theta)), (y, y + length * np.sin(theta)), color=color, linewidth=0.9, zorder=3
    )
