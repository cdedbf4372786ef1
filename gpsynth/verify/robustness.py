"""Robustness: how a law does on a problem, and on the same problem with a finer clock, other limits and noise.

The lower bound on the share of arrivals is that of Clopper and Pearson (Biometrika 26, 1934).
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
from scipy import stats

from gpsynth.arrays import Floats
from gpsynth.checks import check_kind, check_number
from gpsynth.errors import ProblemError
from gpsynth.evaluate import Evaluator
from gpsynth.law import Law
from gpsynth.problem import Problem
from gpsynth.proportions import lower_bound
from gpsynth.verify.stress import Stress, harder

_FEWEST_DRAWS = 3  # with fewer there is no correlation


@dataclass(frozen=True)
class Trial:
    """What became of the law from every start of one problem."""

    name: str
    runs: int
    reached: int
    bound: float  # the probability of arrival is at least this, at the confidence of the report
    median: float  # s, of the arrivals; NaN without any
    worst: float  # s
    held: float  # share of all runs that are at the goal at the horizon, where none stops on arrival
    lost: int  # runs that arrive on the problem as given and not here


@dataclass(frozen=True)
class Sensitivity:
    """How the slowdown of a draw goes with one of its numbers: arrival time over that of the nominal plant."""

    name: str
    unit: str
    low: float  # least and largest value drawn
    high: float
    correlation: float  # Spearman's, of the value and the mean slowdown over the starts of the draw


@dataclass(frozen=True)
class Slowest:
    """The draw with the largest mean slowdown; a run that does not arrive counts with the horizon."""

    values: dict[str, float]
    runs: int
    reached: int
    slowdown: float


@dataclass(frozen=True)
class Robustness:
    """A report on one law; the first trial is the problem as given."""

    trials: tuple[Trial, ...]
    sensitivities: tuple[Sensitivity, ...]
    slowest: Slowest | None  # None where all starts have the same plant and delay
    draws: int  # different ones among the starts
    confidence: float

    def __str__(self) -> str:
        return self.table()

    def table(self) -> str:
        """The report as text."""
        return "\n".join(self._lines())

    def _lines(self) -> Iterator[str]:
        width = max(len(trial.name) for trial in self.trials) + 2
        columns = f"{'reached':>14}{'at least':>10}{'median s':>10}{'worst s':>9}{'held':>8}{'lost':>6}"
        yield f"{'':{width}}{columns}"
        for trial in self.trials:
            yield (
                f"{trial.name:{width}}{f'{trial.reached} of {trial.runs}':>14}{trial.bound:10.4f}"
                f"{trial.median:10.2f}{trial.worst:9.2f}{trial.held:8.3f}{trial.lost:6d}"
            )
        yield f"at least: Clopper-Pearson lower bound of the probability, confidence {self.confidence:g}"
        if self.slowest is None:
            return
        yield ""
        width = max(len(item.name) for item in self.sensitivities) + 2
        yield f"slowdown against the nominal plant over {self.draws} draws: rank correlation, range, slowest draw"
        for item in self.sensitivities:
            drawn = f"[{item.low:.3g}, {item.high:.3g}]"
            value = f"{self.slowest.values[item.name]:.4g} {item.unit}"
            yield f"{item.name:{width}}{item.correlation:+6.2f}{drawn:>22}   {value}".rstrip()
        worst = self.slowest
        yield f"slowest draw: {worst.reached} of {worst.runs} reached, slowdown {worst.slowdown:.2f}"


def assess(
    law: Law, problem: Problem, stress: Stress = Stress(), *, confidence: float = 0.95, threads: int = 1
) -> Robustness:
    """How `law` does on `problem` and on harder ones; its plant may be another one, if it sees the same features.

    The bound takes the runs as independent: give each row a start and a draw of its own, none of which the law was
    found on. Rows that share a draw (`crossed`) show its effect more clearly, but then the bound is too high.
    Raises ProblemError if law and problem do not fit, or a setting makes no sense.
    """
    check_kind("law", law, Law)
    check_kind("problem", problem, Problem)
    check_kind("stress", stress, Stress)
    check_number("the confidence", confidence)
    if not 0.0 < confidence < 1.0:
        raise ProblemError(f"the confidence must lie between 0 and 1, got {confidence}")
    arrival, held = _rolled(law, problem, threads)
    trials = [_trial("as given", arrival, held, arrival, confidence)]
    for name, other in harder(problem, stress):
        trials.append(_trial(name, *_rolled(law, other, threads), arrival, confidence))
    numbers, groups = _draws_of(problem)
    sensitivities: tuple[Sensitivity, ...] = ()
    slowest = None
    if problem.draws is not None and len(numbers) >= _FEWEST_DRAWS:
        nominal, held = _rolled(law, replace(problem, draws=None), threads)
        trials.append(_trial("nominal plant", nominal, held, arrival, confidence))
        slowdowns = _slowdowns(problem, arrival, nominal)
        means = np.bincount(groups, slowdowns) / np.bincount(groups)
        sensitivities = tuple(_sensitivities(problem, numbers, means))
        slowest = _slowest(problem, numbers, means, arrival[groups == np.argmax(means)])
    return Robustness(tuple(trials), sensitivities, slowest, len(numbers), confidence)


def _rolled(law: Law, problem: Problem, threads: int) -> tuple[Floats, npt.NDArray[np.bool_]]:
    """Arrival times (S,), and whether each run is at the goal at the horizon."""
    evaluator = Evaluator(replace(problem, stop=False), threads=threads)
    rolled = evaluator.of_program(law.program, law.parameters[np.newaxis])
    measure = problem.arrival(np.hstack([rolled.final[0], evaluator.goals]))[:, 0]
    return rolled.arrival[0], measure <= 0.0


def _trial(
    name: str, arrival: Floats, held: npt.NDArray[np.bool_], given: Floats, confidence: float
) -> Trial:
    times = arrival[np.isfinite(arrival)]
    return Trial(
        name=name,
        runs=len(arrival),
        reached=len(times),
        bound=lower_bound(len(times), len(arrival), confidence),
        median=float(np.median(times)) if len(times) else np.nan,
        worst=float(times.max()) if len(times) else np.nan,
        held=float(held.mean()),
        lost=int(np.sum(np.isfinite(given) & ~np.isfinite(arrival))),
    )


def _names(problem: Problem) -> tuple[str, ...]:
    return (*problem.plant.parameter_names, "delay")


def _draws_of(problem: Problem) -> tuple[Floats, npt.NDArray[np.intp]]:
    """The different draws (D, q + 1) of plant parameters and delay, and which of them each start has."""
    delay = np.zeros(len(problem.starts)) if problem.draws is None else problem.draws.delay
    numbers, groups = np.unique(
        np.column_stack([problem.plant_parameters, delay]), axis=0, return_inverse=True
    )
    return numbers, groups.ravel()


def _slowdowns(problem: Problem, arrival: Floats, nominal: Floats) -> Floats:
    """Arrival times over the nominal ones of the same starts (S,); at least a period, at most the horizon."""
    times, reference = (np.clip(each, problem.period, problem.horizon) for each in (arrival, nominal))
    return times / reference


def _slowest(problem: Problem, numbers: Floats, means: Floats, arrival: Floats) -> Slowest:
    worst = int(np.argmax(means))
    values = dict(zip(_names(problem), numbers[worst].tolist(), strict=True))
    return Slowest(values, len(arrival), int(np.isfinite(arrival).sum()), float(means[worst]))


def _sensitivities(problem: Problem, numbers: Floats, means: Floats) -> Iterator[Sensitivity]:
    units = (*(unit for unit, *_ in problem.plant.parameters.values()), "s")
    for name, unit, values in zip(_names(problem), units, numbers.T, strict=True):
        varies = np.ptp(values) > 0.0 and np.ptp(means) > 0.0
        correlation = float(stats.spearmanr(values, means).statistic) if varies else 0.0
        yield Sensitivity(name, unit, float(values.min()), float(values.max()), correlation)
