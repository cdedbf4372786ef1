"""Randomness as a function of (seed, path): same seed, same bits, for any number of workers and after any resume."""

import numpy as np

from gpsynth.checks import check_whole
from gpsynth.errors import OptimizerError


def stream(seed: int, *path: int) -> np.random.Generator:
    """The generator of one place in a run, e.g. ``stream(seed, stage, generation)``.

    Streams of different paths are independent, and none depends on what was drawn elsewhere. Raises OptimizerError
    unless seed and path are whole numbers from 0 on.
    """
    for name, value in (("seed", seed), *(("the path of a stream", place) for place in path)):
        check_whole(name, value, 0, OptimizerError)
    return np.random.Generator(np.random.PCG64(np.random.SeedSequence(seed, spawn_key=path)))
