"""Gray code: neighboring numbers differ in one bit, so that cutting and flipping bits moves a number gently.

A number is c integer and d fractional bits, most significant first. With lower = 0 and upper = 2^c its value is the
plain one of the 2022 robot program; other bounds give the scaled, possibly negative one of the 2016 program.
"""

from collections.abc import Sequence

import numpy as np

from gpsynth.encodings.parameters import ParameterSpace, Values


def gray_to_value(gray: Sequence[int], lower: float, upper: float) -> float:
    """lower + (upper - lower) k / 2^n of the n = c + d bits; upper itself is never reached."""
    bit, steps = 0, 0
    for flip in gray:
        bit ^= flip
        steps = 2 * steps + bit
    return lower + (upper - lower) * (steps / (1 << len(gray)))


def value_to_gray(value: float, n_bits: int, lower: float, upper: float) -> tuple[int, ...]:
    """The bits whose value is nearest to `value`."""
    steps = round((value - lower) / (upper - lower) * (1 << n_bits))
    steps = min(max(steps, 0), (1 << n_bits) - 1)
    code = steps ^ (steps >> 1)
    return tuple(code >> position & 1 for position in range(n_bits - 1, -1, -1))


def crossed(
    a: Values, b: Values, n_bits: int, space: ParameterSpace, rng: np.random.Generator
) -> tuple[Values, Values]:
    """Both strings exchanged behind one cut, which goes between numbers, or through one if they have bits."""
    width = max(n_bits, 1)
    place, inside = divmod(int(rng.integers(len(a) * width + 1)), width)
    if inside == 0:
        return a[:place] + b[place:], b[:place] + a[place:]
    ours, theirs = (value_to_gray(values[place], n_bits, space.lower, space.upper) for values in (a, b))
    first = gray_to_value(ours[:inside] + theirs[inside:], space.lower, space.upper)
    second = gray_to_value(theirs[:inside] + ours[inside:], space.lower, space.upper)
    return (*a[:place], first, *b[place + 1 :]), (*b[:place], second, *a[place + 1 :])


def moved(values: Values, n_bits: int, space: ParameterSpace, rng: np.random.Generator) -> Values:
    """One number with one of its bits flipped, or moved by a step if numbers have no bits."""
    if n_bits == 0:
        return space.moved(values, rng)
    place, inside = divmod(int(rng.integers(len(values) * n_bits)), n_bits)
    bits = value_to_gray(values[place], n_bits, space.lower, space.upper)
    flipped = (*bits[:inside], 1 - bits[inside], *bits[inside + 1 :])
    return (*values[:place], gray_to_value(flipped, space.lower, space.upper), *values[place + 1 :])
