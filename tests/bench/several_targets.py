"""`python -m tests.bench.several_targets`: rate equations found together, beside one target at a time.

Both have the same budget, `--evaluations` in all. Size: nodes of the chosen formulas, what they share counted once if
they are found together. Error: 1 - R2 of the worst target against the equations without noise, on the training rows.
"""

import argparse
from collections.abc import Callable

import numpy as np

import gpsynth
from gpsynth.arrays import Floats

ROWS = 100


def reactor(c: Floats, temperature: Floats) -> tuple[Floats, ...]:
    """A stirred tank: concentration and temperature."""
    rate = 5.0 * np.exp(-3.0 / temperature) * c
    return 1.0 - c - rate, 1.0 - temperature + 2.5 * rate


def gravity(x: Floats, y: Floats) -> tuple[Floats, ...]:
    """The pull of one body in a plane."""
    return -x / (x * x + y * y) ** 1.5, -y / (x * x + y * y) ** 1.5


def enzyme(s: Floats, p: Floats) -> tuple[Floats, ...]:
    """Michaelis and Menten: substrate and product."""
    rate = 2.3 * s / (0.7 + s)
    return 0.4 - rate, 0.8 * rate - 0.3 * p


def epidemic(s: Floats, e: Floats, i: Floats) -> tuple[Floats, ...]:
    """Susceptible, exposed and infected, with an incidence that falls again."""
    incidence = 1.7 * s * i / (1.0 + 2.2 * i * i)
    return -incidence, incidence - 0.4 * e, 0.4 * e - 0.25 * i


def lorenz(x: Floats, y: Floats, z: Floats) -> tuple[Floats, ...]:
    """Lorenz 1963: three equations with nothing in common."""
    return 10.0 * (y - x), x * (28.0 - z) - y, x * y - 8.0 / 3.0 * z


SYSTEMS: dict[str, tuple[Callable[..., tuple[Floats, ...]], int]] = {
    "reactor": (reactor, 2),
    "gravity": (gravity, 2),
    "enzyme": (enzyme, 2),
    "epidemic": (epidemic, 3),
    "lorenz": (lorenz, 3),
}


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--evaluations", type=int, default=6_000_000)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    print(f"{'':12}{'noise':>6}{'together: size, error':>26}{'one at a time':>26}")
    for name, (equations, inputs) in SYSTEMS.items():
        for noise in (0.0, 0.01):
            rng = np.random.default_rng(options.seed)
            X = rng.uniform(0.2, 2.0, (ROWS, inputs))
            clean = np.column_stack(equations(*X.T))
            Y = clean + noise * clean.std(axis=0) * rng.standard_normal(clean.shape)
            whole = gpsynth.regress(X, Y, evaluations=options.evaluations)
            share = options.evaluations // Y.shape[1]
            single = [gpsynth.regress(X, y, evaluations=share) for y in Y.T]
            apart = np.column_stack([each.predict(X) for each in single])
            sizes = whole.best.size, sum(each.best.size for each in single)
            worst = [_worst(values, clean) for values in (whole.predict(X), apart)]
            cells = [f"{size:15d} {error:10.1e}" for size, error in zip(sizes, worst, strict=True)]
            print(f"{name:12}{noise:6g}" + "".join(cells), flush=True)


def _worst(values: Floats, clean: Floats) -> float:
    return float(
        np.max(np.sum((values - clean) ** 2, axis=0) / np.sum((clean - clean.mean(axis=0)) ** 2, axis=0))
    )


if __name__ == "__main__":
    main()
