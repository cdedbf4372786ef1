"""A network operator beside its evaluation in the style of the published implementation: float32, maps, dense scan."""

import ctypes
import json
import subprocess
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from gpsynth.arrays import Floats
from gpsynth.builder import bind
from gpsynth.encodings.network_operator_matrix import Matrix, decode_matrix
from gpsynth.encodings.network_operator_text import read_matrix
from gpsynth.evaluate import Evaluator
from gpsynth.program import Program
from tests.bench.measure import median_time
from tests.bench.setting import STEP, STEPS, Setting, unicycle

NOM_461 = Path(__file__).parents[3] / "shared" / "golden" / "nom_461.json"
STARTS = 128
LEAST_SHARE = 0.9  # of outputs that agree to float32's accuracy; the law has jumps
_FLAGS = ("-O3", "-march=native", "-std=c++17", "-shared", "-fPIC")


def network_rows(case: Setting) -> tuple[Program, list[tuple[str, float]]]:
    """The formula, and rollouts per second of the published style and of gpsynth, each from STARTS starts."""
    text = NOM_461.read_text()
    matrix, values = read_matrix(text), json.loads(text)["q"]
    law = bind(decode_matrix(matrix, case.problem.features.names, ("v", "omega")), values)
    starts, none = case.starts[:STARTS], np.empty((1, 0))
    with tempfile.TemporaryDirectory() as folder:
        dense = _Dense(matrix, values, Path(folder))
        _check(dense, law, case.starts)
        published, _ = median_time(lambda: dense.rollouts(starts))
    rows = [("C++ in the published style, float32, maps, dense scan", STARTS / published)]
    for block in (64, 128):
        evaluator = Evaluator(unicycle(starts), block=block)
        seconds, _ = median_time(lambda evaluator=evaluator: evaluator.of_program(law, none))
        rows.append((f"gpsynth, blocks of {block}, float64", STARTS / seconds))
    return law, rows


class _Dense:
    def __init__(self, matrix: Matrix, values: list[float], folder: Path) -> None:
        library = folder / "dense_network.so"
        source = Path(__file__).with_suffix(".cpp")
        subprocess.run(["g++", *_FLAGS, str(source), "-o", str(library)], check=True)
        self._library = ctypes.CDLL(str(library))
        nodes = np.array(matrix.inputs + matrix.parameters + matrix.outputs, dtype=np.int32)
        self._arrays = (np.ascontiguousarray(matrix.psi), nodes, np.array(values, dtype=np.float32))
        self._sizes = (len(matrix.inputs), len(matrix.parameters), len(matrix.outputs))

    def laws(self, inputs: Floats) -> Floats:
        """Outputs (N, m) of inputs (N, n)."""
        return self._call("laws", inputs, (len(inputs), self._sizes[2]))

    def rollouts(self, starts: Floats) -> Floats:
        """Costs (S,)."""
        return self._call("rollouts", starts, (len(starts),), ctypes.c_int(STEPS), ctypes.c_float(STEP))

    def _call(self, name: str, given: Floats, shape: tuple[int, ...], *more: Any) -> Floats:
        psi, nodes, values = self._arrays
        rows, out = np.ascontiguousarray(given, dtype=np.float32), np.empty(shape, dtype=np.float32)
        self._library[name](
            *(_pointer(psi), ctypes.c_int(len(psi)), _pointer(nodes), *map(ctypes.c_int, self._sizes)),
            *(_pointer(values), _pointer(rows), ctypes.c_int(len(rows)), *more, _pointer(out)),
        )
        return out.astype(np.float64)


def _pointer(array: Any) -> ctypes.c_void_p:
    return ctypes.c_void_p(array.ctypes.data)


def _check(dense: _Dense, law: Program, inputs: Floats) -> None:
    ours, theirs = law(inputs), dense.laws(inputs)
    share = float(np.mean(np.abs(ours - theirs) <= 1e-3 * np.abs(ours)))
    if share < LEAST_SHARE:
        raise SystemExit(f"{1 - share:.1%} of the outputs differ from the dense evaluation")
