"""What the searches over vectors share: the box, the first positions, and costs that are not numbers."""

from typing import TypeVar

import numpy as np
import numpy.typing as npt

from gpsynth.arrays import Floats, frozen
from gpsynth.checks import check_number
from gpsynth.errors import OptimizerError

_Scalar = TypeVar("_Scalar", bound=np.generic)


def checked_box(lower: npt.ArrayLike, upper: npt.ArrayLike) -> tuple[Floats, Floats]:
    """Both bounds as read-only vectors; raises OptimizerError unless lower < upper everywhere."""
    try:
        low, high = frozen(np.asarray(lower, np.float64)), frozen(np.asarray(upper, np.float64))
    except (TypeError, ValueError):
        raise OptimizerError(
            f"lower and upper must be vectors of numbers, got {lower!r} and {upper!r}"
        ) from None
    if low.ndim != 1 or low.size == 0 or low.shape != high.shape:
        raise OptimizerError(
            f"lower and upper must be vectors of one length; lower has shape {low.shape}, upper {high.shape}"
        )
    with np.errstate(over="ignore", invalid="ignore"):
        wrong = ~((low < high) & np.isfinite(high - low))
    if wrong.any():
        i = int(wrong.argmax())
        raise OptimizerError(
            f"the box needs lower < upper, both finite; component {i} has lower {low[i]} and upper {high[i]}"
        )
    return low, high


def checked_starts(x0: npt.ArrayLike | None, lower: Floats, upper: Floats, most: int) -> Floats:
    """Given first positions as a read-only (k, d) array, k = 0 where there are none."""
    if x0 is None:
        return frozen(np.empty((0, lower.size)))
    try:
        starts = frozen(np.atleast_2d(np.asarray(x0, np.float64)))
    except (TypeError, ValueError):
        raise OptimizerError(f"x0 must hold positions of numbers, got {x0!r}") from None
    if starts.ndim != 2 or starts.shape[1] != lower.size:
        raise OptimizerError(f"x0 must have {lower.size} columns like the box; its shape is {starts.shape}")
    if len(starts) > most:
        raise OptimizerError(f"x0 has {len(starts)} positions, more than the {most} there is room for")
    outside = ~((lower <= starts) & (starts <= upper))
    if outside.any():
        row, column = np.argwhere(outside)[0]
        raise OptimizerError(
            f"x0[{row}, {column}] = {starts[row, column]} lies outside [{lower[column]}, {upper[column]}]"
        )
    return starts


def checked_at_least(name: str, value: float, least: float) -> None:
    """Raises OptimizerError unless value >= least; NaN never passes."""
    check_number(name, value, OptimizerError)
    if not value >= least:
        raise OptimizerError(f"{name} must be at least {least}, not {value}")


def checked_within(name: str, value: float, least: float, most: float) -> None:
    """Raises OptimizerError unless least <= value <= most; NaN never passes."""
    check_number(name, value, OptimizerError)
    if not least <= value <= most:
        raise OptimizerError(f"{name} must lie in [{least}, {most}], not {value}")


def checked_positive(name: str, value: float) -> None:
    """Raises OptimizerError unless value > 0; NaN never passes."""
    check_number(name, value, OptimizerError)
    if not value > 0:
        raise OptimizerError(f"{name} must be positive, not {value}")


def scatter(rng: np.random.Generator, starts: Floats, lower: Floats, upper: Floats, size: int) -> Floats:
    """The starts (k, d), then uniform positions in the box, (size, d) together."""
    # a factor below 1 rounds the product below the range's own rounding error: no sum can pass the upper wall
    drawn = lower + rng.random((size - len(starts), lower.size)) * (upper - lower)
    return sealed(np.concatenate([starts, drawn]))


def finite_or_worst(costs: Floats, shape: tuple[int, ...]) -> Floats:
    """Costs of the shape expected, every row that is not finite replaced by +inf."""
    values = np.asarray(costs, np.float64)
    if values.shape != shape:
        raise OptimizerError(
            f"costs must have shape {shape}, one row per candidate; they have {values.shape}"
        )
    finite = np.isfinite(values)
    if finite.all():
        return values
    return np.where(finite if values.ndim == 1 else finite.all(axis=1, keepdims=True), values, np.inf)


def sealed(array: npt.NDArray[_Scalar]) -> npt.NDArray[_Scalar]:
    """The same array, read-only: for arrays that were just made and belong to nobody else."""
    array.setflags(write=False)
    return array
