"""A row of the table on vectors of lanes becomes vector instructions, without a call into a mathematical library."""

import re

import llvmlite.binding
import pytest

from tests.kernels.elementary_loops import NAMES, vector_loop

COPIES = ("identity",)  # only copies


@pytest.mark.parametrize("name", [name for name in NAMES if name not in COPIES])
def test_vectors_of_lanes_stay_vectors(name):
    if not llvmlite.binding.get_host_cpu_features().get("avx2"):
        pytest.skip("this CPU has no AVX2")
    (assembly,) = vector_loop(name).inspect_asm().values()
    loop = assembly.split("cpython")[0]  # what follows is the wrapper that Python calls
    arithmetic = r"v(mul|div|add|sub|sqrt|min|max|cmp|and|or|xor|blend)\w*"
    assert re.search(rf"{arithmetic}p[ds]\s.*%[yz]mm", loop)
    assert not re.search(rf"{arithmetic}s[ds]\s", loop)  # no lane is computed on its own
    assert "call" not in loop
