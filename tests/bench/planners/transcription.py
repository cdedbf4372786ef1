"""Direct multiple shooting with IPOPT through CasADi: minimum time over intervals of free length, from several starts.

One interval is an arc with constant v and omega; Simpson's rule integrates it to about 1e-9 m. Obstacles are kept clear
at three points of every interval. The starts are drivable lines along routes of distinct homotopy class.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from applications.rosbot.guides import Guide
from applications.rosbot.scenario import Scenario
from gpsynth.arrays import Floats
from tests.bench.planners.attempt import MARGIN, Answer, Watch, guides_of, resampled

INTERVALS = 60
LOOKED_AT = (1.0 / 3.0, 2.0 / 3.0, 1.0)  # shares of an interval at which obstacles are kept clear
SHORTEST, LONGEST = 0.4, 1.6  # of an interval, as shares of the mean of the start
WITHIN = 0.99  # share of the tolerance that is used


def transcription(scenario: Scenario, seed: int, watch: Watch) -> Iterator[Answer]:
    """A local optimum for each start that converges, those that get better."""
    problem, best = _Problem.of(scenario), np.inf
    for guide in guides_of(scenario, count=5):
        if watch.is_over:
            return
        states, controls, lengths = problem.solve(guide, watch.left)
        total = lengths.sum() if states is not None else np.inf
        if total < best:
            best = total
            yield Answer(watch.spent, controls, lengths)


@dataclass(frozen=True, eq=False)
class _Problem:
    """The nonlinear program of a scenario: states, controls and lengths of the intervals, one after the other."""

    scenario: Scenario
    program: dict[str, Any]
    least: Floats  # of the constraints
    most: Floats

    @classmethod
    def of(cls, scenario: Scenario) -> "_Problem":
        import casadi

        x, u, h = (
            casadi.MX.sym("x", 3, INTERVALS + 1),
            casadi.MX.sym("u", 2, INTERVALS),
            casadi.MX.sym("h", 1, INTERVALS),
        )
        goal = casadi.MX.sym("goal", 3)
        interval = _interval(scenario.discs)
        ends, gaps = interval.map(INTERVALS)(x[:, :-1], u, h)
        miss = x[:, -1] - goal
        parts = [
            (casadi.vec(ends - x[:, 1:]), 0.0, 0.0),
            (casadi.vec(gaps), 0.0, np.inf),
            (casadi.sumsqr(miss[:2]), 0.0, (WITHIN * scenario.position_tolerance) ** 2),
            (miss[2], -WITHIN * scenario.heading_tolerance, WITHIN * scenario.heading_tolerance),
        ]
        least, most = (
            np.concatenate([np.full(part[0].numel(), part[side]) for part in parts]) for side in (1, 2)
        )
        vector = casadi.vertcat(casadi.vec(x), casadi.vec(u), casadi.vec(h))
        constraints = casadi.vertcat(*(part[0] for part in parts))
        return cls(scenario, {"x": vector, "f": casadi.sum2(h), "g": constraints, "p": goal}, least, most)

    def solve(self, guide: Guide, seconds: float) -> tuple[Floats | None, Floats, Floats]:
        """States, controls (n, 2) and lengths (n,) near a guide; None for the states if it does not converge."""
        import casadi

        options = {
            "ipopt": {"max_cpu_time": seconds, "print_level": 0, "sb": "yes", "max_iter": 500, "tol": 1e-5},
            "print_time": False,
        }
        solver = casadi.nlpsol("transcription", "ipopt", self.program, options)
        poses = resampled(guide, INTERVALS + 1)
        length = guide.duration / INTERVALS
        first = np.concatenate(
            [poses.ravel(), self._controls(poses, length).ravel(), np.full(INTERVALS, length)]
        )
        low, high = self._box(length)
        goal = self.scenario.goal.copy()
        goal[2] += 2.0 * np.pi * np.round((poses[-1, 2] - goal[2]) / (2.0 * np.pi))
        found = solver(x0=first, lbx=low, ubx=high, lbg=self.least, ubg=self.most, p=goal)
        vector = np.asarray(found["x"]).ravel()
        states, controls, lengths = np.split(
            vector, [3 * (INTERVALS + 1), 3 * (INTERVALS + 1) + 2 * INTERVALS]
        )
        converged = solver.stats()["success"]
        return states.reshape(-1, 3) if converged else None, controls.reshape(-1, 2), lengths

    def _controls(self, poses: Floats, length: float) -> Floats:
        """What drives from pose to pose, within the limits."""
        steps, middle = np.diff(poses, axis=0), 0.5 * (poses[1:, 2] + poses[:-1, 2])
        along = steps[:, 0] * np.cos(middle) + steps[:, 1] * np.sin(middle)
        low, high = np.array([self.scenario.speed_limits, self.scenario.turn_limits]).T
        return np.clip(np.column_stack([along, steps[:, 2]]) / length, low, high)

    def _box(self, length: float) -> tuple[Floats, Floats]:
        """Bounds of the vector: the start is given, places are within the scenario's bounds."""
        given, start = self.scenario.bounds, self.scenario.start
        sides = []
        for side, share in ((0, SHORTEST), (1, LONGEST)):
            heading = (-np.inf, np.inf)[side]
            states = np.tile([given[side], given[2 + side], heading], (INTERVALS + 1, 1))
            states[0] = start
            limits = [self.scenario.speed_limits[side], self.scenario.turn_limits[side]]
            sides.append(
                np.concatenate(
                    [states.ravel(), np.tile(limits, INTERVALS), np.full(INTERVALS, share * length)]
                )
            )
        return sides[0], sides[1]


def _interval(discs: Floats) -> Any:
    """(state, controls, length) -> the state at the end, and what is to be at least 0 for the path to be clear (m)."""
    import casadi

    x, u, h = casadi.SX.sym("x", 3), casadi.SX.sym("u", 2), casadi.SX.sym("h")
    gaps = []
    for share in LOOKED_AT:
        end = _driven(x, u, share * h)
        for cx, cy, radius in discs.tolist():
            kept = radius + MARGIN
            gaps.append(((end[0] - cx) ** 2 + (end[1] - cy) ** 2 - kept**2) / (2.0 * kept))
    return casadi.Function("interval", [x, u, h], [_driven(x, u, h), casadi.vertcat(*gaps)])


def _driven(x: Any, u: Any, time: Any) -> Any:
    import casadi

    begin, middle, end = (x[2] + share * u[1] * time for share in (0.0, 0.5, 1.0))
    sixth = time * u[0] / 6.0
    dx = sixth * (casadi.cos(begin) + 4.0 * casadi.cos(middle) + casadi.cos(end))
    dy = sixth * (casadi.sin(begin) + 4.0 * casadi.sin(middle) + casadi.sin(end))
    return casadi.vertcat(x[0] + dx, x[1] + dy, end)
