import csv
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.figure import Figure

from gpsynth.errors import OptimizerError, ProblemError
from gpsynth.evaluate import Evaluator
from gpsynth.objective import Objective
from gpsynth.pareto_search import ParetoSearch
from gpsynth.tradeoffs import synthesize_tradeoffs
from tests.test_synthesis import encoding, quadratic

PROBLEM = quadratic(period=0.1)
ENCODING = encoding(PROBLEM)


def error(rollouts):
    x = rollouts.paths.x
    return np.nansum(x[..., 0] ** 2, axis=-1) * PROBLEM.period


def effort(rollouts):
    return np.nansum(rollouts.paths.u[..., :-1, 0] ** 2, axis=-1) * PROBLEM.period


OBJECTIVES = {"error": Objective(error, paths=True), "effort": Objective(effort, paths=True)}


def found(seed=1, budget=4_000, **settings):
    search = ParetoSearch(ENCODING, population=50)
    return synthesize_tradeoffs(
        PROBLEM, ENCODING, OBJECTIVES, seed=seed, budget=budget, search=search, **settings
    )


def least(weight):
    """The least error + weight effort of any feedback: x' P x of the Riccati equation, means over the starts."""
    k1 = weight**-0.5
    k2 = np.sqrt(2.0 * k1)
    p22 = weight * k2
    p12, p11 = weight * k1, weight * k1 * k2
    x, v = PROBLEM.starts.T
    return np.mean(p11 * x * x + 2.0 * p12 * x * v + p22 * v * v)


def test_the_front_comes_near_the_best_of_every_weighting():
    result = found()
    costs = np.array([[entry.costs["error"], entry.costs["effort"]] for entry in result.front])
    for weight in (0.3, 1.0, 3.0):
        assert (costs @ [1.0, weight]).min() == pytest.approx(
            least(weight), rel=0.15
        )  # hold and sums of 0.1 s


def test_no_law_of_the_front_beats_another_in_everything():
    result = found(budget=1_000)
    rows = np.array([[*entry.costs.values(), entry.complexity] for entry in result.front])
    for row in rows:
        beaten = (rows <= row).all(axis=1) & (rows < row).any(axis=1)
        assert not beaten.any()
    for entry in result.front:
        rollouts = Evaluator(PROBLEM).of_program(entry.law.program, entry.law.parameters, paths=True)
        assert entry.costs == {"error": error(rollouts).mean(), "effort": effort(rollouts).mean()}


def test_the_same_seed_gives_the_same_front_for_any_number_of_threads_and_after_a_resume(tmp_path):
    whole = found(budget=600, threads=1)
    assert found(budget=600, threads=2).table() == whole.table()
    found(budget=300, folder=tmp_path)
    assert found(budget=600, folder=tmp_path, resume=True).table() == whole.table()


def test_the_front_is_a_table_a_file_and_a_picture(tmp_path):
    result = found(budget=200)
    result.to_csv(tmp_path / "front.csv")
    with (tmp_path / "front.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["effort"]) for row in rows] == [entry.costs["effort"] for entry in result.front]
    axes = result.plot(ax=Figure().add_subplot())
    assert axes.lines[0].get_xdata().tolist() == [entry.costs["error"] for entry in result.front]
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("error", "effort")


def test_wrong_settings_are_named():
    with pytest.raises(ProblemError, match="expected two objectives or more, got time"):
        synthesize_tradeoffs(PROBLEM, ENCODING, {"time": lambda rollouts: rollouts.end})
    other = replace(ENCODING, max_size=5)
    with pytest.raises(OptimizerError, match="search is of another encoding"):
        synthesize_tradeoffs(PROBLEM, ENCODING, OBJECTIVES, search=ParetoSearch(other))
    with pytest.raises(OptimizerError, match="population must be an integer of at least 4"):
        ParetoSearch(ENCODING, population=2)
    with pytest.raises(OptimizerError, match="are shares of 1"):
        ParetoSearch(ENCODING, crossover=0.9, moved=0.9)
