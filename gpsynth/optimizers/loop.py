"""The one loop of the package: budgets, stopping, history, progress and checkpoints live here alone."""

from collections.abc import Callable
from dataclasses import dataclass
from math import inf, isnan
from typing import Generic, TypeVar

import numpy as np
import numpy.typing as npt

from gpsynth.arrays import Floats
from gpsynth.checks import check_function, check_number, check_whole
from gpsynth.errors import OptimizerError
from gpsynth.optimizers.bar import bar
from gpsynth.optimizers.protocol import Batch, S, Search
from gpsynth.seeds import stream

Candidate = TypeVar("Candidate")


@dataclass(frozen=True, eq=False)
class Progress(Generic[S]):
    """Where a run stands after a generation: all that is needed to continue it."""

    generation: int
    evaluations: int
    nonfinite: int  # evaluations whose cost was NaN or infinite
    history: tuple[tuple[int, float], ...]  # (evaluations, best cost) at every improvement
    state: S


@dataclass(frozen=True, eq=False)
class Result(Generic[S, Candidate]):
    """What a run found and why it ended; `cost` is +inf, and `x` means nothing, where no cost was finite."""

    x: Candidate
    cost: float
    evaluations: int
    generations: int
    reason: str
    history: tuple[tuple[int, float], ...]  # (evaluations, best cost) at every improvement
    nonfinite: int
    state: S

    @property
    def progress(self) -> Progress[S]:
        """To hand to `minimize(resume=...)` with a larger budget."""
        return Progress(self.generations, self.evaluations, self.nonfinite, self.history, self.state)


def minimize(
    cost: Callable[..., npt.ArrayLike],
    optimizer: Search[S, Batch, Candidate],
    *,
    seed: int,
    budget: int,
    target: float = -inf,
    path: tuple[int, ...] = (0,),
    limits: Callable[[S], Floats] | None = None,
    callback: Callable[[Progress[S]], bool | None] | None = None,
    progress: bool = False,
    checkpoint: Callable[[Progress[S]], None] | None = None,
    resume: Progress[S] | None = None,
) -> Result[S, Candidate]:
    """Search until the budget is spent, the target reached, or the optimizer or the callback stops.

    `cost` maps a batch to one row of costs per candidate; with `limits`, a function of the optimizer such as
    `PSO.limits`, it is also given what each candidate must not exceed to matter. The budget counts evaluations and is
    never exceeded: the last generation is the last that fits whole. Generation g draws from stream(seed, *path, g),
    the initial state from g = 0, so a resumed run equals an uninterrupted one bit for bit. `checkpoint` is called
    after every generation, then `callback`, which stops the run by returning True. Raises OptimizerError for a budget
    smaller than one generation and for costs that do not fit their batch.
    """
    _check(seed, budget, target)
    check_function("cost", cost, OptimizerError)
    check_function("callback", callback, OptimizerError, optional=True)
    if not hasattr(optimizer, "ask"):
        raise OptimizerError(f"optimizer must be a search such as gpsynth.CMAES(...), got {optimizer!r}")
    now = resume or Progress(0, 0, 0, (), optimizer.init(stream(seed, *path, 0)))
    with bar(budget, progress) as show:
        while not (reason := _reason(optimizer, now, target)):
            candidates, waiting = optimizer.ask(now.state, stream(seed, *path, now.generation + 1))
            if len(candidates) == 0:
                reason = "nothing new to try"
                break
            if now.evaluations + len(candidates) > budget:
                reason = "budget spent"
                break
            given = (candidates,) if limits is None else (candidates, limits(waiting))
            costs = _costs(cost(*given), len(candidates))
            now = _advanced(optimizer, now, optimizer.tell(waiting, candidates, costs), costs)
            show(now.evaluations, now.history[-1][1] if now.history else inf)
            if checkpoint is not None:
                checkpoint(now)
            if callback is not None and callback(now):
                reason = "stopped by callback"
                break
    if not now.evaluations:
        raise OptimizerError(
            f"a budget of {budget} evaluations is less than one generation of {len(candidates)}"
        )
    x, best_cost = optimizer.best(now.state)
    return Result(
        x, best_cost, now.evaluations, now.generation, reason, now.history, now.nonfinite, now.state
    )


def _check(seed: int, budget: int, target: float) -> None:
    check_whole("seed", seed, 0, OptimizerError)
    check_whole("budget", budget, 1, OptimizerError)
    check_number("target", target, OptimizerError)
    if isnan(target):
        raise OptimizerError("target must be a number, not NaN")


def _reason(optimizer: Search[S, Batch, Candidate], now: Progress[S], target: float) -> str:
    if now.history and now.history[-1][1] <= target:
        return "target reached"
    return optimizer.stop(now.state) if now.evaluations else ""


def _costs(values: npt.ArrayLike, count: int) -> Floats:
    try:
        costs = np.asarray(values, np.float64)
    except (TypeError, ValueError):
        raise OptimizerError(
            f"cost must return numbers, one row per candidate; it returns {values!r}"
        ) from None
    if costs.ndim == 0 or len(costs) != count:
        raise OptimizerError(
            f"cost must return one row per candidate: {count} expected, shape {costs.shape} came"
        )
    return costs


def _advanced(
    optimizer: Search[S, Batch, Candidate], before: Progress[S], state: S, costs: Floats
) -> Progress[S]:
    """The record one generation later; the history grows only when the best cost falls."""
    evaluations = before.evaluations + len(costs)
    nonfinite = before.nonfinite + int((~np.isfinite(costs.reshape(len(costs), -1)).all(axis=1)).sum())
    best_cost = optimizer.best(state)[1]
    improved = best_cost < (before.history[-1][1] if before.history else inf)
    history = (*before.history, (evaluations, best_cost)) if improved else before.history
    return Progress(before.generation + 1, evaluations, nonfinite, history, state)
