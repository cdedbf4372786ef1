"""What a robot is told: v and omega, held for their durations one after the other."""

import numpy as np
import numpy.typing as npt

from gpsynth.arrays import Floats
from gpsynth.errors import ScenarioError


def held(controls: npt.ArrayLike, period: npt.ArrayLike) -> tuple[Floats, Floats]:
    """Controls (n, 2) and their durations (n,) in s, given one number or one a pair; raises ScenarioError if wrong."""
    try:
        pairs = np.asarray(controls, dtype=np.float64)
        durations = np.broadcast_to(np.asarray(period, dtype=np.float64), (len(pairs),))
    except (TypeError, ValueError):
        raise ScenarioError(
            "controls are rows of v and omega, with one duration for all or one for each; got something else"
        ) from None
    if pairs.ndim != 2 or pairs.shape[1] != 2:
        raise ScenarioError(f"controls have shape {pairs.shape}; expected (n, 2), v and omega")
    if not np.all(np.isfinite(pairs)) or not np.all(np.isfinite(durations)):
        raise ScenarioError("controls or their durations hold NaN or infinity; expected finite numbers")
    if np.any(durations < 0.0):
        raise ScenarioError(f"the shortest duration is {durations.min():g} s; expected at least 0")
    return pairs, durations
