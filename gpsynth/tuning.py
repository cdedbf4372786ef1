"""The numbers of a law that a search has found, tuned on the whole problem."""

from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from gpsynth.arrays import Floats
from gpsynth.encodings.parameters import ParameterSpace
from gpsynth.law_cost import LawCost
from gpsynth.optimizers import CMAES
from gpsynth.refitting import improved
from gpsynth.structure_search import Individual

TUNING = 2  # stage of the random streams


@dataclass(frozen=True, eq=False)
class Tuner:
    """CMA-ES over the numbers of a law, within the space of its encoding."""

    cost: LawCost
    space: ParameterSpace
    seed: int
    budget: int  # evaluations of each law; 0: numbers stay as they are

    def __call__(self, individual: Individual[Any], number: int) -> Floats:
        """Better numbers (p,) for the law, which is the one of this number, or those that it has."""
        values = individual.values
        if len(values) == 0 or self.budget < 1:
            return values
        lower, upper = np.full(len(values), self.space.lower), np.full(len(values), self.space.upper)
        optimizer = CMAES(lower, upper, x0=values, sigma=0.02, restarts=0)
        cost = partial(self.cost.means, individual.program)
        return improved(cost, values, optimizer, seed=self.seed, budget=self.budget, path=(TUNING, number))
