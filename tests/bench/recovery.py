"""`python -m tests.bench.recovery`: how often formulas are found again, beside pyoperon in the same run, one core.

Solved: test R2 > 0.999. Exact: 1 - R2 < 1e-9 on the test rows. Sizes are nodes; pyoperon's trees have a free factor at
each variable, which is not counted. The budget is processor time, so the figures are those of one machine.
"""

import argparse
import math
import os
import statistics
import time
import warnings
from collections.abc import Callable, Iterator
from importlib import metadata, util
from typing import NamedTuple

import numpy as np

from gpsynth.arrays import Floats
from tests.bench.measure import pin
from tests.bench.problems import HELD_OUT, SUITE, Case

SOLVED, EXACT = 1e-3, 1e-9
SYMBOLS = "add,sub,mul,div,sin,cos,exp,log,sqrt,constant,variable"


class Outcome(NamedTuple):
    """One run."""

    error: float  # 1 - R2 on the test rows
    size: int
    seconds: float  # of processor time


Method = Callable[[Case, int, float], Outcome]


def ours(case: Case, seed: int, seconds: float) -> Outcome:
    """gpsynth.regress."""
    from gpsynth.regression.entry import regress

    inputs, y, test_inputs, expected = case.data(seed)
    begin = time.process_time()
    result = regress(inputs, y, seed=seed, seconds=seconds, evaluations=10**12)
    taken = time.process_time() - begin
    return Outcome(_error(result.predict(test_inputs), expected), result.best.size, taken)


def operon(case: Case, seed: int, seconds: float) -> Outcome:
    """pyoperon's estimator, as in the comparison: 1000 trees of at most 50 nodes, 5 iterations of its own LM."""
    from pyoperon.sklearn import SymbolicRegressor

    inputs, y, test_inputs, expected = case.data(seed)
    model = SymbolicRegressor(
        allowed_symbols=SYMBOLS,
        population_size=1000,
        optimizer_iterations=5,
        max_length=50,
        generations=10**6,
        max_evaluations=10**9,
        n_threads=1,
        warm_start=True,
    )
    begin, taken, parts = time.process_time(), 0.0, 0
    while (
        taken < 0.95 * seconds
    ):  # max_time is by the clock on the wall, which a busy machine does not give us
        model.set_params(max_time=math.ceil(seconds - taken), random_state=seed + 1000 * parts)
        model.fit(inputs, y)
        taken, parts = time.process_time() - begin, parts + 1
    return Outcome(_error(model.predict(test_inputs), expected), model.model_.Length, taken)


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--seconds", type=float, default=10.0, help="processor time of each run")
    parser.add_argument("--held-out", action="store_true", help="the other problems of the same kinds")
    parser.add_argument("--only", default="", help="names of problems, separated by commas")
    parser.add_argument("--without-peers", action="store_true")
    options = parser.parse_args()
    pin()
    methods: dict[str, Method] = {"gpsynth": ours}
    if not options.without_peers and util.find_spec("pyoperon"):
        methods["pyoperon"] = operon
    versions = ", ".join(
        f"{name} {metadata.version(name)}" for name in ("numpy", "numba", *list(methods)[1:])
    )
    print(f"{options.seconds:g} s of processor time, {options.seeds} seeds, {versions}")
    print(f"{'':18}" + "".join(f"{name + ': solved, exact, 1 - R2, size, s':>46}" for name in methods))
    chosen = [
        case
        for case in (HELD_OUT if options.held_out else SUITE)
        if not options.only or case.name in options.only.split(",")
    ]
    runs: dict[str, list[Outcome]] = {name: [] for name in methods}
    for case in chosen:
        print(f"{case.name:18}", end="", flush=True)
        for name, method in methods.items():
            outcomes = list(_outcomes(method, case, options.seeds, options.seconds))
            runs[name] += outcomes
            print(f"{_summary(outcomes):>46}", end="", flush=True)
        print()
    for name, outcomes in runs.items():
        solved, exact = _share(outcomes, SOLVED), _share(outcomes, EXACT)
        print(f"{name}: solved {solved:.0%}, exact {exact:.0%} of {len(outcomes)} runs")


def _outcomes(method: Method, case: Case, seeds: int, seconds: float) -> Iterator[Outcome]:
    for seed in range(seeds):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield method(case, seed, seconds)


def _summary(outcomes: list[Outcome]) -> str:
    solved = sum(outcome.error < SOLVED for outcome in outcomes)
    exact = sum(outcome.error < EXACT for outcome in outcomes)
    error, size, seconds = (statistics.median(column) for column in zip(*outcomes, strict=True))
    return f"{solved:2d} {exact:2d} of {len(outcomes)}  {error:8.1e} {size:5.0f} {seconds:5.1f}"


def _share(outcomes: list[Outcome], bound: float) -> float:
    return sum(outcome.error < bound for outcome in outcomes) / len(outcomes)


def _error(found: Floats, expected: Floats) -> float:
    error = float(np.sum((found - expected) ** 2) / np.sum((expected - expected.mean()) ** 2))
    return error if error >= 0.0 else float("inf")  # NaN


if __name__ == "__main__":
    for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ.setdefault(variable, "1")
    main()
