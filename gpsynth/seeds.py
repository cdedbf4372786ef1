"""Randomness as a function of (seed, path): same seed, same bits, for any number of workers and after any resume."""

import numpy as np


def stream(seed: int, *path: int) -> np.random.Generator:
    """The generator of one place in a run, e.g. ``stream(seed, stage, generation)``.

    Streams of different paths are independent, and none depends on what was drawn elsewhere.
    """
    return np.random.Generator(np.random.PCG64(np.random.SeedSequence(seed, spawn_key=path)))
