"""Many Reeds-Shepp curves at once, as rows of one array: found, measured and sampled together."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from applications.rosbot.reeds_shepp import ReedsSheppPath, advance, shortest_words
from gpsynth.arrays import Floats

Integers = npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Samples:
    """Poses of the curves, one after the other."""

    poses: Floats  # (M, 3) m, m, rad
    senses: Floats  # (M,) +1 driven forwards, -1 backwards, up to here
    bounds: Integers  # (N + 1,) curve i has the poses bounds[i] to bounds[i + 1]

    def piece(self, curve: int) -> tuple[Floats, Floats]:
        """Poses and senses of one curve."""
        part = slice(self.bounds[curve], self.bounds[curve + 1])
        return self.poses[part], self.senses[part]


@dataclass(frozen=True, eq=False)
class Curves:
    """N curves; segments of length 0 come last."""

    starts: Floats  # (N, 3)
    turns: Integers  # (N, s) +1 left, 0 straight, -1 right
    lengths: Floats  # (N, s) m, negative when driven backwards
    radius: float  # m

    @classmethod
    def shortest(cls, starts: Floats, goals: Floats, radius: float) -> "Curves":
        """The shortest ones from each start to its goal, both (N, 3)."""
        return cls(starts, *shortest_words(starts, goals, radius), radius)

    @classmethod
    def of(cls, paths: list[ReedsSheppPath]) -> "Curves":
        """These paths, of one radius."""
        size = max(len(path.turns) for path in paths)
        turns, lengths = np.zeros((len(paths), size), dtype=np.int64), np.zeros((len(paths), size))
        for row, path in enumerate(paths):
            turns[row, : len(path.turns)], lengths[row, : len(path.turns)] = path.turns, path.lengths
        return cls(np.array([path.start for path in paths]), turns, lengths, paths[0].radius)

    def sampled(self, spacing: float) -> Samples:
        """Poses every so many meters and at the corners."""
        ends = np.cumsum(np.abs(self.lengths), axis=1)
        counts = np.ceil(ends[:, -1] / spacing).astype(np.int64)
        curve = np.repeat(np.arange(len(ends)), counts)
        even = spacing * (np.arange(len(curve)) - np.repeat(np.cumsum(counts) - counts, counts))
        distinct = np.hstack([np.full((len(ends), 1), True), np.diff(ends, axis=1) > 0.0])
        curve = np.concatenate([curve, np.nonzero(distinct)[0]])
        ways = np.concatenate([even, ends[distinct]])
        order = np.lexsort([ways, curve])
        curve, ways = curve[order], ways[order]
        segment = np.minimum(np.sum(ends[curve] < ways[:, np.newaxis], axis=1), ends.shape[1] - 1)
        into = ways - (ends - np.abs(self.lengths))[curve, segment]
        senses = np.sign(self.lengths)[curve, segment]
        poses = advance(
            self._corners()[curve, segment], self.turns[curve, segment], into * senses, self.radius
        )
        return Samples(poses, senses, np.searchsorted(curve, np.arange(len(ends) + 1)))

    def _corners(self) -> Floats:
        """The poses (N, s, 3) at which the segments begin."""
        corners = [self.starts]
        for turns, lengths in zip(self.turns.T[:-1], self.lengths.T[:-1], strict=True):
            corners.append(advance(corners[-1], turns, lengths, self.radius))
        return np.stack(corners, axis=1)
