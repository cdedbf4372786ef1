"""Stage 1 on a plant whose answer is known: the double integrator."""

import csv
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.figure import Figure

from gpsynth.encodings.parameters import ParameterSpace
from gpsynth.encodings.tree import TreeEncoding
from gpsynth.encodings.variational import VariationalEncoding
from gpsynth.epochs import Epochs
from gpsynth.errors import FileError, LawError, OptimizerError, ProblemError
from gpsynth.evaluate import Evaluator
from gpsynth.islands import Islands
from gpsynth.objective import costs_of
from gpsynth.planning import PlanCost, Task
from gpsynth.plant import Plant
from gpsynth.problem import Problem
from gpsynth.schedule import Schedule
from gpsynth.structure_search import StructureSearch
from gpsynth.synthesis import FrontEntry, SynthesisResult, synthesize
from gpsynth.variational_ga import VariationalGA
from tests.test_worth import problem as cart_problem

PLANT = Plant(
    lambda x, u: (x.speed, u.force),
    states={"place": "m", "speed": "m/s"},
    controls={"force": ("N", -5.0, 5.0)},
    name="double_integrator",
)
STARTS = [(1.0, 0.0), (-1.0, 0.5), (0.5, -1.0), (0.0, 1.0)]


def quadratic(period: float = 0.05) -> Problem:
    """Minimize the integral of place^2 + force^2: the optimum is the linear law with gains 1 and sqrt 2."""
    return Problem(
        PLANT,
        STARTS,
        goal=(0.0, 0.0),
        tolerance=0.01,
        horizon=10.0,
        period=period,
        running=lambda x, u, goal: (goal.place - x.place) ** 2 + u.force**2,
        stop=False,
    )


def encoding(problem: Problem) -> TreeEncoding:
    names = problem.features.names
    return TreeEncoding(names, ("force",), ("add", "sub", "mul"), ParameterSpace(3, -5.0, 5.0), max_size=9)


def synthesized(seed: int, threads: int = 2):
    problem = quadratic()
    return synthesize(problem, encoding(problem), seed=seed, budget=4_000, tuning=400, threads=threads)


def test_finds_the_linear_quadratic_regulator() -> None:
    result = synthesized(seed=1)
    optimum = np.mean(
        [np.sqrt(2) * (x * x + v * v) + 2 * x * v for x, v in STARTS]
    )  # x' P x of the Riccati equation
    assert result.best.cost == pytest.approx(
        optimum, rel=5e-3
    )  # zero-order hold and a horizon of 10 s cost a little
    gains = [float(result.law([-1.0, 0.0], [0.0, 0.0])[0]), float(result.law([0.0, -1.0], [0.0, 0.0])[0])]
    assert gains == pytest.approx([1.0, np.sqrt(2)], rel=0.1)


@pytest.mark.parametrize("name", ["epochs", "authors' algorithm"])
def test_searches_that_move_a_basis_find_it_too(name: str) -> None:
    problem = quadratic()
    names = problem.features.names
    varied = VariationalEncoding(names, ("force",), space=ParameterSpace(2, -5.0, 5.0), n_variations=3)
    search = {
        "epochs": Epochs(StructureSearch(varied, population=20, offspring=20), every=3),
        "authors' algorithm": VariationalGA(varied, population=30, couples=5, epoch=3, elite=3),
    }[name]
    with pytest.raises(OptimizerError, match=f"a {type(search).__name__} cannot"):
        synthesize(problem, varied, budget=500, search=search, islands=Islands(2))
    result = synthesize(problem, varied, seed=1, budget=500, tuning=200, search=search)
    assert result.evaluations <= 500
    optimum = np.mean([np.sqrt(2) * (x * x + v * v) + 2 * x * v for x, v in STARTS])
    assert result.best.cost == pytest.approx(optimum, rel=0.02)  # on an eighth of the budget above


def test_front_entries_are_scored_on_the_whole_problem() -> None:
    result = synthesized(seed=2)
    evaluator = Evaluator(quadratic())
    for entry in result.front:
        rollouts = evaluator.of_program(entry.law.program, entry.law.parameters[np.newaxis])
        assert costs_of(rollouts).mean() == entry.cost
    assert [entry.cost for entry in result.front] == sorted(
        (entry.cost for entry in result.front), reverse=True
    )
    assert result.table().count("\n") >= len(result.front)


