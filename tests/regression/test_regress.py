"""`regress`: easy formulas come back, the same seed gives the same result, and what does not fit is said."""

import numpy as np
import pytest

import gpsynth
from gpsynth.errors import RegressionError
from gpsynth.export import to_sympy
from gpsynth.regression.dense import polynomials
from gpsynth.regression.front import Candidate
from gpsynth.regression.joint import choose, joined
from gpsynth.regression.polish import data_of
from gpsynth.regression.state import State
from gpsynth.regression.targets import plain

RNG = np.random.default_rng(9)
ROWS = RNG.uniform(0.5, 3.0, (60, 3))
A, B, C = ROWS.T
EASY = {
    "polynomial": A**3 - 2 * B,
    "wave": 1.5 * A * np.sin(B) + 0.5,
    "quotient": A / (1 + B * C),
    "root": np.sqrt(A * A + B * B),
    "power": 3 * A * np.sqrt(B) / C,
    "inner numbers": np.exp(-0.37 * A),
}


@pytest.mark.parametrize("name", EASY)
def test_easy_formulas_are_found_exactly(name: str) -> None:
    result = gpsynth.regress(ROWS, EASY[name], evaluations=30_000_000)
    assert result.best.error < 1e-20
    assert result.best.size <= 15
    assert result.predict(ROWS) == pytest.approx(EASY[name], rel=1e-9)


def test_the_same_seed_gives_the_same_bits() -> None:
    y = np.sin(A * B) + RNG.normal(size=60)
    first, second = (gpsynth.regress(ROWS, y, evaluations=40_000, seed=3) for _ in range(2))
    assert first.front == second.front
    assert first.history == second.history


def test_the_order_of_rows_does_not_matter_and_weights_mean_repetition() -> None:
    y = A + np.cos(B) + 0.1 * RNG.normal(size=60)
    weights = RNG.integers(0, 3, 60).astype(float)
    repeated = RNG.permutation(np.repeat(np.arange(60), weights.astype(int)))
    weighted = gpsynth.regress(ROWS, y, weights=weights, evaluations=40_000)
    again = gpsynth.regress(ROWS[repeated], y[repeated], evaluations=40_000)
    assert weighted.front == again.front


def test_the_front_falls_in_error_as_it_rises_in_size() -> None:
    y = np.exp(np.sin(A)) * B + 0.01 * RNG.normal(size=60)
    result = gpsynth.regress(ROWS, y, evaluations=300_000, names=("a", "b", "c"))
    sizes, errors = [f.size for f in result.front], [f.error for f in result.front]
    assert sizes == sorted(sizes)
    assert errors == sorted(errors, reverse=True)
    for item in result.front:
        left = item.program(ROWS)[:, 0] - y
        assert item.error == pytest.approx(float(left @ left / np.sum((y - y.mean()) ** 2)), rel=1e-9)
    assert len(result.table().splitlines()) == len(result.front) + 1


def test_the_choice_is_the_shortest_description() -> None:
    small = Candidate(("variable", 0), 1e-2, 1)
    barely_better = Candidate(("add", ("variable", 0), ("variable", 1)), 0.0099, 9)
    much_better = Candidate(("mul", ("variable", 0), ("variable", 1)), 1e-6, 9)
    assert choose(joined([[small, barely_better]]), 30).parts == (small,)
    assert choose(joined([[small, much_better]]), 30).parts == (much_better,)


def test_a_search_whose_time_is_up_does_not_begin() -> None:
    assert gpsynth.regress(ROWS, EASY["wave"], seconds=1e-9).evaluations == 1


@pytest.mark.parametrize("off", [0.0, 1e-3])
def test_a_polynomial_is_one_on_all_rows(off: float) -> None:
    inputs = np.random.default_rng(6).uniform(-1.0, 1.0, (3000, 3))
    y = inputs[:, 0] ** 3 - 2.0 * inputs[:, 1] * inputs[:, 2]
    y[1234] += off
    state = State(data_of(inputs, y, np.ones(3000)), frozenset(("add", "mul")), np.random.default_rng(0))
    polynomials(state, [plain(y)])
    assert [source for _, source, _ in state.found][1:] == ([] if off else ["polynomial of y"])
    assert state.done == (off == 0.0)


def test_a_result_goes_to_the_exporters() -> None:
    result = gpsynth.regress(
        ROWS, EASY["wave"], names=("a", "b", "c"), target_name="u", evaluations=2_000_000
    )
    (expression,) = to_sympy(result.program, expanded=True).expressions
    assert {str(symbol) for symbol in expression.free_symbols} == {"a", "b"}
    assert result.formulas()[-1].startswith("u = ")


