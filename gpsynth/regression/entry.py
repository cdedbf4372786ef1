"""`regress`: formulas from data, with everything a user can get wrong checked first."""

import re
import time
from collections import Counter
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from gpsynth.arrays import Floats
from gpsynth.checks import check_kind, check_names, check_number, check_whole
from gpsynth.errors import RegressionError
from gpsynth.kernels.data_code import NAMES
from gpsynth.program import NAME
from gpsynth.regression.expressions import program_of
from gpsynth.regression.joint import Joint, choose, joined
from gpsynth.regression.result import Formula, RegressionResult
from gpsynth.regression.search import Budget
from gpsynth.regression.several import Found, search_each

FUNCTIONS = ("add", "sub", "mul", "div", "sin", "cos", "exp", "log", "sqrt")
EVALUATIONS = 300_000_000
LARGEST = 1e50


def regress(
    inputs: npt.ArrayLike,
    target: npt.ArrayLike,
    *,
    functions: Sequence[str] = FUNCTIONS,
    names: Sequence[str] | None = None,
    target_name: str | Sequence[str] = "y",
    weights: npt.ArrayLike | None = None,
    evaluations: int = EVALUATIONS,
    seconds: float | None = None,
    seed: int = 0,
    use_all_inputs: bool = False,
) -> RegressionResult:
    """Formulas for target (n,) or targets (n, k) from inputs (n, m), a front of size and error.

    The search ends when a formula is exact up to rounding and none smaller turns up, or with the step in which
    `evaluations` formulas have been scored on rows of data; the same seed gives the same result then. `seconds` of
    processor time end it earlier, and how far it comes is no longer the same on every machine. Weights (n,) are not
    negative.

    Several targets are searched one after the other, each with an equal share of the budget, what those before it have
    left, and parts of their formulas as columns (`gpsynth/regression/several.py:search_each`). Their fronts become one
    (`gpsynth/regression/joint.py:joined`): each formula of it has k outputs, and what two of them share is computed and
    counted once. `target_name` gives k names then, or begins them: y0, y1, ...

    With `use_all_inputs` every formula of the front reads every input, and so do those of each of several targets: what
    one lacks is added to it as a multiple, however small that comes out.

    Columns have the `names` given, or those of a DataFrame, or are called x0, x1, ... Raises RegressionError for what
    does not fit together.
    """
    rows, targets = _matrix(inputs), _targets(target)
    if len(targets) != len(rows):
        raise RegressionError(f"inputs have {len(rows)} rows and the target has {len(targets)}")
    given = np.ones(len(rows)) if weights is None else _vector("weights", weights)
    if len(given) != len(rows) or np.any(given < 0.0) or not np.any(given > 0.0):
        raise RegressionError(f"expected {len(rows)} weights, none negative and one positive")
    wanted = _functions(functions)
    budget = _budget(evaluations, seconds)
    check_whole("seed", seed, 0, RegressionError)
    given_names = getattr(inputs, "columns", None) if names is None else names
    labels, outputs = _names(given_names, target_name, rows.shape[1], targets.shape[1])
    begin = time.process_time()
    check_kind("use_all_inputs", use_all_inputs, bool, error=RegressionError)
    data = merged(rows, targets, given)
    found = search_each(data, wanted, budget=budget, seed=seed, use_all_inputs=use_all_inputs)
    front = joined([each.front for each in found])
    return RegressionResult(
        tuple(_formula(joint, labels, outputs) for joint in front),
        front.index(choose(front, len(data[0]))),
        sum(each.evaluations for each in found),
        time.process_time() - begin,
        _history(found, outputs),
    )


def _formula(joint: Joint, labels: tuple[str, ...], outputs: tuple[str, ...]) -> Formula:
    program = program_of([part.expression for part in joint.parts], labels, outputs)
    return Formula(program, tuple(part.error for part in joint.parts), joint.size)


def _history(found: Sequence[Found], outputs: tuple[str, ...]) -> tuple[tuple[int, str, float], ...]:
    """What was found for one target after the other."""
    history, before = [], 0
    for each, name in zip(found, outputs, strict=True):
        ending = f" for {name}" if len(outputs) > 1 else ""
        history += [(before + count, source + ending, error) for count, source, error in each.history]
        before += each.evaluations
    return tuple(history)


