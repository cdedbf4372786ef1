"""Rewrites that make an expression smaller without changing the function it stands for (up to rounding)."""

from typing import Any

from gpsynth.kernels import elementary
from gpsynth.regression.expressions import Expression, number, rewrite

ZERO, ONE = number(0.0), number(1.0)


def simplify(expression: Expression) -> Expression:
    """Constants folded and gathered, neutral elements dropped, signs moved out."""
    before = None
    while before != expression:
        before, expression = expression, rewrite(expression, _simpler)
    return expression


def total(terms: list[tuple[float, Expression]], constant: float = 0.0) -> Expression:
    """constant + sum of coefficient * term, with as few nodes as possible."""
    positive = [(c, term) for c, term in terms if c > 0.0]
    negative = [(c, term) for c, term in terms if c < 0.0]
    parts = [_scaled(c, term) for c, term in positive]
    if constant > 0.0 or not parts:
        parts.append(number(constant))
        constant = 0.0
    result = parts[0]
    for part in parts[1:]:
        result = ("add", result, part)
    for c, term in negative:
        result = ("sub", result, _scaled(-c, term))
    if constant < 0.0:
        result = ("sub", result, number(-constant))
    return simplify(result)


def _scaled(coefficient: float, term: Expression) -> Expression:
    return term if coefficient == 1.0 else ("mul", number(coefficient), term)


def _is_number(expression: Expression) -> bool:
    return bool(expression[0] == "number")


def _simpler(e: Expression) -> Any:
    if e[0] in {"number", "variable"}:
        return e
    if all(map(_is_number, e[1:])):
        return number(elementary.evaluate(e[0], *(operand[1] for operand in e[1:])))
    if e[0] == "neg":
        return _negated(e[1])
    if e[0] == "exp":
        return _exponential(e[1])
    if e[0] == "square" and e[1][0] == "sqrt":
        return e[1][1]
    if e[0] == "sqrt" and e[1][0] == "exp":
        return ("exp", ("mul", number(0.5), e[1][1]))
    if len(e) == 2:
        return e
    kind, a, b = e
    if kind == "add":
        if ZERO in {a, b}:
            return b if a == ZERO else a
        if a == b:
            return ("mul", number(2.0), a)
        if _is_number(b) and b[1] < 0.0:
            return ("sub", a, number(-b[1]))
        if _is_number(a):
            return ("add", b, a)
        if b[0] == "neg":
            return ("sub", a, b[1])
        if a[0] == "neg":
            return ("sub", b, a[1])
        if b[0] == "mul" and _is_number(b[1]) and b[1][1] < 0.0:
            return ("sub", a, _scaled(-b[1][1], b[2]))
        if _is_number(b) and a[0] in {"add", "sub"} and _is_number(a[2]):
            inner = a[2][1] if a[0] == "add" else -a[2][1]
            return ("add", a[1], number(b[1] + inner))
        if _is_number(b) and a[0] == "sub" and _is_number(a[1]):
            return ("sub", number(a[1][1] + b[1]), a[2])
    elif kind == "sub":
        if b == ZERO:
            return a
        if a == ZERO:
            return _negated(b)
        if a == b:
            return ZERO
        if _is_number(b) and b[1] < 0.0:
            return ("add", a, number(-b[1]))
        if b[0] == "neg":
            return ("add", a, b[1])
        if b[0] == "mul" and _is_number(b[1]) and b[1][1] < 0.0:
            return ("add", a, _scaled(-b[1][1], b[2]))
        if _is_number(b) and a[0] in {"add", "sub"} and _is_number(a[2]):
            inner = a[2][1] if a[0] == "add" else -a[2][1]
            return ("add", a[1], number(inner - b[1]))
        if _is_number(a) and b[0] in {"add", "sub"} and _is_number(b[2]):
            inner = b[2][1] if b[0] == "add" else -b[2][1]
            return ("sub", number(a[1] - inner), b[1])
        if _is_number(a) and b[0] == "sub" and _is_number(b[1]):
            return ("add", b[2], number(a[1] - b[1][1]))
    elif kind == "mul":
        if ZERO in (a, b):
            return ZERO
        if ONE in (a, b):
            return b if a == ONE else a
        if _is_number(b):
            return ("mul", b, a)
        if a == b:
            return ("square", a)
        if _is_number(a) and b[0] == "mul" and _is_number(b[1]):
            return ("mul", number(a[1] * b[1][1]), b[2])
        if _is_number(a) and b[0] == "div" and _is_number(b[1]):
            return ("div", number(a[1] * b[1][1]), b[2])
        if _is_number(a) and b[0] == "div" and _is_number(b[2]) and b[2][1] != 0.0:
            return ("mul", number(a[1] / b[2][1]), b[1])
        if _is_number(a) and b[0] == "sub" and a[1] == -1.0:
            return ("sub", b[2], b[1])
        if _is_number(a) and a[1] < 0.0 and b[0] == "log" and b[1][0] == "div":
            return ("mul", number(-a[1]), ("log", ("div", b[1][2], b[1][1])))
        if b[0] == "div" and b[1] == ONE:
            return ("div", a, b[2])
        if a[0] == "div" and a[1] == ONE:
            return ("div", b, a[2])
        if not _is_number(a) and b[0] == "mul" and _is_number(b[1]):
            return ("mul", b[1], ("mul", a, b[2]))
        if a[0] == "mul" and _is_number(a[1]):
            return ("mul", a[1], ("mul", a[2], b))
    elif kind == "div":
        if b == ONE:
            return a
        if a == ZERO:
            return ZERO
        if _is_number(b) and b[1] != 0.0 and a[0] == "mul" and _is_number(a[1]):
            return ("mul", number(a[1][1] / b[1]), a[2])
        if b[0] == "div" and not _is_number(b[1]):
            return ("div", ("mul", a, b[2]), b[1])
        if b[0] == "div" and _is_number(b[1]) and b[1][1] != 0.0:
            return ("mul", a, ("mul", number(1.0 / b[1][1]), b[2]))
        if a[0] == "div":
            return ("div", a[1], ("mul", a[2], b))
        if b[0] == "mul" and _is_number(b[1]) and _is_number(a) and b[1][1] != 0.0:
            return ("div", number(a[1] / b[1][1]), b[2])
        if b[0] == "mul" and _is_number(b[1]) and a[0] == "mul" and _is_number(a[1]) and b[1][1] != 0.0:
            return ("mul", number(a[1][1] / b[1][1]), ("div", a[2], b[2]))
        if a == b:
            return ONE
    return e


