"""Physical dimensions: texts like "kg m/s^2" and back, and what each operation of the table does to them.

A dimension maps bases to exponents. Besides the seven of the SI, powers of ten and the odd units (deg, min, h) are
bases of their own, so that km and m, or deg and rad, are as different as m and s: adding them is a mistake all the
same.
"""

import re
from collections.abc import Mapping, Sequence
from fractions import Fraction
from types import MappingProxyType

from gpsynth.errors import UnitError
from gpsynth.operations import OPERATIONS

Dimension = Mapping[str, Fraction]  # no exponent is 0

TEN = "10"
NONE: Dimension = MappingProxyType({})

_POWERS: Mapping[str, Mapping[str, int]] = MappingProxyType(
    {
        **{base: {base: 1} for base in ("m", "kg", "s", "A", "K", "mol", "cd", "deg", "min", "h")},
        **{
            "": {},
            "1": {},
            "rad": {},
            "sr": {},
            "%": {TEN: -2},
            "g": {"kg": 1, TEN: -3},
            "t": {"kg": 1, TEN: 3},
        },
        **{"Hz": {"s": -1}, "N": {"kg": 1, "m": 1, "s": -2}, "Pa": {"kg": 1, "m": -1, "s": -2}},
        **{"J": {"kg": 1, "m": 2, "s": -2}, "W": {"kg": 1, "m": 2, "s": -3}, "C": {"A": 1, "s": 1}},
        **{"V": {"kg": 1, "m": 2, "s": -3, "A": -1}, "Ohm": {"kg": 1, "m": 2, "s": -3, "A": -2}},
        **{"F": {"kg": -1, "m": -2, "s": 4, "A": 2}, "H": {"kg": 1, "m": 2, "s": -2, "A": -2}},
        **{"T": {"kg": 1, "s": -2, "A": -1}, "Wb": {"kg": 1, "m": 2, "s": -2, "A": -1}},
        **{"L": {"m": 3, TEN: -3}, "bar": {"kg": 1, "m": -1, "s": -2, TEN: 5}},
    }
)
_PREFIXES: Mapping[str, int] = MappingProxyType(
    {"G": 9, "M": 6, "k": 3, "d": -1, "c": -2, "m": -3, "u": -6, "µ": -6, "n": -9, "p": -12}
)
_PREFIXED = frozenset(
    (
        "m",
        "g",
        "s",
        "A",
        "K",
        "mol",
        "rad",
        "Hz",
        "N",
        "Pa",
        "J",
        "W",
        "C",
        "V",
        "Ohm",
        "F",
        "H",
        "T",
        "Wb",
        "L",
    )
)
_TOKEN = re.compile(
    r"\s*(?:(?P<sign>[*·/()])|(?P<name>[^\W\d_]+|%|1)(?:\^(?P<power>-?\d+(?:/\d+|\.\d+)?))?)\s*"
)


def dimension(unit: str) -> Dimension:
    """The dimension of a unit such as "m", "rad/s", "kg m^2", "N/(m s)"; empty or "1" for none. Raises UnitError."""
    tokens, place = [], 0
    while place < len(unit):
        found = _TOKEN.match(unit, place)
        if found is None or found.end() == place:
            raise UnitError(f"the unit {unit!r} cannot be read at {unit[place:]!r}; write it like kg m/s^2")
        tokens.append(found)
        place = found.end()
    signs = [token["sign"] for token in tokens]
    result, behind = _product(unit, tokens, 0)
    if behind < len(tokens) or signs.count(")") > signs.count("("):
        raise UnitError(f"the unit {unit!r} has a closing parenthesis too many")
    return result


def text(of: Dimension) -> str:
    """A dimension as a unit text, "1" for none."""
    above = [_factor(base, power) for base, power in sorted(of.items()) if power > 0]
    below = [_factor(base, -power) for base, power in sorted(of.items()) if power < 0]
    shown = " ".join(above) or "1"
    if not below:
        return shown
    return f"{shown}/{below[0]}" if len(below) == 1 else f"{shown}/({' '.join(below)})"


