"""Sums with common factors taken out where that makes them smaller: Horner's scheme in several variables."""

from collections.abc import Iterator

from gpsynth.regression.algebra import simplify, total
from gpsynth.regression.expressions import Expression, number, size

Factors = tuple[tuple[Expression, int], ...]  # base and power, sorted
Term = tuple[float, Factors]

ONE = number(1.0)
MOST = 24  # terms of a sum that is looked at


def compact(expression: Expression) -> Expression:
    """The same function up to rounding, in as few nodes as these rules find."""
    if expression[0] in {"number", "variable"}:
        return expression
    operands = tuple(compact(operand) for operand in expression[1:])
    whole: Expression = simplify((expression[0], *operands))
    if expression[0] not in {"add", "sub"}:
        return whole
    terms = _gathered(expression)
    if len(terms) > MOST:
        return whole
    return min((whole, *_forms(terms)), key=size)


def _forms(terms: list[Term]) -> Iterator[Expression]:
    yield _sum(terms)
    yield _factored(terms)
    for scale in {abs(coefficient) for coefficient, _ in terms} - {0.0, 1.0}:
        scaled = [(coefficient / scale, factors) for coefficient, factors in terms]
        yield simplify(("mul", number(scale), _factored(scaled)))


def _gathered(e: Expression) -> list[Term]:
    """The terms of a sum, equal ones added up."""
    sums: dict[Factors, float] = {}
    for coefficient, factors in _terms(e, 1.0):
        sums[factors] = sums.get(factors, 0.0) + coefficient
    return [(coefficient, factors) for factors, coefficient in sums.items() if coefficient != 0.0]


def _terms(e: Expression, sign: float) -> Iterator[Term]:
    if e[0] in {"add", "sub"}:
        yield from _terms(e[1], sign)
        yield from _terms(e[2], sign if e[0] == "add" else -sign)
        return
    coefficient, powers = _product(e)
    if e[0] == "mul" and e[1][0] == "number" and e[2][0] in {"add", "sub"}:
        yield from _terms(e[2], sign * e[1][1])
        return
    yield sign * coefficient, tuple(sorted(powers.items(), key=repr))


def _product(e: Expression) -> tuple[float, dict[Expression, int]]:
    """A product as its number and the powers of its factors."""
    if e[0] == "number":
        return e[1], {}
    if e[0] in {"mul", "div"}:
        a, left = _product(e[1])
        b, right = _product(e[2])
        if e[0] == "mul" or b != 0.0:
            sign = 1 if e[0] == "mul" else -1
            for base, power in right.items():
                left[base] = left.get(base, 0) + sign * power
            return a * b**sign, {base: power for base, power in left.items() if power}
    if e[0] in {"square", "cube"}:
        a, left = _product(e[1])
        power = 2 if e[0] == "square" else 3
        return a**power, {base: power * exponent for base, exponent in left.items()}
    return 1.0, {compact(e): 1}


def _factored(terms: list[Term]) -> Expression:
    """The sum with the factor that most terms share taken out of them, and so on inside and outside."""
    counts: dict[tuple[Expression, int], int] = {}
    for _, factors in terms:
        for base, power in factors:
            key = (base, 1 if power > 0 else -1)
            counts[key] = counts.get(key, 0) + 1
    shared = [(count, key) for key, count in counts.items() if count > 1]
    if not shared:
        return _sum(terms)
    _, (base, sign) = max(shared, key=lambda item: (item[0], size(item[1][0]), repr(item[1])))
    inside, outside = [], []
    for coefficient, factors in terms:
        powers = dict(factors)
        if powers.get(base, 0) * sign > 0:
            powers[base] -= sign
            left = tuple(sorted(((b, p) for b, p in powers.items() if p), key=repr))
            inside.append((coefficient, left))
        else:
            outside.append((coefficient, factors))
    inner = _factored(inside)
    whole: Expression = ("mul", base, inner) if sign > 0 else ("div", inner, base)
    if outside:
        rest = _factored(outside)
        whole = ("add", rest, whole)
    return min((simplify(whole), _sum(terms)), key=size)


def _sum(terms: list[Term]) -> Expression:
    """The sum as it is, but numbers that several terms share written once."""
    constant = sum(coefficient for coefficient, factors in terms if not factors)
    groups: dict[float, list[tuple[float, Expression]]] = {}
    for coefficient, factors in terms:
        if factors:
            groups.setdefault(abs(coefficient), []).append((coefficient, _written(factors)))
    parts: list[tuple[float, Expression]] = []
    for scale, members in groups.items():
        if len(members) == 1 or scale == 1.0:
            parts += members
        else:
            signs = [(1.0 if coefficient > 0 else -1.0, e) for coefficient, e in members]
            negative = all(sign < 0 for sign, _ in signs)
            inner = total([(-sign if negative else sign, e) for sign, e in signs])
            parts.append((-scale if negative else scale, inner))
    return total(parts, constant)


def _written(factors: Factors) -> Expression:
    above: Expression | None = None
    below: Expression | None = None
    for base, power in factors:
        power_of = _power(base, abs(power))
        if power > 0:
            above = power_of if above is None else ("mul", above, power_of)
        else:
            below = power_of if below is None else ("mul", below, power_of)
    if below is None:
        return above if above is not None else ONE
    return ("div", above if above is not None else ONE, below)


def _power(base: Expression, power: int) -> Expression:
    if power == 1:
        return base
    if power % 2 == 0:
        return ("square", _power(base, power // 2))
    return ("mul", base, _power(base, power - 1))
