"""What plans cost with a law: the best of given schedules, by simulation and in closed form."""

import pickle
from dataclasses import replace

import numpy as np
import pytest

from gpsynth.errors import ProblemError
from gpsynth.evaluate import Evaluator
from gpsynth.law import Law
from gpsynth.obstacles import Obstacles
from gpsynth.planning import PlanCost, Task
from gpsynth.planning.objective import NARROW, STEEPNESS
from gpsynth.plant import Plant
from gpsynth.schedule import Schedule, Schedules
from gpsynth.simulation import simulate
from tests.test_worth import LEAST, law_of, problem

AT_ONCE = Schedule(np.empty((0, 2)), np.empty(0))
AWAY = Schedule([[-1.0, 0.0]], [2.0])  # a meter back first, and there until two seconds are over
THERE = Schedule([[9.0, 0.0]], [3.0])
COLUMN = Obstacles(circles=[[2.0, 0.0, 0.0, 0.0, 0.4]], radius=0.1)  # 1 m of the way is covered

FLEEING = Plant(
    lambda x, u: (u.v - np.exp(100.0 * (-3.0 - x.x)), 0.0 * u.v),  # behind -3 m it is carried away
    problem().plant.states,
    problem().plant.controls,
    name="cart",
)


def task(*schedules: Schedule, **changes) -> Task:
    return Task(problem(**changes), LEAST, schedules, budget=20.0)


def costs(law: Law, *tasks: Task, **settings) -> np.ndarray:
    """Of each task."""
    return PlanCost(tasks, **settings)(law.program, law.parameters[np.newaxis])[0]


def test_a_plan_costs_its_arrival_time() -> None:
    """At 1 m/s the cart is within 0.05 m of 4 m after 3.95 s, and is seen there at the end of a period."""
    assert costs(law_of(1e3), task(Schedule([[4.0, 0.0]], [1.0]))) == pytest.approx([LEAST], abs=0.0501)
    assert costs(law_of(1e3), task(AWAY)) == pytest.approx([2.0 + 1.0 + LEAST], abs=0.0501)


def test_the_best_schedule_counts() -> None:
    law = law_of(0.5)
    alone = [costs(law, task(each))[0] for each in (AWAY, THERE)]
    assert alone[1] < alone[0]
    assert costs(law, task(AWAY, THERE)).tolist() == [min(alone)]


def test_it_is_what_the_reference_simulation_takes() -> None:
    law, given = law_of(0.7, 0.9), Schedule([[1.0, 0.0], [6.0, 0.0]], [1.3, 2.0])
    path = simulate(problem(), law, schedule=given, horizon=20.0)
    assert costs(law, task(given))[0] == pytest.approx(path.arrival, abs=1e-12)


def test_what_does_not_arrive_pays_until_the_end_and_what_the_problem_says() -> None:
    law, given = law_of(1.0, 0.05), Schedule([[9.0, 0.0]], [1.0])  # 1 m in 20 s
    assert costs(law, task(given)) == pytest.approx([20.0])
    terminal = problem(terminal=lambda x, goal: 10.0 * np.abs(goal.x - x.x)).terminal
    late = task(given, terminal=terminal)
    left = 4.0 - simulate(problem(), law, schedule=given, horizon=20.0).x[-1, 0]
    assert costs(law, late)[0] == pytest.approx(20.0 + 10.0 * left)


def test_obstacles_cost_what_equation_17_says() -> None:
    law, given = law_of(1e3), Schedule([[9.0, 0.0]], [9.0])
    free, covered = task(given), task(given, obstacles=COLUMN)
    depth = 2.0 * np.trapezoid([0.0, 0.5], [0.0, 0.5])  # m s at 1 m/s, in to the middle and out
    wanted = 1.0 + STEEPNESS * (NARROW * 1.0 + depth)
    extra = costs(law, covered, gamma=3.0, margin=0.0) - costs(law, free)
    coarse = STEEPNESS * (
        NARROW * 0.05 + 0.05 * 0.5
    )  # a period counts as all covered, with its greatest depth
    assert 3.0 * wanted <= extra[0] + 1e-9 <= 3.0 * (wanted + coarse) + 1e-6


def test_every_vector_stands_in_its_row() -> None:
    program, vectors = law_of(1.0).program, np.array([[0.5, 1.0], [2.0, 0.4], [9.0, 0.8]])
    both = PlanCost((task(AWAY, THERE), task(THERE, goal=2.0)))
    together = both(program, vectors)
    assert together.shape == (3, 2)
    for row, vector in zip(together, vectors, strict=True):
        assert row.tolist() == both(program, vector[np.newaxis])[0].tolist()


def test_one_vector_is_a_row() -> None:
    program, cost = law_of(1.0).program, PlanCost((task(AWAY, THERE), task(THERE, goal=2.0)))
    assert cost(program, np.array([0.5, 1.0])).tolist() == cost(program, np.array([[0.5, 1.0]])).tolist()


def test_a_plan_that_diverges_costs_infinity_and_the_best_of_the_others_counts() -> None:
    fleeing = replace(problem(obstacles=COLUMN), plant=FLEEING)
    law = replace(law_of(1e3), plant=FLEEING)
    still, lost = AWAY, Schedule([[-9.0, 0.0]], [20.0])
    assert np.isinf(costs(law, Task(fleeing, LEAST, [lost], budget=20.0)))
    assert costs(law, Task(fleeing, LEAST, [lost, still], budget=20.0)) == costs(
        law, Task(fleeing, LEAST, [still], budget=20.0)
    )


