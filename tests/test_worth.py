"""What a law is worth to plans: shares of least times that are known in closed form, and numbers tuned for them."""

from dataclasses import replace

import numpy as np
import pytest

from gpsynth.builder import Builder
from gpsynth.errors import OptimizerError, ProblemError
from gpsynth.law import Law
from gpsynth.obstacles import Obstacles
from gpsynth.planning import PlanSettings
from gpsynth.planning.worth import Task, Worth, refit_to_plans
from gpsynth.plant import Plant
from gpsynth.problem import Problem

CART = Plant(
    lambda x, u: (u.v, 0.0 * u.v),
    states={"x": "m", "y": "m"},
    controls={"v": ("m/s", -1.0, 1.0)},
    name="cart",
)
LEAST = 3.95  # s from 0 to within 0.05 m of 4 m at 1 m/s
SMALL = PlanSettings(points=1, particles=16, iterations=5, rounds=2)


def problem(goal: float = 4.0, **changes) -> Problem:
    return Problem(
        CART, [0.0, 0.0], [goal, 0.0], tolerance=[0.05, 0.05], horizon=60.0, period=0.05, **changes
    )


def law_of(gain: float, fastest: float = 1.0) -> Law:
    """The speed v = fastest tanh(gain error)."""
    builder = Builder(problem().features.names, ("gain", "fastest"))
    error = builder.apply("mul", builder.parameters[0], builder.inputs[0])
    speed = builder.apply("mul", builder.parameters[1], builder.apply("tanh", error))
    return Law(CART, problem().features, builder.build([speed], ("v",)), np.array([gain, fastest]))


WORTH = Worth((Task(problem(), LEAST),), SMALL)


def test_a_law_that_can_drive_at_the_limit_is_worth_all_the_least_time():
    """A soft law does too, for its point may lie beyond the goal; a hard one may pass by the goal's edge at once."""
    assert 0.97 < WORTH(law_of(1.0)) <= 1.0 + 1e-9


@pytest.mark.parametrize("fastest", [0.5, 0.25])
def test_a_law_at_a_share_of_the_speed_is_worth_that_share(fastest):
    assert 0.97 * fastest < WORTH(law_of(8.0, fastest)) <= fastest + 1e-9


def test_a_law_without_a_plan_is_worth_nothing():
    assert WORTH(law_of(8.0, 0.0)) == 0.0
    walled = problem(obstacles=Obstacles(circles=[[2.0, 0.0, 0.0, 0.0, 0.5]], radius=0.1))
    assert Worth((Task(walled, LEAST),), SMALL)(law_of(1.0)) == 0.0


def test_the_worth_is_the_mean_over_the_tasks_and_repeats_to_the_bit():
    both = Worth((*WORTH.tasks, Task(problem(-2.0), 1.95)), SMALL)
    shares = both.shares(law_of(8.0, 0.5))
    assert shares.shape == (2,)
    assert shares[0] == WORTH(law_of(8.0, 0.5))  # the same random numbers, whatever comes after
    assert both(law_of(8.0, 0.5)) == shares.mean()


def test_the_limits_are_those_of_the_task():
    slow = replace(problem(), plant=CART.with_limits([-0.5], [0.5]))
    assert 0.97 * 0.5 < Worth((Task(slow, LEAST),), SMALL)(law_of(8.0)) <= 0.5 + 1e-9


def test_refitting_makes_a_slow_law_fast():
    found = refit_to_plans(law_of(1.0, 0.3), WORTH, missed=lambda law: 0.0, seed=1, budget=80)
    assert found.program == law_of(1.0).program
    assert WORTH(found) > 0.9


def test_refitting_asks_nothing_of_laws_that_miss():
    asked = []

    def worth(law: Law) -> float:
        asked.append(law.parameters[1])
        return WORTH(law)

    found = refit_to_plans(
        law_of(1.0, 0.3), worth, missed=lambda law: 0.5 * float(law.parameters[1] > 0.5), seed=1, budget=60
    )
    assert max(asked) <= 0.5
    assert 0.3 < found.parameters[1] <= 0.5


def test_refitting_keeps_a_law_that_cannot_be_improved():
    law = law_of(1.0)
    assert refit_to_plans(law, lambda law: 1.0, missed=lambda law: 0.0, budget=20) is law


def test_what_is_wrong_is_said():
    with pytest.raises(ProblemError, match="at least one task"):
        Worth(())
    with pytest.raises(ProblemError, match="finite and greater than 0, not inf"):
        Task(problem(), np.inf)
    with pytest.raises(OptimizerError, match="miss nothing"):
        refit_to_plans(law_of(1.0), WORTH, missed=lambda law: 0.1)
