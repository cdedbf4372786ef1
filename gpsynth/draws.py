"""Draws: under which conditions each start of a problem is run: plant parameters, delay and measurement noise."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from gpsynth.arrays import Floats, Ints, frozen, numbers, shaped
from gpsynth.checks import check_kind, check_whole
from gpsynth.errors import ProblemError
from gpsynth.plant import Plant


@dataclass(frozen=True, eq=False, init=False)
class Draws:
    """Conditions row by row, as the starts of a problem; what is left out is nominal, immediate and exact.

    A delay d means that the control computed at a tick acts from d later on, to the nearest integration step; until
    the first one arrives the control is 0, within its limits. Noise is added to the state that the features see and to
    nothing else. Raises ProblemError if the parts do not fit together.
    """

    parameters: Floats  # (S, q) of the plant; (S, 0): the nominal ones
    delay: Floats  # (S,) s
    noise: Floats  # (K, T, n) errors of the measured state, one a period, over again after T; K = 0: none
    tables: Ints  # (S,) which of the K tables of noise a row has

    def __init__(
        self,
        parameters: npt.ArrayLike | None = None,
        *,
        delay: npt.ArrayLike = 0.0,
        noise: npt.ArrayLike | None = None,
        tables: npt.ArrayLike | None = None,
    ) -> None:
        """One delay stands for all rows; row k has table k modulo K unless `tables` says otherwise."""
        errors = np.empty((0, 0, 0)) if noise is None else shaped("noise", noise, (-1, -1, -1))
        vectors = None if parameters is None else shaped("the draws' parameters", parameters, (-1, -1))
        times = numbers("the draws' delay", delay)
        chosen = None if tables is None else numbers("tables", tables)
        rowed = [part for part in (vectors, times, chosen) if part is not None and part.ndim]
        count = len(rowed[0]) if rowed else max(1, len(errors))
        values = {
            "parameters": frozen(np.empty((count, 0))) if vectors is None else vectors,
            "delay": shaped("the draws' delay", times if times.ndim else np.full(count, times), (count,)),
            "noise": frozen(errors),
            "tables": _tables(
                np.arange(count) % max(1, len(errors)) if chosen is None else chosen, errors, count
            ),
        }
        for name, value in values.items():
            object.__setattr__(self, name, value)
        if np.any(self.delay < 0.0):
            raise ProblemError(f"the draws' delay must be at least 0 s, got {self.delay.min()}")
        if len(errors) and not errors.size:
            raise ProblemError(f"noise has shape {errors.shape}; expected at least one tick and one state")

    def __len__(self) -> int:
        return len(self.delay)


def crossed(starts: npt.ArrayLike, draws: Draws) -> tuple[Floats, Draws]:
    """Every start (S, n) under every one of D draws: starts (D S, n) and their draws, all starts of a draw together."""
    check_kind("draws", draws, Draws)
    places = shaped("starts", np.atleast_2d(numbers("starts", starts)), (-1, -1))
    rows = np.repeat(np.arange(len(draws)), len(places))
    repeated = Draws(
        draws.parameters[rows], delay=draws.delay[rows], noise=draws.noise, tables=draws.tables[rows]
    )
    return np.tile(places, (len(draws), 1)), repeated


def random_draws(
    plant: Plant,
    rng: np.random.Generator,
    count: int,
    *,
    delay: tuple[float, float] = (0.0, 0.0),
    noise: npt.ArrayLike | None = None,
    ticks: int = 1_000,
) -> Draws:
    """`count` draws of the plant's parameters and of the delay (s), uniform in their ranges and spread evenly.

    Each range is cut into `count` equal parts, of which every draw takes another (Latin hypercube). `noise` gives the
    standard deviation of the normal error of each state, (n,) or one number: a table of `ticks` samples a draw. Raises
    ProblemError for what makes no sense.
    """
    check_kind("plant", plant, Plant)
    check_kind("rng", rng, np.random.Generator)
    check_whole("count", count, 1)
    check_whole("ticks", ticks, 1)
    shortest, longest = shaped("the range of the delay, (shortest, longest) in s,", delay, (2,))
    if not 0.0 <= shortest <= longest:
        raise ProblemError(f"the delay must have 0 <= shortest <= longest, got {delay!r}")
    ranges = [[low, high] for _, low, high, _ in plant.parameters.values()]
    bounds = np.array([*ranges, [shortest, longest]])
    parts = np.column_stack([rng.permutation(count) for _ in bounds])
    shares = (parts + rng.random(parts.shape)) / count
    values = bounds[:, 0] + shares * (bounds[:, 1] - bounds[:, 0])
    errors = None if noise is None else noise_tables(plant, rng, (count, ticks), noise)
    return Draws(values[:, :-1], delay=values[:, -1], noise=errors)


def check_draws(draws: Any, plant: Plant, starts: int, *, hold: bool, horizon: float) -> None:
    """Raises ProblemError unless these are draws for that many starts of the plant."""
    if not isinstance(draws, Draws):
        raise ProblemError(f"draws must be Draws or None, got {draws!r}")
    if len(draws) != starts:
        raise ProblemError(
            f"there are {len(draws)} draws for {starts} starts; expected one for each, as "
            "gpsynth.crossed(starts, draws) makes them"
        )
    names, size = plant.parameter_names, len(plant.states)
    if draws.parameters.shape[1] not in (0, len(names)):
        raise ProblemError(
            f"the draws have {draws.parameters.shape[1]} plant parameters; {plant.name} has {len(names)}"
        )
    if len(draws.noise) and draws.noise.shape[2] != size:
        raise ProblemError(
            f"noise has shape {draws.noise.shape}; expected (K, T, {size}), one for each state"
        )
    if not hold and np.any(draws.delay > 0.0):
        raise ProblemError("a delay needs hold=True: only a control that is held can come late")
    if np.any(draws.delay > horizon):
        raise ProblemError(f"a delay of {draws.delay.max()} s is longer than the horizon, {horizon} s")


def noise_tables(
    plant: Plant, rng: np.random.Generator, size: tuple[int, int], deviation: npt.ArrayLike
) -> Floats:
    """Normal errors (K, T, n) of the plant's states for K, T = `size`; `deviation` (n,) or one number for all."""
    states = len(plant.states)
    widths = np.repeat(deviation, states) if np.ndim(deviation) == 0 else deviation
    deviations = shaped("the noise's standard deviation", widths, (states,))
    if np.any(deviations < 0.0):
        raise ProblemError(f"the noise's standard deviation must be at least 0, got {deviations.tolist()}")
    return rng.normal(size=(*size, states)) * deviations


def _tables(rows: npt.NDArray[Any], errors: Floats, count: int) -> Ints:
    last = max(0, len(errors) - 1)
    if rows.shape != (count,) or not np.all((rows == np.rint(rows)) & (rows >= 0) & (rows <= last)):
        raise ProblemError(f"tables are {count} integers from 0 to {last}, one a row, got {rows.tolist()}")
    return frozen(rows.astype(np.int32))
