"""Few columns whose linear combination is the target: orthogonal forward selection, many beginnings side by side.

Chen, Billings and Luo (1989) choose one column after the other, each by how much of the residual it explains once it
is made orthogonal to those before; here the best `width` subsets of each size go on.
"""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from gpsynth.arrays import Floats

DEPENDENT = (
    1e-9  # a column with less than this share of its length outside the span adds nothing but rounding
)
TILE = 256  # rows and columns of a block that is worked on several times, so that it stays in the cache
Indices = npt.NDArray[np.int64]
Floats32 = npt.NDArray[np.float32]


class Columns(NamedTuple):
    """Candidate columns, centered and scaled to length 1."""

    unit: Floats  # (N, r)
    formula: Indices  # (N,) which formula each is


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
    """The columns among the rows of `values` (N, r), cheaper ones first, that differ by more than shift and scale."""
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
        if not chosen:  # every column is in every subset
            break
        grown = [_grow(columns, residuals[beam], bases[beam], column) for beam, column in chosen]
        residuals = np.stack([new for new, _ in grown])
        bases = [basis for _, basis in grown]
        free = free[[beam for beam, _ in chosen]] - (np.stack([b[-1] for b in bases]) @ columns.unit.T) ** 2
        subsets = [(*subsets[beam], column) for beam, column in chosen]
        found += [Subset(subset, float(left @ left)) for subset, left in zip(subsets, residuals, strict=True)]
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


def pairs(columns: Columns, target: Floats, given: Floats, count: int) -> list[tuple[int, int, float]]:
    """The pairs of columns that explain most of a target (r,) beside the columns `given` (k, r): exhaustive.

    With unit columns orthogonal to the given ones, c their overlaps with the target and g that of the two, the pair
    explains (c_i^2 + c_j^2 - 2 c_i c_j g) / (1 - g^2).
    """
    left = target - target.mean()
    unit = columns.unit
    if len(given):
        basis = np.linalg.qr((given - given.mean(axis=1, keepdims=True)).T)[0]
        left = left - basis @ (basis.T @ left)
        unit = unit - (unit @ basis) @ basis.T
    length = np.sqrt(np.einsum("ij,ij->i", unit, unit))
    unit = unit / np.maximum(length, 1e-6)[:, None] * (length > 1e-4)[:, None]
    size = float(left @ left)
    if size == 0.0:
        return []
    overlap = unit @ (left / np.sqrt(size))
    best = _Best(2 * count)
    for row in range(0, len(unit), TILE):
        for column in range(row, len(unit), TILE):
            gain = _pair_gains(unit, overlap, slice(row, row + TILE), slice(column, column + TILE))
            best.add(gain, row, column)
    kept = sorted({(round(1.0 - gain, 13), min(i, j), max(i, j)) for gain, i, j in best.items() if i != j})
    return [(i, j, max(rest, 0.0)) for rest, i, j in kept[:count]]


def _pair_gains(unit: Floats, overlap: Floats, rows: slice, columns: slice) -> Floats:
    cross = unit[rows] @ unit[columns].T
    mine, others = overlap[rows, None], overlap[None, columns]
    gain = np.multiply(mine, cross)
    gain *= -2.0
    gain += others
    gain *= others
    gain += mine * mine
    cross *= cross
    np.subtract(1.0, cross, out=cross)
    gain[cross < 1e-8] = 0.0
    gain /= np.maximum(cross, 1e-8, out=cross)
    return gain


class Products(NamedTuple):
    """All products of a row of `left` and a row of `right`, not written out."""

    left: Floats32  # (K, r)
    right: Floats32  # (N, r)
    weights: (
        Floats32  # (K, N) one over the squared length of the centered product; 0 if that is nearly constant
    )


def products_of(few: Floats, many: Floats) -> Products:
    """The products of rows (K, r) and (N, r), in single precision: what they yield is looked at again."""
    left, right = ((v / np.abs(v).max(axis=1, keepdims=True)).astype(np.float32) for v in (few, many))
    length = (left * left) @ (right * right).T
    free = left @ right.T
    free *= free
    free *= np.float32(-1.0 / few.shape[1])
    free += length
    weights = np.where(free > 1e-4 * length, 1.0 / np.maximum(free, np.float32(1e-20)), np.float32(0.0))
    return Products(left, right, weights.astype(np.float32))


def best_products(products: Products, residual: Floats, count: int) -> list[tuple[int, int]]:
    """The pairs of rows whose product explains most of a centered residual (r,)."""
    weighted = products.left * residual.astype(np.float32)
    best = _Best(count)
    step = max(1, TILE * TILE // len(weighted))
    for begin in range(0, len(products.right), step):
        gain = weighted @ products.right[begin : begin + step].T
        gain *= gain
        gain *= products.weights[:, begin : begin + step]
        best.add(gain, 0, begin)
    found = sorted(best.items(), key=lambda item: (-round(item[0], 5), item[1], item[2]))
    return [(i, j) for _, i, j in found[:count]]


class _Best:
    """The largest `count` entries of a matrix that comes in blocks of rows."""

    def __init__(self, count: int) -> None:
        self.count = count
        self.least = 0.0
        self._gains = np.empty(0)
        self._places = np.empty((2, 0), dtype=np.int64)

    def add(self, block: npt.NDArray[np.floating], row: int, column: int) -> None:
        """A block whose corner is (row, column)."""
        places = np.flatnonzero(block > self.least)
        if len(places) == 0:
            return
        i, j = np.divmod(places, block.shape[1])
        self._gains = np.concatenate((self._gains, block.ravel()[places]))
        self._places = np.concatenate((self._places, np.stack((i + row, j + column))), axis=1)
        if len(self._gains) > self.count:
            kept = np.argpartition(self._gains, -self.count)[-self.count :]
            self._gains, self._places = self._gains[kept], self._places[:, kept]
            self.least = float(self._gains.min())

    def items(self) -> list[tuple[float, int, int]]:
        """(entry, row, column), in no order."""
        return list(zip(self._gains.tolist(), *self._places.tolist(), strict=True))
