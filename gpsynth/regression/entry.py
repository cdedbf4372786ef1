"""`regress`: formulas from data, with everything a user can get wrong checked first."""

import re
import time
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from gpsynth import seeds
from gpsynth.arrays import Floats
from gpsynth.errors import RegressionError
from gpsynth.kernels.data_code import NAMES
from gpsynth.program import NAME
from gpsynth.regression.expressions import number, program_of
from gpsynth.regression.front import choose
from gpsynth.regression.polish import data_of
from gpsynth.regression.result import Formula, RegressionResult
from gpsynth.regression.search import Budget, search
from gpsynth.regression.state import State

FUNCTIONS = ("add", "sub", "mul", "div", "sin", "cos", "exp", "log", "sqrt")
EVALUATIONS = 300_000_000
LARGEST = 1e50
SMALLEST_LIBRARY, LARGEST_LIBRARY = 300, 20_000  # enumerated formulas; small budgets get small libraries


def regress(
    inputs: npt.ArrayLike,
    target: npt.ArrayLike,
    *,
    functions: Sequence[str] = FUNCTIONS,
    names: Sequence[str] | None = None,
    target_name: str = "y",
    weights: npt.ArrayLike | None = None,
    evaluations: int = EVALUATIONS,
    seconds: float | None = None,
    seed: int = 0,
) -> RegressionResult:
    """Formulas for target (n,) from inputs (n, m), a front of size and error.

    The search ends when a formula is exact up to rounding and none smaller turns up, or after `evaluations` formulas
    have been scored on rows of data; the same seed gives the same result then. `seconds` of processor time end it
    earlier, and how far it comes is no longer the same on every machine. Weights (n,) are not negative. Raises
    RegressionError for what does not fit together.
    """
    rows, y = _matrix(inputs), _vector("target", target)
    if len(y) != len(rows):
        raise RegressionError(f"inputs have {len(rows)} rows and the target has {len(y)}")
    given = np.ones(len(y)) if weights is None else _vector("weights", weights)
    if len(given) != len(y) or np.any(given < 0.0) or not np.any(given > 0.0):
        raise RegressionError(f"expected {len(y)} weights, none negative and one positive")
    unknown = [name for name in functions if name not in NAMES]
    if unknown or not functions:
        raise RegressionError(f"functions are some of {', '.join(NAMES)}; not {', '.join(unknown) or 'none'}")
    if evaluations < 1 or (seconds is not None and not seconds > 0.0):
        raise RegressionError(f"the budget is positive, not {evaluations} evaluations and {seconds} seconds")
    if not isinstance(seed, int | np.integer) or seed < 0:
        raise RegressionError(f"seed must be a whole number from 0 on, not {seed!r}")
    labels = (
        column_names(names, rows.shape[1]) if names is None else _checked(names, rows.shape[1], target_name)
    )
    begin = time.process_time()
    library = min(LARGEST_LIBRARY, max(SMALLEST_LIBRARY, evaluations // 500))
    state = State(data_of(*merged(rows, y, given)), frozenset(functions), seeds.stream(seed), library)
    if state.data.total > 0.0 and len(state.y) > 1:
        state.consider([number(float(state.y.mean()))], "constant")
        search(state, Budget(evaluations, seconds))
        front = state.front.members()
    else:
        front = [state.constant()]
    best = choose(front, len(state.y))
    return RegressionResult(
        tuple(Formula(program_of(c.expression, labels, target_name), c.error, c.size) for c in front),
        front.index(best),
        state.evaluations,
        time.process_time() - begin,
        tuple(state.found),
    )


def merged(rows: Floats, y: Floats, weights: Floats) -> tuple[Floats, Floats, Floats]:
    """Rows in one order, equal ones once with the sum of their weights, so that weights mean repetition."""
    used = weights > 0.0
    whole = np.column_stack((rows[used], y[used]))
    unique, place = np.unique(whole, axis=0, return_inverse=True)
    together = np.bincount(place.ravel(), weights=weights[used]).astype(np.float64)
    return np.ascontiguousarray(unique[:, :-1]), np.ascontiguousarray(unique[:, -1]), together


def column_names(names: Sequence[str] | None, count: int) -> tuple[str, ...]:
    """Names of columns that can stand in a formula; x0, x1, ... where there are none."""
    if names is None:
        return tuple(f"x{j}" for j in range(count))
    cleaned = [re.sub(r"\W", "_", str(name), flags=re.ASCII) for name in names]
    cleaned = [name if NAME.match(name) else f"x{j}_{name}" for j, name in enumerate(cleaned)]
    return tuple(name if cleaned.count(name) == 1 else f"{name}_{j}" for j, name in enumerate(cleaned))


def _checked(names: Sequence[str], count: int, target_name: str) -> tuple[str, ...]:
    wrong = [name for name in (*names, target_name) if not NAME.match(name)]
    if wrong or len(names) != count or len({*names, target_name}) != count + 1:
        raise RegressionError(f"expected {count} different names besides {target_name!r}, got {tuple(names)}")
    return tuple(names)


def _matrix(values: npt.ArrayLike) -> Floats:
    rows = _numbers("inputs", values)
    if rows.ndim != 2 or 0 in rows.shape:
        raise RegressionError(f"inputs have shape {rows.shape}; expected (n, m), n and m at least 1")
    return rows


def _vector(what: str, values: npt.ArrayLike) -> Floats:
    vector = _numbers(what, values)
    if vector.ndim != 1:
        raise RegressionError(f"{what} has shape {vector.shape}; expected (n,)")
    return vector


def _numbers(what: str, values: npt.ArrayLike) -> Floats:
    try:
        numbers = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError):
        raise RegressionError(f"{what} must hold numbers in rows of equal length") from None
    if not np.all(np.abs(numbers) < LARGEST):
        raise RegressionError(f"{what} must be finite and below {LARGEST:g}")
    return np.ascontiguousarray(numbers) if numbers.ndim else numbers
