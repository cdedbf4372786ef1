"""An objective that can be broken off: it is asked for a slice of the candidates at a time, with a question between."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from gpsynth.arrays import Floats
from gpsynth.planning.objective import Objective

Stop = Callable[[], bool]


@dataclass(eq=False)
class Slices:
    """Costs as the objective has them until `stop` says so; what is left then costs infinity and leaves no trace."""

    objective: Objective
    stop: Stop | None
    skipped: int = 0  # vectors that have not been rolled out

    def __call__(self, vectors: Floats, limits: Floats | None = None) -> Floats:
        """Costs (N,) of vectors (N, d), with limits (N,) as the objective has them."""
        if self.stop is None:
            return self.objective(vectors, limits)
        costs, evaluator = np.full(len(vectors), np.inf), self.objective.evaluator
        size = evaluator.block * evaluator.threads
        for first in range(0, len(vectors), size):
            if self.stop():
                self.skipped += len(vectors) - first
                break
            part = slice(first, first + size)
            costs[part] = self.objective(vectors[part], None if limits is None else limits[part])
        return costs

    @property
    def is_over(self) -> bool:
        """Whether to stop."""
        return self.stop is not None and self.stop()
