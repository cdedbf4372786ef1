"""Levenberg-Marquardt (Marquardt 1963) for the numbers of many expressions side by side, with exact derivatives.

The step solves (J'WJ + damping diag J'WJ) step = -J'W residual; the damping falls by 10 after a step that helps and
rises by 4 after one that does not. `linearize` evaluates, `advance` decides: two kernels, so that the machine is
compiled into one of them only.
"""

from typing import Any

import numpy as np
from numba import types

from gpsynth.kernels.compile import CODE, INTEGERS, MATRIX, VECTOR, kernel
from gpsynth.kernels.data_code import VARIABLE
from gpsynth.kernels.data_machine import execute
from gpsynth.kernels.derivatives import backward

MOST = 24  # numbers of one expression that are fitted
BLOCK = 64
LEAST_DAMPING, LARGEST_DAMPING = 1e-12, 1e12
SETTLED = 1e-14  # a gain of less than this share ends a fit
_INTEGERS = types.Array(types.int32, 1, "C")
_NUMBERS = types.Array(types.float64, 1, "C")
_ROWS = types.Array(types.float64, 2, "C")
_MATRICES = types.Array(types.float64, 3, "C")


@kernel(
    types.void(
        *(CODE, VECTOR, INTEGERS, INTEGERS, INTEGERS, INTEGERS, MATRIX, VECTOR, VECTOR),
        *(_INTEGERS, types.boolean, _NUMBERS, _ROWS, _MATRICES),
    )
)
def linearize(
    code: Any,
    numbers: Any,
    firsts: Any,
    lasts: Any,
    places: Any,
    ends: Any,
    columns: Any,
    y: Any,
    weights: Any,
    active: Any,
    derive: bool,
    errors: Any,
    slopes: Any,
    normals: Any,
) -> None:
    """Squared errors of the active expressions p = positions [first, last); J'W residual and J'WJ if `derive`.

    Numbers stand at places[ends[p - 1]:ends[p]]; columns (m, N), y and weights (N,), N even.
    """
    v, g = np.empty((len(code), BLOCK)), np.empty((len(code), BLOCK))
    for p in range(len(firsts)):
        if active[p] == 0:
            continue
        first, last, total = firsts[p], lasts[p], 0.0
        begin = ends[p - 1] if p else 0
        count = min(ends[p] - begin, MOST) if derive else 0
        slopes[p, :count] = 0.0
        normals[p, :count, :count] = 0.0
        for start in range(0, columns.shape[1], BLOCK):
            lanes = min(BLOCK, columns.shape[1] - start)
            for t in range(first, last):
                if code[t, 0] <= VARIABLE:
                    for lane in range(lanes):
                        v[t, lane] = columns[VARIABLE - code[t, 0], start + lane]
            execute(code, numbers, first, last, v, lanes, 0, v)
            if count:
                backward(code, first, last, v, g, lanes)
            for lane in range(lanes):
                residual = v[last - 1, lane] - y[start + lane]
                v[last - 1, lane] = residual * weights[start + lane]
                total += residual * v[last - 1, lane]
            for i in range(count):
                row = places[begin + i]
                even, odd = 0.0, 0.0
                for lane in range(0, lanes, 2):
                    even += g[row, lane] * v[last - 1, lane]
                    odd += g[row, lane + 1] * v[last - 1, lane + 1]
                slopes[p, i] += even + odd
                for k in range(i + 1):
                    other = places[begin + k]
                    even, odd = 0.0, 0.0
                    for lane in range(0, lanes, 2):
                        even += g[row, lane] * g[other, lane] * weights[start + lane]
                        odd += g[row, lane + 1] * g[other, lane + 1] * weights[start + lane + 1]
                    normals[p, i, k] += even + odd
        errors[p] = total if total < np.inf else np.inf


