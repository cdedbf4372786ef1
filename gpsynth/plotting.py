"""Trajectories, laws, fronts and histories as pictures; matplotlib loads when the first is drawn.

Every function draws into the axes it is given, or into the current ones of pyplot, and returns them.
"""

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from gpsynth.arrays import Floats
from gpsynth.errors import GpsynthError
from gpsynth.program import Program

if TYPE_CHECKING:
    from matplotlib.axes import Axes as Axes  # noqa: PLC0414 others annotate with it

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


class Timed(Protocol):
    """Quantities over time: the first n columns are states, for which there is a target."""

    @property
    def t(self) -> Floats:
        """(N + 1,) s."""
        ...

    @property
    def x(self) -> Floats:
        """(N + 1, n) states."""
        ...

    @property
    def u(self) -> Floats:
        """(N, m) controls, each held until the next."""
        ...

    @property
    def target(self) -> Floats:
        """(N + 1, n)."""
        ...

    @property
    def units(self) -> Mapping[str, str]:
        """Name -> unit of the n states, then of the m controls."""
        ...


def plot_trajectory(trajectory: Timed, *, shown: Sequence[str] = (), ax: "Axes | None" = None) -> "Axes":
    """States over time, their targets dashed, or those states and controls that are to be `shown`.

    Raises GpsynthError if one to show is not the plant's.
    """
    names, states = tuple(trajectory.units), trajectory.x.shape[1]
    unknown = [name for name in shown if name not in names]
    if unknown:
        raise GpsynthError(
            f"{unknown[0]!r} is not a state or control; they are {', '.join(names[:states])} and "
            f"{', '.join(names[states:])}"
        )
    axes = _axes(ax)
    for number, name in enumerate(shown or names[:states]):
        column, color = names.index(name), CYCLE[number % len(CYCLE)]
        label = quantity(name, trajectory.units[name])
        if column < states:
            axes.plot(trajectory.t, trajectory.x[:, column], color=color, label=label)
            axes.step(
                trajectory.t, trajectory.target[:, column], "--", where="post", color=color, linewidth=0.8
            )
        else:
            held = trajectory.u[:, column - states]
            axes.stairs(held, trajectory.t, baseline=None, color=color, label=label)
    axes.set_xlabel("$t$ (s)")
    axes.set_ylabel("target dashed")
    axes.margins(x=0.0)
    return with_legend(axes)


def plot_response(
    program: Program,
    over: str,
    span: tuple[float, float] = (-1.0, 1.0),
    *,
    units: Mapping[str, str] = MappingProxyType({}),
    ax: "Axes | None" = None,
) -> "Axes":
    """The outputs of a program over one of its inputs from span[0] to span[1], all other inputs being 0.

    Raises GpsynthError if it has no such input; `units` (name -> unit) go into the labels.
    """
    if over not in program.inputs:
        raise GpsynthError(f"{over!r} is not an input; they are {', '.join(program.inputs)}")
    rows = np.zeros((401, len(program.inputs)))
    rows[:, program.inputs.index(over)] = np.linspace(*span, len(rows))
    axes = _axes(ax)
    for name, values, color in zip(program.names, program(rows).T, CYCLE * len(program.names), strict=False):
        axes.plot(
            rows[:, program.inputs.index(over)],
            values,
            color=color,
            label=quantity(name, units.get(name, "")),
        )
    axes.set_xlabel(quantity(over, units.get(over, "")))
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


def plot_errors(
    sizes: Sequence[int], errors: Floats, names: Sequence[str], *, ax: "Axes | None" = None
) -> "Axes":
    """Errors (f, k) of k outputs over the sizes of f formulas; what is below 1e-20 is rounding, and stands there."""
    axes = _axes(ax)
    for name, values, color in zip(names, errors.T, CYCLE * len(names), strict=False):
        axes.step(sizes, np.maximum(values, 1e-20), "o-", where="post", color=color, markersize=4, label=name)
    axes.set_xlabel("size (nodes)")
    axes.set_ylabel("error (share of the variance)")
    axes.set_yscale("log")
    axes.locator_params("x", integer=True)
    return with_legend(axes) if len(names) > 1 else axes


def plot_tradeoff(
    points: Sequence[tuple[float, float]], names: tuple[str, str], *, ax: "Axes | None" = None
) -> "Axes":
    """One cost over another, a point a law."""
    axes = _axes(ax)
    axes.plot(*np.array([*points], dtype=np.float64).reshape(-1, 2).T, "o", color=BLUE, markersize=4.5)
    axes.set_xlabel(names[0])
    axes.set_ylabel(names[1])
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
