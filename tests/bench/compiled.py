"""The same closed loops with each law compiled: C++ generated from the programs, in vectors of 8, 4 or 1 lanes."""

import ctypes
import subprocess
from pathlib import Path
from typing import NamedTuple

import numpy as np

from gpsynth.arrays import Floats
from gpsynth.program import Leaf, Program
from tests.bench.setting import STEP, STEPS, Setting

FLAGS = ("-O3", "-march=native", "-std=c++17", "-shared", "-fPIC", "-Wno-psabi")
_POINTER = ctypes.POINTER(ctypes.c_double)


class Compiled(NamedTuple):
    """A shared library with one function per law."""

    library: ctypes.CDLL
    setting: Setting

    def costs(self, starts: Floats) -> Floats:
        """Costs (laws, S) from these starts (S, 3); S is a multiple of the lanes."""
        out = np.empty((len(self.setting.laws), len(starts)))
        goal = np.ascontiguousarray(self.setting.problem.goal)
        self.library.roll_all(
            starts.ctypes.data_as(_POINTER),
            goal.ctypes.data_as(_POINTER),
            len(starts),
            out.ctypes.data_as(_POINTER),
        )
        return out


def compile_setting(setting: Setting, operations: str, stem: Path, flags: tuple[str, ...]) -> Compiled:
    """Generate, compile and load; `operations` is the C++ type that computes them, as in closed_loop.hpp."""
    source = stem.with_suffix(".cpp")
    source.write_text(text(setting, operations))
    library = stem.with_suffix(".so")
    subprocess.run(
        ["g++", *FLAGS, *flags, "-I", str(Path(__file__).parent), str(source), "-o", str(library)], check=True
    )
    return Compiled(_loaded(library), setting)


def _loaded(library: Path) -> ctypes.CDLL:
    loaded = ctypes.CDLL(str(library))
    loaded.roll_all.argtypes = (_POINTER, _POINTER, ctypes.c_long, _POINTER)
    loaded.roll_all.restype = None
    return loaded


def text(setting: Setting, operations: str) -> str:
    """The C++ source: the plant's functions once, a struct and a call per law."""
    problem = setting.problem
    plant = problem.plant
    shared = {"feature": problem.features, "limit": plant.saturation, "rate": problem.rates}
    lines = ['#include "closed_loop.hpp"', f"using F = {operations};", "using V = F::V;", "struct Plant {"]
    sizes = (len(plant.state_names), len(plant.control_names), len(problem.features.outputs))
    lines.append(
        f"    static constexpr int states = {sizes[0]}, controls = {sizes[1]}, features = {sizes[2]};"
    )
    for name, program in shared.items():
        lines += function(name, program)
    lines.append("};")
    for k, law in enumerate(setting.laws):
        lines += [f"struct Law{k} : Plant {{", *function("law", law), "};"]
    lines.append(
        'extern "C" void roll_all(const double *starts, const double *goal, long count, double *costs) {'
    )
    lines += [
        f"    roll<F, Law{k}>(starts, goal, count, {STEPS}, {STEP!r}, costs + {k} * count);"
        for k in range(len(setting.laws))
    ]
    return "\n".join([*lines, "}", ""])


def function(name: str, program: Program) -> list[str]:
    """A static function of the program, one statement an instruction."""
    lines = [f"    static inline __attribute__((always_inline)) void {name}(const V *in, V *out) {{"]

    def node(operation: str, operands: tuple[str, ...]) -> str:
        variable = f"t{len(lines)}"
        lines.append(f"        const V {variable} = F::{operation}({', '.join(operands)});")
        return variable

    outputs = program.fold(_leaf, lambda row, operands: node(row.name, operands))
    lines += [f"        out[{k}] = {output};" for k, output in enumerate(outputs)]
    return [*lines, "    }"]


def _leaf(leaf: Leaf) -> str:
    return f"in[{leaf.index}]" if leaf.kind == "input" else f"F::all({leaf.value.hex()})"
