"""Few columns whose linear combination is the target: orthogonal forward selection, many beginnings side by side.

Chen, Billings and Luo (1989) choose one column after the other, each by how much of the residual it explains once it
is made orthogonal to those before; here the best `width` subsets of each size go on.
"""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from gpsynth.arrays import Floats

DEPENDENT = 1e-9  # a column with less than this share of its length outside the span adds nothing but rounding
Indices = npt.NDArray[np.int64]


class Columns(NamedTuple):
    """Candidate columns, centered and scaled to length 1."""

    unit: Floats  # (N, r)
    index: Indices  # (N,) which formula each is


class Subset(NamedTuple):
    """Columns that go together, and what they leave unexplained."""

    columns: tuple[int, ...]
    rest: float  # squared residual as a share of the target's


def centered(values: Floats) -> tuple[Floats, npt.NDArray[np.bool_]]:
    """Rows (N, r) without their mean, of length 1; and which rows are not constant."""
    shifted = values - values.mean(axis=1, keepdims=True)
    length = np.sqrt(np.einsum("ij,ij->i", shifted, shifted))
    varies = length > 1e-9 * np.abs(values).max(axis=1)
    return shifted / np.where(varies, length, 1.0)[:, None], varies


def columns_of(values: Floats) -> Columns:
    """The columns among the rows of `values` (N, r) that differ by more than shift and scale; cheaper ones are first."""
    unit, varies = centered(values)
    kept = np.flatnonzero(varies)
    unit = unit[kept]
    projections = np.random.default_rng(11).standard_normal((unit.shape[1], 2))
    keys = np.round(unit @ projections * 1e8).astype(np.int64)
    keys *= np.where(keys[:, :1] < 0, -1, 1)
    _, first = np.unique(keys[:, 0] * 1_000_003 + keys[:, 1], return_index=True)
    first.sort()
    return Columns(unit[first], kept[first])


def select(columns: Columns, target: Floats, *, terms: int, width: int) -> list[Subset]:
    """The best subsets of 1 to `terms` columns for a target (r,), best first within each size.

    The scores are rounded before they are compared, so that the order does not hang on the last bit of a sum.
    """
    residual = target - target.mean()
    size = float(residual @ residual)
    if size == 0.0 or len(columns.unit) == 0:
        return []
    residuals = (residual / np.sqrt(size))[None]
    free = np.ones((1, len(columns.unit)))
    subsets: list[tuple[int, ...]] = [()]
    bases: list[Floats] = [np.empty((0, len(residual)))]
    found: list[Subset] = []
    for _ in range(min(terms, len(residual) - 2)):
        overlap = residuals @ columns.unit.T
        gain = np.where(free > DEPENDENT, overlap * overlap / np.maximum(free, DEPENDENT), 0.0)
        rest = np.einsum("ij,ij->i", residuals, residuals)
        chosen = _best(np.round(np.maximum(rest[:, None] - gain, 0.0), 14), subsets, width)
        grown = [_grow(columns, residuals[beam], bases[beam], column) for beam, column in chosen]
        residuals = np.stack([new for new, _ in grown])
        bases = [basis for _, basis in grown]
        free = free[[beam for beam, _ in chosen]] - (np.stack([b[-1] for b in bases]) @ columns.unit.T) ** 2
        subsets = [(*subsets[beam], column) for beam, column in chosen]
        found += [
            Subset(subset, float(left @ left)) for subset, left in zip(subsets, residuals, strict=True)
        ]
        if min(float(left @ left) for left in residuals) < 1e-24:
            break
    return found


def _best(rest: Floats, subsets: list[tuple[int, ...]], width: int) -> list[tuple[int, int]]:
    """(beam, column) of the smallest rests, no two with the same set of columns."""
    count = rest.shape[1]
    flat = rest.ravel()
    few = min(len(flat), width * (len(subsets[0]) + 2))
    order = np.argpartition(flat, few - 1)[:few]
    order = order[np.lexsort((order, flat[order]))]
    seen: set[frozenset[int]] = set()
    chosen = []
    for place in order.tolist():
        beam, column = divmod(place, count)
        members = frozenset((*subsets[beam], column))
        if column in subsets[beam] or members in seen:
            continue
        seen.add(members)
        chosen.append((beam, column))
        if len(chosen) == width:
            break
    return chosen


def _grow(columns: Columns, residual: Floats, basis: Floats, column: int) -> tuple[Floats, Floats]:
    direction = columns.unit[column]
    for _ in range(2):  # once more for what rounding left over
        direction = direction - basis.T @ (basis @ direction)
    direction = direction / np.sqrt(direction @ direction)
    return residual - direction * (direction @ residual), np.concatenate((basis, direction[None]))


def products(values: Floats, residual: Floats, count: int) -> list[tuple[int, int]]:
    """The pairs of rows of `values` (N, r) whose product explains most of a centered residual (r,)."""
    r = values.shape[1]
    scaled = (values / np.abs(values).max(axis=1, keepdims=True)).astype(np.float32)
    square = scaled * scaled
    weighted = scaled * residual.astype(np.float32)
    best: list[tuple[float, int, int]] = []
    step = max(1, 2_000_000 // len(values))
    for begin in range(0, len(values), step):
        part = slice(begin, begin + step)
        overlap = weighted[part] @ scaled.T
        length = square[part] @ square.T
        mean = scaled[part] @ scaled.T
        free = length - mean * mean / np.float32(r)
        gain = np.where(free > 1e-4 * length, overlap * overlap / np.maximum(free, np.float32(1e-20)), 0.0)
        gain = np.triu(gain, begin)
        few = min(gain.size, count)
        places = np.argpartition(gain.ravel(), gain.size - few)[-few:]
        best += [
            (round(float(gain.ravel()[place]), 5), begin + place // len(values), place % len(values))
            for place in places.tolist()
        ]
    best.sort(key=lambda item: (-item[0], item[1], item[2]))
    return [(i, j) for _, i, j in best[:count]]
