"""The numbers of a law that a search has found, tuned on the whole problem."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from gpsynth.arrays import Floats
from gpsynth.batch_cost import BatchCost
from gpsynth.encodings.parameters import ParameterSpace
from gpsynth.evaluate import Evaluator
from gpsynth.hard_starts import harder
from gpsynth.objective import Objective
from gpsynth.optimizers import CMAES
from gpsynth.problem import Problem
from gpsynth.refitting import improved, mean_cost
from gpsynth.structure_search import Individual

TUNING = 2  # stage of the random streams
ROUNDS = 3  # on a sample, as long as starts are missed


@dataclass(frozen=True, eq=False)
class Tuner:
    """CMA-ES over the numbers of a law, within the space of its encoding.

    With a `sample` it looks at so many starts of the problem at a time: the first, then those of all that the law
    misses when it is tuned (`gpsynth/hard_starts.py`).
    """

    problem: Problem
    objective: Objective
    space: ParameterSpace
    sample: int | None
    seed: int
    budget: int  # evaluations of a round

    def __call__(self, individual: Individual[Any], number: int) -> Floats:
        """Better numbers (p,) for the law, which is the one of this number, or those that it has."""
        if len(individual.values) == 0 or self.budget < 1:
            return individual.values
        if self.sample is None:
            return self._better(individual, self._cost.evaluator, TUNING, number)
        seen = tuple(range(self.sample))
        for turn in range(ROUNDS):
            values = self._better(individual, self._cost.of(seen).evaluator, TUNING, number, turn)
            individual = replace(individual, values=values)
            before, seen = seen, harder(self._cost, [individual.candidate], seen)
            if seen == before:
                break
        return individual.values

    def _better(self, individual: Individual[Any], evaluator: Evaluator, *path: int) -> Floats:
        values = individual.values
        lower, upper = np.full(len(values), self.space.lower), np.full(len(values), self.space.upper)
        optimizer = CMAES(lower, upper, x0=values, sigma=0.02, restarts=0)
        cost = mean_cost(evaluator, individual.program, self.objective)
        return improved(cost, values, optimizer, seed=self.seed, budget=self.budget, path=path)

    @cached_property
    def _cost(self) -> BatchCost:
        return BatchCost(self.problem)
