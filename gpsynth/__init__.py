"""Genetic programming synthesis of feedback laws, and optimal control by moving their equilibrium points."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from gpsynth.errors import GpsynthError

if TYPE_CHECKING:
    from gpsynth.builder import Builder, bind, compose, simplify
    from gpsynth.draws import Draws, crossed, random_draws
    from gpsynth.encodings.cartesian import CartesianEncoding
    from gpsynth.encodings.parameters import ParameterSpace
    from gpsynth.encodings.rules import Rules
    from gpsynth.encodings.template import TemplateEncoding
    from gpsynth.encodings.tree import TreeEncoding
    from gpsynth.encodings.variational import VariationalEncoding
    from gpsynth.epochs import Epochs
    from gpsynth.evaluate import Evaluator
    from gpsynth.islands import Islands
    from gpsynth.law import Law
    from gpsynth.objective import Objective
    from gpsynth.obstacles import Obstacles
    from gpsynth.optimizers import CMAES, NSGA2, PSO, DifferentialEvolution, minimize
    from gpsynth.planning import Plan, PlanSettings, plan
    from gpsynth.plant import Plant
    from gpsynth.problem import Problem
    from gpsynth.program import Program
    from gpsynth.refitting import refit
    from gpsynth.regression.entry import regress
    from gpsynth.regression.estimator import SymbolicRegressor
    from gpsynth.regression.result import RegressionResult
    from gpsynth.rollouts import Rollouts
    from gpsynth.schedule import Schedule
    from gpsynth.seeds import stream
    from gpsynth.simulation import Trajectory, simulate
    from gpsynth.structure_search import StructureSearch
    from gpsynth.synthesis import SynthesisResult, synthesize
    from gpsynth.tracing import inline, trace, where, wrap_angle
    from gpsynth.tradeoffs import Tradeoffs, synthesize_tradeoffs
    from gpsynth.units import UnitReport, check_units
    from gpsynth.variational_ga import VariationalGA
    from gpsynth.verify.robustness import Robustness, assess
    from gpsynth.verify.stress import Stress

__version__ = "0.1.0"

_HOME = {
    "Builder": "builder",
    "bind": "builder",
    "compose": "builder",
    "simplify": "builder",
    "Draws": "draws",
    "crossed": "draws",
    "random_draws": "draws",
    "CartesianEncoding": "encodings.cartesian",
    "ParameterSpace": "encodings.parameters",
    "Rules": "encodings.rules",
    "TemplateEncoding": "encodings.template",
    "TreeEncoding": "encodings.tree",
    "VariationalEncoding": "encodings.variational",
    "Epochs": "epochs",
    "Evaluator": "evaluate",
    "Islands": "islands",
    "Rollouts": "rollouts",
    "Law": "law",
    "Objective": "objective",
    "CMAES": "optimizers",
    "NSGA2": "optimizers",
    "PSO": "optimizers",
    "DifferentialEvolution": "optimizers",
    "inline": "tracing",
    "minimize": "optimizers",
    "Plan": "planning",
    "PlanSettings": "planning",
    "plan": "planning",
    "Plant": "plant",
    "Obstacles": "obstacles",
    "Problem": "problem",
    "Program": "program",
    "RegressionResult": "regression.result",
    "SymbolicRegressor": "regression.estimator",
    "regress": "regression.entry",
    "refit": "refitting",
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
    "VariationalGA": "variational_ga",
    "Robustness": "verify.robustness",
    "assess": "verify.robustness",
    "Stress": "verify.stress",
    "Tradeoffs": "tradeoffs",
    "synthesize_tradeoffs": "tradeoffs",
    "UnitReport": "units",
    "check_units": "units",
}  # public name -> module; loaded on first use, so that `import gpsynth` does not wait for numba

__all__ = [
    "CMAES",
    "NSGA2",
    "PSO",
    "Builder",
    "CartesianEncoding",
    "DifferentialEvolution",
    "Draws",
    "Epochs",
    "Evaluator",
    "GpsynthError",
    "Islands",
    "Law",
    "Objective",
    "Obstacles",
    "ParameterSpace",
    "Plan",
    "PlanSettings",
    "Plant",
    "Problem",
    "Program",
    "RegressionResult",
    "Robustness",
    "Rollouts",
    "Rules",
    "Schedule",
    "Stress",
    "StructureSearch",
    "SymbolicRegressor",
    "SynthesisResult",
    "TemplateEncoding",
    "Tradeoffs",
    "Trajectory",
    "TreeEncoding",
    "UnitReport",
    "VariationalEncoding",
    "VariationalGA",
    "__version__",
    "assess",
    "bind",
    "check_units",
    "compose",
    "crossed",
    "inline",
    "minimize",
    "plan",
    "random_draws",
    "refit",
    "regress",
    "simplify",
    "simulate",
    "stream",
    "synthesize",
    "synthesize_tradeoffs",
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