@kernel(types.boolean(_ROWS, _NUMBERS, types.int64, types.float64, _ROWS, _NUMBERS))
def solve(normal: Any, slope: Any, count: int, damping: float, factor: Any, step: Any) -> bool:
    """The damped step by Cholesky's factorization; False if the matrix is not positive definite."""
    for i in range(count):
        for k in range(i + 1):
            total = normal[i, k]
            if i == k:
                total += damping * (normal[i, i] if normal[i, i] > 1e-30 else 1e-30)
            for m in range(k):
                total -= factor[i, m] * factor[k, m]
            if i == k:
                if not total > 0.0:
                    return False
                factor[i, i] = np.sqrt(total)
            else:
                factor[i, k] = total / factor[k, k]
    for i in range(count):
        total = -slope[i]
        for k in range(i):
            total -= factor[i, k] * step[k]
        step[i] = total / factor[i, i]
    for i in range(count - 1, -1, -1):
        total = step[i]
        for k in range(i + 1, count):
            total -= factor[k, i] * step[k]
        step[i] = total / factor[i, i]
    return True


@kernel(
    types.void(
        *(_NUMBERS, _NUMBERS, INTEGERS, INTEGERS, _INTEGERS, _NUMBERS, _NUMBERS, _NUMBERS),
        *(_ROWS, _MATRICES, _ROWS, _MATRICES, types.boolean),
    )
)
def advance(
    numbers: Any,
    kept: Any,
    places: Any,
    ends: Any,
    active: Any,
    damping: Any,
    tried: Any,
    errors: Any,
    slopes: Any,
    normals: Any,
    kept_slopes: Any,
    kept_normals: Any,
    last: bool,
) -> None:
    """Keep the numbers that were tried where they are better, and set the next ones to try, but not the last time.

    `kept`, `errors`, `kept_slopes`, `kept_normals` are the best so far of each expression; `active` ends at 0.
    """
    factor, step = np.empty((MOST, MOST)), np.empty(MOST)
    for p in range(len(ends)):
        if active[p] == 0:
            continue
        begin = ends[p - 1] if p else 0
        count = min(ends[p] - begin, MOST)
        if tried[p] < errors[p]:
            if (count == 0) | ((errors[p] < np.inf) & (errors[p] - tried[p] <= SETTLED * errors[p])):
                active[p] = 0
            errors[p] = tried[p]
            damping[p] = max(0.1 * damping[p], LEAST_DAMPING)
            for i in range(count):
                kept[places[begin + i]] = numbers[places[begin + i]]
                kept_slopes[p, i] = slopes[p, i]
                for k in range(i + 1):
                    kept_normals[p, i, k] = normals[p, i, k]
        else:
            damping[p] = 4.0 * damping[p]
        while active[p] and not last:
            if (damping[p] > LARGEST_DAMPING) | (errors[p] == np.inf):
                active[p] = 0
            elif solve(kept_normals[p], kept_slopes[p], count, damping[p], factor, step):
                break
            else:
                damping[p] = 4.0 * damping[p]
        for i in range(count):
            place = places[begin + i]
            numbers[place] = kept[place] + step[i] if active[p] and not last else kept[place]


def fit(
    code: Any,
    numbers: Any,
    spans: tuple[Any, Any],
    places: Any,
    ends: Any,
    data: tuple[Any, Any, Any],
    iterations: int,
) -> Any:
    """Improve `numbers` in place; returns the squared errors (p,). spans: first and last positions of each expression.

    data: columns (m, N), y (N,), weights (N,). Without iterations nothing but the errors is computed.
    """
    count = len(ends)
    active, damping = np.ones(count, dtype=np.int32), np.full(count, 1e-3)
    tried, errors = np.full(count, np.inf), np.full(count, np.inf)
    slopes, kept_slopes = np.zeros((2, count, MOST))
    normals, kept_normals = np.zeros((2, count, MOST, MOST))
    kept = numbers.copy()
    frozen = numbers.view()
    frozen.flags.writeable = False
    for k in range(iterations + 1):
        linearize(code, frozen, *spans, places, ends, *data, active, iterations > 0, tried, slopes, normals)
        if iterations == 0:
            return tried
        is_last = k == iterations
        advance(
            numbers,
            kept,
            places,
            ends,
            active,
            damping,
            tried,
            errors,
            slopes,
            normals,
            kept_slopes,
            kept_normals,
            is_last,
        )
        if not active.any():
            break
    return errors