def _exponential(e: Expression) -> Any:
    """exp e, with logarithms in a sum taken out as factors."""
    if e[0] == "log":
        return e[1]
    if e[0] in {"add", "sub"}:
        a, b = e[1:]
        outside = {"add": "mul", "sub": "div"}[e[0]]
        if a[0] == "log" or b[0] == "log":
            return (outside, _exponential(a), _exponential(b))
        if _is_number(b) and _has_logarithm(a):
            return (
                "mul",
                _exponential(a),
                number(elementary.evaluate("exp", b[1] if e[0] == "add" else -b[1])),
            )
        if _has_logarithm(a) or _has_logarithm(b):
            return (outside, _exponential(a), _exponential(b))
    if e[0] == "mul" and _is_number(e[1]) and e[2][0] == "log":
        for power, name in ((0.5, "sqrt"), (2.0, "square")):
            if abs(e[1][1]) == power:
                root: Expression = (name, e[2][1])
                return root if e[1][1] > 0.0 else ("div", ONE, root)
        if e[1][1] == -1.0:
            return ("div", ONE, e[2][1])
    return ("exp", e)


def _has_logarithm(e: Expression) -> bool:
    """Whether a sum has a logarithm as a term."""
    return e[0] == "log" or (e[0] in {"add", "sub"} and any(map(_has_logarithm, e[1:])))


def _negated(e: Expression) -> Any:
    if e[0] == "neg":
        return e[1]
    if e[0] == "sub":
        return ("sub", e[2], e[1])
    if e[0] == "mul" and _is_number(e[1]):
        return ("mul", number(-e[1][1]), e[2])
    if e[0] == "number":
        return number(-e[1])
    return ("mul", number(-1.0), e)
