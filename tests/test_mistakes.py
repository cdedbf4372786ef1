"""What users get wrong in calls of public functions: each is one sentence that names the argument, and no traceback."""

import numpy as np
import pytest

import gpsynth as gs
from gpsynth import export
from gpsynth.pareto_search import ParetoSearch
from gpsynth.planning import PlanCost, Task, Worth, certified_clearance
from gpsynth.schedule import Schedules

PLANT = gs.Plant(
    lambda x, u, p: (x.v, u.u / p.mass),
    states={"x": "m", "v": "m/s"},
    controls={"u": ("N", -1.0, 1.0)},
    parameters={"mass": ("kg", 0.5, 1.5)},
)
PROBLEM = gs.Problem(PLANT, [[1.0, 0.0]], [0.0, 0.0], tolerance=0.1, horizon=2.0)
ENCODING = gs.TreeEncoding(PROBLEM.features.names, ("u",), ("add", "mul"), gs.ParameterSpace(2))
PROGRAM = gs.trace(lambda f: (f.error_x + 2.0 * f.error_v,), [("f", PROBLEM.features.names)], ("u",))
LAW = gs.Law(PLANT, PROBLEM.features, PROGRAM, np.empty(0))
PATH = gs.simulate(PROBLEM, LAW)
WAIT = gs.Schedule([[1.0, 0.0]], [1.0])
TASK = Task(PROBLEM, 1.0, [WAIT])
TURNED = gs.Problem(
    *(PLANT, PROBLEM.starts, PROBLEM.goal),
    tolerance=0.1,
    horizon=2.0,
    features=lambda x, target: {"error_x": x.x - target.x, "error_v": x.v - target.v},
)
OTHERS = PlanCost([Task(TURNED, 1.0, [WAIT])])
RNG = gs.stream(1)
X = np.linspace(1.0, 2.0, 8).reshape(4, 2)
BOX = ([0.0], [1.0])
COSTS = {"time": lambda r: r.end, "cost": lambda r: r.cost}


def synthesize(**settings):
    return gs.synthesize(PROBLEM, ENCODING, **{"budget": 300, "tuning": 0, **settings})


def tradeoffs(objectives=COSTS, **settings):
    return gs.synthesize_tradeoffs(PROBLEM, ENCODING, objectives, **{"budget": 300, **settings})


def plan(**settings):
    return gs.plan(PROBLEM, LAW, gs.PlanSettings(points=2, particles=16, iterations=1, rounds=1), **settings)


def regress(**settings):
    return gs.regress(X, X[:, 0], **settings)


