"""`SymbolicRegressor` keeps scikit-learn's contract; without scikit-learn it says so."""

import subprocess
import sys

import numpy as np
import pytest

sklearn = pytest.importorskip("sklearn", reason="scikit-learn is not installed")

from sklearn.utils.estimator_checks import check_estimator  # noqa: E402

from gpsynth import SymbolicRegressor  # noqa: E402


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore")
def test_it_passes_scikit_learns_own_checks() -> None:
    check_estimator(SymbolicRegressor(evaluations=2_000))


def test_it_finds_a_formula() -> None:
    rows = np.random.default_rng(1).uniform(1, 3, (50, 2))
    model = SymbolicRegressor(evaluations=2_000_000).fit(rows, rows[:, 0] * np.sin(rows[:, 1]))
    assert model.score(rows, rows[:, 0] * np.sin(rows[:, 1])) == pytest.approx(1.0)
    assert model.formula_ == "y = x0 * sin(x1)"


def test_without_scikit_learn_there_is_one_sentence() -> None:
    code = "import sys; sys.modules['sklearn'] = None; import gpsynth; gpsynth.SymbolicRegressor"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert "RegressionError: SymbolicRegressor needs scikit-learn" in done.stderr


def test_several_columns_of_y_are_several_formulas() -> None:
    rows = np.random.default_rng(1).uniform(1, 3, (50, 2))
    y = np.column_stack((rows[:, 0] * rows[:, 1], rows[:, 0] - rows[:, 1]))
    model = SymbolicRegressor(evaluations=200_000).fit(rows, y)
    assert model.predict(rows).shape == (50, 2)
    assert model.score(rows, y) == pytest.approx(1.0)
    assert model.formula_ == "y0 = x0 * x1; y1 = x0 - x1"


def test_targets_do_not_take_the_names_of_columns() -> None:
    pandas = pytest.importorskip("pandas", reason="pandas is not installed")
    rows = pandas.DataFrame({"y": [1.0, 2.0, 4.0, 5.0], "y0": [2.0, 1.0, 3.0, 7.0]})
    model = SymbolicRegressor(evaluations=2_000)
    assert model.fit(rows, rows["y"]).result_.program.names == ("y_",)
    assert model.fit(rows, rows).result_.program.names == ("y_0", "y_1")
