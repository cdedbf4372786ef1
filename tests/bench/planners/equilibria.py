"""gpsynth's own planner, with the law that comes along with the application."""

from collections.abc import Iterator

import numpy as np

from applications.rosbot.planner import PERIOD, plan_scenario
from applications.rosbot.scenario import Scenario
from applications.rosbot.stabilizer import default_law
from gpsynth.planning import Plan
from tests.bench.planners.attempt import Answer, Watch


def equilibria(scenario: Scenario, seed: int, watch: Watch) -> Iterator[Answer]:
    """The plans that get better while it searches, and the one that it hands out."""
    found: list[Answer] = []
    best = np.inf

    def note(plan: Plan) -> None:
        nonlocal best
        if plan.is_free and plan.arrival_time < best:
            best = plan.arrival_time
            found.append(_answer(watch, plan))

    report = plan_scenario(scenario, [default_law()], seed=seed, callback=note)
    if report.plan is not None:
        found.append(_answer(watch, report.plan))
    yield from found


def _answer(watch: Watch, plan: Plan) -> Answer:
    controls = plan.trajectory.u
    return Answer(watch.spent, controls, np.full(len(controls), PERIOD))
