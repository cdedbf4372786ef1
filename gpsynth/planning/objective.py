"""What a schedule of equilibrium points costs: Shmalko & Yamshanov, eq. 17, with the time budget T+ given."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from gpsynth.arrays import Floats
from gpsynth.evaluate import Evaluator, Rollouts
from gpsynth.law import Law
from gpsynth.planning.settings import PlanSettings
from gpsynth.schedule import Schedule

Flags = npt.NDArray[np.bool_]

NARROW = 0.2  # m; being in collision for a second weighs as much as this depth
STEEPNESS = 8.0  # 1/(m s) of the obstacle term
INSTANT = 1e-9  # s; a clock reading this close to a switching time has reached it


@dataclass(frozen=True, eq=False)
class Objective:
    """The cost of vectors (N, d), each the points (k, n) and, where they are free, the dwell times (k,) of a schedule.

    It depends on nothing but its arguments: T+ (`budget`, s) is fixed here and tightened outside, between rounds.
    """

    evaluator: Evaluator
    law: Law
    settings: PlanSettings
    budget: float

    def __call__(self, vectors: Floats) -> Floats:
        """Costs (N,)."""
        points, dwell = self.schedules(vectors)
        rollouts = self.rollouts(points, dwell)
        return self.costs(rollouts, points, dwell)

    def schedules(self, vectors: Floats) -> tuple[Floats, Floats]:
        """Points (N, k, n) and dwell times (N, k) of vectors (N, d)."""
        k, n = self.settings.points, self.evaluator.problem.starts.shape[1]
        points = vectors[:, : k * n].reshape(-1, k, n)
        if self.settings.dwell is None:
            step = self.budget / (k + 1)  # eq. 10, the goal being the last point
            return points, np.full((len(vectors), k), step)
        return points, vectors[:, k * n :]

    def schedule(self, vector: Floats) -> Schedule:
        """The schedule of one vector (d,)."""
        points, dwell = self.schedules(vector[np.newaxis])
        return Schedule(points[0], dwell[0])

    def rollouts(self, points: Floats, dwell: Floats) -> Rollouts:
        """Rollouts (N, 1), which end when they can no longer win."""
        problem, settings = self.evaluator.problem, self.settings
        longest = settings.patience * self.budget + (1.0 if settings.patience > 1.0 else 0.0)
        horizon = min(problem.horizon, longest)
        return self.evaluator.of_schedules(self.law, points, dwell, horizon, reach=settings.reach)

    def costs(self, rollouts: Rollouts, points: Floats, dwell: Floats) -> Floats:
        """Costs (N,) of eq. 17; infinity where a rollout diverged."""
        settings = self.settings
        arrived = np.isfinite(rollouts.arrival[:, 0])
        used = np.where(arrived, self.arrivals(rollouts, points, dwell), rollouts.end[:, 0])
        error = self.errors(rollouts.final[:, 0])
        if settings.obstacles == "path":
            error = np.where(arrived, 0.0, error)  # within the tolerance only time counts
        late = np.maximum(0.0, used - self.budget)  # T_penalty
        cost = (
            settings.alpha * error
            + settings.beta * (late + used / self.budget)
            + settings.gamma * self.obstacle_term(rollouts, points)
        )  # eq. 17
        return np.where(rollouts.diverged[:, 0] > 0.0, np.inf, cost)

    def errors(self, states: Floats) -> Floats:
        """Distances (N,) of states (N, n) from the goal, angles wrapped, in the units of the states."""
        problem = self.evaluator.problem
        error = states - problem.goal
        wrapped = np.remainder(error + np.pi, 2.0 * np.pi) - np.pi
        angles = np.array([name in problem.plant.angles for name in problem.plant.state_names])
        distances: Floats = np.linalg.norm(np.where(angles, wrapped, error), axis=1)
        return distances

    def obstacle_term(self, rollouts: Rollouts, points: Floats) -> Floats:
        """C_obs (N,): points that lie in an obstacle, or how much of the path does."""
        if self.settings.obstacles == "points":
            return self.covered(points)
        exposure, depth = rollouts.exposure[:, 0], rollouts.depth[:, 0]
        return np.where(exposure > 0.0, 1.0 + STEEPNESS * (NARROW * exposure + depth), 0.0)

    def admissible(self, rollouts: Rollouts, points: Floats) -> Flags:
        """Whether (N,) the goal is reached, and the path or the points, as the settings ask, are clear of obstacles."""
        free = (
            self.covered(points) == 0.0
            if self.settings.obstacles == "points"
            else rollouts.clearance[:, 0] >= 0.0
        )
        return np.isfinite(rollouts.arrival[:, 0]) & free

    def covered(self, points: Floats) -> Floats:
        """How many of the points (N, k, n) of each schedule lie in an obstacle, as it is at time 0."""
        problem = self.evaluator.problem
        if problem.obstacles is None:
            return np.zeros(len(points))
        names = problem.plant.state_names
        poses = points[..., [names.index(name) for name in problem.obstacles.position]]
        gaps = problem.obstacles.gaps(poses.reshape(-1, poses.shape[-1])).reshape(points.shape[:2])
        inside: Floats = np.sum(gaps < 0.0, axis=1, dtype=np.float64)
        return inside

    def arrivals(self, rollouts: Rollouts, points: Floats, dwell: Floats) -> Floats:
        """Arrival times (N,) between the control periods, so that the cost has no steps of one period.

        The arrival measure is taken as linear in the last period, whose beginning is found backwards along the rates
        at its end. Where points are left as soon as they are reached, the target is not known, and under draws the
        control that acts is not; then the tick counts.
        """
        times = rollouts.arrival[:, 0].copy()
        rows = np.flatnonzero(np.isfinite(times) & (times > 0.0))
        problem, period = self.evaluator.problem, self.evaluator.problem.period
        if not len(rows) or self.settings.reach > 0.0 or problem.draws is not None:
            return times
        states, ends = rollouts.final[rows, 0], times[rows, np.newaxis]
        goals = np.broadcast_to(problem.goal, states.shape)
        due = np.sum(ends - period >= np.cumsum(dwell[rows], axis=1) - INSTANT, axis=1)
        targets = np.concatenate([points[rows], goals[:, np.newaxis]], axis=1)[np.arange(len(rows)), due]
        inputs = np.hstack([states, self.law(states, targets), goals, ends])
        rates = problem.rates(inputs, problem.plant.nominal)[:, : states.shape[1]]
        after = problem.arrival(np.hstack([states, goals]))[:, 0]
        before = problem.arrival(np.hstack([states - period * rates, goals]))[:, 0]
        share = after / np.where(before > after, after - before, -np.inf)
        times[rows] -= period * np.clip(share, 0.0, 1.0)
        return times
