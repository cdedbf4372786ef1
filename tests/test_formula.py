import pytest

from gpsynth.builder import Builder
from gpsynth.formula import lines
from gpsynth.program import Program

CASES = {
    "a * b + c": "c + a * b",
    "(a + b) * c": "c * (a + b)",
    "a - (b - c)": "a - (b - c)",
    "a - b - c": "a - b - c",
    "-a - b": "-a - b",
    "a - -b": "a + b",
    "a / (b * c)": "a / (b * c)",
    "a / b / c": "a / b / c",
    "a + -2 * b": "a - 2 * b",
    "(a / b) ** 2": "(a / b)^2",
    "(a ** 2) ** 3": "(a^2)^3",
    "-(a + b)": "-(a + b)",
    "sin(a) * b": "b * sin(a)",
    "b * 1e-7 * (a < b)": "1e-07 * b * (a < b)",
    "where(a, b + c, 0)": "(b + c if a else 0)",
}


class Symbol:
    """Enough of Python's arithmetic to write the cases down."""

    def __init__(self, builder: Builder, reference: int) -> None:
        self.builder, self.reference = builder, reference

    def _apply(self, name: str, *operands: object) -> "Symbol":
        values = [
            item.reference if isinstance(item, Symbol) else self.builder.constant(item) for item in operands
        ]
        return Symbol(self.builder, self.builder.apply(name, *values))

    def __add__(self, other):
        return self._apply("add", self, other)

    def __sub__(self, other):
        return self._apply("sub", self, other)

    def __mul__(self, other):
        return self._apply("mul", self, other)

    __rmul__ = __mul__

    def __truediv__(self, other):
        return self._apply("div", self, other)

    def __neg__(self):
        return self._apply("neg", self)

    def __lt__(self, other):
        return self._apply("lt", self, other)

    def __pow__(self, exponent):
        return self._apply({2: "square", 3: "cube"}[exponent], self)


@pytest.mark.parametrize(("written", "expected"), CASES.items())
def test_parentheses_stand_where_they_are_needed_and_nowhere_else(written, expected):
    builder = Builder(("a", "b", "c"))
    names = {name: Symbol(builder, item) for name, item in zip("abc", builder.inputs, strict=True)}
    functions = {
        "sin": lambda a: a._apply("sin", a),
        "where": lambda a, b, c: a._apply("where", a, b, float(c)),
    }
    value = eval(written, {**names, **functions})
    assert lines(builder.build([value.reference], ["y"])) == (f"y = {expected}",)


def _doubling(depth: int, inputs: tuple[str, ...] = ("x",)) -> Program:
    builder = Builder(inputs)
    value = builder.inputs[0]
    for _ in range(depth):
        value = builder.apply("add", builder.apply("mul", value, value), builder.apply("sin", value))
    return builder.build([value], ["y"])


def test_shared_values_are_written_once():
    written = lines(_doubling(40))
    assert len(written) <= 40
    assert sum(map(len, written)) < 3000


def test_every_name_is_assigned_before_it_is_used():
    known = {"x", "sin"}
    for line in lines(_doubling(10)):
        name, formula = line.split(" = ")
        words = "".join(character if character.isalnum() else " " for character in formula).split()
        assert {word for word in words if not word.isdigit()} <= known
        known.add(name)


def test_names_of_inputs_are_not_taken():
    assert [line.split(" = ")[0] for line in lines(_doubling(4, ("z1", "z2")))] == ["z3", "z4", "z5", "y"]


def test_long_formulas_are_broken_up():
    builder = Builder(tuple(f"x{index}" for index in range(50)))
    total = builder.inputs[0]
    for item in builder.inputs[1:]:
        total = builder.apply("add", total, item)
    written = lines(builder.build([total], ["y"]))
    assert len(written) == 4
    assert all(len(line) < 100 for line in written)


def test_dead_code_is_not_written():
    program = Program(("x",), (), [], [[10, 0, -1, -1], [14, 0, -1, -1]], [1], ("y",))
    assert len(lines(program)) == 1
