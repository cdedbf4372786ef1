"""The numbers of a law found anew, its structure kept: for another plant, other starts, another objective."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from gpsynth.arrays import Floats
from gpsynth.checks import check_whole
from gpsynth.errors import OptimizerError
from gpsynth.evaluate import Evaluator, check_law
from gpsynth.law import Law
from gpsynth.law_cost import LawCost, PlanCases, check_plans
from gpsynth.notation import fresh_names
from gpsynth.objective import Function, Objective, as_objective
from gpsynth.optimizers import CMAES, minimize
from gpsynth.problem import Problem
from gpsynth.program import Program

REFIT = 3  # stage of the random streams
REACH, SMALLEST, STEP = (
    10.0,
    0.1,
    0.01,
)  # a number moves by REACH (|number| + SMALLEST); first step, share of that


def refit(  # noqa: PLR0913 names each choice as a keyword
    problem: Problem,
    law: Law,
    *,
    seed: int = 0,
    budget: int = 2_000,
    constants: bool = False,
    objective: Objective | Function | None = None,
    plans: PlanCases | None = None,
) -> Law:
    """The law with the parameters that CMA-ES finds best on `problem`, never worse than those it has.

    With `constants` the numbers written into the formula are tuned too, and become parameters. The cost is the mean
    over the starts of the problem's own or of `objective`, and that of `plans` besides (`gpsynth.planning.PlanCost`).
    Raises ProblemError if the law or the plans are not for the problem's plant and features, OptimizerError for a
    budget below one generation.
    """
    check_law(problem, law)
    check_plans(plans, problem)
    check_whole("seed", seed, 0, OptimizerError)
    check_whole("budget", budget, 1, OptimizerError)
    program = without_constants(law.program) if constants else law.program
    values = np.concatenate([law.parameters, law.program.constants]) if constants else law.parameters
    if len(values) == 0:
        return law
    reach = REACH * (np.abs(values) + SMALLEST)
    optimizer = CMAES(values - reach, values + reach, x0=values, sigma=0.5 * STEP)
    cost = partial(LawCost(Evaluator(problem), as_objective(objective), plans).means, program)
    found = improved(cost, values, optimizer, seed=seed, budget=budget, path=(REFIT,))
    return law if found is values else replace(law, program=program, parameters=found)


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
