"""What a schedule of equilibrium points costs: Shmalko & Yamshanov, eq. 17, with the time budget T+ given."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from gpsynth.arrays import Floats
from gpsynth.evaluate import Evaluator
from gpsynth.kernels.layout import Toll, readonly
from gpsynth.law import Law
from gpsynth.planning.settings import PlanSettings
from gpsynth.rollouts import Rollouts
from gpsynth.schedule import Schedule

Flags = npt.NDArray[np.bool_]

NARROW = 0.2  # m; being in collision for a second weighs as much as this depth
STEEPNESS = 8.0  # 1/(m s) of the obstacle term
TOUCHING = 1e-10  # m; a path that touches an obstacle is clear, and rounding may show an overlap of less
ROUNDING = 1e-9  # of a limit: what is above it by no more is not above it


@dataclass(frozen=True, eq=False)
class Objective:
    """The cost of vectors (N, d), each the points (k, n) and, where they are free, the dwell times (k,) of a schedule.

    It depends on nothing but its arguments: T+ (`budget`, s) is fixed here and tightened outside, between rounds.
    """

    evaluator: Evaluator
    law: Law
    settings: PlanSettings
    budget: float

    def __call__(self, vectors: Floats, limits: Floats | None = None) -> Floats:
        """Costs (N,); what costs more than its limit (N,) need not be rolled out to its end, and costs more anyway."""
        points, dwell = self.schedules(vectors)
        return self.costs(self.rollouts(points, dwell, limits), points)

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

    def rollouts(self, points: Floats, dwell: Floats, limits: Floats | None = None) -> Rollouts:
        """Rollouts (N, 1), which end when they can no longer win: at once if they are given limits (N,) of cost."""
        problem, settings = self.evaluator.problem, self.settings
        longest = settings.patience * self.budget + (1.0 if settings.patience > 1.0 else 0.0)
        horizon = min(problem.horizon, longest)
        toll = self._toll(limits) if limits is not None and problem.stop else None
        return self.evaluator.of_schedules(self.law, points, dwell, horizon, reach=settings.reach, toll=toll)

    def costs(self, rollouts: Rollouts, points: Floats) -> Floats:
        """Costs (N,) of eq. 17; infinity where a rollout diverged."""
        settings = self.settings
        arrived = np.isfinite(rollouts.arrival[:, 0])
        used = self.spent(rollouts)
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

    def spent(self, rollouts: Rollouts) -> Floats:
        """T_used (N,) in s: the arrival time or the end of the rollout, with what the weights add."""
        arrival, end = rollouts.arrival[:, 0], rollouts.end[:, 0]
        arrived = np.isfinite(arrival)
        used = np.where(arrived, self.arrivals(rollouts), end)
        if self.settings.weights.is_time_alone:
            return used
        last = np.where(arrived, arrival, end)
        return rollouts.cost[:, 0] * np.where(last > 0.0, used / np.where(last > 0.0, last, 1.0), 1.0)

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
        return obstacle_term(rollouts.exposure[:, 0], rollouts.depth[:, 0])

    def admissible(self, rollouts: Rollouts, points: Floats) -> Flags:
        """Whether (N,) the goal is reached, and the path or the points, as the settings ask, are clear of obstacles."""
        free = (
            self.covered(points) == 0.0
            if self.settings.obstacles == "points"
            else rollouts.clearance[:, 0] >= -TOUCHING
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

    def arrivals(self, rollouts: Rollouts) -> Floats:
        """Arrival times (N,) between the control periods, so that the cost has no steps of one period."""
        behind = self.evaluator.problem.period * rollouts.share[:, 0]
        times: Floats = rollouts.arrival[:, 0] - behind
        return times

    def _toll(self, limits: Floats) -> Toll:
        """What a rollout will cost at least, eq. 17, against the limits (N,); arrival is always at the goal."""
        settings, problem, world = self.settings, self.evaluator.problem, self.evaluator.world
        on_path = settings.obstacles == "path"
        gamma = settings.gamma if on_path else 0.0
        slack = float(np.hypot(*problem.tolerance[world.position[:2]])) if len(world.position) else 0.0
        return Toll(
            limits=readonly(limits * (1.0 + ROUNDING)),
            due=self.budget,
            rate=settings.beta / self.budget,
            late=settings.beta,
            pace=1.0 / settings.top_speed if len(world.position) else 0.0,
            slack=slack,
            entry=gamma,
            exposure=gamma * STEEPNESS * NARROW,
            depth=gamma * STEEPNESS,
        )


def obstacle_term(exposure: Floats, depth: Floats) -> Floats:
    """C_obs of paths that are for so long (s), and so deep (m s), within obstacles and their margin."""
    return np.where(exposure > 0.0, 1.0 + STEEPNESS * (NARROW * exposure + depth), 0.0)
