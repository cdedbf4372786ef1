"""Links: Reeds-Shepp curves that join start and goal to a route, and how long and how blocked they are."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from applications.rosbot.curves import Curves, Samples
from applications.rosbot.escapes import Escape, room_at
from applications.rosbot.scenario import Scenario
from gpsynth.arrays import Floats

Piece = tuple[Floats, Floats]  # poses (N, 3) and the sense of travel up to each, (N,); 0 is a turn in place

SENSES = (1.0, -1.0)  # forwards, backwards
SPACING = 0.05  # m, between the poses
BLOCKED = 40.0  # s of detour that a meter in collision counts for, times its depth and 0.1 m in m
TOUCHING = 1e-9  # m; less depth is none


@dataclass(frozen=True, eq=False)
class Links:
    """Curves from each of some escapes to N poses, and from N others to what each of some ways to arrive begins at."""

    samples: Samples
    leaves: Sequence[Escape]
    arrives: Sequence[Escape]
    scores: tuple[
        Floats, Floats
    ]  # (b, N), (e, N) s: heads and tails; duration and what the obstacles count for
    blocked: tuple[bool, bool]  # whether the best of them is

    @classmethod
    def of(
        cls,
        scenario: Scenario,
        firsts: Floats,
        lasts: Floats,
        radius: float,
        leaves: Sequence[Escape],
        arrives: Sequence[Escape],
    ) -> "Links":
        """The shortest curves of a radius (m) to poses (N, 3), and from others (N, 3)."""
        count = len(firsts)
        begins, ends = (
            np.array([each.poses[at] for each in some]) for some, at in ((leaves, -1), (arrives, 0))
        )
        curves = Curves.shortest(
            np.concatenate([np.repeat(begins, count, axis=0), np.tile(lasts, (len(arrives), 1))]),
            np.concatenate([np.tile(firsts, (len(leaves), 1)), np.repeat(ends, count, axis=0)]),
            radius,
        )
        samples = curves.sampled(SPACING)
        blockage = blockages(scenario, samples)
        seconds = np.repeat([each.seconds for each in (*leaves, *arrives)], count)
        scores = seconds + durations(scenario, curves) + BLOCKED * blockage
        first = count * len(leaves)
        return cls(
            samples,
            leaves,
            arrives,
            (scores[:first].reshape(-1, count), scores[first:].reshape(-1, count)),
            (
                bool(blockage[:first][np.argmin(scores[:first])] > 0.0),
                bool(blockage[first:][np.argmin(scores[first:])] > 0.0),
            ),
        )

    def head(self, number: int) -> list[Piece]:
        """The best way from the start to a pose."""
        escape = int(np.argmin(self.scores[0][:, number]))
        curve = self.samples.piece(escape * self.scores[0].shape[1] + number)
        return [*_piece(self.leaves[escape]), curve]

    def tail(self, number: int) -> list[Piece]:
        """The best way from a pose to the goal."""
        escape = int(np.argmin(self.scores[1][:, number]))
        curve = self.samples.piece(self.scores[0].size + escape * self.scores[1].shape[1] + number)
        return [curve, *_piece(self.arrives[escape])]


def pace(scenario: Scenario, sense: float) -> float:
    """Seconds a meter takes at top speed, forwards or backwards; infinity where the limits forbid it."""
    limit = scenario.speed_limits[1] if sense > 0.0 else -scenario.speed_limits[0]
    return 1.0 / limit if limit > 0.0 else np.inf


def durations(scenario: Scenario, curves: Curves) -> Floats:
    """How long driving along takes at top speed (N,), in s."""
    seconds = np.zeros(len(curves.lengths))
    for sense in SENSES:
        driven = np.sum(np.maximum(sense * curves.lengths, 0.0), axis=1)
        seconds[driven > 0.0] += pace(scenario, sense) * driven[driven > 0.0]
    return seconds


def blockages(scenario: Scenario, samples: Samples) -> Floats:
    """Integral (N,) along curves of the depth in obstacles or out of bounds and 0.1 m, where there is any (m^2)."""
    depth = -room_at(scenario, samples.poses[:, :2])
    counted = np.concatenate([[0.0], np.cumsum(np.where(depth > TOUCHING, 0.1 + depth, 0.0))])
    blocked: Floats = SPACING * np.diff(counted[samples.bounds])
    return blocked


def _piece(escape: Escape) -> list[Piece]:
    return [(escape.poses, escape.senses)] if len(escape.poses) > 1 else []
