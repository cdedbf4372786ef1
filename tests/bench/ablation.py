"""`python -m tests.bench.ablation`: what each part of the structure search is worth, on three problems.

Each row leaves one part out; all spend the same number of evaluations on the same seeds. A cell is the median cost that
the search itself minimizes, and in brackets the number of seeds for which the whole search is the cheaper one. The last
columns take the problems together: how often it is, and how likely a difference like that is by chance (signed ranks
over the seeds, `tests/bench/chance.py:paired`, corrected by Holm for the rows).
"""

import argparse
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from statistics import median
from types import MappingProxyType

import joblib

import gpsynth as gs
from applications.rosbot.stabilization import stabilization, training_poses
from applications.rosbot.stabilizer import OPERATIONS, SYMMETRIES
from examples import planar_quadrotor
from gpsynth.batch_cost import BatchCost
from gpsynth.islands import search_islands
from gpsynth.structure_search import StructureSearch
from tests.bench import robot_a
from tests.bench.chance import Runs, corrected, paired

Encoding = gs.TreeEncoding | gs.TemplateEncoding
Found = Mapping[str, Mapping[str, Runs]]  # of each part and problem


def _rosbot() -> tuple[gs.Problem, Encoding]:
    starts = training_poses(gs.stream(1, 7), 32)
    problem = stabilization(starts, period=0.1, horizon=20.0, method="heun", stop=False)
    names, space = (problem.features.names, problem.plant.control_names), gs.ParameterSpace(8, -10.0, 10.0)
    return problem, gs.TreeEncoding(*names, OPERATIONS, space, max_size=20, symmetries=dict(SYMMETRIES))


def _quadrotor() -> tuple[gs.Problem, Encoding]:
    problem = planar_quadrotor.flight(planar_quadrotor.STARTS, period=0.05, horizon=6.0)
    return problem, planar_quadrotor.encoding


CASES: MappingProxyType[str, Callable[[], tuple[gs.Problem, Encoding]]] = MappingProxyType(
    {
        "ROSbot": _rosbot,
        "robot A": lambda: (robot_a.problem(0.01), robot_a.encoding()),
        "quadrotor": _quadrotor,
    }
)
WHOLE, ISLANDS = "the whole search", "four islands"
WITHOUT: MappingProxyType[str, Callable[[StructureSearch], StructureSearch]] = MappingProxyType(
    {
        WHOLE: lambda search: search,
        "without symmetries": lambda search: replace(search, encoding=_free(search.encoding)),
        "without CMA-ES": lambda search: replace(search, tuned=0),
        "without lexicase": lambda search: replace(search, lexicase=0.0),
        "without crossover": lambda search: replace(search, crossover=0.0),
        "without small parents": lambda search: replace(search, simple=0.0),
        "without places for the young": lambda search: replace(search, youth=0.0, fresh=0.0),
    }
)

PARTS = (*WITHOUT, ISLANDS)


def _free(encoding: Encoding) -> Encoding:
    if isinstance(encoding, gs.TemplateEncoding):
        return replace(encoding, holes=_free(encoding.holes))
    return replace(encoding, symmetries=None)


def cost_found(part: str, case: str, seed: int, budget: int) -> float:
    """The least cost of one run."""
    problem, encoding = CASES[case]()
    cost = BatchCost(problem)
    search = StructureSearch(encoding)
    if part == ISLANDS:
        found = search_islands(cost, search, islands=gs.Islands(4), seed=seed, budget=budget, path=(1,))
        return found.progress.state.population[0].cost
    return gs.minimize(cost, WITHOUT[part](search), seed=seed, budget=budget, path=(1,)).cost


def table(found: Found) -> Iterator[str]:
    """One row a part, the whole search first."""
    others = [part for part in found if part != WHOLE]
    pairs = {part: [(found[WHOLE][case], found[part][case]) for case in CASES] for part in others}
    together = corrected({part: paired(pairs[part]) for part in others})
    yield f"| | {' | '.join(CASES)} | whole search better | by chance |\n|---|{'---:|' * (len(CASES) + 2)}"
    yield f"| {WHOLE} | {' | '.join(f'{median(runs):.3f}' for runs in found[WHOLE].values())} | | |"
    for part in others:
        cells = [f"{median(theirs):.3f} ({_better(ours, theirs)})" for ours, theirs in pairs[part]]
        better = sum(_better(*pair) for pair in pairs[part])
        count = sum(len(ours) for ours, _ in pairs[part])
        yield f"| {part} | {' | '.join(cells)} | {better} of {count} | {together[part]:.4f} |"


def _better(ours: Runs, theirs: Runs) -> int:
    return sum(one < other for one, other in zip(ours, theirs, strict=True))


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--budget", type=int, default=3_000)
    parser.add_argument("--parts", nargs="+", choices=PARTS[1:], default=PARTS[1:])
    parser.add_argument("--jobs", type=int, default=2)
    arguments = parser.parse_args()
    parts, seeds = [WHOLE, *arguments.parts], range(1, arguments.seeds + 1)
    tasks = [(part, case, seed, arguments.budget) for part in parts for case in CASES for seed in seeds]
    costs = iter(joblib.Parallel(n_jobs=arguments.jobs)(joblib.delayed(cost_found)(*task) for task in tasks))
    found = {part: {case: [next(costs) for _ in seeds] for case in CASES} for part in parts}
    print(f"{arguments.seeds} seeds, {arguments.budget} evaluations each")
    print("\n".join(table(found)))


if __name__ == "__main__":
    main()
