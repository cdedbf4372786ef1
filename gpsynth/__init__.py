"""Genetic programming synthesis of feedback laws, and optimal control by moving their equilibrium points."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from gpsynth.errors import GpsynthError

if TYPE_CHECKING:
    from gpsynth.builder import Builder, bind, compose, simplify
    from gpsynth.encodings.cartesian import CartesianEncoding
    from gpsynth.encodings.network_operator import NetworkOperatorEncoding
    from gpsynth.encodings.parameters import ParameterSpace
    from gpsynth.encodings.tree import TreeEncoding
    from gpsynth.evaluate import Evaluator, Rollouts
    from gpsynth.law import Law
    from gpsynth.optimizers import CMAES, NSGA2, PSO, DifferentialEvolution, minimize
    from gpsynth.planning import Plan, PlanSettings, plan
    from gpsynth.plant import Plant
    from gpsynth.problem import Obstacles, Problem
    from gpsynth.program import Program
    from gpsynth.regression.entry import regress
    from gpsynth.regression.estimator import SymbolicRegressor
    from gpsynth.regression.result import RegressionResult
    from gpsynth.schedule import Schedule
    from gpsynth.seeds import stream
    from gpsynth.simulation import Trajectory, simulate
    from gpsynth.structure_search import StructureSearch
    from gpsynth.synthesis import SynthesisResult, synthesize
    from gpsynth.tracing import trace, where, wrap_angle

__version__ = "0.1.0"

_HOME = {
    "Builder": "builder",
    "bind": "builder",
    "compose": "builder",
    "simplify": "builder",
    "CartesianEncoding": "encodings.cartesian",
    "NetworkOperatorEncoding": "encodings.network_operator",
    "ParameterSpace": "encodings.parameters",
    "TreeEncoding": "encodings.tree",
    "Evaluator": "evaluate",
    "Rollouts": "evaluate",
    "Law": "law",
    "CMAES": "optimizers",
    "NSGA2": "optimizers",
    "PSO": "optimizers",
    "DifferentialEvolution": "optimizers",
    "minimize": "optimizers",
    "Plan": "planning",
    "PlanSettings": "planning",
    "plan": "planning",
    "Plant": "plant",
    "Obstacles": "problem",
    "Problem": "problem",
    "Program": "program",
    "RegressionResult": "regression.result",
    "SymbolicRegressor": "regression.estimator",
    "regress": "regression.entry",
    "Schedule": "schedule",
    "stream": "seeds",
    "Trajectory": "simulation",
    "simulate": "simulation",
    "StructureSearch": "structure_search",
    "SynthesisResult": "synthesis",
    "synthesize": "synthesis",
    "trace": "tracing",
    "where": "tracing",
    "wrap_angle": "tracing",
}  # public name -> module; loaded on first use, so that `import gpsynth` does not wait for numba

__all__ = [
    "CMAES",
    "NSGA2",
    "PSO",
    "Builder",
    "CartesianEncoding",
    "DifferentialEvolution",
    "Evaluator",
    "GpsynthError",
    "Law",
    "NetworkOperatorEncoding",
    "Obstacles",
    "ParameterSpace",
    "Plan",
    "PlanSettings",
    "Plant",
    "Problem",
    "Program",
    "RegressionResult",
    "Rollouts",
    "Schedule",
    "StructureSearch",
    "SymbolicRegressor",
    "SynthesisResult",
    "Trajectory",
    "TreeEncoding",
    "__version__",
    "bind",
    "compose",
    "minimize",
    "plan",
    "regress",
    "simplify",
    "simulate",
    "stream",
    "synthesize",
    "trace",
    "where",
    "wrap_angle",
]


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module 'gpsynth' has no attribute {name!r}")
    return getattr(import_module(f"gpsynth.{_HOME[name]}"), name)


def __dir__() -> list[str]:
    return sorted(__all__)
