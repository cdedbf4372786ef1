"""The two array types of the package: float64 and int32, C order; and how a user's numbers become one."""

from typing import TypeVar

import numpy as np
import numpy.typing as npt

from gpsynth.errors import ProblemError

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int32]

_Scalar = TypeVar("_Scalar", bound=np.generic)


def frozen(array: npt.NDArray[_Scalar]) -> npt.NDArray[_Scalar]:
    """A read-only, C-ordered copy, so that a frozen dataclass is frozen all the way down."""
    copy = np.array(array, order="C")
    copy.setflags(write=False)
    return copy


def numbers(name: str, values: npt.ArrayLike) -> Floats:
    """A copy of the values; raises ProblemError if they are not numbers."""
    try:
        return np.array(values, dtype=np.float64)
    except (TypeError, ValueError):
        raise ProblemError(f"{name} must hold numbers in rows of equal length, got {values!r}") from None


def shaped(name: str, values: npt.ArrayLike, shape: tuple[int, ...], *, finite: bool = True) -> Floats:
    """A read-only copy of this shape, of which a -1 stands for any length; raises ProblemError if it has another."""
    array = numbers(name, values)
    if array.size == 0 and shape[:1] == (-1,) and -1 not in shape[1:]:
        array = array.reshape(0, *shape[1:])
    if array.ndim != len(shape) or any(
        want not in (-1, has) for want, has in zip(shape, array.shape, strict=True)
    ):
        expected = str(shape).replace("-1", "any number")
        raise ProblemError(f"{name} has shape {array.shape}; expected {expected}")
    if np.any(np.isnan(array)) or (finite and not np.all(np.isfinite(array))):
        raise ProblemError(f"{name} holds NaN or infinity: {array.tolist()}")
    return frozen(array)
