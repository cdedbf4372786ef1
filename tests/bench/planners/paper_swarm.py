"""pyswarms with the paper's setting: eq. 17 with obstacles at the points, omega 1.0, c1 = c2 = 0.65, equal dwell times.

T+ is tightened from the fastest arrival of every generation, and what particles remember keeps its old cost, as a
straightforward reading of Algorithm 1 has it. The law is the one that comes along with the application.
"""

import contextlib
import tempfile
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from applications.rosbot.problems import PERIOD, problem_of
from applications.rosbot.scenario import Scenario
from applications.rosbot.stabilizer import default_law
from gpsynth.arrays import Floats
from gpsynth.evaluate import Evaluator
from gpsynth.planning import Objective, PlanSettings
from gpsynth.planning.rounds import default_region
from gpsynth.seeds import stream
from gpsynth.simulation import simulate
from tests.bench.planners.attempt import Answer, Watch

PARTICLES, GENERATIONS = 64, 200
COEFFICIENTS = {"w": 1.0, "c1": 0.65, "c2": 0.65}


def paper_swarm(scenario: Scenario, seed: int, watch: Watch) -> Iterator[Answer]:
    """One answer, after all generations."""
    low, high = zip(scenario.speed_limits, scenario.turn_limits, strict=True)
    law = default_law().with_limits(low, high)
    problem = problem_of(scenario, law)
    settings = PlanSettings.paper(5)
    now = Objective(Evaluator(problem), law, settings, min(18.0, problem.horizon))
    best_cost, best = np.inf, None

    def costs(vectors: Floats) -> Floats:
        nonlocal now, best_cost, best
        points, dwell = now.schedules(vectors)
        rollouts = now.rollouts(points, dwell)
        found = np.nan_to_num(now.costs(rollouts, points), posinf=1e6)
        if found.min() < best_cost:
            best_cost, best = found.min(), now.schedule(vectors[found.argmin()])
        now = replace(now, budget=min(now.budget, float(rollouts.arrival.min())))
        return found

    lower, upper = (np.tile(bound, settings.points) for bound in default_region(problem))
    _swarm(lower, upper, seed).optimize(costs, iters=GENERATIONS, verbose=False)
    path = simulate(problem, law, schedule=best, reach=settings.reach)
    yield Answer(watch.spent, path.u, np.full(len(path.u), PERIOD))


def _swarm(lower: Floats, upper: Floats, seed: int):
    """The swarm of pyswarms, which draws from numpy's global generator and leaves a log file where it is made."""
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        from pyswarms.single import GlobalBestPSO

        np.random.seed(stream(seed, 2).integers(2**31))  # noqa: NPY002 it knows no other generator
        return GlobalBestPSO(PARTICLES, len(lower), COEFFICIENTS, bounds=(lower, upper))
