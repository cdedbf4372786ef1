"""Stage 1 of the ROSbot: the shipped law and a fresh one reach the goal from starts nobody trained on."""

from dataclasses import replace

import numpy as np
import pytest

from applications.rosbot.model import DELAY, dynamic_unicycle
from applications.rosbot.stabilization import poses, stabilization, training_poses
from applications.rosbot.stabilizer import default_law, synthesize_stabilizer
from gpsynth.draws import Draws, crossed, random_draws
from gpsynth.errors import EncodingError
from gpsynth.evaluate import Evaluator
from gpsynth.formula_text import read_formulas
from gpsynth.law import Law
from gpsynth.simulation import simulate


def arrivals(law: Law, count: int, *, period: float, box: float = 2.0) -> np.ndarray:
    """Arrival times (s) from random poses; infinity where 30 s were not enough."""
    problem = stabilization(poses(np.random.default_rng(20_261_122), count, box), period=period)
    return Evaluator(problem, threads=2).of_program(law.program, law.parameters[np.newaxis]).arrival[0]


@pytest.mark.parametrize("period", [0.05, 0.005])
def test_the_shipped_law_reaches_the_goal_from_every_start(period: float) -> None:
    assert np.all(np.isfinite(arrivals(default_law(), 200, period=period)))


def test_the_shipped_law_reaches_the_goal_from_beyond_its_training_box() -> None:
    assert np.all(np.isfinite(arrivals(default_law(), 1000, period=0.05, box=3.0)))


@pytest.mark.parametrize("period", [0.05, 0.005])
@pytest.mark.parametrize("box", [2.0, 0.3, 0.0])
def test_the_shipped_law_stays_at_the_goal(box: float, period: float) -> None:
    """After 30 s every run is within the tolerance; box 0 has nothing but a heading to mend."""
    law, starts = default_law(), poses(np.random.default_rng(7), 100, box)
    problem = stabilization(starts, period=period, stop=False)
    final = Evaluator(problem, threads=2).of_program(law.program, law.parameters[np.newaxis]).final[0]
    measure = problem.arrival(np.hstack([final, np.zeros_like(final)]))[:, 0]
    assert np.all(measure <= 0.0)


def test_the_shipped_law_drives_the_dynamic_robot_over_its_whole_family() -> None:
    law, rng = default_law(), np.random.default_rng(12)
    plant = dynamic_unicycle()
    starts, draws = crossed(poses(rng, 50, 3.0), random_draws(plant, rng, 20, delay=DELAY))
    problem = stabilization(starts, plant=plant, draws=draws, horizon=40.0)
    rolled = Evaluator(problem, threads=2).of_program(law.program, law.parameters[np.newaxis])
    assert np.all(np.isfinite(rolled.arrival))


def test_a_law_is_carried_to_the_dynamic_robot_by_its_plant_and_features() -> None:
    law, starts = default_law(), poses(np.random.default_rng(8), 3)
    problem = stabilization(starts, plant=dynamic_unicycle(), draws=Draws(delay=[0.0, 0.05, 0.1]))
    carried = replace(law, plant=problem.plant, features=problem.features)
    rolled = Evaluator(problem).of_program(law.program, law.parameters[np.newaxis])
    for row in range(3):
        alone = simulate(problem, carried, row=row)
        assert alone.arrival == rolled.arrival[0, row] < np.inf
        assert alone.x[0].tolist() == [*starts[row], 0.0, 0.0]


def test_steps_resolve_the_shortest_lag() -> None:
    """At tau = 0.02 s, half the step moves no pose by as much as a millimeter in 3 s."""
    law, plant, starts = default_law(), dynamic_unicycle(), poses(np.random.default_rng(3), 50)
    quick = [[1.02, 0.02, 1.5, 0.6, 0.02, 4.0]] * len(starts)
    rolled = []
    for factor in (1, 2):
        problem = stabilization(starts, plant=plant, draws=Draws(quick), horizon=3.0, stop=False)
        finer = replace(problem, step=problem.step / factor)
        rolled.append(Evaluator(finer).of_program(law.program, law.parameters[np.newaxis]).final[0])
    assert problem.step == pytest.approx(0.01)
    assert np.max(np.abs(rolled[0] - rolled[1])[:, :3]) < 1e-3


def test_the_shipped_law_keeps_the_limits_and_rests_at_the_target() -> None:
    law = default_law()
    rng = np.random.default_rng(4)
    controls = law(rng.uniform(-9.0, 9.0, (1000, 3)), rng.uniform(-9.0, 9.0, (1000, 3)))
    assert np.all(np.abs(controls) <= 0.5)
    assert np.all(np.isfinite(law([1.0, -2.0, 0.5], [1.0, -2.0, 0.5])))


@pytest.mark.slow
def test_a_law_found_from_scratch_reaches_the_goal() -> None:
    """A third of the main job's budget, so the bar is lower; `python -m tests.bench.stabilizer` shows the full one."""
    result = synthesize_stabilizer(seed=1, budget=10_000)
    for period in (0.05, 0.005):
        assert np.isfinite(arrivals(result.law, 200, period=period)).mean() >= 0.9
    assert result.front[0].complexity < result.best.complexity


def _seam(count: int) -> np.ndarray:
    """Training starts beside the goal, turned half round."""
    return training_poses(np.random.default_rng(5), 8 * count)[7::8]


def _lost(law: Law, starts: np.ndarray, period: float) -> float:
    """The share of starts from which 30 s are not enough."""
    problem = stabilization(starts, period=period)
    rolled = Evaluator(problem, threads=2).of_program(law.program, law.parameters[np.newaxis])
    return float(np.mean(np.isinf(rolled.arrival)))


@pytest.mark.parametrize("period", [0.1, 0.05, 0.005])
def test_the_shipped_law_leaves_the_places_where_its_features_jump(period: float) -> None:
    assert _lost(default_law(), _seam(300), period) == 0.0


def test_a_law_that_goes_to_and_fro_beside_the_goal_loses_training_starts_there() -> None:
    """It arrives from 999 of 1000 other starts."""
    formulas = (
        "v = 3.0041 * (error_x + sin(2.29583 * atan(error_y * tanh(-4.98976 * error_theta))))\n"
        "omega = -0.791574 * sin(error_theta) + 3 * bearing + 56.2695 * heading"
    )
    program = read_formulas(formulas, default_law().features.names, ("v", "omega"))
    law = replace(default_law(), program=program, parameters=np.empty(0))
    assert _lost(law, poses(np.random.default_rng(20_261_122), 1000, 3.0), 0.05) <= 0.001
    assert _lost(law, _seam(300), 0.1) >= 0.05


def test_an_unknown_encoding_is_named() -> None:
    with pytest.raises(EncodingError, match="not 'forest'"):
        synthesize_stabilizer(seed=1, encoding="forest")  # type: ignore[arg-type]
