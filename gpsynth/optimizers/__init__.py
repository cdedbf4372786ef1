"""Ask/tell optimizers, one algorithm a file, and the one loop that drives them."""

from gpsynth.optimizers.cmaes import CMAES, CMAESState
from gpsynth.optimizers.differential_evolution import DifferentialEvolution, DifferentialEvolutionState
from gpsynth.optimizers.loop import Progress, Result, minimize
from gpsynth.optimizers.nsga2 import NSGA2, NSGA2State
from gpsynth.optimizers.protocol import Optimizer, Search
from gpsynth.optimizers.pso import PSO, PSOState, rescore

__all__ = [
    "CMAES",
    "NSGA2",
    "PSO",
    "CMAESState",
    "DifferentialEvolution",
    "DifferentialEvolutionState",
    "NSGA2State",
    "Optimizer",
    "PSOState",
    "Progress",
    "Result",
    "Search",
    "minimize",
    "rescore",
]
