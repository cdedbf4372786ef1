"""`SymbolicRegressor`: the search as an estimator of scikit-learn, which is an optional extra."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from gpsynth.arrays import Floats
from gpsynth.errors import RegressionError
from gpsynth.regression.entry import EVALUATIONS, FUNCTIONS, column_names, output_names, regress
from gpsynth.regression.result import RegressionResult

try:
    from sklearn.base import BaseEstimator, RegressorMixin
    from sklearn.utils import check_random_state
    from sklearn.utils.validation import _check_sample_weight, check_is_fitted, validate_data
except ImportError as error:
    raise RegressionError(
        "SymbolicRegressor needs scikit-learn 1.6 or newer: pip install gpsynth[sklearn]; gpsynth.regress does without"
    ) from error

if TYPE_CHECKING:
    from typing import Self


class SymbolicRegressor(RegressorMixin, BaseEstimator):  # type: ignore[misc]
    """A formula for y, or one for each column of y together, found by `gpsynth.regress`.

    Fitted: `result_` (RegressionResult), `formula_` (text), `n_features_in_` and, from data frames,
    `feature_names_in_`. What does not fit raises ValueError, as scikit-learn's estimators do.
    """

    def __init__(
        self,
        *,
        functions: Sequence[str] = FUNCTIONS,
        evaluations: int = EVALUATIONS,
        seconds: float | None = None,
        random_state: Any = 0,
        use_all_inputs: bool = False,
    ) -> None:
        self.functions = functions
        self.evaluations = evaluations
        self.seconds = seconds
        self.random_state = random_state
        self.use_all_inputs = use_all_inputs

    def fit(self, X: npt.ArrayLike, y: npt.ArrayLike, sample_weight: npt.ArrayLike | None = None) -> "Self":
        """Search formulas for y (n,) or (n, k) of X (n, m)."""
        X, y = validate_data(
            self, X, y, multi_output=True, y_numeric=True, dtype=np.float64, ensure_min_samples=2
        )
        weights = (
            None
            if sample_weight is None
            else _check_sample_weight(sample_weight, X, ensure_non_negative=True)
        )
        seed = self.random_state
        if not isinstance(seed, int | np.integer):
            seed = check_random_state(seed).randint(2**31)
        try:
            self.result_: RegressionResult = regress(
                X,
                np.asarray(y, dtype=np.float64),
                functions=self.functions,
                names=column_names(getattr(self, "feature_names_in_", None), np.shape(X)[1]),
                target_name=_free("y", np.shape(y), getattr(self, "feature_names_in_", ())),
                weights=weights,
                evaluations=self.evaluations,
                seconds=self.seconds,
                seed=int(seed),
                use_all_inputs=self.use_all_inputs,
            )
        except RegressionError as error:
            raise ValueError(str(error)) from error
        self.formula_ = str(self.result_.best)
        return self

    def __sklearn_tags__(self) -> Any:
        """What scikit-learn asks an estimator about itself: y may have several columns."""
        tags = super().__sklearn_tags__()
        tags.target_tags.multi_output = True
        return tags

    def predict(self, X: npt.ArrayLike) -> Floats:
        """The chosen formula (n,), or (n, k) for k > 1 targets, on X (n, m); NaN where it is not defined."""
        check_is_fitted(self)
        return self.result_.predict(validate_data(self, X, reset=False, dtype=np.float64))


def _free(name: str, shape: tuple[int, ...], taken: Sequence[str]) -> tuple[str, ...]:
    """Names for the targets of this shape that no column has."""
    found = output_names(name, shape[1] if len(shape) > 1 else 1)
    return _free(f"{name}_", shape, taken) if set(found) & set(taken) else found
