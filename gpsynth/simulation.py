"""One trajectory, for people: the same kernel as `evaluate`, with everything it passes through kept."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from gpsynth.arrays import Floats, numbers
from gpsynth.checks import check_kind, check_whole
from gpsynth.errors import ProblemError
from gpsynth.evaluate import Evaluator, check_law, periods_of, roll
from gpsynth.kernels import rollout
from gpsynth.kernels.layout import Lanes, sealed
from gpsynth.law import Law
from gpsynth.plant import Plant
from gpsynth.plotting import plot_trajectory
from gpsynth.problem import Problem
from gpsynth.schedule import Schedule

if TYPE_CHECKING:
    from gpsynth.plotting import Axes


@dataclass(frozen=True)
class Trajectory:
    """A closed loop in time, N control periods long."""

    plant: Plant
    t: Floats  # (N + 1,) s
    x: Floats  # (N + 1, n)
    u: Floats  # (N, m) computed at each tick and held over the period; with a delay it acts that much later
    target: Floats  # (N + 1, n)
    arrival: float  # s, infinity if the goal is not reached
    cost: float  # running cost, infinity if the rollout diverged
    clearance: float  # m, smallest along the path, robot radius deducted; infinity without obstacles

    @property
    def units(self) -> Mapping[str, str]:
        """Name -> unit of the states, then of the controls."""
        return {**self.plant.states, **{name: unit for name, (unit, _, _) in self.plant.controls.items()}}

    def plot(self, *, shown: Sequence[str] = (), ax: "Axes | None" = None) -> "Axes":
        """States over time, or those states and controls that are to be `shown` (`gpsynth.plotting`)."""
        return plot_trajectory(self, shown=shown, ax=ax)


def simulate(  # noqa: PLR0913 names each choice as a keyword
    problem: Problem,
    law: Law,
    start: Floats | None = None,
    *,
    schedule: Schedule | None = None,
    horizon: float | None = None,
    reach: float = 0.0,
    row: int = 0,
) -> Trajectory:
    """The closed loop of `law` from `start` (n,) until arrival or the horizon (s).

    `row` says which of the problem's starts it is by default, and under which of its draws. The target is the problem's
    goal, or the points of `schedule` and then the goal; `reach` as in `of_schedules`. Raises ProblemError if start,
    row, schedule, horizon or reach do not fit, or the law is not for the problem's plant and features.
    """
    check_law(problem, law)
    states = len(problem.plant.state_names)
    check_whole("row", row, 0)
    check_kind("schedule", schedule, Schedule, optional=True)
    if row >= len(problem.starts):
        raise ProblemError(f"there is no row {row}; the problem has {len(problem.starts)} starts")
    starts = problem.starts.copy()
    if start is not None:
        starts[row] = _start(start, states)
    horizon = problem.horizon if horizon is None else horizon
    periods = periods_of(problem, horizon)
    points = np.empty((0, states)) if schedule is None else schedule.points
    ends = np.empty(0) if schedule is None else schedule.ends
    if points.shape[1] != states:
        raise ProblemError(f"the points of the schedule have shape {points.shape}; expected (k, {states})")
    evaluator = Evaluator(problem, block=1)
    lanes = Lanes(
        picks=np.array([[row, 0, 0]], dtype=np.int32),
        starts=starts,
        goals=evaluator.goals,
        parameters=np.array(law.parameters, dtype=np.float64)[np.newaxis],
        points=np.array(points, dtype=np.float64)[np.newaxis],
        ends=np.array(ends, dtype=np.float64)[np.newaxis],
    )
    controls = len(problem.plant.control_names)
    trace = np.empty((1, periods + 1, 2 * states + controls))
    result = roll(evaluator, law.program, sealed(lanes), evaluator.until(horizon, reach=reach), trace)[0]
    ticks = round(result[rollout.END] / problem.period) + 1
    path = trace[0, :ticks]
    return Trajectory(
        plant=problem.plant,
        t=np.arange(ticks) * problem.period,
        x=path[:, :states],
        u=path[:-1, states : states + controls],
        target=path[:, states + controls :],
        arrival=float(result[rollout.ARRIVAL]),
        cost=float(result[rollout.COST]),
        clearance=float(result[rollout.CLEARANCE]),
    )


def _start(start: Floats, states: int) -> Floats:
    origin = numbers("the start", start)
    if origin.shape != (states,):
        raise ProblemError(f"the start has shape {origin.shape}; expected ({states},)")
    if not np.isfinite(origin).all():
        raise ProblemError(f"the start holds NaN or infinity: {origin.tolist()}; expected finite numbers")
    return origin
