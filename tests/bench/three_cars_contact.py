"""Contact of the three cars' bodies and walls by clipping polygons, independent of what the search was told."""

import itertools

import numpy as np

import gpsynth as gs
from examples import three_cars
from examples.command import Finding
from gpsynth.arrays import Floats

WALLS = [
    np.array([(-20.0, -1.0), (-8.0, -1.0), (-8.0, 1.0), (-20.0, 1.0)]),
    np.array([(8.0, -1.0), (20.0, -1.0), (20.0, 1.0), (8.0, 1.0)]),
]
STEP = 0.002  # s, of the integration and of the check


def body(x: float, y: float, theta: float) -> Floats:
    """The corners (4, 2), counterclockwise."""
    corners = np.array([(-2.0, -1.0), (2.0, -1.0), (2.0, 1.0), (-2.0, 1.0)])
    turn = np.array([(np.cos(theta), np.sin(theta)), (-np.sin(theta), np.cos(theta))])
    return corners @ turn + (x, y)


def common_area(a: Floats, b: Floats) -> float:
    """Area of the intersection of two convex polygons (Sutherland & Hodgman 1974, and the shoelace formula)."""
    points = list(a)
    for first, second in zip(b, np.roll(b, -1, axis=0), strict=True):
        edge = second - first
        inside = [edge[0] * (p[1] - first[1]) - edge[1] * (p[0] - first[0]) for p in points]
        clipped = []
        for k, (p, d) in enumerate(zip(points, inside, strict=True)):
            q, e = points[k - 1], inside[k - 1]
            if (d > 0.0) != (e > 0.0):
                clipped.append(q + (p - q) * (e / (e - d)))
            if d > 0.0:
                clipped.append(p)
        points = clipped
    if len(points) < 3:
        return 0.0
    x, y = np.array(points).T
    return float(abs(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2.0)


def largest_contact(states: Floats) -> float:
    """The largest common area (m^2) of two bodies or of a body and a wall along a path (N, 9)."""
    largest = 0.0
    for state in states:
        bodies = [body(*state[3 * k : 3 * k + 3]) for k in range(3)]
        pairs = [*itertools.combinations(bodies, 2), *itertools.product(bodies, WALLS)]
        near = [(a, b) for a, b in pairs if _near(a, b)]
        largest = max([largest, *(common_area(a, b) for a, b in near)])
    return largest


def deepest(finding: Finding) -> str:
    """In how many of the 8 cases all three cars arrive without contact, and the largest contact."""
    problem = three_cars.meeting(finding.problem.plant, STEP)
    paths = [gs.simulate(problem, finding.best.law, start) for start in problem.starts]
    areas = [largest_contact(path.x) for path in paths]
    good = sum(np.isfinite(path.arrival) and area < 1e-9 for path, area in zip(paths, areas, strict=True))
    last = max(path.arrival for path in paths)
    return f"{good} of 8 without contact, largest common area {max(areas):.3g} m^2, last arrival {last:.2f} s"


def _near(a: Floats, b: Floats) -> bool:
    """Whether the boxes around two polygons meet."""
    return bool(np.all(a.min(axis=0) < b.max(axis=0)) and np.all(b.min(axis=0) < a.max(axis=0)))
