"""The two array types of the package: float64 and int32, C order."""

from typing import TypeVar

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int32]

_Scalar = TypeVar("_Scalar", bound=np.generic)


def frozen(array: npt.NDArray[_Scalar]) -> npt.NDArray[_Scalar]:
    """A read-only, C-ordered copy, so that a frozen dataclass is frozen all the way down."""
    copy = np.array(array, order="C")
    copy.setflags(write=False)
    return copy
