"""Starts and plans in one mean."""

from dataclasses import replace

import numpy as np
import pytest

import gpsynth as gs
from gpsynth.evaluate import Evaluator
from gpsynth.law_cost import LawCost
from gpsynth.objective import score
from gpsynth.planning import PlanCost, Task
from gpsynth.schedule import Schedule
from tests.test_worth import law_of, problem

SETTLING = gs.Problem(
    problem().plant, [[-1.0, 0.0], [2.0, 0.0], [3.0, 0.0]], [0.0, 0.0], tolerance=0.05, horizon=20.0
)
PLANS = PlanCost(
    tuple(
        Task(problem(), 3.95, [Schedule([[9.0, 0.0]], [time])], budget=20.0) for time in (1.0, 2.0, 3.0, 4.0)
    ),
    weight=0.7,
)
PROGRAM, VECTORS = law_of(1.0).program, np.array([[0.4, 1.0], [3.0, 0.6]])
BOTH = LawCost(Evaluator(SETTLING), plans=PLANS)


def test_the_mean_is_that_of_the_starts_and_the_weighted_one_of_the_plans() -> None:
    starts = score(Evaluator(SETTLING), PROGRAM, VECTORS).mean(axis=1)
    plans = PLANS(PROGRAM, VECTORS).mean(axis=1)
    assert BOTH.cases(PROGRAM, VECTORS).shape == (2, 7)
    assert BOTH.means(PROGRAM, VECTORS) == pytest.approx(starts + 0.7 * plans, rel=1e-14)


def test_without_plans_it_is_the_score_to_the_bit() -> None:
    alone = LawCost(Evaluator(SETTLING)).cases(PROGRAM, VECTORS)
    assert alone.tolist() == score(Evaluator(SETTLING), PROGRAM, VECTORS).tolist()


@pytest.mark.parametrize("share", [0.2, 0.99, 1.0, 1.5])
def test_only_what_is_above_the_bound_may_cost_infinity(share: float) -> None:
    for vector in VECTORS:
        mean = BOTH.means(PROGRAM, vector[np.newaxis])[0]
        found = BOTH.cases(PROGRAM, vector[np.newaxis], bound=share * mean).mean()
        assert found == mean or (share < 1.0 and np.isinf(found))


def test_plans_are_not_tried_with_laws_that_lose_without_them() -> None:
    class Asked:
        problems, weight, nonnegative = PLANS.problems, 1.0, True

        def __call__(self, program, vectors, most):
            raise AssertionError("nothing is to be tried")

    found = LawCost(Evaluator(SETTLING), plans=Asked()).cases(PROGRAM, VECTORS[:1], bound=1e-3)
    assert np.isinf(found.mean())
    assert found.shape == (1, 7)


def test_plans_that_may_earn_something_are_tried_with_every_law() -> None:
    """What a law loses from its starts it may get back."""
    running = problem(running=lambda x, u, goal: x.x - 10.0).running
    task = PLANS.tasks[0]
    earned = LawCost(
        Evaluator(SETTLING), plans=PlanCost([replace(task, problem=problem(running=running))], weight=9.0)
    )
    mean = earned.means(PROGRAM, VECTORS[:1])[0]
    assert mean < 0.0 < score(Evaluator(SETTLING), PROGRAM, VECTORS[:1]).mean()
    assert earned.cases(PROGRAM, VECTORS[:1], bound=mean).mean() == mean


@pytest.mark.parametrize("weight", [1e-16, 1e-9])
def test_the_bound_itself_is_not_above_it_however_little_plans_weigh(weight: float) -> None:
    """The sum is rounded; what of it is left for plans then has hardly a digit right."""
    both = LawCost(Evaluator(SETTLING), plans=PlanCost(PLANS.tasks, weight=weight))
    for vector in np.random.default_rng(1).uniform(0.3, 3.0, (20, 2)):
        mean = both.means(PROGRAM, vector[np.newaxis])[0]
        assert both.cases(PROGRAM, vector[np.newaxis], bound=mean).mean() == mean
