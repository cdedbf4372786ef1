"""Pictures: what is drawn, into which axes, and that matplotlib loads no earlier."""

import subprocess
import sys

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.figure import Figure

from gpsynth.errors import GpsynthError
from gpsynth.plotting import plot_front, plot_history, plot_trajectory, quantity
from gpsynth.simulation import Trajectory
from gpsynth.synthesis import FrontEntry

STATES = {"x": "m", "theta": "rad"}


@pytest.fixture
def ax():
    return Figure().add_subplot()


@pytest.fixture
def trajectory():
    t = np.linspace(0.0, 1.0, 11)
    x = np.column_stack([np.sin(t), np.cos(t)])
    return Trajectory(t, x, np.zeros((10, 1)), np.zeros((11, 2)), arrival=1.0, cost=1.0, clearance=np.inf)


def _entry(complexity, cost):
    return FrontEntry(None, cost=cost, complexity=complexity, reached=1.0, median_time=1.0)


def test_a_trajectory_shows_each_state_and_its_target(ax, trajectory):
    assert plot_trajectory(trajectory, STATES, ax=ax) is ax
    x, x_target, theta, theta_target = (line.get_ydata() for line in ax.lines)
    assert np.array_equal(np.column_stack([x, theta]), trajectory.x)
    assert np.array_equal(np.column_stack([x_target, theta_target]), trajectory.target)
    assert ax.get_legend_handles_labels()[1] == ["$x$ (m)", r"$\theta$ (rad)"]


def test_a_trajectory_shows_only_the_states_asked_for(ax, trajectory):
    plot_trajectory(trajectory, STATES, shown=["theta"], ax=ax)
    assert np.array_equal(ax.lines[0].get_ydata(), trajectory.x[:, 1])
    assert len(ax.lines) == 2


def test_an_unknown_state_is_named(ax, trajectory):
    with pytest.raises(GpsynthError, match="'y' is not a state; the states are x, theta"):
        plot_trajectory(trajectory, STATES, shown=["y"], ax=ax)


def test_a_front_shows_each_law(ax):
    plot_front([_entry(3, 9.0), _entry(7, 4.0)], ax=ax)
    assert ax.lines[1].get_xydata().tolist() == [[3.0, 9.0], [7.0, 4.0]]


@pytest.mark.parametrize(("costs", "scale"), [((3.0, 0.5), "log"), ((3.0, -0.5), "linear"), ((), "linear")])
def test_a_history_is_logarithmic_where_it_can_be(ax, costs, scale):
    plot_history([(100 * number, cost) for number, cost in enumerate(costs)], ax=ax)
    assert ax.get_yscale() == scale
    assert ax.lines[0].get_ydata().tolist() == list(costs)


def test_without_axes_the_current_ones_of_pyplot_are_used():
    mpl.use("agg")
    from matplotlib import pyplot

    _, current = pyplot.subplots()
    try:
        assert plot_history([(1, 2.0)]) is current
    finally:
        pyplot.close()


def test_a_quantity_is_labeled_with_its_unit():
    assert [quantity("omega", "rad/s"), quantity("x", ""), quantity("speed", "m/s")] == [
        r"$\omega$ (rad/s)",
        "$x$",
        "speed (m/s)",
    ]


def test_matplotlib_loads_with_the_first_picture_only():
    code = "import gpsynth.plotting, sys; sys.exit('matplotlib' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
