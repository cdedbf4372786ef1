"""The least cost of the Landau oscillator over all controls |b| <= 1, by dynamic programming (Bellman 1957).

The value function stands on a grid over the plane and is interpolated by cubic splines; a step is RK4 with b held. What
comes out is no law, but what no law can undercut; followed from a start, it is a control whose cost is integrated anew.
"""

import numpy as np
from scipy.linalg import solve_continuous_are
from scipy.ndimage import map_coordinates, spline_filter

from gpsynth.arrays import Floats

EDGE = 1.3  # beyond the cycle, towards which every orbit outside runs
LEVELS = np.linspace(-1.0, 1.0, 21)
FINE = np.linspace(-1.0, 1.0, 401)
WEIGHT = 0.01  # of b^2


def rates(y: Floats, b: Floats | float) -> Floats:
    """Derivatives of a1, a2 and the cost, (3, ...)."""
    square = y[0] ** 2 + y[1] ** 2
    return np.array(
        [(1 - square) * y[0] - y[1], (1 - square) * y[1] + y[0] + b, square + WEIGHT * b**2 + 0 * y[0]]
    )


def stepped(a1: Floats, a2: Floats, b: Floats | float, step: float) -> Floats:
    """a1, a2 and cost after one step, (3, ...)."""
    y = np.array([a1, a2, np.zeros_like(a1)])
    k1 = rates(y, b)
    k2 = rates(y + step / 2 * k1, b)
    k3 = rates(y + step / 2 * k2, b)
    k4 = rates(y + step * k3, b)
    return y + step / 6 * (k1 + 2 * k2 + 2 * k3 + k4)


def optimum(
    nodes: int, step: float, starts: list[tuple[float, float]], seconds: float = 8.0
) -> tuple[float, float]:
    """Mean over the starts of the value, and of the cost of the control that follows it."""
    axis = np.linspace(-EDGE, EDGE, nodes)
    a1, a2 = np.meshgrid(axis, axis, indexing="ij")
    moves = [stepped(a1, a2, b, step) for b in LEVELS]
    riccati = solve_continuous_are([[1, -1], [1, 1]], [[0], [1]], np.eye(2), [[WEIGHT]])
    value = np.minimum(np.einsum("iab,ij,jab->ab", (a1, a2), riccati, (a1, a2)), 3.0)

    def ahead(spline: Floats, move: Floats) -> Floats:
        places = np.clip((move[:2] + EDGE) / (axis[1] - axis[0]), 0, nodes - 1)
        return move[2] + map_coordinates(spline, places, order=3, prefilter=False, mode="nearest")

    for _ in range(round(seconds / step)):
        spline = spline_filter(value, order=3)
        costs = np.array([ahead(spline, move) for move in moves])
        value = ahead(spline, stepped(a1, a2, _lowest(costs), step))
    spline = spline_filter(value, order=3)
    values = [float(ahead(spline, np.array([[x], [y], [0.0]]))[0]) for x, y in starts]
    followed = []
    for start in starts:
        state = np.array([*start, 0.0])
        for _ in range(round(15.0 / step)):
            every = stepped(np.full_like(FINE, state[0]), np.full_like(FINE, state[1]), FINE, step)
            state[:] = (0, 0, state[2]) + every[:, ahead(spline, every).argmin()]
        followed.append(state[2])
    return float(np.mean(values)), float(np.mean(followed))


def _lowest(costs: Floats) -> Floats:
    """The control of least cost, between the levels by a parabola."""
    at = costs.argmin(axis=0)
    middle = np.clip(at, 1, len(LEVELS) - 2)
    low, mid, high = (np.take_along_axis(costs, (middle + k)[None], 0)[0] for k in (-1, 0, 1))
    bend = np.maximum(low - 2 * mid + high, 1e-12)
    shift = np.clip((low - high) / (2 * bend), -1.0, 1.0)
    inside = (at > 0) & (at < len(LEVELS) - 1)
    lowest: Floats = np.where(inside, LEVELS[middle] + (LEVELS[1] - LEVELS[0]) * shift, LEVELS[at])
    return lowest


if __name__ == "__main__":
    print(optimum(121, 0.1, [(1.0, 0.0), (0.0, 1.0)], 6.0))
