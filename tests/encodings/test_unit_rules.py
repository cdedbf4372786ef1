import pytest

from gpsynth.dimensions import dimension
from gpsynth.encodings.parameters import ParameterSpace
from gpsynth.encodings.tree import TreeEncoding
from gpsynth.errors import EncodingError, UnitError
from gpsynth.operations import GP_NAMES
from gpsynth.tracing import trace
from gpsynth.units import _check, _Equations
from tests.encodings.helpers import ENCODINGS, PLAIN
from tests.encodings.test_contract import walk

UNITS = {"x": "m", "y": "m/s", "phi": "rad", "u": "m", "v": "m/s^2"}
RICH = TreeEncoding(("x", "y", "phi"), ("u", "v"), GP_NAMES, ParameterSpace(12), units=UNITS)


def conflicts(encoding, genome):
    """What the linear equations of `gpsynth.units` say, which know nothing of trees."""
    equations = _Equations()
    known = {name: dimension(encoding.units[name]) for name in encoding.inputs}
    program = encoding.decode(genome)
    numbers = {name: equations.unknown() for name in program.parameters}
    _check(
        equations,
        program,
        {**known, **numbers},
        [dimension(encoding.units[name]) for name in encoding.outputs],
    )
    return equations.conflicts


@pytest.mark.parametrize("encoding", [ENCODINGS["tree-units"], RICH], ids=["plain", "rich"])
def test_the_units_of_every_formula_fit_whatever_the_search_does(encoding):
    complexities = set()
    for family in walk(encoding, 300, seed=1):
        for genome in family:
            assert conflicts(encoding, genome) == []
            complexities.add(encoding.decode(genome).complexity)
    assert len(complexities) > 8  # not by being trivial


def test_without_units_formulas_do_not_fit():
    free = TreeEncoding(RICH.inputs, RICH.outputs, PLAIN, ParameterSpace(8))
    wrong = 0
    for genome, *_ in walk(free, 100, seed=2):
        program = free.decode(genome)
        equations = _Equations()
        known = {name: dimension(UNITS[name]) for name in (*free.inputs,)}
        numbers = {name: equations.unknown() for name in program.parameters}
        _check(equations, program, {**known, **numbers}, [dimension(UNITS[name]) for name in free.outputs])
        wrong += bool(equations.conflicts)
    assert wrong > 50


def test_a_formula_whose_units_do_not_fit_is_refused():
    encoding = TreeEncoding(
        ("x", "y"), ("u",), ("add", "mul"), ParameterSpace(2), units={"x": "m", "y": "s", "u": "m"}
    )
    encoding.from_program(trace(lambda f: f.x + 2.0 * f.y, [("f", ("x", "y"))], ("u",)))
    with pytest.raises(EncodingError, match="do not keep the symmetries or units"):
        encoding.from_program(trace(lambda f: f.x + f.y, [("f", ("x", "y"))], ("u",)))


@pytest.mark.parametrize(
    ("changes", "error", "sentence"),
    [
        ({"units": {"x": "m"}}, EncodingError, "'u' has none"),
        ({"units": {"x": "m", "u": "m", "z": "m"}}, EncodingError, "'z' is none of them"),
        ({"units": {"x": "m", "u": "ell"}}, UnitError, "unknown part 'ell'"),
        ({"operations": ("add",)}, EncodingError, "the operations must have mul"),
        ({"space": ParameterSpace(0)}, EncodingError, "at least 1 numbers"),
        (
            {"outputs": ("u", "v"), "units": {"x": "m", "u": "N", "v": "N"}},
            EncodingError,
            "at least 2 numbers",
        ),
    ],
)
def test_wrong_units_are_named(changes, error, sentence):
    settings = {
        "inputs": ("x",),
        "outputs": ("u",),
        "operations": ("add", "mul"),
        "space": ParameterSpace(1),
        "units": {"x": "m", "u": "m"},
    }
    with pytest.raises(error, match=sentence):
        TreeEncoding(**{**settings, **changes})
