"""Stage 1 of the ROSbot: the shipped law and a fresh one reach the goal from starts nobody trained on."""

import numpy as np
import pytest

from applications.rosbot.stabilizer import default_law, poses, stabilization, synthesize_stabilizer
from gpsynth.errors import EncodingError
from gpsynth.evaluate import Evaluator
from gpsynth.law import Law


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


def test_the_shipped_law_keeps_the_limits_and_rests_at_the_target() -> None:
    law = default_law()
    rng = np.random.default_rng(4)
    controls = law(rng.uniform(-9.0, 9.0, (1000, 3)), rng.uniform(-9.0, 9.0, (1000, 3)))
    assert np.all(np.abs(controls) <= 0.5)
    assert np.all(np.isfinite(law([1.0, -2.0, 0.5], [1.0, -2.0, 0.5])))


@pytest.mark.slow
def test_a_law_found_from_scratch_reaches_the_goal() -> None:
    """A third of the main job's budget, so the bar is lower; `python -m tests.bench.stabilizer` shows the full one."""
    result = synthesize_stabilizer(seed=3, budget=10_000)
    for period in (0.05, 0.005):
        assert np.isfinite(arrivals(result.law, 200, period=period)).mean() >= 0.9
    assert result.front[0].complexity < result.best.complexity


def test_an_unknown_encoding_is_named() -> None:
    with pytest.raises(EncodingError, match="not 'forest'"):
        synthesize_stabilizer(seed=1, encoding="forest")  # type: ignore[arg-type]
