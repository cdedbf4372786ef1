"""Stress: the same problem with a finer clock, with other limits of the controls, with noise."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from gpsynth.arrays import numbers, shaped
from gpsynth.checks import check_whole
from gpsynth.draws import Draws, noise_tables
from gpsynth.errors import ProblemError
from gpsynth.problem import Problem
from gpsynth.seeds import stream

_TABLES, _TICKS = 32, 1_000  # of noise


@dataclass(frozen=True)
class Stress:
    """How a problem is made harder; raises ProblemError if a number makes no sense."""

    refine: int = 10  # period and step are divided by it
    limits: tuple[float, ...] = (0.8, 1.2)  # factors of all limits of the controls
    noise: npt.ArrayLike | None = (
        None  # standard deviation of each measured state, (n,) or one number; None: no trial
    )
    seed: int = 0  # of the noise

    def __post_init__(self) -> None:
        check_whole("refine", self.refine, 1)
        check_whole("seed", self.seed, 0)
        if not np.all(shaped("limits", self.limits, (-1,)) > 0.0):
            raise ProblemError(f"limits are scaled by positive factors, got {self.limits!r}")
        if self.noise is not None and not np.all(numbers("noise", self.noise) >= 0.0):
            raise ProblemError(f"noise is a standard deviation of at least 0, got {self.noise!r}")


def harder(problem: Problem, stress: Stress) -> Iterator[tuple[str, Problem]]:
    """The harder problems by name."""
    if stress.refine > 1:
        yield f"period and step / {stress.refine}", refined(problem, stress.refine)
    for factor in stress.limits:
        yield f"limits x {factor:g}", scaled(problem, factor)
    if stress.noise is not None:
        yield "noise", noisy(problem, stress.noise, stress.seed)


def refined(problem: Problem, factor: int) -> Problem:
    """The problem with period and step divided by an integer; noise and delay keep their times."""
    draws = problem.draws
    if draws is not None:
        draws = replace(draws, noise=np.repeat(draws.noise, factor, axis=1))
    return replace(problem, period=problem.period / factor, step=problem.step / factor, draws=draws)


def scaled(problem: Problem, factor: float) -> Problem:
    """The problem with all limits of the controls times a factor."""
    plant = problem.plant
    return replace(problem, plant=plant.with_limits(factor * plant.lower, factor * plant.upper))


def noisy(problem: Problem, deviation: npt.ArrayLike, seed: int = 0) -> Problem:
    """The problem with normal errors of the measured state in place of those it has."""
    rows = len(problem.starts)
    tables = noise_tables(problem.plant, stream(seed), (min(rows, _TABLES), _TICKS), deviation)
    draws = problem.draws or Draws(delay=np.zeros(rows))
    return replace(problem, draws=Draws(draws.parameters, delay=draws.delay, noise=tables))
