"""`python -m tests.bench.encodings`: every encoding on three problems at equal budgets, with what chance explains.

The same search, starts, functions and numbers for all; matrices use the functions with their published guards. A cell
is the median over the seeds of the cost found, and in brackets the probability of a difference like that from the best
median of its column if there were none (Mann-Whitney U, two-sided, corrected by Holm over the column). An evaluation is
one candidate rolled out from all starts.
"""

import argparse
import sys
from collections.abc import Callable
from statistics import median
from types import MappingProxyType
from typing import Any

import numpy as np
from scipy.stats import mannwhitneyu

import gpsynth as gs
from applications.rosbot.stabilizer import poses, stabilization
from examples import landau_oscillator
from gpsynth.encodings.columns import basic_columns
from gpsynth.encodings.complete_tree import basic_tree
from gpsynth.encodings.layers import basic_layers
from gpsynth.synthesis import BatchCost
from tests.bench import robot_a

PLAIN = ("add", "mul", "max", "min", "neg", "square", "signed_sqrt", "tanh", "sin", "cos", "atan")
NETWORK = (
    "add",
    "nop_mul",
    "max",
    "min",
    "neg",
    "nop_square",
    "signed_sqrt",
    "tanh_half",
    "sin",
    "cos",
    "atan",
)
SPACE = gs.ParameterSpace(8, -10.0, 10.0)
Names = tuple[tuple[str, ...], tuple[str, ...]]  # inputs, outputs


def _counts(names: Names) -> tuple[int, int, int]:
    return len(names[0]), SPACE.count, len(names[1])


def _search(encoding: Any) -> Any:
    return gs.StructureSearch(encoding, population=100, offspring=50)


def _operator(names: Names) -> gs.VariationalEncoding:
    return gs.VariationalEncoding(*names, NETWORK, SPACE, n_variations=12)


def _varied(basis: Callable[..., Any], operations: tuple[str, ...]) -> Callable[[Names], Any]:
    return lambda names: _search(
        gs.VariationalEncoding(*names, operations, SPACE, basis(*_counts(names)), n_variations=12)
    )


SEARCHES: MappingProxyType[str, Callable[[Names], Any]] = MappingProxyType(
    {
        "trees": lambda names: _search(gs.TreeEncoding(*names, PLAIN, SPACE, max_size=20)),
        "Cartesian": lambda names: _search(gs.CartesianEncoding(*names, PLAIN, SPACE)),
        "network operator": lambda names: _search(_operator(names)),
        "network operator, epochs": lambda names: gs.Epochs(_search(_operator(names)), every=8),
        "network operator, authors' GA": lambda names: gs.VariationalGA(
            _operator(names), population=100, couples=16, elite=5
        ),
        "layers of operators": _varied(basic_layers, NETWORK),
        "complete tree": _varied(basic_tree, PLAIN),
        "columns": _varied(basic_columns, PLAIN),
    }
)
PROBLEMS: MappingProxyType[str, Callable[[], gs.Problem]] = MappingProxyType(
    {
        "ROSbot": lambda: stabilization(
            poses(gs.stream(1, 7), 16), period=0.1, horizon=20.0, method="heun", stop=False
        ),
        "robot A": lambda: robot_a.problem(0.01),
        "Landau": lambda: landau_oscillator.oscillation(period=0.1, horizon=15.0),
    }
)


def costs(problem: gs.Problem, search: Callable[[Names], Any], seeds: int, budget: int) -> list[float]:
    """The cost that each seed finds."""
    names = problem.features.names, tuple(problem.plant.control_names)
    cost = BatchCost(problem)
    found = [gs.minimize(cost, search(names), seed=seed, budget=budget).cost for seed in range(1, seeds + 1)]
    print(problem.plant.name, np.round(sorted(found), 3).tolist(), file=sys.stderr, flush=True)
    return found


def chances(found: dict[str, list[float]], reference: str | None = None) -> dict[str, float]:
    """How likely so large a difference is by chance, corrected for their number (Holm 1979).

    From the runs called `reference`, or from those of the best median.
    """
    best = reference or min(found, key=lambda name: median(found[name]))
    raw = {name: mannwhitneyu(found[best], runs).pvalue for name, runs in found.items() if name != best}
    corrected, least = {best: 1.0}, 0.0
    for rank, name in enumerate(sorted(raw, key=raw.__getitem__)):
        least = max(least, min(1.0, (len(raw) - rank) * float(raw[name])))
        corrected[name] = least
    return corrected


def main() -> None:
    """Print one row an encoding."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=7)
    parser.add_argument("--budget", type=int, default=1_500)
    arguments = parser.parse_args()
    cells: dict[str, list[str]] = {name: [] for name in SEARCHES}
    for make in PROBLEMS.values():
        problem = make()
        found = {
            name: costs(problem, search, arguments.seeds, arguments.budget)
            for name, search in SEARCHES.items()
        }
        for name, chance in chances(found).items():
            cells[name].append(f"{np.median(found[name]):.3f} ({chance:.3f})")
    print(f"| | {' | '.join(PROBLEMS)} |\n|---|{'---:|' * len(PROBLEMS)}")
    for name, row in cells.items():
        print(f"| {name} | {' | '.join(row)} |")


if __name__ == "__main__":
    main()
