"""Stage 2: with the law fixed, search the equilibrium points that bring the plant to its goal in least time."""

from gpsynth.planning.certificate import certified_clearance
from gpsynth.planning.objective import Objective
from gpsynth.planning.plan_cost import PlanCost
from gpsynth.planning.rounds import Particles, Plan, plan, plans
from gpsynth.planning.settings import PlanSettings
from gpsynth.planning.task import Task
from gpsynth.planning.weights import Weights
from gpsynth.planning.worth import Worth

__all__ = [
    "Objective",
    "Particles",
    "Plan",
    "PlanCost",
    "PlanSettings",
    "Task",
    "Weights",
    "Worth",
    "certified_clearance",
    "plan",
    "plans",
]
