"""`python -m tests.bench.encodings`: every encoding on five problems at equal budgets, with what chance explains.

The same search, starts, functions and numbers for all; matrices use the functions with their published guards. A cell
is the median over the seeds of the cost found, and in brackets the probability of a difference like that from the best
median of its column if there were none (Mann-Whitney U, two-sided, corrected by Holm over the column). An evaluation is
one candidate rolled out from all starts, or computed for all rows of a regression.
"""

import argparse
import sys
from collections.abc import Callable
from types import MappingProxyType
from typing import Any

import numpy as np

import gpsynth as gs
from applications.rosbot.stabilization import poses, stabilization
from examples import cart_pole, landau_oscillator
from gpsynth.batch_cost import BatchCost
from gpsynth.encodings.columns import basic_columns
from gpsynth.encodings.complete_tree import basic_tree
from gpsynth.encodings.layers import basic_layers
from gpsynth.structure_search import Candidate, Cost
from tests.bench import robot_a
from tests.bench.chance import chances
from tests.bench.problems import HELD_OUT

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


def _loop(problem: gs.Problem) -> tuple[Names, Cost]:
    return (problem.features.names, problem.plant.control_names), BatchCost(problem)


def _regression(name: str) -> tuple[Names, Cost]:
    """Squared errors, row by row."""
    rows, wanted, *_ = next(case for case in HELD_OUT if case.name == name).data(seed=1)

    def errors(batch: tuple[Candidate[Any], ...]) -> np.ndarray:
        with np.errstate(all="ignore"):
            values = [each.program(rows, each.values)[:, 0] for each in batch]
            return (np.array(values) - wanted) ** 2

    return (tuple(f"x{k}" for k in range(rows.shape[1])), ("y",)), errors


PROBLEMS: MappingProxyType[str, Callable[[], tuple[Names, Cost]]] = MappingProxyType(
    {
        "ROSbot": lambda: _loop(
            stabilization(poses(gs.stream(1, 7), 16), period=0.1, horizon=20.0, method="heun", stop=False)
        ),
        "robot A": lambda: _loop(robot_a.problem(0.01)),
        "Landau": lambda: _loop(landau_oscillator.oscillation(period=0.1, horizon=15.0)),
        "cart-pole": lambda: _loop(cart_pole.transfer(period=0.02, horizon=5.0)),
        "Jin-1": lambda: _regression("Jin-1"),
    }
)


def costs(
    problem: tuple[Names, Cost], search: Callable[[Names], Any], seeds: int, budget: int
) -> list[float]:
    """The cost that each seed finds."""
    names, cost = problem
    found = [gs.minimize(cost, search(names), seed=seed, budget=budget).cost for seed in range(1, seeds + 1)]
    print(np.round(sorted(found), 3).tolist(), file=sys.stderr, flush=True)
    return found


def main() -> None:
    """Print one row an encoding."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=7)
    parser.add_argument("--budget", type=int, default=1_500)
    arguments = parser.parse_args()
    cells: dict[str, list[str]] = {name: [] for name in SEARCHES}
    for problem in (make() for make in PROBLEMS.values()):
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
