"""The numbers of a law found anew, its structure kept: for another plant, other starts, another objective."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from gpsynth.arrays import Floats
from gpsynth.checks import check_whole
from gpsynth.errors import OptimizerError
from gpsynth.evaluate import Evaluator, check_law
from gpsynth.law import Law
from gpsynth.notation import fresh_names
from gpsynth.objective import PROBLEMS_OWN, Function, Objective, as_objective, score
from gpsynth.optimizers import CMAES, minimize
from gpsynth.problem import Problem
from gpsynth.program import Program

REFIT = 3  # stage of the random streams
REACH, SMALLEST, STEP = (
    10.0,
    0.1,
    0.01,
)  # a number moves by REACH (|number| + SMALLEST); first step, share of that


def refit(
    problem: Problem,
    law: Law,
    *,
    seed: int = 0,
    budget: int = 2_000,
    constants: bool = False,
    objective: Objective | Function | None = None,
) -> Law:
    """The law with the parameters that CMA-ES finds best on `problem`, never worse than those it has.

    With `constants` the numbers written into the formula are tuned too, and become parameters. The cost is the mean
    over the starts of the problem's own or of `objective`. Raises ProblemError if the law is not for the problem's
    plant and features, OptimizerError for a budget below one generation.
    """
    check_law(problem, law)
    check_whole("seed", seed, 0, OptimizerError)
    check_whole("budget", budget, 1, OptimizerError)
    program = without_constants(law.program) if constants else law.program
    values = np.concatenate([law.parameters, law.program.constants]) if constants else law.parameters
    if len(values) == 0:
        return law
    reach = REACH * (np.abs(values) + SMALLEST)
    optimizer = CMAES(values - reach, values + reach, x0=values, sigma=0.5 * STEP)
    cost = mean_cost(Evaluator(problem), program, as_objective(objective))
    found = improved(cost, values, optimizer, seed=seed, budget=budget, path=(REFIT,))
    return law if found is values else replace(law, program=program, parameters=found)


def mean_cost(
    evaluator: Evaluator, program: Program, objective: Objective = PROBLEMS_OWN
) -> Callable[[Floats], Floats]:
    """The cost (N,) of parameter vectors (N, p), the mean over the starts."""

    def cost(vectors: Floats) -> Floats:
        means: Floats = score(evaluator, program, vectors, objective).mean(axis=1)
        return means

    return cost


def improved(
    cost: Callable[[Floats], Floats],
    values: Floats,
    optimizer: CMAES,
    *,
    seed: int,
    budget: int,
    path: tuple[int, ...],
) -> Floats:
    """The best parameters (p,) that the optimizer finds, or `values` themselves if none cost less."""
    found = minimize(cost, optimizer, seed=seed, budget=budget, path=path)
    return found.x if found.cost < float(cost(values[np.newaxis])[0]) else values


def without_constants(program: Program) -> Program:
    """The program with its constants as further parameters, c1, c2, ..., behind those it has."""
    names = fresh_names("c", program)
    further = tuple(next(names) for _ in range(len(program.constants)))
    # constants follow the parameters in the numbering of operands, so the code stays as it is
    return replace(program, parameters=program.parameters + further, constants=np.empty(0))