def test_what_is_above_the_limit_ends_early_and_nothing_else_does() -> None:
    program, vectors = law_of(1.0).program, np.array([[2.0, 1.0], [2.0, 0.5]])
    three = PlanCost(3 * (task(THERE),))
    exact = three(program, vectors)
    limits = exact.mean(axis=1) * [1.0, 0.5]
    cut = three(program, vectors, limits)
    assert cut[0].tolist() == exact[0].tolist()
    assert cut[1, 0] == exact[1, 0]
    assert np.isinf(cut[1, -1])


def test_a_cost_that_may_be_negative_has_no_early_end() -> None:
    running = problem(running=lambda x, u, goal: x.x - 1.0).running
    odd = PlanCost(2 * (task(THERE, running=running),))
    assert np.isfinite(odd(law_of(1.0).program, law_of(1.0).parameters[np.newaxis], np.array([-99.0]))).all()


def test_it_goes_to_another_process_and_back() -> None:
    law, cost = law_of(0.6), PlanCost((task(AWAY, THERE),), weight=2.0, gamma=1.0)
    before = cost(law.program, law.parameters[np.newaxis])
    other = pickle.loads(pickle.dumps(cost))
    assert (other.weight, other.gamma) == (2.0, 1.0)
    assert other(law.program, law.parameters[np.newaxis]).tolist() == before.tolist()


def test_limits_are_those_of_the_task() -> None:
    slow = replace(problem(), plant=problem().plant.with_limits([-0.5], [0.5]))
    found = costs(law_of(1e3), Task(slow, LEAST, [Schedule([[9.0, 0.0]], [7.0])], budget=20.0))
    assert found == pytest.approx([2.0 * LEAST], abs=0.0501)


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (lambda: PlanCost(()), "at least one task"),
        (lambda: PlanCost((task(),)), "no initial schedules"),
        (lambda: PlanCost((problem(),)), "a task must be a Task, got a Problem"),
        (lambda: PlanCost(task(AWAY)), "tasks of the cost of plans must be a list or a tuple, got a Task"),
        (lambda: PlanCost(3), "tasks of the cost of plans must be a list or a tuple, got 3"),
        (lambda: PlanCost((task(AWAY),), weight=0.0), "weight of plans must be finite and greater than 0"),
        (lambda: PlanCost((task(AWAY),), gamma=np.inf), "gamma of plans must be finite and greater than 0"),
        (lambda: PlanCost((task(AWAY),), margin=-1.0), "margin must be finite and at least 0"),
        (lambda: Task(problem(), LEAST, budget=0.0), "budget of a task must be finite and greater than 0"),
        (lambda: Task(problem(), LEAST, budget=0.02), "0.02 s, is shorter than the period, 0.05 s"),
        (lambda: Task(problem(), LEAST, budget=1e9), "at most 10000000 periods"),
        (lambda: Task(problem(), None), "least time of a task must be a number, got None"),
        (lambda: Task(problem(goal=0.04), LEAST), "begins at its goal already"),
        (lambda: Task(replace(problem(), starts=np.zeros((2, 2))), LEAST), "at one start; its problem has 2"),
        (lambda: Task(problem(), LEAST, AWAY), "must be a list or a tuple or a Schedules, got a Schedule"),
        (lambda: task(3), "a schedule must be a Schedule, got 3"),
        (lambda: task(AWAY, AT_ONCE), r"points of one shape; these have \(0, 2\) and \(1, 2\)"),
        (lambda: task(Schedule([[1.0]], [1.0])), r"points of shape \(1, 1\); expected \(k, 2\)"),
        (lambda: Task(problem(), LEAST, Schedules([[[np.nan, 0.0]]], [[1.0]])), "hold NaN or infinity"),
        (lambda: Task(problem(), LEAST, Schedules([[[1.0, 0.0]]], [[-1.0]])), "at least 0 s, got"),
        (lambda: PlanCost((task(AWAY),))(law_of(1.0).program, [[1.0, 1.0]], 3.0), r"most has shape \(\)"),
        (lambda: PlanCost((task(AWAY),))(law_of(1.0), [[1.0, 1.0]]), "must be a Program, got a Law"),
    ],
)
def test_what_is_wrong_is_said(make, sentence) -> None:
    with pytest.raises(ProblemError, match=sentence):
        make()


def test_the_rollouts_of_plans_are_those_of_each_law_under_its_schedules() -> None:
    """Bit for bit, though many laws are rolled out together."""
    evaluator, program = Evaluator(problem(obstacles=COLUMN), margin=0.1), law_of(1.0).program
    vectors = np.random.default_rng(3).uniform(0.1, 3.0, (20, 2))
    cost = PlanCost((task(*(Schedule([[float(k), 0.0]], [0.5 * k]) for k in range(1, 12))),))
    schedules = cost.tasks[0].schedules
    together = evaluator.of_plans(program, vectors, schedules, 9.0)
    for number, vector in enumerate(vectors):
        law = replace(law_of(1.0), parameters=vector)
        alone = evaluator.of_schedules(law, schedules.points, schedules.dwell, 9.0)
        for name in ("arrival", "cost", "clearance", "exposure", "depth", "final"):
            assert getattr(together, name)[number].tolist() == getattr(alone, name)[:, 0].tolist()
