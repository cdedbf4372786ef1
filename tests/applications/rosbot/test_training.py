"""The scenarios that the ROSbot's laws are judged on for planning."""

import numpy as np

from applications.rosbot.model import unicycle
from applications.rosbot.polar_law import SATURATING, SETTLING, polar_law
from applications.rosbot.reachability import reachability
from applications.rosbot.scenario import Scenario
from applications.rosbot.training import KINDS, plan_worth, training_scenarios


def content(scenario: Scenario) -> tuple:
    return tuple(np.concatenate([scenario.start, scenario.goal, scenario.circles.ravel()]))


def test_scenarios_are_of_all_kinds_and_their_goals_can_be_reached():
    scenarios = training_scenarios(10)
    assert [each.name.split("-")[0] for each in scenarios] == [*KINDS, *KINDS]
    assert len({content(each) for each in scenarios}) == 10
    assert {reachability(each).status for each in scenarios} == {"reachable"}


def test_the_same_seed_gives_the_same_scenarios_and_another_one_others():
    first = [content(each) for each in training_scenarios(5, seed=1)]
    assert first == [content(each) for each in training_scenarios(5, seed=1)]
    assert not set(first) & {content(each) for each in training_scenarios(5, seed=2)}


def test_gains_that_saturate_are_worth_more_than_those_that_settle_fast():
    """As independent measurements with another planner found."""
    worth = plan_worth(training_scenarios(10))
    saturating, settling = (worth.shares(polar_law(unicycle(), each)) for each in (SATURATING, SETTLING))
    assert np.all(saturating <= 1.0 + 1e-9)  # none is faster than the bound
    assert saturating.mean() > settling.mean() > 0.5
