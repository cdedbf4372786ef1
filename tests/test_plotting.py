"""Pictures: what is drawn, into which axes, and that matplotlib loads no earlier."""

import subprocess
import sys

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.figure import Figure

from gpsynth.errors import GpsynthError
from gpsynth.plant import Plant
from gpsynth.plotting import plot_front, plot_history, plot_response, plot_trajectory, quantity
from gpsynth.simulation import Trajectory
from gpsynth.synthesis import FrontEntry
from gpsynth.tracing import trace

PLANT = Plant(lambda x, u: (u.v, 0.0), {"x": "m", "theta": "rad"}, {"v": ("m/s", -1.0, 1.0)})


@pytest.fixture
def ax():
    return Figure().add_subplot()


@pytest.fixture
def trajectory():
    t = np.linspace(0.0, 1.0, 11)
    x = np.column_stack([np.sin(t), np.cos(t)])
    u, target = np.arange(10.0)[:, np.newaxis], np.zeros((11, 2))
    return Trajectory(PLANT, t, x, u, target, arrival=1.0, cost=1.0, clearance=np.inf)


def _entry(complexity, cost):
    times = {"median_time": 1.0, "worst_time": 2.0}
    return FrontEntry(
        None, cost=cost, complexity=complexity, reached=1.0, starts=4, reached_at_least=None, **times
    )


def test_a_trajectory_shows_each_state_and_its_target(ax, trajectory):
    assert plot_trajectory(trajectory, ax=ax) is ax
    x, x_target, theta, theta_target = (line.get_ydata() for line in ax.lines)
    assert np.array_equal(np.column_stack([x, theta]), trajectory.x)
    assert np.array_equal(np.column_stack([x_target, theta_target]), trajectory.target)
    assert ax.get_legend_handles_labels()[1] == ["$x$ (m)", r"$\theta$ (rad)"]


def test_a_trajectory_shows_only_the_states_asked_for(ax, trajectory):
    plot_trajectory(trajectory, shown=["theta"], ax=ax)
    assert np.array_equal(ax.lines[0].get_ydata(), trajectory.x[:, 1])
    assert len(ax.lines) == 2


def test_a_control_is_shown_as_it_was_held(ax, trajectory):
    trajectory.plot(shown=["theta", "v"], ax=ax)
    values, edges, _ = ax.patches[0].get_data()
    assert np.array_equal(values, trajectory.u[:, 0])
    assert np.array_equal(edges, trajectory.t)
    assert ax.get_legend_handles_labels()[1] == [r"$\theta$ (rad)", "$v$ (m/s)"]


def test_a_response_shows_each_output_over_one_input(ax):
    program = trace(lambda f: {"a": 2.0 * f.x, "b": f.x * f.y + 1.0}, [("f", ("x", "y"))])
    plot_response(program, "x", (-1.0, 3.0), units={"a": "N"}, ax=ax)
    first, second = (line.get_xydata() for line in ax.lines)
    assert np.array_equal(first[:, 1], 2.0 * first[:, 0])
    assert np.array_equal(first[[0, -1], 0], [-1.0, 3.0])
    assert np.array_equal(second[:, 1], np.ones(401))
    with pytest.raises(GpsynthError, match="'z' is not an input; they are x, y"):
        plot_response(program, "z", ax=ax)


def test_an_unknown_state_is_named(ax, trajectory):
    with pytest.raises(GpsynthError, match="'y' is not a state or control; they are x, theta and v"):
        plot_trajectory(trajectory, shown=["y"], ax=ax)


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
