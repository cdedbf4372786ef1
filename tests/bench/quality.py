"""Quality over time: what the plans of several planners are worth after so many seconds of computing."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from applications.rosbot.figures import BLACK, BLUE, GRAY, GREEN, ORANGE, RED, SKY, STYLE

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Found = Sequence[tuple[float, float]]  # (s, T / T_ref) of every plan of a run
COLORS = (BLUE, BLACK, ORANGE, GREEN, RED, SKY, GRAY, "#CC79A7", "#8C6D1F")
SHORTEST, LONGEST = 0.02, 20.0  # s


def quality_figure(runs: Mapping[str, Sequence[Found]]) -> "Figure":
    """Mean over the runs of T_ref / T of the best plan so far, 0 where there is none yet; one curve a planner."""
    from matplotlib import rc_context
    from matplotlib.figure import Figure

    instants = np.geomspace(SHORTEST, LONGEST, 400)
    with rc_context(dict(STYLE)):
        figure = Figure(figsize=(6.0, 3.6), layout="constrained")
        axes = figure.subplots()
        for (name, found), color in zip(runs.items(), COLORS, strict=False):
            mean = np.mean([_worth(each, instants) for each in found], axis=0)
            axes.step(
                instants,
                mean,
                where="post",
                color=color,
                label=name,
                linewidth=2.2 if name == "gpsynth" else 1.2,
            )
        axes.axhline(1.0, color=GRAY, linewidth=0.6)
        axes.set_xscale("log")
        axes.set_xlim(instants[0], LONGEST)
        axes.set_ylim(0.0, 1.05)
        axes.set_xlabel("processor time (s)")
        axes.set_ylabel(r"mean of $T_\mathrm{ref} / T$, 0 without a plan")
        figure.legend(loc="outside right center")
    return figure


def _worth(found: Found, instants: np.ndarray) -> np.ndarray:
    """T_ref / T of the best plan there is at each instant."""
    worth = np.zeros(len(instants))
    for spent, ratio in found:
        worth = np.maximum(worth, np.where(instants >= spent, 1.0 / ratio, 0.0))
    return worth
