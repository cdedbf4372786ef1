"""Many searches side by side that merge two by two: luck at the start does not decide what is found in the end.

A structure search settles early in one basin, and whether that is a good one shows after some generations. So many
islands search for a while; then half as many, each merged of two, for as long again, until one is left: successive
halving (Karnin, Koren & Somekh 2013; Jamieson & Talwalkar 2016), but what loses is merged, not thrown away. The best
island merges with the worst, the second best with the second worst.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

import joblib
from joblib.externals.loky.process_executor import BrokenProcessPool

from gpsynth.errors import OptimizerError
from gpsynth.optimizers import Progress, Result, minimize
from gpsynth.optimizers.bar import bar
from gpsynth.runs import Outcome
from gpsynth.structure_search import Cost, SearchState, StructureSearch

G = TypeVar("G")
Callback = Callable[[Progress[SearchState[Any]]], bool | None]

TRIES = 3  # of a level whose worker processes died


@dataclass(frozen=True)
class Islands:
    """How many islands a search begins with, a power of 2; raises OptimizerError for another number."""

    count: int = 16

    def __post_init__(self) -> None:
        count = self.count
        if not isinstance(count, int) or isinstance(count, bool) or count < 1 or count & (count - 1):
            raise OptimizerError(f"the number of islands must be a power of 2, not {count!r}")

    @property
    def levels(self) -> int:
        """Levels of merging, the last with a single island."""
        return self.count.bit_length()


@dataclass(frozen=True, eq=False)
class Archipelago(Generic[G]):
    """Where a search on islands stands between two levels; the best island comes first."""

    level: int  # levels that are done
    islands: tuple[Progress[SearchState[G]] | None, ...]
    history: tuple[tuple[int, float], ...] = ()  # (evaluations, best cost) after each level

    @property
    def evaluations(self) -> int:
        """Evaluations of all islands together."""
        return sum(map(_spent, self.islands))

    @property
    def state(self) -> SearchState[G]:
        """The search of the best island."""
        best = self.islands[0]
        return SearchState((), ()) if best is None else best.state


def search_islands(  # noqa: PLR0913 takes what `minimize` takes
    cost: Cost,
    strategy: StructureSearch[Any],
    *,
    islands: Islands,
    seed: int,
    budget: int,
    path: tuple[int, ...],
    workers: int = 1,
    progress: bool = False,
    callback: Callback | None = None,
    checkpoint: Callable[[Archipelago[Any]], None] | None = None,
    resume: Archipelago[Any] | None = None,
) -> Outcome:
    """The search after all levels, on each of which every island may spend the same share of the budget (evaluations).

    Islands run in `workers` processes through joblib, so `joblib.parallel_config(backend="dask")` sends them to a
    cluster; the same seed gives the same result wherever they run. `checkpoint`, `callback` and the progress bar hear
    of each level. A run is resumed with the budget it began with. Raises OptimizerError if an island's share is less
    than one population.
    """
    least = strategy.population * (2 * islands.count - 1)
    if budget < least:
        raise OptimizerError(
            f"a budget of {budget} evaluations is too small for {islands.count} islands; at least {least} are needed"
        )
    now = resume or Archipelago(0, (None,) * islands.count)
    reason = "budget spent"
    with bar(budget, progress) as show:
        while now.level < islands.levels and not reason.startswith("stopped"):
            share = (budget - now.evaluations) // (2 * len(now.islands) - 1)
            tasks = [
                joblib.delayed(minimize)(
                    *(cost, strategy),
                    seed=seed,
                    budget=_spent(before) + share,
                    path=(*path, now.level, number),
                    resume=before,
                )
                for number, before in enumerate(now.islands)
            ]
            ranked = sorted(_results(tasks, min(workers, len(tasks))), key=lambda each: each.cost)
            now = _next(strategy, now, ranked)
            show(*now.history[-1])
            if checkpoint is not None:
                checkpoint(now)
            if callback is not None and callback(_whole(now, ranked[0].state)):
                reason = "stopped by callback"
    return Outcome(now, reason)


def _results(tasks: Sequence[Any], workers: int) -> list[Any]:
    for _ in range(TRIES):
        try:
            return list(joblib.Parallel(n_jobs=workers)(tasks))
        except BrokenProcessPool:  # a level is a pure function: nothing changes if it is tried again
            continue
    raise OptimizerError(
        f"the processes that the islands run in died {TRIES} times, for lack of memory perhaps"
    )


def _next(
    strategy: StructureSearch[Any], before: Archipelago[Any], ranked: Sequence[Result[Any, Any]]
) -> Archipelago[Any]:
    """After a level: the best island merged with the worst, the second best with the second worst."""
    found = [each.progress for each in ranked]
    half = len(found) // 2
    pairs = list(zip(found[:half], found[: half - 1 : -1], strict=True)) if half else [tuple(found)]
    islands = tuple(
        _summed(pair, strategy.merged([each.state for each in pair]), history=()) for pair in pairs
    )
    spent = sum(each.evaluations for each in found)
    return Archipelago(before.level + 1, islands, (*before.history, (spent, ranked[0].cost)))


def _whole(now: Archipelago[Any], best: SearchState[Any]) -> Progress[SearchState[Any]]:
    return _summed([each for each in now.islands if each is not None], best, history=now.history)


def _summed(
    parts: Sequence[Progress[Any]], state: SearchState[Any], history: tuple[tuple[int, float], ...]
) -> Progress[SearchState[Any]]:
    """What the parts have spent together, for a search that goes on from `state`."""
    return Progress(
        generation=max(each.generation for each in parts),
        evaluations=sum(each.evaluations for each in parts),
        nonfinite=sum(each.nonfinite for each in parts),
        history=history,
        state=state,
    )


def _spent(progress: Progress[Any] | None) -> int:
    return 0 if progress is None else progress.evaluations
