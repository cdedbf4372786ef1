"""Names and units come from files; no exported form may let them become code."""

import pytest

from gpsynth.builder import Builder
from gpsynth.errors import GpsynthError
from gpsynth.export import to_c, to_document, to_latex, to_python, to_text
from gpsynth.export.reading import printable
from gpsynth.law import Law
from gpsynth.plant import Plant
from tests.export.helpers import COMPILER, FLAGS, needs_compiler, robot_law, run

HOSTILE = (
    '*/ #error "escaped" /*',
    '"""\nimport os\nos.abort()\n"""',
    "\\input{/etc/passwd}\n\\undefined",
    "\\\n*/\nint escaped;\n/*",
    "??/\n#error",
    "m\u2028#error\r\n#error",
)


def _law(text: str) -> Law:
    """The fixed law of a plant whose name and units are `text`."""
    law = robot_law()
    states = dict.fromkeys(law.plant.states, text)
    controls = {name: (text, low, high) for name, (_, low, high) in law.plant.controls.items()}
    plant = Plant(law.plant.dynamics, states, controls, angles=("theta",), name=text)
    return Law(plant, law.features, law.program, law.parameters)


@needs_compiler
@pytest.mark.parametrize("text", HOSTILE)
def test_units_stay_inside_comments_of_c(tmp_path, text):
    source, header = to_c(_law(text))
    (tmp_path / "law.c").write_text(source)
    (tmp_path / "law.h").write_text(header)
    run([str(COMPILER), *FLAGS, "-c", str(tmp_path / "law.c"), "-o", str(tmp_path / "law.o")])
    assert source.count("escaped") == 0 or "#error" not in printable(text)


@pytest.mark.parametrize("text", HOSTILE)
def test_units_stay_inside_the_docstring_of_python(text):
    namespace: dict = {}
    exec(to_python(_law(text)), namespace)
    assert "os" not in namespace


@pytest.mark.parametrize("text", HOSTILE)
def test_units_stay_inside_comments_of_latex(text):
    law = _law(text)
    lines = to_latex(law).splitlines()
    assert all(line.startswith("%") for line in lines[: lines.index("\\begin{align*}")])
    assert "\\input" not in to_document(law)
    assert "\\undefined" not in to_document(law)
    assert len(to_text(law).splitlines()) == len(to_text(robot_law()).splitlines())


@pytest.mark.parametrize(
    "name", ["__import__('os').system('true')", "x;}", "x y", "x\n", "", "é", "1x", "x-1"]
)
def test_values_cannot_have_such_names(name):
    with pytest.raises(GpsynthError, match="is not a name"):
        Builder((name,)).build([0], ["u"])
    document = robot_law().to_dict()
    document["features"]["names"][0] = name
    with pytest.raises(GpsynthError):
        Law.from_dict(document)