class _Frame(np.ndarray):
    """An array with the names of its columns, as far as a DataFrame is one."""

    columns = ("speed", "load")


def test_a_data_frame_gives_its_columns_their_names() -> None:
    result = gpsynth.regress(ROWS[:, :2].view(_Frame), 2.0 * A + B)
    assert result.program.inputs == ("speed", "load")
    assert repr(result) == f"<RegressionResult of {len(result.front)} formulas, best: {result.best}>"


def test_a_constant_target_is_its_value() -> None:
    result = gpsynth.regress(ROWS, np.full(60, 2.5))
    assert result.predict(ROWS) == pytest.approx(np.full(60, 2.5))


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"target": np.ones(3)}, "60 rows and the target has 3"),
        ({"inputs": np.ones(60)}, r"shape \(60,\)"),
        ({"target": np.full(60, np.nan)}, "finite"),
        ({"functions": ("add", "gamma")}, "not gamma"),
        ({"weights": -np.ones(60)}, "60 weights"),
        ({"names": ("a", "b")}, "expected 3 names of columns, got 2: a, b"),
        ({"names": ("a", "b", "__import__('os')")}, r"\"__import__\('os'\)\" is not a name"),
        ({"evaluations": 0}, "evaluations must be an integer of at least 1, not 0"),
    ],
)
def test_what_does_not_fit_is_one_sentence(settings, message) -> None:
    arguments = {"inputs": ROWS, "target": A, **settings}
    with pytest.raises(RegressionError, match=message):
        gpsynth.regress(arguments.pop("inputs"), arguments.pop("target"), **arguments)


@pytest.mark.parametrize(
    ("inputs", "target"),
    [
        (np.ones((10, 2)), np.arange(10.0)),
        (np.array([[1.0, 2.0], [2.0, 1.0]]), np.array([3.0, 5.0])),
        (np.repeat([[1.0, 2.0], [2.0, 1.0]], 5, axis=0), np.repeat([3.0, 5.0], 5)),
        (np.array([[1.0, 2.0], [2.0, 1.0], [3.0, 7.0]]) * 1e45, np.array([3.0, 5.0, 7.0]) * 1e45),
        (np.random.default_rng(2).normal(size=(300, 2)) * 1e40, np.random.default_rng(3).normal(size=300)),
    ],
    ids=["constant columns", "two rows", "two different rows", "huge numbers", "huge powers"],
)
def test_data_that_say_little_give_a_formula_all_the_same(inputs, target):
    result = gpsynth.regress(inputs, target, evaluations=20_000)
    assert np.all(np.isfinite(result.predict(inputs)))


def test_a_seed_that_is_none_is_named():
    with pytest.raises(RegressionError, match="an integer of at least 0, not -1"):
        gpsynth.regress(np.ones((3, 1)), np.ones(3), seed=-1)


@pytest.mark.parametrize("functions", [("add", "mul", "sin"), ("mul", "sin")])
def test_every_formula_reads_all_inputs_where_that_is_asked_for(functions):
    rng = np.random.default_rng(8)
    inputs = rng.uniform(0.5, 2.0, (120, 3))
    y = inputs[:, 0] * np.sin(inputs[:, 1]) + 0.05 * rng.standard_normal(120)
    free = gpsynth.regress(inputs, y, functions=functions, evaluations=60_000)
    bound = gpsynth.regress(inputs, y, functions=functions, evaluations=60_000, use_all_inputs=True)
    assert not all("x2" in str(formula) for formula in free.front)
    for formula in bound.front:
        assert all(name in str(formula) for name in ("x0", "x1", "x2"))
    assert bound.front[-1].error <= 1.05 * np.mean((y - inputs[:, 0] * np.sin(inputs[:, 1])) ** 2) / np.var(y)


def test_formulas_of_several_targets_read_all_inputs_each():
    inputs = np.random.default_rng(9).uniform(0.5, 2.0, (100, 3))
    rate = inputs[:, 0] * inputs[:, 1] / inputs[:, 2]
    found = gpsynth.regress(
        inputs, np.column_stack([rate, rate + inputs[:, 2]]), evaluations=60_000, use_all_inputs=True
    )
    assert found.best.error < 1e-20
    for formula in found.front:
        for output in formula.program.names:
            assert {"x0", "x1", "x2"} <= read_by(formula.program, output)


def read_by(program, output):
    """The names of the inputs that an output hangs on."""
    moved = np.random.default_rng(10).uniform(0.5, 2.0, (1, len(program.inputs)))
    column = program.names.index(output)
    changes = moved + 0.1 * np.eye(len(program.inputs))
    values = program(np.vstack([moved, changes]))[:, column]
    return {name for name, value in zip(program.inputs, values[1:], strict=True) if value != values[0]}
