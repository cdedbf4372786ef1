"""One trajectory: the evaluator's rollout with everything on its way."""

from typing import Any

import numpy as np
import pytest

from gpsynth.errors import ProblemError
from gpsynth.evaluate import Evaluator
from gpsynth.law import Law
from gpsynth.obstacles import Obstacles
from gpsynth.plant import Plant
from gpsynth.problem import Problem
from gpsynth.schedule import Schedule
from gpsynth.simulation import simulate
from gpsynth.tracing import trace


def _problem(**choices: object) -> Problem:
    plant = Plant(
        lambda x, u: (x.v, u.a),
        states={"x": "m", "v": "m/s"},
        controls={"a": ("m/s2", -1.0, 1.0)},
        name="cart",
    )
    settings = {"starts": [[2.0, 0.0], [-1.0, 0.5]], "goal": [0.0, 0.0], "tolerance": 0.05, "horizon": 20.0}
    return Problem(plant, **(settings | choices))  # type: ignore[arg-type]


def _law(problem: Problem) -> Law:
    program = trace(lambda e: e.error_x + 1.5 * e.error_v, [("e", problem.features.names)], ("a",))
    return Law(problem.plant, problem.features, program, np.empty(0))


def test_a_trajectory_is_the_rollout_of_the_evaluator() -> None:
    problem = _problem(obstacles=Obstacles(np.array([[5.0, 5.0, 0.0, 0.0, 1.0]]), position=("x", "v")))
    law = _law(problem)
    rolled = Evaluator(problem).of_program(law.program, law.parameters)
    for k, start in enumerate(problem.starts):
        path = simulate(problem, law, start)
        assert path.x[0].tolist() == start.tolist()
        assert path.x[-1].tobytes() == rolled.final[0, k].tobytes()
        assert (path.arrival, path.cost, path.clearance) == (
            rolled.arrival[0, k],
            rolled.cost[0, k],
            rolled.clearance[0, k],
        )
        assert path.t[-1] == rolled.end[0, k]


def test_controls_are_the_laws_own_at_each_tick() -> None:
    problem = _problem()
    law = _law(problem)
    path = simulate(problem, law)
    assert (len(path.t), len(path.u), len(path.target)) == (len(path.x), len(path.x) - 1, len(path.x))
    assert path.u.tobytes() == law(path.x[:-1], path.target[:-1]).tobytes()
    assert np.max(np.abs(path.u)) == 1.0
    assert np.array_equal(path.t, np.arange(len(path.t)) * problem.period)


def test_the_target_follows_the_schedule_and_then_the_goal() -> None:
    schedule = Schedule(np.array([[3.0, 0.0], [1.0, 0.0]]), np.array([0.2, 0.1]))
    path = simulate(_problem(), _law(_problem()), schedule=schedule, horizon=0.5)
    assert path.target[:, 0].tolist() == [3.0] * 4 + [1.0] * 2 + [0.0] * 5


def test_the_horizon_ends_a_trajectory_that_does_not_arrive() -> None:
    path = simulate(_problem(), _law(_problem()), horizon=0.5)
    assert (len(path.t), path.arrival) == (11, np.inf)
    assert path.t[-1] == 0.5


def test_a_start_at_the_goal_is_a_trajectory_of_one_tick() -> None:
    path = simulate(_problem(), _law(_problem()), np.zeros(2))
    assert (path.t.tolist(), path.u.shape, path.arrival) == ([0.0], (0, 1), 0.0)


def test_a_start_of_the_wrong_shape_is_named() -> None:
    with pytest.raises(ProblemError, match=r"the start has shape \(3,\); expected \(2,\)"):
        simulate(_problem(), _law(_problem()), np.zeros(3))


def _approaching(reach: float, dwell: list[float]) -> list[float]:
    """Targets at each tick of x' = target - x held over 0.25 s, from 2 by way of 8 and 4 to 0."""
    plant = Plant(lambda x, u: (u.v,), {"x": "m"}, {"v": ("m/s", -99.0, 99.0)})
    problem = Problem(plant, [2.0], [0.0], tolerance=1e-12, period=0.25, horizon=4.0)
    program = trace(lambda e: (e.error_x,), [("e", problem.features.names)], ("v",))
    law = Law(plant, problem.features, program, np.empty(0))
    schedule = Schedule(np.array([[8.0], [4.0]]), np.array(dwell))
    return simulate(problem, law, schedule=schedule, reach=reach).target[:, 0].tolist()


def _by_hand(reach: float, dwell: list[float]) -> list[float]:
    x, passed, left, targets = 2.0, 0, list(dwell), []
    points = [8.0, 4.0, 0.0]
    for _ in range(17):
        while passed < 2 and (left[passed] <= 0.0 or (reach > 0.0 and abs(points[passed] - x) <= reach)):
            passed += 1
        targets.append(points[passed])
        x += 0.25 * (points[passed] - x)
        if passed < 2:
            left[passed] -= 0.25
    return targets


@pytest.mark.parametrize("reach", [0.0, 0.5, 3.0, 7.0])
@pytest.mark.parametrize("dwell", [[2.0, 1.0], [0.5, 3.0], [9.0, 0.25]])
def test_a_point_within_reach_is_left_at_once(reach: float, dwell: list[float]) -> None:
    assert _approaching(reach, dwell) == _by_hand(reach, dwell)


@pytest.mark.parametrize(
    ("choices", "sentence"),
    [
        ({"start": [np.nan, 0.0]}, "the start holds NaN or infinity"),
        ({"start": ["left", 0.0]}, "the start must hold numbers"),
        ({"schedule": Schedule(np.zeros((2, 3)), np.ones(2))}, r"shape \(2, 3\); expected \(k, 2\)"),
        ({"horizon": np.nan}, "the horizon is nan s"),
        ({"horizon": -1.0}, "the horizon is -1.0 s"),
        ({"horizon": np.inf}, "the horizon is inf s"),
        ({"horizon": 1e9}, "at most 10000000 periods"),
        ({"reach": np.nan}, "the reach must be at least 0, got nan"),
    ],
)
def test_what_does_not_fit_is_said(choices: dict[str, Any], sentence: str) -> None:
    with pytest.raises(ProblemError, match=sentence):
        simulate(_problem(), _law(_problem()), **choices)


def test_a_law_with_other_limits_is_another_law() -> None:
    problem = _problem()
    law = _law(problem)
    wider = law.with_limits([-2.0], [2.0])
    with pytest.raises(
        ProblemError, match=r"controls in \[-2, 2\], the problem for \[-1, 1\].*law.with_limits"
    ):
        simulate(problem, wider)
    adapted = wider.with_limits(problem.plant.lower, problem.plant.upper)
    assert simulate(problem, adapted).x.tobytes() == simulate(problem, law).x.tobytes()


def test_a_law_of_other_features_is_refused() -> None:
    other = _problem(features=lambda x, target: {"error_x": target.x - x.x, "error_v": -x.v})
    with pytest.raises(ProblemError, match=r"give the problem features=law.features"):
        simulate(other, _law(_problem()))
