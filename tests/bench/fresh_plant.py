"""From a plant that nobody has seen to its first evaluated generation, in a process whose kernels are loaded."""

import statistics
import time

import numpy as np

from gpsynth.batch_cost import BatchCost
from gpsynth.encodings.parameters import ParameterSpace
from gpsynth.encodings.tree import TreeEncoding
from gpsynth.optimizers import minimize
from gpsynth.plant import Plant
from gpsynth.problem import Problem
from gpsynth.structure_search import StructureSearch
from tests.bench.measure import REPEATS

STARTS = 8
OPERATIONS = ("add", "sub", "mul", "sin", "tanh")


def fresh_plant_row() -> tuple[str, float]:
    """Label, and the median processor time (s) of plants with different equations, after one that warms up."""
    times = []
    for plant in range(REPEATS + 1):
        begin = time.process_time()
        formulas = _first_generation(plant)
        times.append(time.process_time() - begin)
    label = f"fresh plant to first generation ({formulas} formulas, {STARTS} starts)"
    return label, statistics.median(times[1:])


def _first_generation(seed: int) -> int:
    """Define a pendulum with links and friction of its own, and evaluate a first generation; its number of formulas."""
    rng = np.random.default_rng(seed)
    links, friction = range(1, 2 + seed), rng.uniform(0.1, 1.0)
    plant = Plant(
        lambda x, u: (x.omega, u.torque - friction * x.omega - sum(np.sin(k * x.theta) / k for k in links)),
        states={"theta": "rad", "omega": "rad/s"},
        controls={"torque": ("N m", -2.0, 2.0)},
        angles=("theta",),
        name="pendulum",
    )
    starts = rng.uniform(-1.0, 1.0, (STARTS, 2))
    problem = Problem(plant, starts, goal=(0.0, 0.0), tolerance=0.05, horizon=10.0, period=0.05)
    encoding = TreeEncoding(problem.features.names, plant.control_names, OPERATIONS, ParameterSpace(4))
    search = StructureSearch(encoding)
    found = minimize(BatchCost(problem), search, seed=seed, budget=100_000, callback=lambda _: True)
    return found.evaluations
