import re
import shutil

import numpy as np
import pytest

from gpsynth.errors import LawError
from gpsynth.export import to_c
from tests.export.helpers import (
    COMPILER,
    FLAGS,
    LEVELS,
    compiled,
    law_of_numbers,
    law_of_operations,
    needs_compiler,
    random_law,
    robot_law,
    rows_to_try,
    run,
    same_bits,
)

pytestmark = needs_compiler
N_STATES = 100_000  # ten sets of them, 1e6 in all, at each level


@pytest.mark.parametrize("seed", range(9))
def test_random_law_equals_its_c_in_every_bit_and_stays_in_its_limits(tmp_path, seed):
    law = random_law(np.random.default_rng(seed))
    rows = rows_to_try(N_STATES, 6, seed)
    expected = law(rows[:, :3], rows[:, 3:])
    assert np.all((expected >= -0.5) & (expected <= 0.5))
    for level in LEVELS:
        controls = compiled(law, tmp_path, level)(rows[:, :3], rows[:, 3:])
        assert same_bits(controls, expected), level


@pytest.mark.parametrize("level", LEVELS)
def test_every_operation_equals_its_c_in_every_bit(tmp_path, level):
    law = law_of_operations()
    rows = rows_to_try(N_STATES, 6, 90)
    expected = law(rows[:, :3], rows[:, 3:])
    controls = compiled(law, tmp_path, level)(rows[:, :3], rows[:, 3:])
    differing = [
        name
        for index, name in enumerate(law.plant.control_names)
        if not same_bits(controls[:, index].copy(), expected[:, index].copy())
    ]
    assert differing == []


def test_every_number_is_written_exactly(tmp_path):
    numbers = [
        0.1,
        -0.0,
        5e-324,
        -2.3e-308,
        1.7976931348623157e308,
        1e22,
        -1e16,
        1 / 3,
        float("inf"),
        float("nan"),
    ]
    law = law_of_numbers(numbers)
    rows = rows_to_try(1000, 6, 91)
    assert same_bits(compiled(law, tmp_path, "-O0")(rows[:, :3], rows[:, 3:]), law(rows[:, :3], rows[:, 3:]))


def _write(law, folder, name="law"):
    source, header = to_c(law, name)
    (folder / f"{name}.c").write_text(source)
    (folder / f"{name}.h").write_text(header)
    return folder / f"{name}.c"


def test_self_test_passes_and_says_so(tmp_path):
    source = _write(robot_law(), tmp_path, "drive")
    run([COMPILER, *FLAGS, "-O2", "-DDRIVE_SELF_TEST", str(source), "-o", str(tmp_path / "test")])
    assert run([str(tmp_path / "test")]).stdout == "ok: 32 rows\n"


def test_self_test_fails_on_a_wrong_bit(tmp_path):
    source = _write(robot_law(), tmp_path)
    text = source.read_text()
    source.write_text(text.replace("* 3.1;", "* 3.1000000000000005;"))
    assert source.read_text() != text
    run([COMPILER, *FLAGS, "-DLAW_SELF_TEST", str(source), "-o", str(tmp_path / "test")])
    with pytest.raises(AssertionError, match=r"row \d+: control\[0\] is"):
        run([str(tmp_path / "test")])


def test_self_test_takes_the_vectors_it_is_given(tmp_path):
    states, targets = np.zeros((3, 3)), np.ones((3, 3))
    source, _ = to_c(robot_law(), vectors=(states, targets))
    assert "static const double rows[3][8]" in source


@pytest.mark.parametrize(
    "vectors", [3, (np.zeros((3, 3)),), (np.zeros(3), np.zeros(3)), (np.zeros((0, 3)), np.zeros((0, 3)))]
)
def test_vectors_of_another_shape_are_an_error(vectors):
    with pytest.raises(LawError, match=r"vectors are states and targets, \(V, n\) each, with V at least 1"):
        to_c(robot_law(), vectors=vectors)


@pytest.mark.parametrize("options", ["-ffast-math", "-Ofast", "-mfpmath=387"])
def test_compiling_without_ieee_arithmetic_is_refused(tmp_path, options):
    source = _write(robot_law(), tmp_path)
    with pytest.raises(AssertionError, match=r"#error|fpmath"):
        run([COMPILER, "-std=c99", options, "-c", str(source), "-o", str(tmp_path / "law.o")])


def test_object_needs_nothing_but_memcpy(tmp_path):
    if shutil.which("nm") is None:
        pytest.skip("there is no nm to list symbols with")
    source = _write(law_of_operations(), tmp_path)
    run([COMPILER, *FLAGS, "-O0", "-c", str(source), "-o", str(tmp_path / "law.o")])
    needed = run(["nm", "-u", str(tmp_path / "law.o")]).stdout.split()
    assert set(needed) <= {"U", "memcpy", "_GLOBAL_OFFSET_TABLE_"}
    assert "math.h" not in source.read_text()


def test_object_has_no_writable_data(tmp_path):
    if shutil.which("nm") is None:
        pytest.skip("there is no nm to list symbols with")
    source = _write(law_of_operations(), tmp_path)
    run([COMPILER, *FLAGS, "-c", str(source), "-o", str(tmp_path / "law.o")])
    kinds = {line.split()[-2] for line in run(["nm", str(tmp_path / "law.o")]).stdout.splitlines()}
    assert kinds.isdisjoint(set("bBdDC"))


def test_header_compiles_as_cplusplus(tmp_path):
    _write(robot_law(), tmp_path)
    (tmp_path / "use.cpp").write_text('#include "law.h"\nint main() { return 0; }\n')
    compiler = shutil.which("c++") or shutil.which("g++")
    if compiler is None:
        pytest.skip("there is no C++ compiler")
    run([compiler, "-Wall", "-Werror", "-c", str(tmp_path / "use.cpp"), "-o", str(tmp_path / "use.o")])


def test_source_says_what_it_is():
    law = robot_law()
    source, header = to_c(law)
    for text in (source, header):
        assert f"sha256 {law.hash}" in text
        assert "state[2], target[2]: theta in rad" in text
        assert "control[1]: omega in rad/s, from -0.5 to 0.5" in text
    assert "-ffp-contract=off" in source
    assert re.search(r"const double r\d+ = gp_tanh\(r\d+\);", source)


@pytest.mark.parametrize(
    "name",
    [
        "int",
        "main",
        "_law",
        "law-1",
        "gp_add",
        "r12",
        "1law",
        "",
        "law\n",
        "a" * 32,
        "law(void){}//",
        "memcpy",
        "é",
    ],
)
def test_name_that_c_cannot_have_is_refused(name):
    with pytest.raises(LawError, match="cannot name a C function"):
        to_c(robot_law(), name)
