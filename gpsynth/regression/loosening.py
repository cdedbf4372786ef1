"""Numbers put where a formula has none yet: arguments get a factor and a shift, which the fit then decides."""

from gpsynth.regression.expressions import Expression, number, numbers, rewrite, size
from gpsynth.regression.polish import LONGEST
from gpsynth.regression.state import State

ONE, ZERO = number(1.0), number(0.0)
MOST = 20  # numbers in a formula
FRONT = 12  # formulas that are loosened


def loosened(expression: Expression) -> Expression:
    """The same function with free numbers: sin(g) becomes sin(1 g + 0), and so on."""
    return rewrite(expression, _rule)


def loosen_front(state: State) -> None:
    """Loosen the best formulas and fit them anew."""
    best = sorted(state.front.members(), key=lambda c: c.error)[:FRONT]
    found = []
    for candidate in best:
        free = loosened(candidate.expression)
        if sum(1 for _ in numbers(free)) <= MOST and size(free) <= LONGEST:
            found.append(free)
    state.consider(found, "loosened formulas", iterations=40)


def _rule(e: Expression) -> Expression:
    kind = e[0]
    if kind in {"sin", "cos", "tan", "tanh", "atan"}:
        return (kind, ("add", _scaled(e[1]), ZERO))
    if kind == "exp":
        return (kind, _scaled(e[1]))
    if kind in {"log", "sqrt", "square", "cube", "cbrt"} and e[1][0] not in {"add", "sub"}:
        return (kind, ("add", e[1], ZERO))
    if kind == "div" and e[2][0] not in {"add", "sub", "variable"}:
        return (kind, e[1], ("add", e[2], ZERO))
    return e


def _scaled(e: Expression) -> Expression:
    if e[0] in {"add", "sub"}:
        return (e[0], _scaled(e[1]), _scaled(e[2]))
    if e[0] == "number" or (e[0] == "mul" and e[1][0] == "number"):
        return e
    return ("mul", ONE, e)
