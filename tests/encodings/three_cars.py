"""Three cars that follow equilibrium points moved by a multilayer network operator, as published in 2016.

A simulation of its own, in plain numpy on all eight cases at once: it shares nothing with the package but the formula
under test.
"""

import itertools
from collections.abc import Callable

import numpy as np

from gpsynth.encodings.layers import Layers

STEP, HORIZON, NEAR = 0.01, 8.0, 0.01  # s, s, largest error at the goals
GOALS = np.array([[-5.0, 0.0, 0.0], [0.0, 0.0, 0.0], [5.0, 0.0, 0.0]])
STARTS = np.array(
    [[(a, 2.0, 0), (b, 4.0, 0), (c, 6.0, 0)] for a, b, c in itertools.product((-10.0, 10.0), repeat=3)]
)
LEFT = np.array([(-8.0, 1.0), (-20.0, 1.0), (-20.0, -1.0), (-8.0, -1.0)])
RIGHT = np.array([(20.0, 1.0), (8.0, 1.0), (8.0, -1.0), (20.0, -1.0)])
BODY = np.array([(2.0, 1.0), (-2.0, 1.0), (-2.0, -1.0), (2.0, -1.0)])  # m along and across the heading
Q = (10.218, 0.44775390625, 1.4932, 0.42098, 14.37744140625, 8.479736328125, 0.28297)
PARAMETERS = (
    *(-8.0413818359375, 6.904296875, -8.5955810546875, 8.2806396484375, -8.6083984375),
    *(-2.49053955078125, 9.74212646484375, 3.56048583984375, -0.2154541015625),
)  # of the published solution 148
EDGES = [*((node, 6 + node // 2) for node in range(6)), *((node, node + 3) for node in range(6, 13))]


def basic_network() -> Layers:
    """Four layers of 16 nodes: each of three weights a car's equilibrium point, the last gathers the headings."""
    entries = np.zeros((4, 16, 16), dtype=np.int32)
    for tail, head in EDGES:
        entries[:, tail, head] = 1
    for node in range(6, 16):
        entries[:, node, node] = 1
    entries[:3, range(6, 9), range(6, 9)] = 2
    return Layers(
        entries,
        (
            *(tuple((0, 3 * car + k + 9 * q) for k in range(3) for q in range(2)) for car in range(3)),
            ((1, 14), (1, 15), (2, 14), (2, 15), (3, 14), (3, 15)),
        ),
        9,
        9,
        ((1, 15), (1, 13), (4, 15), (2, 15), (2, 13), (4, 14), (3, 15), (3, 13), (4, 13)),
    )


def driven(
    law: Callable[[np.ndarray], np.ndarray], obstacles: tuple[np.ndarray, ...]
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Time, penalty and miss of each case; `law` gives the velocities of the nine coordinates from these.

    F0 sums times and penalties, F1 misses and penalties.
    """
    cars, points = STARTS.copy(), np.broadcast_to(GOALS, STARTS.shape).copy()
    points[:, :, 1] -= STARTS[:, :, 1]
    penalty, end = np.zeros(8), np.zeros(8)
    running = np.ones(8, dtype=bool)
    while running.any():
        paid, stopped = contacts(cars, obstacles)
        penalty += np.where(running, paid, 0.0)
        moved = heun(cars, points, law, stopped)
        cars = np.where(running[:, None, None], moved[0], cars)
        points = np.where(running[:, None, None], moved[1], points)
        end += np.where(running, STEP, 0.0)
        running &= (end <= HORIZON + 1e-9) & (np.abs(cars - GOALS).max(axis=(1, 2)) >= NEAR)
    return end, 0.5 * STEP * penalty, np.abs(cars - GOALS).max(axis=(1, 2))


def heun(cars, points, law, stopped):
    first = velocities(cars, points, law, stopped)
    second = velocities(cars + STEP * first[0], points + STEP * first[1], law, stopped)
    return cars + 0.5 * STEP * (first[0] + second[0]), points + 0.5 * STEP * (first[1] + second[1])


def velocities(cars, points, law, stopped):
    u1, u2 = stabilizer(*np.moveaxis(points - cars, -1, 0))
    u1 = np.where(stopped, 0.0, np.clip(u1, -5.0, 5.0))
    u2 = np.where(stopped, 0.0, np.clip(u2, -1.0, 1.0))
    theta = cars[..., 2]
    rates = np.stack([u1 * np.cos(theta), u1 * np.sin(theta), 0.5 * u1 * np.tan(u2)], axis=-1)
    moving = law(points.reshape(8, 9)).reshape(8, 3, 3)
    return np.clip(rates, -1e8, 1e8), np.clip(moving, -1e8, 1e8)


def contacts(cars, obstacles):
    """What each case pays now, and which cars stand still for a step because one before them has the way."""
    corners = cars[:, :, None, :2] + turned(BODY, cars[..., 2])
    paid, stopped = np.zeros(8), np.zeros((8, 3), dtype=bool)
    for car in range(3):
        for obstacle in obstacles:
            rectangle = np.broadcast_to(obstacle, (8, 4, 2))
            paid += depth(corners[:, car], rectangle) + depth(rectangle, corners[:, car])
        for other in range(car):
            overlap = depth(corners[:, car], corners[:, other]) + depth(corners[:, other], corners[:, car])
            paid += overlap
            stopped[:, car] |= overlap > 0.0
    return paid, stopped


def turned(body, theta):
    c, s = np.cos(theta)[..., None], np.sin(theta)[..., None]
    return np.stack([c * body[:, 0] - s * body[:, 1], s * body[:, 0] + c * body[:, 1]], axis=-1)


def depth(inner, outer):
    """Distances to the nearest corner of `outer` of the corners of `inner` strictly inside it, summed (8,)."""
    side = np.roll(outer, -1, axis=1) - outer  # (8, 4, 2)
    arm = inner[:, :, None] - outer[:, None]  # (8, inner, outer, 2)
    cross = side[:, None, :, 0] * arm[..., 1] - side[:, None, :, 1] * arm[..., 0]
    inside = (cross > 0).all(axis=-1) | (cross < 0).all(axis=-1)
    nearest = np.sqrt((arm**2).sum(axis=-1)).min(axis=-1)
    return np.where(inside, nearest, 0.0).sum(axis=-1)


def stabilizer(dx, dy, dtheta):
    """The published law of a single car; functions by their network-operator numbers."""
    z9 = -Q[2] * dtheta * dy + Q[1] * dy + Q[0] * dx
    z15 = 0.5 * (Q[3] * z9 + rho19(Q[0] * dx)) + rho8(Q[3] * z9) + dx * dx * dx
    a = sgn(Q[6] * dx) * np.sqrt(np.abs(Q[6] * dx)) * Q[5] * dtheta
    z10 = a + Q[4] * dy + Q[6] * dx + rho5(a) + sgn(Q[4] * dy) - Q[6] * dx
    z13 = z10 + sgn(z10) * np.sqrt(np.abs(z10)) + rho18(a)
    z115 = z13 * np.cos(dx) + rho18(z13) + rho5(z10)
    return 1.5 * z15, rho18(3.0 * z115 + rho19(3.0 * z15))


def sgn(z):
    return np.where(z < 0, -1.0, 1.0)


def rho5(z):
    small = np.abs(z) <= 1e-8
    return np.where(small, sgn(z) * 1e8, 1.0 / np.where(small, 1.0, z))


def rho8(z):
    e = np.exp(-np.clip(z, -19.0, 19.0))
    return np.where(np.abs(z) > 18.420680743952367, sgn(z), (1.0 - e) / (1.0 + e))


def rho18(z):
    e = np.exp(np.minimum(np.abs(z), 19.0)) - 1.0
    return sgn(z) * np.where(np.abs(z) > 18.420680743952367, 1e8, e)


def rho19(z):
    return sgn(z) * np.where(np.abs(z) > 1e8, 1e-8, np.exp(-np.abs(z)))
