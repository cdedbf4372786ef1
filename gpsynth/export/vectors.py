"""States and targets to test an exported law with: ordinary ones and those that break careless arithmetic."""

import numpy as np

from gpsynth.arrays import Floats
from gpsynth.law import Law
from gpsynth.seeds import stream

SPECIAL = (
    *(0.0, -0.0, 5e-324, -2.2e-308, 1e-8, -1e-8, 0.5, 1.0, -1.0, 3.141592653589793),
    *(1e4, -1e8, 1e22, -1e22, 1e308, -1e308, float("inf"), float("-inf"), float("nan")),
)


def trial_states(law: Law, count: int, seed: int = 1) -> tuple[Floats, Floats]:
    """`count` states and as many targets (count, n); in every other row about half of the entries are special."""
    random = stream(seed)
    size = len(law.plant.state_names)
    rows = random.normal(size=(count, 2 * size)) * 10.0 ** random.integers(-2, 3, size=(count, 1))
    special = random.choice(SPECIAL, size=rows.shape)
    chance = np.where(np.arange(count) % 2, 0.5, 0.0)[:, None]
    rows = np.where(random.random(rows.shape) < chance, special, rows)
    return rows[:, :size], rows[:, size:]
