"""Trajectories, fronts and histories as pictures; matplotlib loads when the first is drawn.

Every function draws into the axes it is given, or into the current ones of pyplot, and returns them.
"""

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from gpsynth.errors import GpsynthError

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from gpsynth.simulation import Trajectory

# Okabe & Ito 2008: told apart by people of any color vision.
BLUE, ORANGE, GREEN, RED, SKY = "#0072B2", "#E69F00", "#009E73", "#D55E00", "#56B4E9"
PURPLE, BLACK, GRAY, PALE = "#CC79A7", "#000000", "#666666", "#D9D9D9"
CYCLE = (BLUE, ORANGE, GREEN, RED, SKY, PURPLE, BLACK)

STYLE: Mapping[Any, Any] = MappingProxyType(
    {
        "font.family": "serif",
        "font.serif": ["STIXGeneral", "DejaVu Serif"],
        "mathtext.fontset": "stix",
        "font.size": 9.0,
        "axes.labelsize": 9.0,
        "legend.fontsize": 8.0,
        "xtick.labelsize": 8.0,
        "ytick.labelsize": 8.0,
        "xtick.direction": "in",
        "ytick.direction": "in",
        "axes.linewidth": 0.6,
        "lines.linewidth": 1.4,
        "legend.frameon": False,
    }
)  # of figures in a column of a paper, for matplotlib.rc_context; fonts that come with matplotlib

_GREEK = MappingProxyType(
    {name: f"$\\{name}$" for name in ("alpha", "beta", "gamma", "delta", "theta", "phi", "psi", "omega")}
)


class Scored(Protocol):
    """What a front is made of."""

    @property
    def cost(self) -> float:
        """The smaller, the better."""
        ...

    @property
    def complexity(self) -> int:
        """Instructions of the formula."""
        ...


def plot_trajectory(
    trajectory: "Trajectory",
    states: Mapping[str, str],
    *,
    shown: Sequence[str] = (),
    ax: "Axes | None" = None,
) -> "Axes":
    """States over time, all or those `shown`, with their targets dashed; `states` are the plant's (name -> unit).

    Raises GpsynthError if a state to show is not one of the plant's.
    """
    names = tuple(states)
    unknown = [name for name in shown if name not in names]
    if unknown:
        raise GpsynthError(f"{unknown[0]!r} is not a state; the states are {', '.join(names)}")
    axes = _axes(ax)
    for number, name in enumerate(shown or names):
        column, color = names.index(name), CYCLE[number % len(CYCLE)]
        axes.plot(trajectory.t, trajectory.x[:, column], color=color, label=quantity(name, states[name]))
        axes.step(trajectory.t, trajectory.target[:, column], "--", where="post", color=color, linewidth=0.8)
    axes.set_xlabel("$t$ (s)")
    axes.set_ylabel("state (target dashed)")
    axes.margins(x=0.0)
    return with_legend(axes)


def plot_front(front: Sequence[Scored], *, ax: "Axes | None" = None) -> "Axes":
    """Cost over complexity: the best law of every size, as in the `front` of a synthesis."""
    axes = _axes(ax)
    sizes, costs = [entry.complexity for entry in front], [entry.cost for entry in front]
    axes.step(sizes, costs, where="post", color=PALE, zorder=1)
    axes.plot(sizes, costs, "o", color=BLUE, markersize=4.5)
    axes.set_xlabel("complexity (instructions)")
    axes.set_ylabel("cost")
    axes.locator_params("x", integer=True)
    return axes


def plot_history(history: Sequence[tuple[int, float]], *, ax: "Axes | None" = None) -> "Axes":
    """Best cost over evaluations, each improvement a step; logarithmic where all costs are positive."""
    axes = _axes(ax)
    evaluations, costs = np.array([*history], dtype=np.float64).reshape(-1, 2).T
    axes.step(evaluations, costs, where="post", color=BLUE)
    axes.set_xlabel("evaluations")
    axes.set_ylabel("best cost")
    if len(costs) and costs.min() > 0.0:
        axes.set_yscale("log")
    return axes


def quantity(name: str, unit: str) -> str:
    """The label of a quantity, e.g. $x$ (m); Greek names as letters."""
    symbol = _GREEK.get(name, f"${name}$" if len(name) == 1 else name)
    return f"{symbol} ({unit})" if unit else symbol


def with_legend(axes: "Axes") -> "Axes":
    """A legend in one row above the axes, where it covers no data."""
    columns = max(1, len(axes.get_legend_handles_labels()[1]))
    axes.legend(
        loc="lower left",
        bbox_to_anchor=(0.0, 1.0),
        ncols=min(columns, 4),
        borderaxespad=0.2,
        columnspacing=1.2,
    )
    return axes


def _axes(ax: "Axes | None") -> "Axes":
    if ax is not None:
        return ax
    from matplotlib import pyplot

    return pyplot.gca()
