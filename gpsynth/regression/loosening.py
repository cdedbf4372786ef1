"""Numbers put where a formula has none yet: arguments get a factor and a shift, which the fit then decides."""

import numpy as np

from gpsynth.regression.expressions import Expression, number, numbers, rewrite, size
from gpsynth.regression.library import Library
from gpsynth.regression.polish import LONGEST, data_of, fit_numbers
from gpsynth.regression.state import State
from gpsynth.regression.targets import Target

ONE, ZERO = number(1.0), number(0.0)
MOST = 20  # numbers in a formula
SINGLES, FACTORS = 400, 30  # formulas that are templates, and that are multiplied with each other
VERY_CHEAP = 5
FEW_ROWS = 48  # that templates are fitted on
ITERATIONS = 12
BEST = 12


def loosened(expression: Expression) -> Expression:
    """The same function with free numbers: sin(g) becomes sin(1 g + 0), and so on."""
    return rewrite(expression, _rule)


def loosen_front(state: State) -> None:
    """Loosen the formulas of the front that have not been, and fit them anew."""
    found = []
    for candidate in state.front.members():
        if candidate.expression in state.loosened:
            continue
        state.loosened.add(candidate.expression)
        free = loosened(candidate.expression)
        if sum(1 for _ in numbers(free)) <= MOST and size(free) <= LONGEST:
            found.append(free)
    state.consider(found, "loosened formulas", iterations=30, hope=0.0)


def templates(state: State, library: Library, target: Target) -> None:
    """Fit c0 + c1 f for every cheap formula f and product of two very cheap ones, with free numbers inside f."""
    usable = np.flatnonzero(library.costs > 0)
    singles = [library.expression(int(k)) for k in usable[:SINGLES]]
    cheapest = usable[library.costs[usable] <= VERY_CHEAP][:FACTORS]
    factors = [library.expression(int(k)) for k in cheapest]
    pairs = [("mul", f, g) for k, f in enumerate(factors) for g in factors[:k]]
    rows = state.rows[:FEW_ROWS]
    data = data_of(state.data.inputs[rows], target.values[rows], state.data.weights[rows].copy())
    if data.total == 0.0:  # on these rows there is nothing to explain
        return
    free = [
        ("add", ("mul", ONE, loosened(structure)), ZERO)
        for structure in (*singles, *pairs)
        if sum(1 for _ in numbers(structure)) < MOST // 2
    ]
    fitted = fit_numbers(free, data, ITERATIONS)
    state.evaluations += len(free) * ITERATIONS
    best = sorted(range(len(free)), key=lambda k: (round(fitted[k][1], 12), k))[:BEST]
    state.consider([target.inverse(fitted[k][0]) for k in best], f"templates of {target.name}", hope=0.0)


def _rule(e: Expression) -> Expression:
    kind = e[0]
    if kind in {"sin", "cos", "tanh", "atan"}:
        return (kind, ("add", _scaled(e[1]), ZERO))
    if kind == "exp":
        return (kind, _scaled(e[1]))
    if kind in {"log", "sqrt", "square", "cube"} and e[1][0] not in {"add", "sub"}:
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
