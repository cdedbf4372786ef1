"""Islands find the same wherever they run, spend what they may, and lose nothing when they merge."""

import os
import signal
import sys
from dataclasses import dataclass
from pathlib import Path

import joblib
import numpy as np
import pytest

import gpsynth as gs
from gpsynth.batch_cost import BatchCost
from gpsynth.errors import OptimizerError
from gpsynth.islands import Islands, search_islands
from gpsynth.structure_search import StructureSearch

ISLANDS = Islands(4)
BUDGET = 1_200
PROBLEM = gs.Problem(
    gs.Plant(
        lambda x, u: (x.speed, u.force),
        states={"place": "m", "speed": "m/s"},
        controls={"force": ("N", -5.0, 5.0)},
        name="double_integrator",
    ),
    starts=[(1.0, 0.0), (-1.0, 0.5), (0.5, -1.0), (0.0, 1.0)],
    goal=(0.0, 0.0),
    tolerance=0.01,
    horizon=10.0,
    running=lambda x, u, goal: x.place**2 + u.force**2,
    stop=False,
)
ENCODING = gs.TreeEncoding(
    PROBLEM.features.names, ("force",), ("add", "sub", "mul"), gs.ParameterSpace(3, -5.0, 5.0), max_size=9
)


@pytest.fixture(name="search")
def _search():
    return StructureSearch(ENCODING, population=20, offspring=20)


def _found(search, **settings):
    cost = BatchCost(PROBLEM)
    return search_islands(cost, search, islands=ISLANDS, seed=1, budget=BUDGET, path=(1,), **settings)


def _costs(found):
    return [individual.cost for individual in found.progress.state.population]


def test_one_island_is_left_and_the_budget_is_kept(search):
    found = _found(search)
    assert len(found.progress.islands) == 1
    assert 0.8 * BUDGET < found.progress.evaluations <= BUDGET
    spent, costs = zip(*found.progress.history, strict=True)
    assert len(spent) == ISLANDS.levels
    assert list(costs) == sorted(costs, reverse=True)


@pytest.mark.slow
def test_processes_change_nothing(search):
    assert _costs(_found(search, workers=2)) == _costs(_found(search))


@dataclass(frozen=True)
class DiesOnce:
    """Costs, but the first process that is asked for them is killed."""

    marker: Path

    def __call__(self, batch):
        """Costs of a batch."""
        if not self.marker.exists():
            self.marker.touch()
            os.kill(os.getpid(), signal.SIGKILL)
        return BatchCost(PROBLEM)(batch)


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGKILL")
def test_a_killed_process_changes_nothing(search, tmp_path):
    settings = {"islands": ISLANDS, "seed": 1, "budget": BUDGET, "path": (1,)}
    found = search_islands(DiesOnce(tmp_path / "died"), search, **settings, workers=2)
    assert (tmp_path / "died").exists()
    assert _costs(found) == _costs(_found(search))


@pytest.mark.slow
def test_a_dask_cluster_that_loses_a_worker_changes_nothing(search, tmp_path):
    distributed = pytest.importorskip("distributed", reason="dask is an extra: gpsynth[cluster]")
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
        distributed.Client(cluster),
        joblib.parallel_config(backend="dask"),
    ):
        settings = {"islands": ISLANDS, "seed": 1, "budget": BUDGET, "path": (1,)}
        there = search_islands(DiesOnce(tmp_path / "died"), search, **settings, workers=2)
    assert (tmp_path / "died").exists()
    assert _costs(there) == _costs(_found(search))


def test_resuming_after_any_level_changes_nothing(search):
    kept = []
    whole = _found(search, checkpoint=kept.append)
    for level in kept:
        assert _costs(_found(search, resume=level)) == _costs(whole)


def test_a_callback_ends_it_after_a_level(search):
    found = _found(search, callback=lambda progress: progress.evaluations > 0)
    assert found.reason == "stopped by callback"
    assert found.progress.level == 1


def test_merging_keeps_the_best_of_both(search):
    states = [
        gs.minimize(BatchCost(PROBLEM), search, seed=seed, budget=100, path=(1,)).state for seed in (1, 2)
    ]
    merged = search.merged(states)
    assert len(merged.population) <= search.population
    assert merged.population[0].cost == min(state.population[0].cost for state in states)
    least = {each.complexity: each.cost for state in states for each in state.front}
    assert all(each.cost <= least.get(each.complexity, np.inf) for each in merged.front)


def test_the_number_of_islands_is_a_power_of_two():
    with pytest.raises(OptimizerError, match="a power of 2, not 6"):
        Islands(6)