MISTAKES = {
    "a seed with a fraction": (lambda: gs.stream(1.5), "seed must be an integer of at least 0, not 1.5"),
    "a seed that is a text": (lambda: gs.stream("1"), "seed must be an integer of at least 0, not '1'"),
    "synthesize: seed": (lambda: synthesize(seed=1.5), "seed must be an integer"),
    "synthesize: no budget": (lambda: synthesize(budget=0), "budget must be an integer of at least 1, not 0"),
    "synthesize: budget": (lambda: synthesize(budget=1e3), "budget must be an integer of at least 1, not 1000.0"),
    "synthesize: tuning": (lambda: synthesize(tuning=-1), "tuning must be an integer of at least 0, not -1"),
    "synthesize: threads": (lambda: synthesize(threads=0), "threads must be an integer of at least 1, not 0"),
    "synthesize: swapped": (lambda: gs.synthesize(ENCODING, PROBLEM), "problem must be a Problem, got a TreeEncoding"),
    "synthesize: encoding": (lambda: gs.synthesize(PROBLEM, "tree"), "encoding must be an Encoding, got 'tree'"),
    "synthesize: search": (lambda: synthesize(search="ga"), "search must be a StructureSearch or an Epochs or"),
    "synthesize: one guess": (lambda: synthesize(guesses="error_x"), "guesses are formulas in a list, got 'error_x'"),
    "synthesize: one trial": (lambda: synthesize(trials=PROBLEM), "trials must be a list or a tuple, got a Problem"),
    "synthesize: rough": (lambda: synthesize(rough=LAW), "rough must be a Problem or None, got a Law"),
    "synthesize: folder": (lambda: synthesize(folder=3), "folder must be a str or a PathLike, got 3"),
    "synthesize: callback": (lambda: synthesize(callback=3), "callback must be a function or None, got 3"),
    "synthesize: one task": (lambda: synthesize(plans=TASK), "plans, a PlanCost, must be a PlanCases or None, got a T"),
    "synthesize: tasks": (lambda: synthesize(plans=[TASK]), "plans, a PlanCost, must be a PlanCases or None, got a li"),
    "synthesize: a worth": (lambda: synthesize(plans=Worth([TASK])), "must be a PlanCases or None, got a Worth"),
    "synthesize: a class": (lambda: synthesize(plans=PlanCost), "must be a PlanCases or None, got <class"),
    "synthesize: other plans": (lambda: synthesize(plans=OTHERS), "the features of plan 0 have the names of the prob"),
    "an objective's name": (lambda: synthesize(objective=lambda r: r.coost), "the objective fails on rollouts"),
    "tradeoffs: a list": (lambda: tradeoffs([len, len]), "objectives, functions by name, must be a Mapping"),
    "tradeoffs: threads": (lambda: tradeoffs(threads=0), "threads must be an integer of at least 1, not 0"),
    "tradeoffs: seed": (lambda: tradeoffs(seed=0.5), "seed must be an integer"),
    "tradeoffs: population": (lambda: ParetoSearch(ENCODING, population="9"), "population must be an integer of at"),
    "tradeoffs: a share": (lambda: ParetoSearch(ENCODING, moved="0.1"), "moved must be a number, got '0.1'"),
    "tradeoffs: NaN": (lambda: ParetoSearch(ENCODING, fresh=np.nan), "crossover, moved and fresh are shares of 1"),
    "regress: no target": (lambda: gs.regress(X, []), "inputs have 4 rows and the target has 0"),
    "problem: no horizon": (lambda: gs.Problem(PLANT, [[1, 0]], [0, 0], tolerance=1, horizon=[]), "shape (0,)"),
    "a bound": (lambda: gs.Evaluator(PROBLEM).of_program(PROGRAM, [], bound="1"), "the bound must be a number"),
    "refit: swapped": (lambda: gs.refit(LAW, PROBLEM), "problem must be a Problem, got a Law"),
    "refit: plans": (lambda: gs.refit(PROBLEM, LAW, plans="all"), "must be a PlanCases or None, got 'all'"),
    "refit: other plans": (lambda: gs.refit(PROBLEM, LAW, plans=OTHERS), "of plan 0 have the names of the problem's"),
    "worth: one task": (lambda: Worth(TASK), "tasks of the worth of a law must be a list or a tuple, got a Task"),
    "worth: problems": (lambda: Worth([PROBLEM]), "a task must be a Task, got a Problem"),
    "worth: settings": (lambda: Worth([TASK], 5), "settings must be a PlanSettings, got 5"),
    "worth: a program": (lambda: Worth([TASK])(PROGRAM), "law must be a Law, got a Program"),
    "schedule: split": (lambda: gs.Schedule([], []).split(2), "shapes (0,) and (0,); expected (k, n) and (k,)"),
    "schedule: no points": (lambda: gs.Schedule(np.empty((0, 2)), []).split(2), "has none that could be split"),
    "schedule: count": (lambda: WAIT.split("2"), "the count of points of a schedule must be an integer of at least 0"),
    "schedule: after": (lambda: WAIT.after("1"), "the time elapsed of a schedule must be a number, got '1'"),
    "schedules: shapes": (lambda: Schedules(X, X), "shapes (4, 2) and (4, 2); expected (N, k, n) and (N, k)"),
    "schedules: texts": (lambda: Schedules("a", "b"), "the points of a schedule must be numbers in rows of equal"),
    "refit: budget": (lambda: gs.refit(PROBLEM, LAW, budget=0), "budget must be an integer of at least 1, not 0"),
    "plan: swapped": (lambda: gs.plan(LAW, PROBLEM), "problem must be a Problem, got a Law"),
    "plan: seed": (lambda: gs.plan(PROBLEM, LAW, seed=1.5), "seed must be an integer of at least 0, not 1.5"),
    "plan: settings": (lambda: gs.plan(PROBLEM, LAW, 5), "settings must be a PlanSettings, got 5"),
    "plan: initial": (lambda: plan(initial=3), "the schedules to begin with, must be a list or a tuple or a Schedules"),
    "plan: region": (lambda: plan(region=([0, 0],)), "highest points, has shape (1, 2); expected (2, 2)"),
    "plan: a region's states": (lambda: plan(region=([0], [1])), "has shape (2, 1); expected (2, 2)"),
    "plan: no budget": (lambda: plan(budget=0), "budget must be a finite time above 0 s, not 0"),
    "plan: a NaN": (lambda: plan(budget=np.nan), "budget must be a finite time above 0 s, not nan"),
    "plan: a text": (lambda: plan(budget="1"), "budget must be a number, got '1'"),
    "plan: path": (lambda: plan(path=3), "path must be a tuple, got 3"),
    "plan: threads": (lambda: plan(threads=0), "threads must be an integer of at least 1, not 0"),
    "plan: callback": (lambda: plan(callback=3), "callback must be a function or None, got 3"),
    "proof: swapped": (lambda: certified_clearance(PATH, PROBLEM), "problem must be a Problem, got a Trajectory"),
    "proof: row": (lambda: certified_clearance(PROBLEM, PATH, row=1), "row is 1; the problem has 1 rows"),
    "plan: points": (lambda: gs.PlanSettings(points=1.5), "points of a plan must be an integer of at least 1"),
    "plan: dwell": (lambda: gs.PlanSettings(dwell=3.0), "dwell, (shortest, longest) in s, has shape ()"),
    "plan: optimizer": (lambda: gs.PlanSettings(optimizer="pso"), "optimizer of a plan must be one of ('clerc',"),
    "plan: a weight": (lambda: gs.PlanSettings(alpha=np.nan), "alpha of a plan must be finite and at least 0"),
    "simulate: swapped": (lambda: gs.simulate(LAW, PROBLEM), "problem must be a Problem, got a Law"),
    "simulate: row": (lambda: gs.simulate(PROBLEM, LAW, row=0.5), "row must be an integer of at least 0, not 0.5"),
    "simulate: horizon": (lambda: gs.simulate(PROBLEM, LAW, horizon="2"), "the horizon must be a number, got '2'"),
    "simulate: schedule": (lambda: gs.simulate(PROBLEM, LAW, schedule=3), "schedule must be a Schedule or None, got 3"),
    "assess: swapped": (lambda: gs.assess(PROBLEM, LAW), "law must be a Law, got a Problem"),
    "assess: stress": (lambda: gs.assess(LAW, PROBLEM, 0.1), "stress must be a Stress, got 0.1"),
    "stress: noise": (lambda: gs.Stress(noise=-1.0), "noise is a standard deviation of at least 0, got -1.0"),
    "stress: noise of one": (lambda: gs.Stress(noise=[0.1, -0.1]), "noise is a standard deviation of at least 0"),
    "stress: limits": (lambda: gs.Stress(limits=0.5), "limits has shape (); expected (any number,)"),
    "draws: one delay": (lambda: gs.random_draws(PLANT, RNG, 3, delay=0.1), "(shortest, longest) in s, has shape ()"),
    "draws: delay falls": (lambda: gs.random_draws(PLANT, RNG, 3, delay=(2, 1)), "0 <= shortest <= longest, got (2"),
    "draws: a seed": (lambda: gs.random_draws(PLANT, 5, 3), "rng must be a Generator, got 5"),
    "draws: none": (lambda: gs.random_draws(PLANT, RNG, 0), "count must be an integer of at least 1, not 0"),
    "draws: a problem": (lambda: gs.random_draws(PROBLEM, RNG, 3), "plant must be a Plant, got a Problem"),
    "crossed: no draws": (lambda: gs.crossed([[0.0, 0.0]], 3), "draws must be a Draws, got 3"),
    "regress: seed": (lambda: regress(seed=1.5), "seed must be an integer of at least 0, not 1.5"),
    "regress: budget": (lambda: regress(evaluations=1e6), "evaluations must be an integer of at least 1"),
    "regress: too few names": (lambda: regress(names=("a",)), "expected 2 names of columns, got 1: a"),
    "regress: one text": (lambda: regress(names="ab"), "names must be names in a tuple, got 'ab'"),
    "regress: a wrong name": (lambda: regress(names=("a", "b c")), "'b c' is not a name: a letter or _, then"),
    "regress: the same name": (lambda: regress(names=("a", "a")), "need different names; a is there twice"),
    "regress: target's name": (lambda: regress(names=("y", "a")), "need different names; y is there twice"),
    "regress: functions": (lambda: regress(functions="add"), "functions must be names in a tuple, got 'add'"),
    "regress: all inputs": (lambda: regress(use_all_inputs=1), "use_all_inputs must be a bool, got 1"),
    "regress: constant": (lambda: gs.regress(X, [1] * 4, use_all_inputs=True), "the target is constant"),
    "regress: complex": (lambda: gs.regress(X * 1j, X[:, 0]), "inputs must hold numbers"),
    "law: order": (lambda: gs.Law(PROBLEM, PROBLEM.features, PROGRAM, []), "plant of a law must be a Plant, got"),
    "law: parameters": (lambda: gs.Law(PLANT, PROBLEM.features, PROGRAM, "a"), "parameters of a law are numbers"),
    "law: called with texts": (lambda: LAW("a", [0.0, 0.0]), "x and target must hold numbers, got 'a'"),
    "program_to_python: keyword": (lambda: export.program_to_python(PROGRAM, "lambda"), "'lambda' cannot name a"),
    "program_to_python: import": (lambda: export.program_to_python(PROGRAM, "math"), "'math' cannot name a Python"),
    "program_to_c: a law": (lambda: export.program_to_c(LAW), "program must be a Program, got a Law"),
    "to_c: a program": (lambda: export.to_c(PROGRAM), "law must be a Law, got a Program"),
    "to_sympy: a text": (lambda: export.to_sympy("x"), "must be a Law or a Program, got 'x'"),
    "tree: operations": (lambda: gs.TreeEncoding(("x",), ("u",), "add"), "operations must be one name or more in a"),
    "tree: space": (lambda: gs.TreeEncoding(("x",), ("u",), ("add",), 4), "space of an encoding must be a Para"),
    "template: holes": (lambda: gs.TemplateEncoding("tree", len, ("u",)), "holes of a template are an encoding"),
    "parameters: count": (lambda: gs.ParameterSpace(1.5), "count of parameters must be an integer of at least 0"),
    "rules: a list": (lambda: gs.Rules(limits=["tanh"]), "limits of Rules must be a Mapping, got a list"),
    "a search's encoding": (lambda: gs.StructureSearch(3), "encoding must be an Encoding, got 3"),
    "a search's population": (
        lambda: gs.StructureSearch(ENCODING, population=1.5),
        "population must be an integer of at least 1, not 1.5",
    ),
    "a search's shares": (lambda: gs.StructureSearch(ENCODING, youth=2), "youth must be from 0 to 1, not 2"),
    "an angle": (lambda: gs.wrap_angle("a"), "wrap_angle takes numbers, arrays or traced values, not 'a'"),
    "epochs: an encoding": (lambda: gs.Epochs(ENCODING), "search must be a StructureSearch, got a TreeEncoding"),
    "optimizer: size": (lambda: gs.PSO(*BOX, size=1.5), "size must be an integer of at least 1, not 1.5"),
    "optimizer: sigma": (lambda: gs.CMAES(*BOX, sigma="wide"), "sigma must be a number, got 'wide'"),
    "optimizer: box": (lambda: gs.PSO("a", "b"), "lower and upper must be vectors of numbers"),
    "minimize: cost": (lambda: gs.minimize(3, gs.PSO(*BOX), seed=1, budget=99), "cost must be a function, got 3"),
    "minimize: optimizer": (lambda: gs.minimize(len, gs.PSO, seed=1, budget=99.0), "budget must be an integer"),
    "minimize: a class": (lambda: gs.minimize(len, 3, seed=1, budget=99), "optimizer must be a search such as"),
    "problem: step": (lambda: gs.Problem(PLANT, X, X[0], tolerance=1, step=1e-300), "has at most 1000000 steps"),
    "plant: angles": (lambda: gs.Plant(len, PLANT.states, PLANT.controls, angles=3), "must be different states out of"),
    "units: a program": (lambda: gs.check_units(PROGRAM), "must be a Law or a Plant, got a Program"),
    "bind: a text": (lambda: gs.bind(PROGRAM, ["a"]), "a parameter must be a number, got 'a'"),
    "compose: a law": (lambda: gs.compose(PROGRAM, LAW), "inner must be a Program, got a Law"),
    "inline: one value": (lambda: gs.inline(PROGRAM, 1.0), "values must be a list or a tuple or a Vector, got 1.0"),
    "evaluator: a law": (lambda: gs.Evaluator(LAW), "problem must be a Problem, got a Law"),
    "objective: no function": (lambda: gs.Objective(3), "an objective must be a function, got 3"),
}  # fmt: skip


@pytest.mark.parametrize(("call", "sentence"), MISTAKES.values(), ids=list(MISTAKES))
def test_a_mistake_is_one_sentence(call, sentence):
    with pytest.raises(gs.GpsynthError) as raised:
        call()
    assert sentence in str(raised.value)
    assert "\n" not in str(raised.value)


@pytest.mark.parametrize("name", ["a b", "1a", "null", "jac", "hess", "a__b", "_a", "", 3])
def test_a_name_that_casadi_does_not_take_is_one_sentence(name):
    pytest.importorskip("casadi", reason="casadi is not installed")
    with pytest.raises(gs.GpsynthError, match="cannot name a casadi function"):
        LAW.to_casadi(name)


def test_names_that_casadi_takes_are_left_alone():
    pytest.importorskip("casadi", reason="casadi is not installed")
    assert LAW.to_casadi("a_b_2").name() == "a_b_2"
