"""Formulas to be found again: the 19 problems of the comparison, and others of the same kinds that nothing is tuned on.

Sources: Nguyen, Keijzer, Pagie, Vladislavleva, Korns and Jin as collected by McDermott et al. (GECCO 2012); Livermore,
R and Constant by Mundhenk et al. and Petersen et al. (2021); Feynman by Udrescu and Tegmark (2020).
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from gpsynth.arrays import Floats

Rows = Callable[[np.random.Generator], Floats]


class Case(NamedTuple):
    """One problem: rows to learn from, rows to be judged on."""

    name: str
    target: Callable[..., Floats]  # of columns
    train: Rows
    test: Rows
    noise: float = 0.0  # standard deviation, as a share of that of y in the training rows

    def data(self, seed: int) -> tuple[Floats, Floats, Floats, Floats]:
        """X and y to learn from, X and y of the test, drawn anew for each seed."""
        rng = np.random.default_rng([seed, *self.name.encode()])
        inner, outer = self.train(rng), self.test(rng)
        y = self.target(*inner.T)
        y = y + self.noise * y.std() * rng.standard_normal(len(y))
        return inner, y, outer, self.target(*outer.T)


def uniform(n: int, *ranges: tuple[float, float]) -> Rows:
    """n rows, column j uniform in ranges[j]."""
    low, high = np.array(ranges).T
    return lambda rng: rng.uniform(low, high, (n, len(low)))


def _line(first: float, last: float, step: float) -> Rows:
    return lambda rng: np.arange(first, last + step / 2, step)[:, None]


def _grid(first: float, last: float, step: float) -> Rows:
    axis = np.arange(first, last + step / 2, step)
    return lambda rng: np.stack(np.meshgrid(axis, axis), axis=-1).reshape(-1, 2)


def _both(
    name: str, target: Callable[..., Floats], n: int, *ranges: tuple[float, float], noise: float = 0.0
) -> Case:
    return Case(name, target, uniform(n, *ranges), uniform(1000, *ranges), noise)


def _power_sum(degree: int) -> Callable[[Floats], Floats]:
    return lambda x: sum(x**k for k in range(1, degree + 1))


def _harmonic(x: Floats) -> Floats:
    return np.array([np.sum(1.0 / np.arange(1, int(k) + 1)) for k in x])


def _poly10(*x: Floats) -> Floats:
    return x[0] * x[1] + x[2] * x[3] + x[4] * x[5] + x[0] * x[6] * x[8] + x[2] * x[5] * x[9]


UNIT, SQUARE = (-1.0, 1.0), (0.0, 1.0)
SUITE: tuple[Case, ...] = (
    *(_both(f"Nguyen-{d - 2}", _power_sum(d), 20, UNIT) for d in (3, 4, 5, 6)),
    _both("Nguyen-5", lambda x: np.sin(x**2) * np.cos(x) - 1, 20, UNIT),
    _both("Nguyen-6", lambda x: np.sin(x) + np.sin(x + x**2), 20, UNIT),
    _both("Nguyen-7", lambda x: np.log(x + 1) + np.log(x**2 + 1), 20, (0, 2)),
    _both("Nguyen-8", np.sqrt, 20, (0, 4)),
    _both("Nguyen-9", lambda x, y: np.sin(x) + np.sin(y**2), 20, SQUARE, SQUARE),
    _both("Nguyen-10", lambda x, y: 2 * np.sin(x) * np.cos(y), 20, SQUARE, SQUARE),
    Case("Keijzer-6", _harmonic, _line(1, 50, 1), _line(1, 120, 1)),
    Case(
        "Pagie-1",
        lambda x, y: 1 / (1 + x**-4) + 1 / (1 + y**-4),
        _grid(-5, 5, 0.4),
        uniform(1000, (-5, 5), (-5, 5)),
    ),
    Case(
        "Vladislavleva-4",
        lambda *x: 10 / (5 + sum((x_i - 3) ** 2 for x_i in x)),
        uniform(1024, *[(0.05, 6.05)] * 5),
        uniform(5000, *[(-0.25, 6.35)] * 5),
    ),
    _both("Poly-10", _poly10, 250, *[UNIT] * 10),
    _both("I.6.2a", lambda t: np.exp(-(t**2) / 2) / np.sqrt(2 * np.pi), 1000, (1, 3)),
    _both("I.12.11", lambda q, e, b, v, th: q * (e + b * v * np.sin(th)), 1000, *[(1, 5)] * 5),
    _both(
        "I.29.16", lambda a, b, p, q: np.sqrt(a**2 + b**2 - 2 * a * b * np.cos(p - q)), 1000, *[(1, 5)] * 4
    ),
    _both(
        "I.34.14", lambda c, v, w: w * (1 + v / c) / np.sqrt(1 - v**2 / c**2), 1000, (3, 10), (1, 2), (1, 5)
    ),
    _both("I.50.26", lambda x, w, t, a: x * (np.cos(w * t) + a * np.cos(w * t) ** 2), 1000, *[(1, 3)] * 4),
)

HELD_OUT: tuple[Case, ...] = (
    _both("Nguyen-11", lambda x, y: np.exp(y * np.log(x)), 20, SQUARE, SQUARE),
    _both("Nguyen-12", lambda x, y: x**4 - x**3 + y**2 / 2 - y, 20, SQUARE, SQUARE),
    _both("Livermore-1", lambda x: 1 / 3 + x + np.sin(x**2), 100, (-10, 10)),
    _both("Livermore-3", lambda x: np.sin(x**3) * np.cos(x**2) - 1, 20, UNIT),
    _both("Livermore-4", lambda x: np.log(x + 1) + np.log(x**2 + 1) + np.log(x), 20, (0, 2)),
    _both("Livermore-7", np.sinh, 20, UNIT),
    _both("Livermore-14", lambda x: x**3 + x**2 + x + np.sin(x) + np.sin(x**2), 20, UNIT),
    _both("Livermore-17", lambda x, y: 4 * np.sin(x) * np.cos(y), 20, SQUARE, SQUARE),
    _both("R-1", lambda x: (x + 1) ** 3 / (x**2 - x + 1), 20, UNIT),
    _both("R-2", lambda x: (x**5 - 3 * x**3 + 1) / (x**2 + 1), 20, UNIT),
    _both("R-3", lambda x: (x**6 + x**5) / (x**4 + x**3 + x**2 + x + 1), 20, UNIT),
    _both("Constant-3", lambda x, y: np.sin(1.5 * x) * np.cos(0.5 * y), 20, SQUARE, SQUARE),
    _both("Constant-6", lambda x: np.exp(0.426 * np.log(x)), 20, (0, 4)),
    _both("Constant-8", lambda x: np.log(x + 1.4) + np.log(x**2 + 1.3), 20, (0, 2)),
    _both(
        "Keijzer-4",
        lambda x: x**3 * np.exp(-x) * np.cos(x) * np.sin(x) * (np.sin(x) ** 2 * np.cos(x) - 1),
        200,
        (0, 10),
    ),
    _both("Keijzer-5", lambda x, y, z: 30 * x * z / ((x - 10) * y**2), 1000, UNIT, (1, 2), UNIT),
    _both("Keijzer-11", lambda x, y: x * y + np.sin((x - 1) * (y - 1)), 100, (-3, 3), (-3, 3)),
    _both("Keijzer-14", lambda x, y: 8 / (2 + x**2 + y**2), 100, (-3, 3), (-3, 3)),
    _both("Keijzer-15", lambda x, y: x**3 / 5 + y**3 / 2 - y - x, 100, (-3, 3), (-3, 3)),
    _both(
        "Vladislavleva-1",
        lambda x, y: np.exp(-((x - 1) ** 2)) / (1.2 + (y - 2.5) ** 2),
        100,
        (0.3, 4),
        (0.3, 4),
    ),
    _both(
        "Vladislavleva-5",
        lambda x, y, z: 30 * (x - 1) * (z - 1) / (y**2 * (x - 10)),
        300,
        (0.05, 2),
        (1, 2),
        (0.05, 2),
    ),
    _both(
        "Vladislavleva-7",
        lambda x, y: (x - 3) * (y - 3) + 2 * np.sin((x - 4) * (y - 4)),
        300,
        (0.05, 6.05),
        (0.05, 6.05),
    ),
    _both(
        "Vladislavleva-8",
        lambda x, y: ((x - 3) ** 4 + (y - 3) ** 3 - (y - 3)) / ((y - 2) ** 4 + 10),
        300,
        (0.05, 6.05),
        (0.05, 6.05),
    ),
    _both("Korns-4", lambda a, b, c, d, e: -2.3 + 0.13 * np.sin(c), 500, *[(-50, 50)] * 5),
    _both("Korns-6", lambda a, b, c, d, e: 1.3 + 0.13 * np.sqrt(a), 500, *[(0, 50)] * 5),
    _both(
        "Korns-7", lambda a, b, c, d, e: 213.80940889 * (1 - np.exp(-0.54723748542 * a)), 500, *[(0, 10)] * 5
    ),
    _both("Jin-1", lambda x, y: 2.5 * x**4 - 1.3 * x**3 + 0.5 * y**2 - 1.7 * y, 100, (-3, 3), (-3, 3)),
    _both("Jin-5", lambda x, y: 1.5 * np.exp(x) + 5 * np.cos(y), 100, (-3, 3), (-3, 3)),
    _both("Jin-6", lambda x, y: 1.35 * x * y + 5.5 * np.sin((x - 1) * (y - 1)), 100, (-3, 3), (-3, 3)),
    _both("I.8.14", lambda a, b, c, d: np.sqrt((b - a) ** 2 + (d - c) ** 2), 1000, *[(1, 5)] * 4),
    _both("I.10.7", lambda m, v, c: m / np.sqrt(1 - v**2 / c**2), 1000, (1, 5), (1, 2), (3, 10)),
    _both(
        "I.15.3x",
        lambda x, u, c, t: (x - u * t) / np.sqrt(1 - u**2 / c**2),
        1000,
        (5, 10),
        (1, 2),
        (3, 20),
        (1, 2),
    ),
    _both("I.16.6", lambda c, v, u: (u + v) / (1 + u * v / c**2), 1000, *[(1, 5)] * 3),
    _both("I.18.4", lambda m, n, r, s: (m * r + n * s) / (m + n), 1000, *[(1, 5)] * 4),
    _both("I.37.4", lambda a, b, d: a + b + 2 * np.sqrt(a * b) * np.cos(d), 1000, *[(1, 5)] * 3),
    _both("I.40.1", lambda n, m, g, x, t: n * np.exp(-m * g * x / t), 1000, *[(1, 3)] * 5),
    _both("I.44.4", lambda n, t, v, w: n * t * np.log(w / v), 1000, *[(1, 5)] * 4),
    _both(
        "II.6.15a",
        lambda e, p, r, x, y, z: 3 * p * z * np.sqrt(x**2 + y**2) / (e * r**5),
        1000,
        *[(1, 3)] * 6,
    ),
    _both(
        "II.11.27", lambda n, a, e, f: n * a * e * f / (1 - n * a / 3), 1000, (0, 1), (0, 1), (1, 2), (1, 2)
    ),
    _both("II.35.18", lambda n, m, b, t: n / (np.exp(m * b / t) + np.exp(-m * b / t)), 1000, *[(1, 3)] * 4),
    _both("III.10.19", lambda m, a, b, c: m * np.sqrt(a**2 + b**2 + c**2), 1000, *[(1, 5)] * 4),
    _both("III.17.37", lambda b, a, t: b * (1 + a * np.cos(t)), 1000, *[(1, 5)] * 3),
    _both(
        "I.26-like",
        lambda n, i, d: i * np.sin(n * d / 2) ** 2 / np.sin(d / 2) ** 2,
        1000,
        (1, 5),
        (1, 5),
        (1, 3),
    ),
    _both("damped", lambda t: 2 * np.exp(-0.7 * t) * np.cos(3.1 * t) + 0.3, 200, (0, 5)),
    _both(
        "additive-3",
        lambda x, y, z: np.sin(2 * x) + np.exp(-(y**2)) + np.sqrt(z),
        200,
        (0, 3),
        (0, 3),
        (0, 3),
    ),
    _both("nested", lambda x, y: np.sqrt(1 + np.exp(np.sin(x * y))), 200, (0, 3), (0, 3)),
    _both("noisy-poly", lambda x, y: x**2 * y - 2 * y + 1, 300, (-2, 2), (-2, 2), noise=0.02),
    _both("noisy-wave", lambda x, y: y * np.sin(2 * x) + 0.5 * x, 300, (0, 4), (0, 4), noise=0.02),
    _both("noisy-ratio", lambda x, y: x / (1 + y**2), 300, (-3, 3), (-3, 3), noise=0.02),
)
