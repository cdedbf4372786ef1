"""`python -m tests.bench.data_parts`: where the time of the data machine goes, 1000 rows, one core.

Alone: what the same instructions take one operation after the other on few rows, when no branch is chosen anew and
everything stays in the first-level cache. What the machine takes beyond that is choosing branches and reaching rows.
"""

import argparse
import cProfile
import pstats
import time
from collections.abc import Callable

import numpy as np

from gpsynth.arrays import Floats
from gpsynth.kernels.data_code import EMIT, OPCODE
from gpsynth.kernels.layout import readonly
from gpsynth.regression import evolution as evolving
from gpsynth.regression.evolution import SIZE, Evolution, Trees, evolve, flat_of
from gpsynth.regression.polish import data_of
from gpsynth.regression.population import Shared, columns_of, evaluate, scores, scoring, share
from gpsynth.regression.state import State
from tests.bench.data_speed import TREES, VARIABLES, Tree, evolved_trees, population_of, random_tree
from tests.bench.measure import machine, median_time, pin

ROWS, REPEATED, LINE = 1000, 20, 2000
FUNCTIONS = frozenset(("add", "sub", "mul", "div", "sin", "cos", "exp", "log", "sqrt"))
BLOCKS = (64, 128, 256, 512, 1024)


def main() -> None:
    """Measure and print."""
    argparse.ArgumentParser(description=__doc__).parse_args()
    pin()
    rng = np.random.default_rng(1)
    print(machine())
    populations = {
        "random, arithmetic": [random_tree(rng, ()) for _ in range(TREES)],
        "random, sine and cosine": [random_tree(rng, ("sin", "cos")) for _ in range(TREES)],
        "evolved, 20 generations": evolved_trees(rng, 20),
    }
    inputs = rng.uniform(0.5, 2.0, (ROWS, VARIABLES))
    columns = readonly(columns_of(inputs))
    print(
        f"\n{'microseconds':26}{'nodes':>7}{'instructions':>14}{'sharing':>9}{'machine':>9}{'alone':>8}{'scores':>8}"
    )
    for label, trees in populations.items():
        print(label.ljust(26) + _parts(trees, inputs, columns))
    print(f"\n{'machine, blocks of':26}" + "".join(f"{block:9}" for block in BLOCKS))
    for label, trees in populations.items():
        shared = share(population_of(trees))
        times = (_microseconds(lambda b=block, s=shared: evaluate(s, columns, b)) for block in BLOCKS)
        print(label.ljust(26) + "".join(f"{time:9.0f}" for time in times))
    names = ("add", "mul", "div", "sqrt", "sin", "exp", "log", "tanh")
    print("\ndistinct nodes of a generation, and those its parents do not have: {} {}".format(*_new(rng)))
    print("shares of 60 generations: " + ", ".join(f"{k} {v:.0%}" for k, v in _shares(rng).items()))
    print("ns per row, alone: " + ", ".join(f"{name} {_alone(OPCODE[name], columns):.3f}" for name in names))


def _parts(trees: list[Tree], inputs: Floats, columns: Floats) -> str:
    whole = population_of(trees)
    shared = share(whole)
    data = scoring(inputs, inputs[:, 0] * inputs[:, 1], np.ones(len(inputs)))
    operations, counts = np.unique(shared.code[:, 0], return_counts=True)
    each = [_alone(op, columns) for op in operations.tolist()]
    alone = float(counts @ each) * ROWS / 1e3
    times = (
        _microseconds(work)
        for work in (lambda: share(whole), lambda: evaluate(shared, columns), lambda: scores(whole, data))
    )
    sharing, running, scored = times
    return f"{len(whole.ops):7}{len(shared.code):14}{sharing:9.0f}{running:9.0f}{alone:8.0f}{scored:8.0f}"


def _alone(operation: int, columns: Floats) -> float:
    """ns per row of an instruction in a long line of its like."""
    code = np.zeros((LINE, 4), dtype=np.int32)
    code[:, 0] = operation
    code[:, 1] = np.arange(LINE) % 2 + (0 if operation == EMIT else VARIABLES)
    code[:, 3] = 1
    shared = Shared(0, np.arange(2, dtype=np.int32), 2, code, np.full(LINE, 1.5), VARIABLES + 2)
    return _microseconds(lambda: evaluate(shared, columns)) * 1e3 / LINE / ROWS


def _new(rng: np.random.Generator) -> tuple[int, int]:
    """What columns kept from one generation to the next could save, after 20 generations."""
    inputs = rng.uniform(-1.0, 1.0, (128, 3))
    y = np.exp(np.sin(3.0 * inputs[:, 0])) * inputs[:, 1] + inputs[:, 2] ** 2
    evolution = Evolution(State(data_of(inputs, y, np.ones(len(y))), FUNCTIONS, rng))
    parents = evolution.scored(evolution.random(SIZE))
    for _ in range(20):
        parents = evolution.next_generation(parents)
    children = evolution.children(parents)
    together = Trees(*(np.concatenate(pair) for pair in zip(parents.trees, children, strict=True)))
    mine, theirs, all_ = (share(flat_of(trees)).nodes for trees in (children, parents.trees, together))
    return mine, all_ - theirs


def _shares(rng: np.random.Generator) -> dict[str, float]:
    """What the parts of an evolution on 1000 rows take of its time."""
    inputs = rng.uniform(-2.0, 2.0, (ROWS, 3))
    y = np.exp(np.sin(3.0 * inputs[:, 0])) * inputs[:, 1] + 0.1 * rng.standard_normal(ROWS)
    evolution = evolve(State(data_of(inputs, y, np.ones(ROWS)), FUNCTIONS, rng))
    next(evolution)
    profile = cProfile.Profile(time.process_time)
    profile.enable()
    for _ in range(60):
        next(evolution)
    profile.disable()
    times = {
        name: row[3]
        for (file, _, name), row in pstats.Stats(profile).stats.items()
        if file == evolving.__file__
    }
    parts = ("children", "scored", "fitted", "survivors", "report", "harvest")
    return {part: times[part] / times["evolve"] for part in parts}


def _microseconds(work: Callable[[], object]) -> float:
    def several() -> None:
        for _ in range(REPEATED):
            work()

    return median_time(several)[0] / REPEATED * 1e6


if __name__ == "__main__":
    main()
