"""Algorithm 1 of Shmalko & Yamshanov taken literally, to be compared with its reading as rounds (`rounds.py`).

T+, and with it the switching step, falls as soon as a candidate reaches the goal in less. So a cost depends on what was
evaluated before it, and what particles remember keeps the cost that it had under the T+ of its time.
"""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from gpsynth.arrays import Floats
from gpsynth.optimizers import Optimizer, minimize
from gpsynth.planning.objective import Objective
from gpsynth.schedule import Schedule


@dataclass(frozen=True, eq=False)
class LiteralPlan:
    """What the search holds to be best, and how T+ fell."""

    schedule: Schedule  # under the T+ of its time
    cost: float  # eq. 17 under the T+ of its time
    budget: float  # s, the last T+
    history: tuple[tuple[int, float], ...]  # (evaluations, T+ in s) at the beginning and whenever it fell
    improvements: tuple[tuple[int, float], ...]  # (evaluations, cost), after a generation


def plan_literally(
    objective: Objective,
    optimizer: Optimizer[Any],
    *,
    seed: int,
    evaluations: int,
    path: tuple[int, ...] = (0,),
) -> LiteralPlan:
    """The search of so many evaluations; T+ is the objective's at first."""
    running = _Running(objective)
    found = minimize(running, optimizer, seed=seed, path=path, budget=evaluations)
    assert running.best is not None
    return LiteralPlan(
        running.best, running.cost, running.objective.budget, tuple(running.history), found.history
    )


class _Running:
    """The cost of candidates scored one after the other: the one cost here that remembers."""

    def __init__(self, objective: Objective) -> None:
        self.objective, self.cost = objective, np.inf
        self.best: Schedule | None = None
        self.evaluations, self.history = 0, [(0, objective.budget)]

    def __call__(self, vectors: Floats) -> Floats:
        """Costs (N,) of N candidates in a row."""
        costs, first = np.empty(len(vectors)), 0
        while first < len(vectors):
            count, used = self._until_sooner(vectors[first:])
            costs[first : first + count] = self._scored(vectors[first : first + count])
            first += count
            if used < self.objective.budget:
                self.objective = replace(self.objective, budget=used)  # T+ <- T_used
                self.history.append((self.evaluations, used))
        return costs

    def _until_sooner(self, vectors: Floats) -> tuple[int, float]:
        """How many candidates there are up to the first that arrives in less than T+, and its time (s)."""
        arrivals = self.objective.rollouts(*self.objective.schedules(vectors)).arrival[:, 0]
        arrivals = np.maximum(arrivals, self.objective.evaluator.problem.period)
        sooner = np.flatnonzero(arrivals < self.objective.budget)
        return (int(sooner[0]) + 1, float(arrivals[sooner[0]])) if len(sooner) else (len(vectors), np.inf)

    def _scored(self, vectors: Floats) -> Floats:
        costs = self.objective(vectors)
        self.evaluations += len(vectors)
        leader = int(np.argmin(costs))
        if costs[leader] < self.cost:
            self.cost, self.best = float(costs[leader]), self.objective.schedule(vectors[leader])
        return costs
