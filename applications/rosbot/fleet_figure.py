"""A fleet as a figure: where the robots are at a few instants, and how near any two are all the time."""

from collections.abc import Sequence
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from applications.rosbot.others import Other, poses_at
from applications.rosbot.room_figure import draw_room
from applications.rosbot.scenario import Scenario
from gpsynth.arrays import Floats
from gpsynth.plotting import BLACK, CYCLE, GRAY, PALE, RED, STYLE

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

INSTANTS = 4
WIDTH = 7.2  # inches, of a page of a paper
BEYOND = 0.7  # m, shown around the ways
FLAT = 2.0  # times as wide as high: instants stand one below the other
NEAR = 1.0  # m, up to where distances of robots are shown
FINE = 0.02  # s, between the points of a line


def draw_fleet(scenarios: Sequence[Scenario], driven: Sequence[Other]) -> "Figure":
    """Four instants of the plans of a fleet, and the least distance of any two robots over time."""
    from matplotlib import rc_context
    from matplotlib.figure import Figure

    end = max(each.path.times[-1] for each in driven)
    times = np.append(np.arange(0.0, end, FINE), end)
    paths = [poses_at(each.path, times) for each in driven]
    low, high = _window(scenarios, paths)
    width, height = high - low
    columns = 1 if width > FLAT * height else 2
    rows = INSTANTS // columns
    shown = WIDTH / columns * height / width * rows
    with rc_context(dict(STYLE)):
        figure = Figure(figsize=(WIDTH, shown + 2.2), layout="constrained")
        parts = figure.subfigures(2, 1, squeeze=False, height_ratios=(shown + 0.4, 1.8)).ravel()
        places = parts[0].subplots(rows, columns, sharex=True, sharey=True).ravel()
        instants = np.linspace(0.0, end, INSTANTS + 1)[1:] - end / (2 * INSTANTS)
        for axes, instant in zip(places, instants, strict=True):
            count = int(np.searchsorted(times, instant, side="right"))
            _draw_instant(axes, scenarios, [path[:count] for path in paths], instant)
            axes.set_xlim(low[0], high[0])
            axes.set_ylim(low[1], high[1])
        _draw_gaps(parts[1].subplots(), driven, times, paths, instants)
    return figure


def _window(scenarios: Sequence[Scenario], paths: Sequence[Floats]) -> tuple[Floats, Floats]:
    """The corners of what is shown."""
    places = np.vstack([*(path[:, :2] for path in paths), *(each.goal[np.newaxis, :2] for each in scenarios)])
    return places.min(axis=0) - BEYOND, places.max(axis=0) + BEYOND


def _draw_instant(
    axes: "Axes", scenarios: Sequence[Scenario], paths: Sequence[Floats], instant: float
) -> None:
    """The plane at the end of the paths, each (N, 3)."""
    from matplotlib.patches import Circle

    first = scenarios[0]
    if first.room is not None:
        draw_room(axes, first.room)
    for x, y, vx, vy, radius in first.circles:
        place = x + vx * instant, y + vy * instant
        axes.add_patch(Circle(place, radius, facecolor=PALE, edgecolor=GRAY, linewidth=0.5))
    for number, (scenario, path) in enumerate(zip(scenarios, paths, strict=True)):
        color, (x, y, heading) = CYCLE[number % len(CYCLE)], path[-1]
        axes.plot(*scenario.goal[:2], "*", color=color, markersize=7.0, zorder=3)
        axes.plot(*path[:, :2].T, color=color, linewidth=1.2, zorder=4)
        axes.add_patch(
            Circle((x, y), scenario.radius, facecolor="white", edgecolor=color, linewidth=1.2, zorder=5)
        )
        nose = x + scenario.radius * np.cos(heading), y + scenario.radius * np.sin(heading)
        axes.plot(*np.transpose([(x, y), nose]), color=color, linewidth=1.2, zorder=6)
    axes.set_aspect("equal")
    axes.set_title(f"{instant:.1f} s", fontsize=9.0)


def _draw_gaps(
    axes: "Axes", driven: Sequence[Other], times: Floats, paths: Sequence[Floats], instants: Floats
) -> None:
    """The least distance between any two discs, with the instants above marked."""
    gaps = [
        np.hypot(*(paths[one] - paths[two])[:, :2].T) - driven[one].radius - driven[two].radius
        for one, two in combinations(range(len(driven)), 2)
    ]
    axes.plot(times, np.min(gaps, axis=0), color=BLACK, linewidth=1.2)
    axes.axhline(0.0, color=RED, linewidth=0.8)
    for instant in instants:
        axes.axvline(instant, color=PALE, linewidth=0.6, zorder=0)
    axes.set_ylim(-0.05, NEAR)
    axes.set_xlabel("$t$ (s)")
    axes.set_ylabel("nearest two (m)")
