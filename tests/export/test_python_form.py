import ast
import sys

import numpy as np
import pytest

from gpsynth.export import to_python
from tests.export.helpers import (
    law_of_numbers,
    law_of_operations,
    random_law,
    robot_law,
    rows_to_try,
    run,
    same_bits,
)

DRIVER = """
import runpy, sys
control = runpy.run_path(sys.argv[1])["control"]
for line in open(sys.argv[2]):
    row = [float.fromhex(text) for text in line.split()]
    half = len(row) // 2
    print(*(value.hex() for value in control(row[:half], row[half:])))
"""


def _computed_alone(law, rows, folder):
    """The controls by an interpreter that sees the module and the standard library only."""
    (folder / "law.py").write_text(to_python(law))
    (folder / "rows.txt").write_text(
        "\n".join(" ".join(value.hex() for value in row) for row in rows.tolist())
    )
    command = [sys.executable, "-I", "-c", DRIVER, str(folder / "law.py"), str(folder / "rows.txt")]
    lines = run(command).stdout.splitlines()
    return np.array([[float.fromhex(text) for text in line.split()] for line in lines])


LAWS = {
    "every operation": law_of_operations,
    "numbers": lambda: law_of_numbers([0.1, -0.0, 5e-324, 1e22, float("-inf"), float("nan")]),
    "robot": robot_law,
    "random 1": lambda: random_law(np.random.default_rng(1), 60),
    "random 2": lambda: random_law(np.random.default_rng(2), 60),
}


@pytest.mark.parametrize("make", LAWS.values(), ids=LAWS)
def test_module_equals_the_law_in_every_bit_and_never_raises(tmp_path, make):
    law = make()
    size = len(law.plant.state_names)
    rows = rows_to_try(4000, 2 * size, 92)
    assert same_bits(_computed_alone(law, rows, tmp_path), law(rows[:, :size], rows[:, size:]))


def test_module_imports_the_standard_library_alone():
    tree = ast.parse(to_python(law_of_operations()))
    imported = [ast.unparse(node) for node in tree.body if isinstance(node, ast.Import | ast.ImportFrom)]
    assert imported == ["import math", "import struct", "from collections.abc import Sequence"]


def test_module_takes_integers_and_arrays():
    namespace: dict = {}
    exec(to_python(robot_law()), namespace)
    state, target = [0, 0, 0], [1, 1, 0]
    assert namespace["control"](state, target) == tuple(robot_law()(state, target))
    assert namespace["control"](np.array(state), np.array(target)) == tuple(robot_law()(state, target))
