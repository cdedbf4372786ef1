from itertools import pairwise

import pytest

from gpsynth.encodings.gray import crossed, gray_to_value, moved, value_to_gray
from gpsynth.encodings.parameters import ParameterSpace
from gpsynth.seeds import stream

PLAIN = (0.0, 16.0)  # c = 4 integer bits


def test_bits_read_as_published():
    # g = 1 1 0 1 | 0 1: b = 1 0 0 1 | 1 0, so 8 + 1 + 1/2
    assert gray_to_value((1, 1, 0, 1, 0, 1), *PLAIN) == 9.5


def test_bounds_scale_the_plain_value():
    bits = (1, 1, 0, 1, 0, 1)
    assert gray_to_value(bits, -10.0, 10.0) == -10.0 + 20.0 * 9.5 / 16.0


@pytest.mark.parametrize("bounds", [PLAIN, (-10.0, 10.0)])
def test_every_number_of_eight_bits_is_read_back(bounds):
    lower, upper = bounds
    values = [lower + (upper - lower) * k / 256 for k in range(256)]
    codes = [value_to_gray(value, 8, *bounds) for value in values]
    assert [gray_to_value(code, *bounds) for code in codes] == pytest.approx(values, rel=1e-15)
    assert all(sum(map(int.__ne__, a, b)) == 1 for a, b in pairwise(codes))


def test_other_numbers_become_the_nearest():
    assert gray_to_value(value_to_gray(5.3, 16, *PLAIN), *PLAIN) == pytest.approx(5.3, abs=2**-13)
    assert gray_to_value(value_to_gray(16.0, 16, *PLAIN), *PLAIN) == 16 - 2**-12
    assert gray_to_value(value_to_gray(-1.0, 16, *PLAIN), *PLAIN) == 0.0


def test_a_cut_goes_through_the_bits_of_one_number():
    space = ParameterSpace(3, *PLAIN)
    a, b = (1.0, 2.0, 3.0), (9.0, 10.0, 11.0)
    rng = stream(1)
    strings = [sum((value_to_gray(value, 8, *PLAIN) for value in values), ()) for values in (a, b)]
    seen = set()
    for _ in range(300):
        first, second = crossed(a, b, 8, space, rng)
        bits = [sum((value_to_gray(value, 8, *PLAIN) for value in values), ()) for values in (first, second)]
        cuts = [
            cut
            for cut in range(25)
            if bits == [strings[0][:cut] + strings[1][cut:], strings[1][:cut] + strings[0][cut:]]
        ]
        assert cuts
        seen.add(tuple(cuts))
    assert len(seen) > 5


def test_without_bits_a_cut_goes_between_numbers():
    rng = stream(2)
    pairs = {crossed((1.0, 2.0), (3.0, 4.0), 0, ParameterSpace(2), rng) for _ in range(50)}
    assert pairs == {
        ((1.0, 2.0), (3.0, 4.0)),
        ((1.0, 4.0), (3.0, 2.0)),
        ((3.0, 4.0), (1.0, 2.0)),
    }


def test_a_move_flips_one_bit():
    rng = stream(3)
    seen = set()
    for _ in range(200):
        values = moved((5.0, 7.0), 8, ParameterSpace(2, *PLAIN), rng)
        bits = [value_to_gray(value, 8, *PLAIN) for value in (*values, 5.0, 7.0)]
        flips = [
            place
            for place, (x, y) in enumerate(zip(bits[0] + bits[1], bits[2] + bits[3], strict=True))
            if x != y
        ]
        assert len(flips) == 1
        seen.add(flips[0])
    assert seen == set(range(16))
