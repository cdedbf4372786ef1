"""The numbers beside a structure: how many, between which bounds, and how they are drawn and moved."""

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from gpsynth.checks import check_number, check_whole
from gpsynth.errors import EncodingError

Values = tuple[float, ...]


@dataclass(frozen=True)
class ParameterSpace:
    """Up to `count` numbers in [lower, upper]; they become the parameters q0, q1, ... of the program."""

    count: int = 0
    lower: float = -10.0
    upper: float = 10.0
    step: float = 0.1  # standard deviation of a mutation, as a fraction of the range
    rate: float = 0.5  # how often a mutation moves a number instead of changing the structure

    def __post_init__(self) -> None:
        check_whole("the count of parameters", self.count, 0, EncodingError)
        for name in ("lower", "upper", "step", "rate"):
            check_number(f"{name} of a ParameterSpace", getattr(self, name), EncodingError)
        if not (self.lower < self.upper and math.isfinite(self.upper - self.lower)):
            raise EncodingError(
                f"parameters need lower < upper, both finite; got lower {self.lower}, upper {self.upper}"
            )
        if not (math.isfinite(self.step) and self.step > 0):
            raise EncodingError(f"the step of a parameter must be positive and finite, not {self.step}")
        if not 0 <= self.rate <= 1:
            raise EncodingError(f"the rate of parameter mutations must lie in [0, 1], not {self.rate}")
        object.__setattr__(self, "lower", float(self.lower))
        object.__setattr__(self, "upper", float(self.upper))

    def random(self, rng: np.random.Generator, count: int) -> Values:
        """Numbers from anywhere between the bounds."""
        return tuple(rng.uniform(self.lower, self.upper, count).tolist())

    def moved(self, values: Values, rng: np.random.Generator) -> Values:
        """One of the numbers, of which there must be some, moved by a Gaussian step and kept within the bounds."""
        index = int(rng.integers(len(values)))
        value = values[index] + self.step * (self.upper - self.lower) * rng.standard_normal()
        return (*values[:index], self.nearest(float(value)), *values[index + 1 :])

    def moves(self, values: Values, rng: np.random.Generator) -> bool:
        """Whether this mutation is the numbers' turn."""
        return len(values) > 0 and rng.random() < self.rate

    def nearest(self, value: float) -> float:
        """The number within the bounds that is nearest to `value`."""
        return min(max(value, self.lower), self.upper)

    def checked(self, values: npt.ArrayLike, count: int) -> Values:
        """The values as a tuple; raises EncodingError unless there are `count`, all within the bounds."""
        vector = np.asarray(values, dtype=np.float64)
        if vector.shape != (count,):
            raise EncodingError(f"expected {count} parameters as a vector, got shape {vector.shape}")
        outside = ~((self.lower <= vector) & (vector <= self.upper))
        if outside.any():
            index = int(outside.argmax())
            raise EncodingError(
                f"parameter {index} is {vector[index]}; it must lie in [{self.lower}, {self.upper}]"
            )
        return tuple(vector.tolist())

    @staticmethod
    def names(count: int) -> tuple[str, ...]:
        """The names of the program's parameters."""
        return tuple(f"q{index}" for index in range(count))
