"""gpsynth's own planner, with the law that comes along with the application."""

from collections.abc import Iterator

import numpy as np

from applications.rosbot.planner import PlanReport, plan_scenario
from applications.rosbot.problems import PERIOD
from applications.rosbot.scenario import Scenario
from applications.rosbot.stabilizer import default_law
from tests.bench.planners.attempt import Answer, Watch


def equilibria(scenario: Scenario, seed: int, watch: Watch) -> Iterator[Answer]:
    """The plans that get better while it searches; it ends by itself, or when the time is up."""
    found: list[Answer] = []
    best = np.inf

    def note(report: PlanReport) -> bool:
        nonlocal best
        if report.plan is not None and report.plan.arrival_time < best:
            best = report.plan.arrival_time
            controls = report.plan.trajectory.u
            found.append(Answer(watch.spent, controls, np.full(len(controls), PERIOD)))
        return watch.is_over

    plan_scenario(scenario, [default_law()], seed=seed, callback=note)
    yield from found
