"""ns per element of the elementary functions, beside numpy's."""

from collections.abc import Iterator

import numpy as np

from gpsynth.arrays import Floats
from gpsynth.kernels import machine, rollout
from gpsynth.operations import CODES
from tests.bench.measure import median_time

REPEATED, LONG = 4096, 1024
BESIDE: dict[str, np.ufunc] = {
    "sin": np.sin,
    "cos": np.cos,
    "tan": np.tan,
    "atan": np.arctan,
    "atan2": np.arctan2,
    "asin": np.arcsin,
    "acos": np.arccos,
    "exp": np.exp,
    "log": np.log,
    "tanh": np.tanh,
    "cbrt": np.cbrt,
    "sqrt": np.sqrt,
    "hypot": np.hypot,
    "div": np.divide,
    "add": np.add,
}


def elementary_rows() -> Iterator[tuple[str, float, float]]:
    """Name, ns per element of the lane machine (blocks of 64) and of numpy (arrays of 1024, so in cache as well)."""
    values = np.random.default_rng(1).uniform(0.05, 0.95, (2, LONG))
    for name, function in BESIDE.items():
        yield name, _ours(name, values[:, : machine.BLOCK]), _numpys(function, values)


def _ours(name: str, operands: Floats) -> float:
    workspace = rollout.workspace(3, machine.BLOCK)
    workspace[:2] = operands
    code = np.tile(np.array([CODES[name], 2, 0, 1, 1], dtype=np.int32), (REPEATED, 1))
    code.setflags(write=False)
    seconds, _ = median_time(lambda: machine.execute(code, 0, REPEATED, workspace, machine.BLOCK))
    return seconds / (REPEATED * machine.BLOCK) * 1e9


def _numpys(function: np.ufunc, values: Floats) -> float:
    operands, out = values[: function.nin], np.empty(LONG)

    def work() -> None:
        for _ in range(REPEATED // 16):
            function(*operands, out=out)

    return median_time(work)[0] / (REPEATED // 16 * LONG) * 1e9
