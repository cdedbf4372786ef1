import contextlib
import json
import math
import sys

import numpy as np
import pytest
from matplotlib.figure import Figure

from gpsynth import export
from gpsynth.builder import Builder
from gpsynth.errors import FileError, GpsynthError, LawError, MissingPackageError
from gpsynth.law import Law
from gpsynth.plant import Plant
from gpsynth.program import Program
from tests.export.helpers import errors_of, plant_of, random_law, robot_law, rows_to_try, same_bits

STATES = np.array([[0.1, -0.2, 0.3], [1.0, 2.0, -3.0], [0.0, 0.0, 0.0], [-4.0, 0.5, 9.0]])
TARGETS = np.array([[1.0, 1.0, 0.0], [0.0, 0.0, 0.0], [0.5, 0.0, 0.1], [1.0, 1.0, 1.0]])


def _by_hand(x, goal) -> list[float]:
    """The robot law with the functions of the standard library."""
    dx, dy = goal[0] - x[0], goal[1] - x[1]
    ahead = math.cos(x[2]) * dx + math.sin(x[2]) * dy
    aside = math.cos(x[2]) * dy - math.sin(x[2]) * dx
    turn = math.remainder(goal[2] - x[2], 2.0 * math.pi)
    shared = math.tanh(2.25 * (math.atan2(0.7 * aside, abs(ahead) + 1e-3) - turn))
    root = math.sqrt(abs(ahead))
    quotient = shared / root if root > 1e-8 else shared * 1e8
    controls = (3.1 * ahead * (1.0 - shared * shared), quotient - aside**3)
    return [min(max(control, -0.5), 0.5) for control in controls]


def test_controls_are_those_of_the_formula():
    expected = [_by_hand(x, goal) for x, goal in zip(STATES.tolist(), TARGETS.tolist(), strict=True)]
    # a dozen operations, each of at most 2 ulp here and in the standard library
    assert np.allclose(robot_law()(STATES, TARGETS), expected, rtol=1e-13, atol=1e-15)


def test_one_state_gives_one_control_vector():
    law = robot_law()
    assert law(STATES[0], TARGETS[0]).shape == (2,)
    assert same_bits(law(STATES[0], TARGETS[0]), law(STATES, TARGETS)[0])


def test_a_single_target_serves_all_states():
    law = robot_law()
    many = law(STATES, np.tile(TARGETS[1], (4, 1)))
    assert same_bits(law(STATES, TARGETS[1]), many)
    assert same_bits(law(STATES[0], TARGETS), law(np.tile(STATES[0], (4, 1)), TARGETS))


def test_no_rows_give_no_controls():
    assert robot_law()(np.empty((0, 3)), np.zeros(3)).shape == (0, 2)


@pytest.mark.parametrize(
    ("x", "target"), [((2,), (3,)), ((4, 2), (3,)), ((3,), (1, 4, 3)), ((4, 3), (5, 3)), ((), (3,))]
)
def test_wrong_shapes_are_refused(x, target):
    with pytest.raises(LawError, match=r"shape|rows"):
        robot_law()(np.zeros(x), np.zeros(target))


def test_controls_are_within_limits_and_never_nan():
    rows = rows_to_try(20_000, 6, 5)
    controls = robot_law()(rows[:, :3], rows[:, 3:])
    assert np.all((controls >= -0.5) & (controls <= 0.5))


def _constant_law(value: float, low: float, high: float) -> Law:
    plant = plant_of(["x"], ["u"]).with_limits([low], [high])
    builder = Builder(("error_x",))
    return Law(plant, errors_of(["x"]), builder.build([builder.constant(value)], ["u"]), np.empty(0))


@pytest.mark.parametrize(
    ("low", "high", "expected"), [(-0.5, 0.5, 0.0), (0.2, 0.5, 0.2), (-0.5, -0.2, -0.2), (0.0, 1.0, 0.0)]
)
def test_nan_becomes_the_admissible_number_nearest_to_zero(low, high, expected):
    assert _constant_law(float("nan"), low, high)([1.0], [0.0]).tolist() == [expected]