def merged(rows: Floats, targets: Floats, weights: Floats) -> tuple[Floats, Floats, Floats]:
    """Rows in one order, equal ones once with the sum of their weights, so that weights mean repetition."""
    used, inputs = weights > 0.0, rows.shape[1]
    whole = np.column_stack((rows[used], targets[used]))
    unique, place = np.unique(whole, axis=0, return_inverse=True)
    together = np.bincount(place.ravel(), weights=weights[used]).astype(np.float64)
    return np.ascontiguousarray(unique[:, :inputs]), unique[:, inputs:], together


def column_names(names: Sequence[str] | None, count: int) -> tuple[str, ...]:
    """Names of columns that can stand in a formula; x0, x1, ... where there are none."""
    if names is None:
        return tuple(f"x{j}" for j in range(count))
    cleaned = [re.sub(r"\W", "_", str(name), flags=re.ASCII) for name in names]
    cleaned = [name if NAME.match(name) else f"x{j}_{name}" for j, name in enumerate(cleaned)]
    return tuple(name if cleaned.count(name) == 1 else f"{name}_{j}" for j, name in enumerate(cleaned))


def output_names(name: str | Sequence[str], count: int) -> tuple[str, ...]:
    """The names of the targets, those of several being numbered if they are not given."""
    if not isinstance(name, str):
        return check_names("target_name", name, RegressionError)
    return (name,) if count == 1 else tuple(f"{name}{k}" for k in range(count))


def _names(
    names: Sequence[str] | None, target_name: str | Sequence[str], inputs: int, outputs: int
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """The names of inputs and targets, which must all be different."""
    labels = column_names(None, inputs) if names is None else check_names("names", names, RegressionError)
    targets = output_names(target_name, outputs)
    for what, given, count in (("columns", labels, inputs), ("targets", targets, outputs)):
        if len(given) != count:
            raise RegressionError(
                f"expected {count} names of {what}, got {len(given)}: {', '.join(map(str, given))}"
            )
    for name in (*labels, *targets):
        if not isinstance(name, str) or not NAME.match(name):
            raise RegressionError(f"{name!r} is not a name: a letter or _, then letters, digits and _")
    twice = [name for name, times in Counter((*labels, *targets)).items() if times > 1]
    if twice:
        raise RegressionError(f"columns and targets need different names; {', '.join(twice)} is there twice")
    return labels, targets


def _functions(functions: Sequence[str]) -> frozenset[str]:
    wanted = check_names("functions", functions, RegressionError)
    unknown = [str(name) for name in wanted if name not in NAMES]
    if unknown or not wanted:
        raise RegressionError(f"functions are some of {', '.join(NAMES)}; not {', '.join(unknown) or 'none'}")
    return frozenset(wanted)


def _budget(evaluations: int, seconds: float | None) -> Budget:
    check_whole("evaluations", evaluations, 1, RegressionError)
    if seconds is not None:
        check_number("seconds", seconds, RegressionError)
        if not seconds > 0.0:
            raise RegressionError(f"seconds must be positive, not {seconds}")
    return Budget(int(evaluations), seconds)


def _matrix(values: npt.ArrayLike) -> Floats:
    rows = _numbers("inputs", values)
    if rows.ndim != 2 or 0 in rows.shape:
        raise RegressionError(f"inputs have shape {rows.shape}; expected (n, m), n and m at least 1")
    return rows


def _targets(values: npt.ArrayLike) -> Floats:
    """One column for each target."""
    columns = _numbers("target", values)
    if columns.ndim not in (1, 2) or 0 in columns.shape[1:]:
        raise RegressionError(f"target has shape {columns.shape}; expected (n,) or (n, k), k at least 1")
    return columns if columns.ndim == 2 else columns[:, np.newaxis]


def _vector(what: str, values: npt.ArrayLike) -> Floats:
    vector = _numbers(what, values)
    if vector.ndim != 1:
        raise RegressionError(f"{what} has shape {vector.shape}; expected (n,)")
    return vector


def _numbers(what: str, values: npt.ArrayLike) -> Floats:
    try:
        numbers = np.asarray(values)
        numbers = numbers.astype(np.float64, casting="unsafe" if numbers.dtype.kind == "O" else "same_kind")
    except (TypeError, ValueError):
        raise RegressionError(f"{what} must hold numbers in rows of equal length") from None
    if not np.all(np.abs(numbers) < LARGEST):
        raise RegressionError(f"{what} must be finite and below {LARGEST:g}")
    return np.ascontiguousarray(numbers) if numbers.ndim else numbers
