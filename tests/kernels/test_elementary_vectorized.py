"""The loop over lanes of every row becomes vector instructions, without a call into a mathematical library."""

import re

import llvmlite.binding
import numpy as np
import pytest

from tests.kernels.elementary_loops import NAMES, numba_loop

COPIES = ("identity",)  # only copies


@pytest.mark.parametrize("name", [name for name in NAMES if name not in COPIES])
def test_loop_is_vectorized(name):
    if not llvmlite.binding.get_host_cpu_features().get("avx2"):
        pytest.skip("this CPU has no AVX2")
    (assembly,) = numba_loop(name).inspect_asm().values()
    loop = assembly.split("cpython")[0]  # what follows is the wrapper that Python calls
    assert re.search(r"v(mul|div|add|sub|sqrt|min|max|cmp|and|or|xor|blend)\w*p[ds]\s.*%[yz]mm", loop)
    assert "call" not in loop


def test_the_loop_reads_what_it_writes_for_no_other_lane():
    values = np.linspace(-3.0, 3.0, 64)
    in_place = values.copy()
    numba_loop("cube")(in_place, in_place)
    assert np.array_equal(in_place, values * values * values)
