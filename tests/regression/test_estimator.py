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
