"""Levenberg-Marquardt (Marquardt 1963) for the numbers of many expressions, with exact derivatives.

Steps solve (J'WJ + damping diag J'WJ) step = -J'W residual; the damping falls by 10 after a step that helps and rises
by 4 after one that does not.
"""

from typing import Any

import numpy as np
from numba import types

from gpsynth.kernels.compile import CODE, INTEGERS, MATRIX, OUT_MATRIX, VECTOR, kernel
from gpsynth.kernels.derivatives import backward, forward

MOST = 24  # numbers of one expression
BLOCK = 64
_NUMBERS = types.Array(types.float64, 1, "C")


@kernel(types.float64(CODE, VECTOR, types.int64, types.int64, MATRIX, VECTOR, VECTOR, OUT_MATRIX))
def squared_error(
    code: Any, numbers: Any, first: int, last: int, columns: Any, y: Any, weights: Any, v: Any
) -> float:
    """The weighted sum of squared residuals of one expression; infinity if it is not finite."""
    total = 0.0
    for begin in range(0, columns.shape[1], BLOCK):
        lanes = min(BLOCK, columns.shape[1] - begin)
        forward(code, numbers, first, last, columns, begin, lanes, v)
        for lane in range(lanes):
            residual = v[last - 1, lane] - y[begin + lane]
            total += weights[begin + lane] * residual * residual
    return total if total < np.inf else np.inf


@kernel(
    types.float64(
        *(CODE, VECTOR, types.int64, types.int64, INTEGERS, types.int64, MATRIX, VECTOR, VECTOR),
        *(OUT_MATRIX, OUT_MATRIX, OUT_MATRIX, _NUMBERS),
    )
)
def normal_equations(
    code: Any,
    numbers: Any,
    first: int,
    last: int,
    places: Any,
    count: int,
    columns: Any,
    y: Any,
    weights: Any,
    v: Any,
    g: Any,
    normal: Any,
    slope: Any,
) -> float:
    """J'WJ and J'W residual by the numbers at `places`; returns the squared error."""
    total = 0.0
    for i in range(count):
        slope[i] = 0.0
        for k in range(i + 1):
            normal[i, k] = 0.0
    for begin in range(0, columns.shape[1], BLOCK):
        lanes = min(BLOCK, columns.shape[1] - begin)
        forward(code, numbers, first, last, columns, begin, lanes, v)
        backward(code, first, last, v, g, lanes)
        for lane in range(lanes):
            v[last - 1, lane] = (v[last - 1, lane] - y[begin + lane]) * weights[begin + lane]
            residual = v[last - 1, lane]
            if weights[begin + lane] > 0.0:
                total += residual * residual / weights[begin + lane]
        for i in range(count):
            row = places[i]
            even, odd = 0.0, 0.0
            for lane in range(0, lanes, 2):
                even += g[row, lane] * v[last - 1, lane]
                odd += g[row, lane + 1] * v[last - 1, lane + 1]
            slope[i] += even + odd
            for k in range(i + 1):
                other = places[k]
                even, odd = 0.0, 0.0
                for lane in range(0, lanes, 2):
                    even += g[row, lane] * g[other, lane] * weights[begin + lane]
                    odd += g[row, lane + 1] * g[other, lane + 1] * weights[begin + lane + 1]
                normal[i, k] += even + odd
    return total if total < np.inf else np.inf


@kernel(types.boolean(OUT_MATRIX, _NUMBERS, types.int64, types.float64, OUT_MATRIX, _NUMBERS))
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
        *(CODE, _NUMBERS, INTEGERS, INTEGERS, INTEGERS, INTEGERS, MATRIX, VECTOR, VECTOR, types.int64),
        _NUMBERS,
    )
)
def fit(
    code: Any,
    numbers: Any,
    firsts: Any,
    lasts: Any,
    places: Any,
    ends: Any,
    columns: Any,
    y: Any,
    weights: Any,
    iterations: int,
    errors: Any,
) -> None:
    """Improve numbers[places[ends[p - 1]:ends[p]]] of each expression p = positions [first, last); errors are final."""
    longest = 0
    for p in range(len(firsts)):
        longest = max(longest, lasts[p])
    v, g = np.empty((longest, BLOCK)), np.empty((longest, BLOCK))
    normal, factor = np.empty((MOST, MOST)), np.empty((MOST, MOST))
    slope, step, kept = np.empty(MOST), np.empty(MOST), np.empty(MOST)
    for p in range(len(firsts)):
        first, last = firsts[p], lasts[p]
        begin = ends[p - 1] if p else 0
        own = places[begin : ends[p]]
        count = min(len(own), MOST)
        error = squared_error(code, numbers, first, last, columns, y, weights, v)
        damping = 1e-3
        stale = True
        for _ in range(iterations if (count > 0) & (error < np.inf) else 0):
            if stale:
                error = normal_equations(
                    code, numbers, first, last, own, count, columns, y, weights, v, g, normal, slope
                )
                stale = False
            if not solve(normal, slope, count, damping, factor, step):
                damping = max(4.0 * damping, 1e-12)
                continue
            for i in range(count):
                kept[i] = numbers[own[i]]
                numbers[own[i]] = kept[i] + step[i]
            tried = squared_error(code, numbers, first, last, columns, y, weights, v)
            if tried < error:
                settled = error - tried <= 1e-14 * error
                error = tried
                damping *= 0.1
                stale = True
                if settled:
                    break
            else:
                for i in range(count):
                    numbers[own[i]] = kept[i]
                damping = 4.0 * damping
                if damping > 1e12:
                    break
        errors[p] = error
