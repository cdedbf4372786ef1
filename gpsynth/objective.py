"""What a law costs from each start: what its problem says, or a function of whole rollouts that the user writes."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from gpsynth.arrays import Floats
from gpsynth.checks import check_function
from gpsynth.errors import ProblemError
from gpsynth.evaluate import Evaluator
from gpsynth.program import Program
from gpsynth.rollouts import Rollouts

Function = Callable[[Rollouts], npt.ArrayLike]


@dataclass(frozen=True)
class Objective:
    """A cost of one's own: `function` maps the rollouts of N laws from S starts to costs (N, S), the less the better.

    It works on arrays, so one call serves many laws. With `paths` the rollouts hold what they pass through
    (`gpsynth.rollouts.Paths`), which takes time and memory; without, it has arrival, end, cost, clearance and final
    state. NaN, and whatever diverged, costs infinity.
    """

    function: Function
    paths: bool = False

    def __post_init__(self) -> None:
        check_function("an objective", self.function)

    def __call__(self, rollouts: Rollouts) -> Floats:
        """Costs (N, S); raises ProblemError if the function returns another shape or no numbers."""
        shape = rollouts.cost.shape
        try:
            costs = np.asarray(self.function(rollouts), dtype=np.float64)
        except (TypeError, ValueError, AttributeError, IndexError) as error:
            raise ProblemError(f"the objective fails on rollouts of shape {shape}: {error}") from None
        if costs.shape != shape:
            raise ProblemError(f"the objective returns shape {costs.shape}; expected {shape}, laws by starts")
        return np.where(np.isnan(costs) | (rollouts.diverged > 0.0), np.inf, costs)


def costs_of(rollouts: Rollouts) -> Floats:
    """Running cost and terminal costs from each start, (N, S); +inf where a rollout diverged."""
    total: Floats = rollouts.cost + rollouts.terminal.sum(axis=-1)
    return np.where(np.isfinite(total), total, np.inf)


PROBLEMS_OWN = Objective(costs_of)


def as_objective(given: Objective | Function | None) -> Objective:
    """The objective that a user means: none is that of the problem; raises ProblemError for what is no function."""
    if given is None:
        return PROBLEMS_OWN
    return given if isinstance(given, Objective) else Objective(given)


def score(
    evaluator: Evaluator,
    program: Program,
    vectors: Floats,
    objective: Objective = PROBLEMS_OWN,
    bound: float = np.inf,
) -> Floats:
    """Costs (N, S) of a law under N parameter vectors (N, p).

    A mean cost above `bound` may come out as infinity, which saves time where the costs are the problem's own.
    """
    bound = bound if objective == PROBLEMS_OWN else np.inf
    return objective(evaluator.of_program(program, vectors, bound=bound, paths=objective.paths))