def test_other_limits_leave_the_formula():
    law = robot_law()
    wide = law.with_limits([-9.0, -9.0], [9.0, 9.0])
    assert wide.program == law.program
    assert same_bits(np.clip(wide(STATES, TARGETS), -0.5, 0.5), law(STATES, TARGETS))
    assert law.plant.upper.tolist() == [0.5, 0.5]


def test_saved_law_comes_back_and_computes_the_same_bits(tmp_path):
    rows = rows_to_try(2000, 6, 6)
    for seed in range(5):
        law = random_law(np.random.default_rng(seed))
        law.save(tmp_path / "law.json")
        again = Law.load(tmp_path / "law.json")
        assert again == law
        assert again.hash == law.hash
        assert hash(again) == hash(law)
        assert same_bits(again(rows[:, :3], rows[:, 3:]), law(rows[:, :3], rows[:, 3:]))


def test_parameters_are_kept_exactly(tmp_path):
    law = robot_law()
    odd = Law(law.plant, law.features, law.program, np.array([5e-324, -0.0, 1 / 3]))
    odd.save(tmp_path / "law.json")
    assert same_bits(Law.load(tmp_path / "law.json").parameters, odd.parameters)


def test_content_decides_equality():
    law = robot_law()
    assert law == robot_law()
    assert law != Law(law.plant, law.features, law.program, (3.1, 0.7, 2.2500000000000004))
    assert law != law.with_limits([-0.5, -0.5], [0.5, 0.6])


def test_parameters_cannot_be_changed():
    with pytest.raises(ValueError, match="read-only"):
        robot_law().parameters[0] = 1.0


def test_formulas_read_as_written():
    assert robot_law().formulas() == (
        "z1 = tanh(2.25 * (atan2(0.7 * aside, abs(ahead) + 0.001) - error_theta))",
        "v = limit(3.1 * ahead * (1 - z1^2), -0.5, 0.5)",
        "omega = limit(div_protected(z1, sqrt_protected(ahead)) - aside^3, -0.5, 0.5)",
    )


def test_a_law_prints_as_its_formulas():
    assert str(robot_law()).splitlines() == list(robot_law().formulas())


def test_complexity_counts_the_instructions_of_the_program():
    law = robot_law()
    assert law.complexity == len(law.program.code) == 16


def _changed(document: dict, path: tuple, value: object) -> dict:
    changed = json.loads(json.dumps(document))
    inner = changed
    for key in path[:-1]:
        inner = inner[key]
    inner[path[-1]] = value
    return changed


@pytest.mark.parametrize(
    ("path", "value"),
    [
        (("format",), "gpsynth-law/2"),
        (("surprise",), 1),
        (("hash",), "0" * 64),
        (("parameters",), ["0x1p0", "0x1p0", "0x1p1"]),
        (("parameters",), ["0x1p0", "0x1p0"]),
        (("parameters",), [3.1, 0.7, 2.25]),
        (("parameters",), ["nan", "inf", "0x1p0"]),
        (("parameters",), ["eggs", "0x1p0", "0x1p0"]),
        (("parameters",), ["0x1p5000", "0x1p0", "0x1p0"]),
        (("parameters",), None),
        (("plant",), None),
        (("plant", "name"), "other"),
        (("program",), []),
        (("program", "code", 0), ["add", 0]),
        (("program", "code", 0), ["shell", 0, 1]),
        (("program", "names"), ["v", "w"]),
        (("features", "inputs", 0), "y"),
        (("features", "constants"), ["0x1p0"]),
    ],
)
def test_changed_document_is_refused_with_one_sentence(tmp_path, path, value):
    (tmp_path / "law.json").write_text(json.dumps(_changed(robot_law().to_dict(), path, value)))
    with pytest.raises(LawError, match=r"law\.json: ") as caught:
        Law.load(tmp_path / "law.json")
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("document", [None, [], "law", {}, {"format": "gpsynth-law/1"}])
def test_what_is_no_law_document_is_refused(document):
    with pytest.raises(LawError, match="a law document has"):
        Law.from_dict(document)


