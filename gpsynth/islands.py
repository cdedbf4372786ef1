"""Many searches side by side that merge two by two: luck at the start does not decide what is found in the end.

A structure search settles early in one basin, and whether that is a good one shows after a few generations. So many
islands get a small budget each, then half as many twice the population to choose from and the same budget for all of
them together, until one is left: successive halving (Karnin, Koren & Somekh 2013; Jamieson & Talwalkar 2016), but
what loses is merged, not thrown away. The best island merges with the worst, the second best with the second worst.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, TypeVar

import joblib
from joblib.externals.loky.process_executor import BrokenProcessPool

from gpsynth.errors import OptimizerError
from gpsynth.optimizers import Progress, Result, minimize
from gpsynth.optimizers.bar import bar
from gpsynth.structure_search import Cost, Individual, SearchState, StructureSearch

G = TypeVar("G")
Callback = Callable[[Progress[SearchState[Any]]], bool | None]

TRIES = (
    3  # of a level whose worker processes died; a level is a pure function, so trying again changes nothing
)


@dataclass(frozen=True)
class Islands:
    """How many islands a search begins with, a power of 2; raises OptimizerError for another number."""

    count: int = 16

    def __post_init__(self) -> None:
        if self.count < 1 or self.count & (self.count - 1):
            raise OptimizerError(f"the number of islands must be a power of 2, not {self.count}")

    @property
    def levels(self) -> int:
        """Levels of merging, the last with a single island."""
        return self.count.bit_length()


def search_islands(
    cost: Cost,
    strategy: StructureSearch[G],
    islands: Islands,
    *,
    seed: int,
    budget: int,
    path: tuple[int, ...],
    workers: int = 1,
    progress: bool = False,
    callback: Callback | None = None,
) -> Result[SearchState[G], Individual[G]]:
    """The search after all levels, each of which may spend an equal share of the budget (evaluations).

    Islands run in `workers` processes through joblib, so `joblib.parallel_config(backend="dask")` sends them to a
    cluster; the same seed gives the same result wherever they run. `callback` and the progress bar hear of each level.
    Raises OptimizerError if an island's share is less than one generation.
    """
    now: list[Progress[SearchState[G]] | None] = [None] * islands.count
    history: list[tuple[int, float]] = []
    with bar(budget, progress) as show:
        for level in range(islands.levels):
            share = (budget - sum(map(_spent, now))) // ((islands.levels - level) * len(now))
            found = _level(cost, strategy, now, seed=seed, path=(*path, level), share=share, workers=workers)
            found.sort(key=lambda each: each.cost)
            whole = _summed([each.progress for each in found], found[0].state)
            history.append((whole.evaluations, found[0].cost))
            show(*history[-1])
            if callback is not None and callback(replace(whole, history=tuple(history))):
                found[0] = replace(found[0], reason="stopped by callback")
                break
            now = [_merged(strategy, pair) for pair in _pairs([each.progress for each in found])]
    return replace(found[0], evaluations=whole.evaluations, nonfinite=whole.nonfinite, history=tuple(history))


def _level(
    cost: Cost,
    strategy: StructureSearch[G],
    now: Sequence[Progress[SearchState[G]] | None],
    *,
    seed: int,
    path: tuple[int, ...],
    share: int,
    workers: int,
) -> list[Result[SearchState[G], Individual[G]]]:
    """All islands of a level, each from where it stands, with `share` more evaluations."""
    tasks = [
        joblib.delayed(_island)(cost, strategy, before, seed=seed, path=(*path, number), share=share)
        for number, before in enumerate(now)
    ]
    for trial in range(TRIES):
        try:
            found: list[Any] = joblib.Parallel(n_jobs=min(workers, len(tasks)))(tasks)
        except BrokenProcessPool:
            if trial == TRIES - 1:
                raise OptimizerError(f"the worker processes of the islands died {TRIES} times") from None
        else:
            break
    return found


def _island(
    cost: Cost,
    strategy: StructureSearch[G],
    before: Progress[SearchState[G]] | None,
    *,
    seed: int,
    path: tuple[int, ...],
    share: int,
) -> Result[SearchState[G], Individual[G]]:
    return minimize(cost, strategy, seed=seed, budget=_spent(before) + share, path=path, resume=before)


def _spent(progress: Progress[Any] | None) -> int:
    return 0 if progress is None else progress.evaluations


def _pairs(ranked: Sequence[Progress[SearchState[G]]]) -> list[tuple[Progress[SearchState[G]], ...]]:
    """The best with the worst, the second best with the second worst; one island stays alone."""
    half = len(ranked) // 2
    return list(zip(ranked[:half], ranked[: half - 1 : -1], strict=True)) if half else [tuple(ranked)]


def _merged(
    strategy: StructureSearch[G], pair: Sequence[Progress[SearchState[G]]]
) -> Progress[SearchState[G]]:
    return _summed(pair, strategy.merged([each.state for each in pair]))


def _summed(parts: Sequence[Progress[SearchState[G]]], state: SearchState[G]) -> Progress[SearchState[G]]:
    """What the parts have spent together, for a search that goes on from `state`."""
    return Progress(
        generation=max(each.generation for each in parts),
        evaluations=sum(each.evaluations for each in parts),
        nonfinite=sum(each.nonfinite for each in parts),
        history=(),
        state=state,
    )