def test_the_front_is_a_table_a_file_and_a_picture(tmp_path) -> None:
    problem = quadratic()
    result = synthesize(problem, encoding(problem), seed=2, budget=450, tuning=0)
    result.to_csv(tmp_path / "front.csv")
    with (tmp_path / "front.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["cost"]) for row in rows] == [entry.cost for entry in result.front]
    assert [row["formulas"] for row in rows] == ["; ".join(entry.law.formulas()) for entry in result.front]
    assert [row["complexity"] for row in result.rows()] == [entry.complexity for entry in result.front]
    axes = result.plot(ax=Figure().add_subplot())
    assert axes.lines[1].get_ydata().tolist() == [entry.cost for entry in result.front]


def test_a_front_without_laws_is_a_sentence_when_its_law_is_wanted() -> None:
    nothing = SynthesisResult((), 700, (), "budget spent")
    with pytest.raises(LawError, match="no law with a finite cost was found in 700 evaluations"):
        nothing.law  # noqa: B018 a property that raises
    assert str(nothing) == nothing.table()
    assert repr(nothing) == "<SynthesisResult of 0 laws>"


def _front(*reached: float, starts: int = 1000) -> SynthesisResult:
    """Laws that cost the less the later they come."""
    times = {"median_time": 1.0, "worst_time": 2.0, "reached_at_least": None}
    entries = [
        FrontEntry(None, cost=9.0 - size, complexity=size, reached=share, starts=starts, **times)
        for size, share in enumerate(reached)
    ]
    return SynthesisResult(tuple(entries), 0, (), "")


def test_the_best_law_arrives_from_all_starts_if_any_does() -> None:
    assert _front(0.2, 1.0, 1.0, 0.999).best.complexity == 2


def test_one_start_more_or_less_decides_nothing_where_no_law_arrives_from_all() -> None:
    """998 of 1000 may be 994 by chance (Clopper-Pearson, 95 %), and is not 992."""
    assert _front(0.998, 0.997, 0.994, 0.992).best.complexity == 2
    assert _front(0.998, 0.997, 0.994, 0.992, starts=100_000).best.complexity == 0


def test_threads_do_not_change_the_result() -> None:
    one, two = synthesized(seed=3, threads=1), synthesized(seed=3, threads=2)
    assert one.law.hash == two.law.hash
    assert one.history == two.history


def test_encoding_must_fit_the_problem() -> None:
    problem = quadratic()
    wrong = TreeEncoding(("place",), ("force",), ("add",))
    with pytest.raises(ProblemError, match=r"the problem has features \('error_place', 'error_speed'\)"):
        synthesize(problem, wrong, budget=100)
    fitting, other = encoding(problem), replace(problem, features=lambda x, target: {"place": x.place})
    for name, settings in {
        "rough problem": {"rough": other},
        "tuned problem": {"tuned": other},
        "problem of trial 1": {"trials": [problem, other]},
    }.items():
        with pytest.raises(ProblemError, match=rf"the {name} has features \('place',\)"):
            synthesize(problem, fitting, budget=450, **settings)


def test_a_search_of_another_encoding_is_an_error() -> None:
    problem = quadratic()
    names = problem.features.names
    varied = VariationalEncoding(names, ("force",), space=ParameterSpace(2))
    for search in (StructureSearch(varied), Epochs(StructureSearch(varied)), VariationalGA(varied)):
        with pytest.raises(
            OptimizerError, match="search is of another encoding, a VariationalEncoding, than the"
        ):
            synthesize(problem, encoding(problem), budget=450, search=search)
    again = VariationalEncoding(names, ("force",), space=ParameterSpace(2))
    few = StructureSearch(varied, population=10, offspring=10)
    assert synthesize(problem, again, budget=30, tuning=0, search=few).front


def _eager() -> PlanCost:
    """A plan that is wanted soon, whatever force it takes."""
    second = replace(quadratic(), running=Problem(PLANT, STARTS, goal=(0.0, 0.0), tolerance=0.1).running)
    soon = replace(second, starts=[[2.0, 0.0]], tolerance=[0.1, 10.0], stop=True)
    return PlanCost((Task(soon, 1.0, [Schedule([[0.0, 0.0]], [1.0])]),), weight=100.0)


def test_plans_weigh_in_when_laws_are_searched(tmp_path) -> None:
    problem = quadratic()
    settings = {"seed": 1, "budget": 1_500, "tuning": 200, "threads": 1}
    calm = synthesize(problem, encoding(problem), **settings)
    eager = synthesize(problem, encoding(problem), plans=_eager(), folder=tmp_path, **settings)
    plans = _eager()
    program, values = eager.law.program, eager.law.parameters[np.newaxis]
    of_plans = plans(program, values).mean()
    of_starts = costs_of(Evaluator(problem).of_program(program, values)).mean()
    assert calm.best.plan_cost is None
    assert eager.best.plan_cost == of_plans
    assert eager.best.cost == pytest.approx(of_starts + 100.0 * of_plans)
    slow = plans(calm.law.program, calm.law.parameters[np.newaxis]).mean()
    assert of_plans < 0.7 * slow
    assert eager.rows()[-1]["plan_cost"] == eager.front[-1].plan_cost
    with pytest.raises(FileError, match="another cost of plans"):
        synthesize(problem, encoding(problem), folder=tmp_path, resume=True, **settings)


def test_plans_of_another_plant_are_an_error() -> None:
    other = Task(cart_problem(), 3.95, [Schedule([[4.0, 0.0]], [1.0])])
    with pytest.raises(ProblemError, match="problem of plan 0 has features"):
        synthesize(quadratic(), encoding(quadratic()), plans=PlanCost((other,)))
