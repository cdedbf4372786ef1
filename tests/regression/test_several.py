"""Several targets at once: one front, shared parts found, computed and counted once."""

import itertools
import math

import numpy as np
import pytest

import gpsynth
from gpsynth.regression.front import Candidate
from gpsynth.regression.joint import Joint, joined
from gpsynth.regression.search import Budget
from gpsynth.regression.several import share_of

RNG = np.random.default_rng(4)
ROWS = RNG.uniform(0.1, 3.0, (60, 2))
S, P = ROWS.T
RATE = 2.3 * S / (0.7 + S)
ENZYME = np.column_stack((0.4 - RATE, 0.8 * RATE - 0.3 * P))
X, Y = ("variable", 0), ("variable", 1)
PRODUCT = ("mul", X, Y)


@pytest.fixture(scope="module")
def enzyme():
    return gpsynth.regress(ROWS, ENZYME, names=("s", "p"), target_name=("ds", "dp"), evaluations=2_000_000)


def test_what_targets_have_in_common_is_found_and_computed_once(enzyme):
    assert enzyme.program.names == ("ds", "dp")
    assert enzyme.predict(ROWS) == pytest.approx(ENZYME, rel=1e-9)
    divisions = [operation.name for operation, _ in enzyme.program.instructions].count("div")
    assert divisions == 1  # of the rate, which both have
    assert enzyme.best.size <= 17  # one at a time: 8 and 14 at least


def test_the_exports_have_all_targets_and_the_shared_part_once(enzyme):
    place: dict[str, object] = {}
    exec(compile(enzyme.to_python("rates"), "rates", "exec"), place)
    assert place["rates"]((1.5, 0.25)) == tuple(enzyme.predict([[1.5, 0.25]])[0])
    assert enzyme.to_c("rates").count(" / ") == 1
    assert "double y[2]" in enzyme.to_c("rates")
    first, second = enzyme.to_sympy(expanded=True).expressions
    values = {symbol: {"s": 1.5, "p": 0.25}[symbol.name] for symbol in second.free_symbols}
    assert float(second.subs(values)) == pytest.approx(0.8 * 2.3 * 1.5 / 2.2 - 0.075)
    assert {str(symbol) for symbol in first.free_symbols} == {"s"}
    assert enzyme.to_latex().count("\\frac") == 1


def test_the_first_target_is_found_as_if_it_were_alone():
    noisy = ENZYME + 0.02 * np.random.default_rng(1).standard_normal(ENZYME.shape)
    whole = gpsynth.regress(ROWS, noisy, evaluations=60_000, seed=2)
    alone = gpsynth.regress(ROWS, noisy[:, 0], evaluations=30_000, seed=2)
    assert {f.errors[0] for f in whole.front} <= {f.error for f in alone.front}
    assert min(f.errors[0] for f in whole.front) == alone.front[-1].error
    assert gpsynth.regress(ROWS, noisy, evaluations=60_000, seed=2).front == whole.front


def test_the_front_falls_in_the_product_of_errors_and_each_error_is_that_of_its_formula():
    noisy = ENZYME + 0.02 * np.random.default_rng(1).standard_normal(ENZYME.shape)
    result = gpsynth.regress(ROWS, noisy, evaluations=60_000)
    products = [math.prod(f.errors) for f in result.front]
    assert [f.size for f in result.front] == sorted({f.size for f in result.front})
    assert products == sorted(products, reverse=True)
    for item in result.front:
        left = item.program(ROWS) - noisy
        shares = np.sum(left**2, axis=0) / np.sum((noisy - noisy.mean(axis=0)) ** 2, axis=0)
        assert item.errors == pytest.approx(tuple(shares), rel=1e-9)
        assert item.error == pytest.approx(shares.mean(), rel=1e-9)
    header, *lines = result.table().splitlines()
    assert header.split() == ["size", "y0", "y1", "formula"]
    assert len(lines) == len(result.front) == len(result.rows())


