r"""A law as LaTeX: features, intermediate values and controls, one line each, in an align environment."""

import re
from collections.abc import Callable, Iterable, Mapping
from types import MappingProxyType

from gpsynth.export.reading import header_lines, meanings, printable, spell_law
from gpsynth.law import Law
from gpsynth.notation import Brackets, Level, Notation, Piece, number_text
from gpsynth.operations import Operation
from gpsynth.program import Leaf

PARENTHESES = Brackets("\\left(", "\\right)")
GREEK = (
    "alpha beta gamma delta epsilon zeta eta theta iota kappa lambda mu nu xi pi rho sigma tau upsilon phi chi psi "
    "omega Gamma Delta Theta Lambda Xi Pi Sigma Upsilon Phi Psi Omega"
)

# How tightly the templates of the table hold together, and how tightly their operands must; what is not named here
# encloses its operands, as a fraction, a root or a function with parentheses does.
_SHAPES: Mapping[str, tuple[Level, Level]] = MappingProxyType(
    {
        **dict.fromkeys(("sin", "cos", "tan", "atan", "asin", "acos"), (Level.FUNCTION, Level.POWER)),
        **dict.fromkeys(("log", "tanh", "sign"), (Level.FUNCTION, Level.POWER)),
        **dict.fromkeys(("log_protected", "nop_log", "tanh_half"), (Level.FUNCTION, Level.SUM)),
        **dict.fromkeys(
            ("square", "cube", "nop_square", "nop_cube", "nop_inverse"), (Level.POWER, Level.ATOM)
        ),
        **dict.fromkeys(
            ("abs", "floor", "sqrt", "sqrt_protected", "cbrt", "nop_cbrt"), (Level.ATOM, Level.SUM)
        ),
        **dict.fromkeys(("lt", "le", "eq", "where"), (Level.ATOM, Level.SUM)),
        **dict.fromkeys(("signed_sqrt", "signed_decay"), (Level.PRODUCT, Level.SUM)),
        **dict.fromkeys(("signed_log1p", "signed_expm1", "signed_saturation"), (Level.PRODUCT, Level.SUM)),
        **dict.fromkeys(("circle", "notch", "signed_hypot"), (Level.PRODUCT, Level.ATOM)),
        **dict.fromkeys(("signed_abs_sum", "signed_abs_max"), (Level.PRODUCT, Level.PRODUCT)),
        "not": (Level.FUNCTION, Level.ATOM),
        "hypot": (Level.ATOM, Level.ATOM),
        "minus_cube": (Level.ATOM, Level.ATOM),
        "sigmoid": (Level.POWER, Level.PRODUCT),
    }
)
_ENCLOSING = (Level.POWER, Level.SUM)
_OPEN = (Level.OPEN, Level.FUNCTION)
_STARTS_WITH_NUMBER = re.compile(r"\d|\\tfrac")


def to_latex(law: Law, name: str = "law") -> str:
    """The law as an align* environment (it needs amsmath), behind comments that say what it is."""
    features = law.features
    names = symbols((*features.inputs, *features.names, *law.program.names))
    rows = [
        (names.get(left, symbol(left)), right.text)
        for left, right in spell_law(law, notation(names), largest=10)
    ]
    comments = [*header_lines(law, name), *meanings(law)]
    return "\n".join(
        [
            *(f"% {comment}" for comment in comments),
            "\\begin{align*}",
            " \\\\\n".join(f"  {left} &= {right}" for left, right in rows),
            "\\end{align*}",
            "",
        ]
    )


def to_document(law: Law, name: str = "law") -> str:
    """A LaTeX article with the law and what the less common operations mean."""
    where = [f"\\item \\texttt{{{_escaped(meaning)}}}" for meaning in meanings(law)]
    return "\n".join(
        [
            "\\documentclass{article}",
            "\\usepackage[margin=2cm]{geometry}",
            "\\usepackage{amsmath}",
            "\\allowdisplaybreaks",
            "\\frenchspacing",
            "\\begin{document}",
            f"\\section*{{Feedback law of the plant \\texttt{{{_escaped(printable(law.plant.name))}}}}}",
            to_latex(law, name).rstrip(),
            *(["\\begin{itemize}", *where, "\\end{itemize}"] if where else []),
            "\\end{document}",
            "",
        ]
    )