def product(*factors: tuple[Mapping[str, Fraction], Fraction | int]) -> dict[str, Fraction]:
    """Dimensions multiplied, each raised to its power."""
    result: dict[str, Fraction] = {}
    for factor, power in factors:
        for base, exponent in factor.items():
            result[base] = result.get(base, Fraction(0)) + exponent * power
    return {base: exponent for base, exponent in result.items() if exponent}


def _product(unit: str, tokens: Sequence[re.Match[str]], place: int) -> tuple[Dimension, int]:
    """The product that begins at a token, up to the end or a closing parenthesis; a slash rules one factor."""
    result, sign = dict(NONE), 1
    while place < len(tokens):
        token = tokens[place]
        place += 1
        if token["sign"] == ")":
            break
        if token["sign"] in ("*", "·", "/"):
            sign = -1 if token["sign"] == "/" else 1
            continue
        if token["sign"] == "(":
            factor, place = _product(unit, tokens, place)
            if tokens[place - 1]["sign"] != ")":
                raise UnitError(f"the unit {unit!r} lacks a closing parenthesis")
        else:
            factor = product((_named(unit, token["name"]), Fraction(token["power"] or 1)))
        result, sign = product((result, 1), (factor, sign)), 1
    return result, place


def _named(unit: str, name: str) -> Dimension:
    if name in _POWERS:
        return {base: Fraction(power) for base, power in _POWERS[name].items()}
    if name[0] in _PREFIXES and name[1:] in _PREFIXED:
        return product((_named(unit, name[1:]), 1), ({TEN: Fraction(_PREFIXES[name[0]])}, 1))
    raise UnitError(
        f"the unit {unit!r} has the unknown part {name!r}; known are {', '.join(filter(None, _POWERS))}"
    )


def _factor(base: str, power: Fraction) -> str:
    return base if power == 1 else f"{base}^{power}"


_POWER_OF: Mapping[str, tuple[Fraction, ...]] = MappingProxyType(
    {
        **dict.fromkeys(("neg", "abs", "half", "double", "identity"), (Fraction(1),)),
        **dict.fromkeys(("square", "nop_square"), (Fraction(2),)),
        **dict.fromkeys(("cube", "nop_cube"), (Fraction(3),)),
        **dict.fromkeys(("sqrt", "sqrt_protected", "signed_sqrt"), (Fraction(1, 2),)),
        **dict.fromkeys(("cbrt", "nop_cbrt"), (Fraction(1, 3),)),
        **dict.fromkeys(("sign", "sgn", "step", "step_open", "not"), (Fraction(0),)),
        "nop_inverse": (Fraction(-1),),
        **dict.fromkeys(("mul", "nop_mul"), (Fraction(1), Fraction(1))),
        **dict.fromkeys(("div", "div_protected"), (Fraction(1), Fraction(-1))),
    }
)  # the result is the product of the operands raised to these; the others ask something of their operands
_ALIKE = frozenset(
    ["add", "sub", "max", "min", "hypot", "signed_hypot", "signed_abs_sum", "signed_abs_max", "limit"]
)
_COMPARED = frozenset(["lt", "le", "eq", "atan2"])


def powers(name: str) -> tuple[Fraction, ...]:
    """The result's dimension: the product of the operands', raised to these powers."""
    if name in _POWER_OF:
        return _POWER_OF[name]
    if name == "where":
        return Fraction(0), Fraction(1), Fraction(0)
    arity = next(row.arity for row in OPERATIONS if row.name == name)
    return (Fraction(int(name in _ALIKE)), *(Fraction(0),) * (arity - 1))


def alike(name: str) -> tuple[int, ...]:
    """Which operands must have one dimension."""
    if name in _ALIKE or name in _COMPARED:
        return (0, 1, 2) if name == "limit" else (0, 1)
    return (1, 2) if name == "where" else ()


def pure(name: str) -> tuple[int, ...]:
    """Which operands must have no dimension."""
    if name in _POWER_OF or alike(name):
        return ()
    return tuple(range(len(powers(name))))