def test_a_joined_front_is_what_no_combination_beats():
    fronts = [
        [Candidate(("number", value), error, 1 + 2 * k) for k, (value, error) in enumerate(column)]
        for column in (
            [(1.0, 0.5), (2.0, 0.1), (3.0, 1e-9)],
            [(4.0, 0.9), (5.0, 1e-3)],
            [(6.0, 0.3), (7.0, 0.29), (8.0, 0.01)],
        )
    ]
    for number, front in enumerate(fronts):  # sizes that differ: chains of sines
        for place, candidate in enumerate(front):
            tree = candidate.expression
            for _ in range(place):
                tree = ("sin", ("add", tree, ("number", 10.0 + number)))
            front[place] = candidate._replace(expression=tree, size=1 + 3 * place)
    every = [
        (sum(c.size for c in parts), math.prod(c.error for c in parts), parts)
        for parts in itertools.product(*fronts)
    ]
    best = {
        (size, error)
        for size, error, _ in every
        if not any((s <= size and e < error) or (s < size and e <= error) for s, e, _ in every)
    }
    found = joined(fronts)
    assert {(joint.size, round(joint.loss, 9)) for joint in found} == {
        (size, round(math.log(error), 9)) for size, error in best
    }


def test_a_target_has_its_share_and_what_others_have_left_and_no_less_if_they_took_more():
    assert share_of(Budget(100), Budget(0), 4, 4) == Budget(25)
    assert share_of(Budget(100), Budget(10), 4, 3) == Budget(30)
    assert share_of(Budget(100, 8.0), Budget(90, 7.0), 4, 1) == Budget(25, 2.0)


def test_what_a_formula_shares_with_one_before_is_one_node():
    first, second = ("sin", PRODUCT), ("add", ("cos", PRODUCT), PRODUCT)
    parts = Candidate(first, 0.1, 4), Candidate(second, 0.1, 8)
    assert Joint(parts).size == 4 + 4  # add, cos and twice the product
    assert Joint((parts[0], parts[0])).size == 4 + 1


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"target_name": ("a", "b", "c")}, "expected 2 names of targets, got 3: a, b, c"),
        ({"target_name": ("a", "a")}, "different names; a is there twice"),
        ({"target_name": ("a", "x0")}, "different names; x0 is there twice"),
        ({"target": ENZYME[:, :, None]}, r"shape \(60, 2, 1\); expected \(n,\) or \(n, k\)"),
        ({"target": ENZYME[:, :0]}, r"shape \(60, 0\)"),
        ({"target": ENZYME * [1.0, np.nan]}, "finite"),
    ],
)
def test_targets_that_do_not_fit_are_one_sentence(settings, message):
    arguments = {"inputs": ROWS, "target": ENZYME, **settings}
    with pytest.raises(gpsynth.GpsynthError, match=message):
        gpsynth.regress(arguments.pop("inputs"), arguments.pop("target"), **arguments)


def test_a_target_that_does_not_change_is_its_value():
    result = gpsynth.regress(ROWS, np.column_stack((S, np.full(60, 2.5))), evaluations=20_000)
    assert result.predict(ROWS) == pytest.approx(np.column_stack((S, np.full(60, 2.5))))


def test_a_single_column_is_a_vector():
    column, vector = (gpsynth.regress(ROWS, y, evaluations=5_000) for y in (RATE[:, None], RATE))
    assert column.front == vector.front
    assert column.predict(ROWS).shape == (60,)


def test_a_result_draws_and_writes_itself(enzyme, tmp_path):
    from matplotlib import pyplot

    axes = enzyme.plot(ax=pyplot.figure().add_subplot())
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["ds", "dp"]
    assert [len(line.get_xdata()) for line in axes.get_lines()] == [len(enzyme.front)] * 2
    pyplot.close("all")
    enzyme.to_csv(tmp_path / "front.csv")
    assert (tmp_path / "front.csv").read_text().splitlines()[0] == "size,error,error_ds,error_dp,formula"