def symbol(name: str) -> str:
    r"""A name as LaTeX: theta as \theta, x_target as x^{*}, error_x as \Delta x, x1 as x_{1}, speed as \mathrm."""
    if name.endswith("_target") and name != "_target":
        return f"{symbol(name.removesuffix('_target'))}^{{*}}"
    if name.startswith("error_") and name != "error_":
        return f"\\Delta {symbol(name.removeprefix('error_'))}"
    first, *rest = [
        _word(word) for part in name.split("_") for word in re.findall(r"\d+|[A-Za-z]+", part)
    ] or [""]
    return f"{first}_{{{','.join(rest)}}}" if rest else first


def symbols(names: Iterable[str]) -> dict[str, str]:
    """The symbol of each name; names that would look the same stand as they are."""
    symbols = {name: symbol(name) for name in names}
    shown = list(symbols.values())
    return {
        name: text if text and shown.count(text) == 1 else f"\\mathtt{{{_escaped(name)}}}"
        for name, text in symbols.items()
    }


def _word(word: str) -> str:
    if word in GREEK.split():
        return f"\\{word}"
    return word if len(word) == 1 or word.isdigit() else f"\\mathrm{{{word}}}"


def _escaped(text: str) -> str:
    return re.sub(r"([%_])", r"\\\1", text.replace("^", "\\^{}"))


def notation(names: dict[str, str]) -> Notation[Piece]:
    """How LaTeX writes programs whose values have these symbols."""

    def named(name: str) -> Piece:
        text = names.get(name, symbol(name))
        return Piece(text, Level.POWER if "^" in text or text.startswith("\\Delta ") else Level.ATOM)

    def leaf(item: Leaf) -> Piece:
        return number(item.value) if item.kind == "constant" else named(item.name)

    return Notation(leaf=leaf, node=_node, symbol=named, copies=_copies)


def _copies(operation: Operation) -> tuple[int, ...]:
    return tuple(operation.latex.count(f"{{{index}}}") for index in range(operation.arity))


def number(value: float) -> Piece:
    """A number with six digits, powers of ten written out."""
    text = number_text(value)
    mantissa, _, exponent = text.partition("e")
    if exponent:
        power = f"10^{{{int(exponent)}}}"
        text = {"1": power, "-1": f"-{power}"}.get(mantissa, f"{mantissa} \\times {power}")
    text = text.replace("inf", "\\infty").replace("nan", "\\mathrm{NaN}")
    level = Level.PRODUCT if exponent else Level.ATOM
    return Piece(text, Level.SIGNED if text.startswith("-") else level, is_number=True)


def _node(operation: Operation, operands: tuple[Piece, ...]) -> Piece:
    if operation.name in _JOINED:
        return _JOINED[operation.name](*operands)
    level, least = _SHAPES.get(operation.name, _ENCLOSING)
    return Piece(operation.latex.format(*(PARENTHESES.around(operand, least) for operand in operands)), level)


def _product(a: Piece, b: Piece) -> Piece:
    """a b, numbers first and bare functions last: what stands behind one would belong to its argument."""
    first, second = (b, a) if b.is_number or (a.level in _OPEN and b.level != Level.FUNCTION) else (a, b)
    least = Level.OPEN if second.level == Level.FUNCTION else Level.PRODUCT
    left = first.text if first.is_number else PARENTHESES.around(first, least)
    right = PARENTHESES.around(second, Level.OPEN)
    is_apart = left.endswith("\\right)") or right.startswith("\\left(")
    space = " " if is_apart else " \\, "
    if first.is_number and _STARTS_WITH_NUMBER.match(right):
        space = " \\cdot "
    level = Level.OPEN if second.level in _OPEN else Level.PRODUCT
    return Piece(f"{left}{space}{right}", Level.SIGNED if left.startswith("-") else level)


def _probabilistic_sum(a: Piece, b: Piece) -> Piece:
    difference = PARENTHESES.subtract(PARENTHESES.add(a, b), _product(a, b))
    return Piece(PARENTHESES.around(difference, Level.ATOM))


# Operations whose signs and factors are joined rather than put into the table's template.
_JOINED: Mapping[str, Callable[..., Piece]] = MappingProxyType(
    {
        "add": PARENTHESES.add,
        "sub": PARENTHESES.subtract,
        "neg": PARENTHESES.negate,
        "mul": _product,
        "nop_mul": _product,
        "double": lambda a: _product(Piece("2", is_number=True), a),
        "half": lambda a: _product(Piece("\\tfrac{1}{2}", is_number=True), a),
        "prob_sum": _probabilistic_sum,
        "identity": lambda a: a,
    }
)
