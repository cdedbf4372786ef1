"""Random trees are trees, whatever functions there are to make them of."""

import numpy as np
import pytest

from gpsynth.kernels import genomes
from gpsynth.kernels.data_code import CONSTANT, OPCODE, VARIABLE
from gpsynth.kernels.layout import readonly

COUNT, LONGEST = 500, 15


@pytest.mark.parametrize(
    ("unary", "binary"), [(("sin",), ()), (("sin", "half"), ()), ((), ("sub",)), (("exp",), ("add", "div"))]
)
def test_a_grown_tree_is_one_tree_of_the_functions_there_are(
    unary: tuple[str, ...], binary: tuple[str, ...]
) -> None:
    rng = np.random.default_rng(3)
    codes = [
        readonly(np.array([OPCODE[name] for name in names], dtype=np.int32)) for names in (unary, binary)
    ]
    lengths = rng.integers(1, LONGEST + 1, COUNT).astype(np.int32) | np.int32(0 if unary else 1)
    ops, numbers = np.zeros((COUNT, LONGEST), dtype=np.int32), np.zeros((COUNT, LONGEST))
    uniforms = rng.random((COUNT, genomes.DRAWS * LONGEST))
    genomes.grow(*codes, 2, readonly(lengths), readonly(uniforms), ops, numbers)
    leaves = {CONSTANT, VARIABLE, VARIABLE - 1}
    for tree, length in zip(ops, lengths, strict=True):
        depth = 0
        for op in tree[:length].tolist():
            assert op in leaves.union(*(code.tolist() for code in codes))
            depth += 1 - genomes.arity(op)
            assert depth >= 1
        assert depth == 1