def test_missing_file_is_named(tmp_path):
    with pytest.raises(FileError, match=r"none\.json does not exist"):
        Law.load(tmp_path / "none.json")


def test_key_that_stands_twice_is_refused(tmp_path):
    text = json.dumps(robot_law().to_dict())
    (tmp_path / "law.json").write_text(text[:-1] + ', "hash": ""}')
    with pytest.raises(FileError, match="twice"):
        Law.load(tmp_path / "law.json")


def _parts() -> tuple[Plant, Program, Program]:
    law = robot_law()
    return law.plant, law.features, law.program


def test_parts_that_do_not_fit_are_refused():
    plant, features, program = _parts()
    with pytest.raises(LawError, match=r"the parameters have shape \(2,\); expected \(3,\)"):
        Law(plant, features, program, (1.0, 2.0))
    with pytest.raises(LawError, match="must be finite"):
        Law(plant, features, program, (1.0, float("nan"), 2.0))
    with pytest.raises(
        LawError, match=r"the features take .* expected the states and their targets, a, a_target"
    ):
        Law(plant_of(["a"], ["v", "omega"]), features, program, (1.0, 2.0, 3.0))
    with pytest.raises(
        LawError, match=r"the program takes .*; the features are error_x, error_y, error_theta"
    ):
        Law(plant, errors_of(["x", "y", "theta"]), program, (1.0, 2.0, 3.0))
    with pytest.raises(LawError, match="the program computes v, omega; the controls are a, b"):
        Law(plant_of(["x", "y", "theta"], ["a", "b"]), features, program, (1.0, 2.0, 3.0))


def test_feature_cannot_take_the_name_of_another_value():
    builder = Builder(("x", "x_target"))
    features = builder.build([builder.apply("neg", builder.inputs[0])], ["x"])
    program = Builder(("x",))
    with pytest.raises(LawError, match="the feature 'x' has the name of another"):
        Law(plant_of(["x"], ["u"]), features, program.build(program.inputs, ["u"]), np.empty(0))


def test_hostile_document_raises_nothing_but_our_errors():
    document = robot_law().to_dict()
    rng = np.random.default_rng(7)
    values = (None, -1, 2**40, 1.5, "x", [], {}, [[]], True, "\x00")
    for _ in range(400):
        path: list = []
        inner = document
        while isinstance(inner, dict | list) and inner and (not path or rng.random() < 0.8):
            keys = list(inner) if isinstance(inner, dict) else list(range(len(inner)))
            path.append(keys[rng.integers(len(keys))])
            inner = inner[path[-1]]
        with contextlib.suppress(GpsynthError):
            changed = Law.from_dict(_changed(document, tuple(path), values[rng.integers(len(values))]))
            assert changed == robot_law(), f"a change at {path} was not noticed"


def test_each_export_is_a_method_too():
    law = robot_law()
    assert law.to_latex() == export.to_latex(law)
    assert law.to_c("steer") == export.to_c(law, "steer")
    assert law.to_python("steer") == export.to_python(law, "steer")
    assert law.to_sympy(expanded=True) == export.to_sympy(law, expanded=True)


@pytest.mark.parametrize(("method", "package"), [("to_casadi", "casadi"), ("to_control", "control")])
def test_a_package_that_is_not_installed_is_named(monkeypatch, method, package):
    monkeypatch.setitem(sys.modules, package, None)
    monkeypatch.delitem(sys.modules, f"gpsynth.export.{package}_form", raising=False)
    with pytest.raises(MissingPackageError, match=rf"pip install gpsynth\[{package}\]"):
        getattr(robot_law(), method)()


def test_a_law_draws_its_controls_over_a_feature():
    law, axes = robot_law(), Figure().add_subplot()
    law.plot("ahead", (-2.0, 2.0), ax=axes)
    assert axes.get_legend_handles_labels()[1] == ["$v$ (m/s)", r"$\omega$ (rad/s)"]
    assert np.abs([line.get_ydata() for line in axes.lines]).max() == 0.5
