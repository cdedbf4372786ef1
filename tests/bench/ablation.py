"""`python -m tests.bench.ablation`: what each part of the structure search is worth, on three problems.

Each row leaves one part out; all spend the same number of evaluations. A cell is the median cost over the seeds that
the search itself minimizes, and in brackets how likely so large a difference from the whole search is by chance
(Mann-Whitney U, corrected by Holm for the rows of a column).
"""

import argparse
from collections.abc import Callable
from dataclasses import replace
from statistics import median
from types import MappingProxyType

import joblib

import gpsynth as gs
from applications.rosbot.stabilizer import OPERATIONS, SYMMETRIES, stabilization, training_poses
from examples import landau_oscillator
from gpsynth.islands import search_islands
from gpsynth.structure_search import StructureSearch
from gpsynth.synthesis import BatchCost
from tests.bench import robot_a
from tests.bench.encodings import chances


def _rosbot() -> gs.Problem:
    return stabilization(
        training_poses(gs.stream(1, 7), 32), period=0.1, horizon=20.0, method="heun", stop=False
    )


def _landau() -> gs.Problem:
    return landau_oscillator.oscillation(period=0.1, horizon=15.0)


def _trees(problem: gs.Problem, operations: tuple[str, ...], symmetries: dict[str, str]) -> gs.TreeEncoding:
    names = problem.features.names, problem.plant.control_names
    return gs.TreeEncoding(
        *(*names, operations, gs.ParameterSpace(8, -10.0, 10.0)), max_size=20, symmetries=symmetries
    )


CASES: MappingProxyType[str, Callable[[], tuple[gs.Problem, gs.TreeEncoding | gs.TemplateEncoding]]] = (
    MappingProxyType(
        {
            "ROSbot": lambda: (case := _rosbot(), _trees(case, OPERATIONS, dict(SYMMETRIES))),
            "robot A": lambda: (robot_a.problem(0.01), robot_a.encoding()),
            "Landau": lambda: (
                case := _landau(),
                _trees(
                    case,
                    ("add", "sub", "mul", "tanh", "abs"),
                    dict.fromkeys((*case.features.names, "b"), "-"),
                ),
            ),
        }
    )
)
WITHOUT: MappingProxyType[str, Callable[[StructureSearch], StructureSearch]] = MappingProxyType(
    {
        "the whole search": lambda search: search,
        "without symmetries": lambda search: replace(search, encoding=_free(search.encoding)),
        "without CMA-ES": lambda search: replace(search, tuned=0),
        "without lexicase": lambda search: replace(search, lexicase=0.0),
        "without crossover": lambda search: replace(search, crossover=0.0),
        "without small parents": lambda search: replace(search, simple=0.0),
        "without places for the young": lambda search: replace(search, youth=0.0, fresh=0.0),
    }
)
ISLANDS = "four islands"


def _free(encoding: gs.TreeEncoding | gs.TemplateEncoding) -> gs.TreeEncoding | gs.TemplateEncoding:
    if isinstance(encoding, gs.TemplateEncoding):
        return replace(encoding, holes=_free(encoding.holes))
    return replace(encoding, symmetries=None)


def _cost(case: str, part: str, seed: int, budget: int) -> float:
    problem, encoding = CASES[case]()
    cost = BatchCost(problem)
    search = StructureSearch(encoding)
    if part == ISLANDS:
        found = search_islands(cost, search, islands=gs.Islands(4), seed=seed, budget=budget, path=(1,))
        return found.progress.state.population[0].cost
    return gs.minimize(cost, WITHOUT[part](search), seed=seed, budget=budget, path=(1,)).cost


def main() -> None:
    """Print one row a part."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=8)
    parser.add_argument("--budget", type=int, default=6_000)
    parser.add_argument("--jobs", type=int, default=2)
    arguments = parser.parse_args()
    parts = [*WITHOUT, ISLANDS]
    cells: dict[str, list[str]] = {part: [] for part in parts}
    for case in CASES:
        tasks = [
            joblib.delayed(_cost)(case, part, seed, arguments.budget)
            for part in parts
            for seed in range(1, arguments.seeds + 1)
        ]
        costs = joblib.Parallel(n_jobs=arguments.jobs)(tasks)
        count = arguments.seeds
        found = {part: costs[k * count : (k + 1) * count] for k, part in enumerate(parts)}
        by_chance = chances(found, parts[0])
        for part in parts:
            note = "" if part == parts[0] else f" ({by_chance[part]:.2f})"
            cells[part].append(f"{median(found[part]):.3f}{note}")
    print(f"{arguments.seeds} seeds, {arguments.budget} evaluations each")
    print(f"{'':30}" + "".join(f"{case:>18}" for case in CASES))
    for part, row in cells.items():
        print(f"{part:30}" + "".join(f"{cell:>18}" for cell in row))


if __name__ == "__main__":
    main()
