"""Loops over the rows of the table, for the tests of the elementary functions: numba, the interpreter and C."""

import ctypes
import shutil
import subprocess
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numba
import numpy as np

from gpsynth.export.elementary_c import HEADERS, c_name, functions
from gpsynth.kernels.carried import on_vectors
from gpsynth.kernels.compile import widest_vectors
from gpsynth.kernels.elementary import evaluate, function_of
from gpsynth.kernels.vectors import WIDTH, put, take
from gpsynth.operations import OPERATIONS, operation

NAMES = tuple(row.name for row in OPERATIONS)
COMPILER = shutil.which("cc") or shutil.which("gcc")
FLAGS = (
    *(
        "-std=c99",
        "-Wall",
        "-Wextra",
        "-Werror",
        "-pedantic",
        "-Wconversion",
        "-Wdouble-promotion",
        "-Wshadow",
    ),
    *("-Wmissing-prototypes", "-ffp-contract=off", "-nostdlib", "-Wl,-z,defs"),
)


@cache
def numba_loop(name: str) -> Any:
    """A jitted loop over the lanes of the operands; its last argument receives the values."""
    scalar = function_of(name)

    def unary(a, out):
        for lane in range(out.size):
            out[lane] = scalar(a[lane])

    def binary(a, b, out):
        for lane in range(out.size):
            out[lane] = scalar(a[lane], b[lane])

    def ternary(a, b, c, out):
        for lane in range(out.size):
            out[lane] = scalar(a[lane], b[lane], c[lane])

    arity = operation(name).arity
    signature = numba.void(*[numba.float64[::1]] * (arity + 1))
    return numba.njit(signature, error_model="numpy", nogil=True)((unary, binary, ternary)[arity - 1])


@cache
def vector_loop(name: str) -> Any:
    """A jitted loop over vectors of lanes: row `arity` of its first argument receives the values."""
    carried, arity = on_vectors(function_of(name)), operation(name).arity

    def unary(w, lanes):
        widest_vectors()
        for at in range(0, lanes, WIDTH):
            put(w, 1, at, carried(take(w, 0, at)))

    def binary(w, lanes):
        widest_vectors()
        for at in range(0, lanes, WIDTH):
            put(w, 2, at, carried(take(w, 0, at), take(w, 1, at)))

    def ternary(w, lanes):
        widest_vectors()
        for at in range(0, lanes, WIDTH):
            put(w, 3, at, carried(take(w, 0, at), take(w, 1, at), take(w, 2, at)))

    signature = numba.void(numba.float64[:, ::1], numba.int64)
    return numba.njit(signature, error_model="numpy", nogil=True)((unary, binary, ternary)[arity - 1])


def by_numba(name: str, operands: list[np.ndarray]) -> np.ndarray:
    out = np.empty_like(operands[0])
    numba_loop(name)(*operands, out)
    return out


def by_interpreter(name: str, operands: list[np.ndarray]) -> np.ndarray:
    return np.array([evaluate(name, *row) for row in zip(*operands, strict=True)])


def c_library(folder: Path, *optimization: str) -> Callable[[str, list[np.ndarray]], np.ndarray]:
    """All rows compiled as C, each with a loop over lanes."""
    source = folder / "rows.c"
    source.write_text(HEADERS + functions(NAMES) + "".join(map(_c_loop, NAMES)))
    library = folder / f"rows{''.join(optimization)}.so"
    command = [
        str(COMPILER),
        *FLAGS,
        *optimization,
        "-shared",
        "-fPIC",
        str(source),
        "-lc",
        "-o",
        str(library),
    ]
    subprocess.run(command, check=True)
    loaded = ctypes.CDLL(str(library))

    def by_c(name: str, operands: list[np.ndarray]) -> np.ndarray:
        out = np.empty_like(operands[0])
        pointers = [ctypes.c_void_p(array.ctypes.data) for array in (*operands, out)]
        loaded[f"loop_{name}"](ctypes.c_long(out.size), *pointers)
        return out

    return by_c


def _c_loop(name: str) -> str:
    letters = "abc"[: operation(name).arity]
    head = f"void loop_{name}(long lanes, {''.join(f'const double *{x}, ' for x in letters)}double *out)"
    call = f"{c_name(name)}({', '.join(f'{x}[lane]' for x in letters)})"
    return f"\n{head};\n{head}\n{{\n    for (long lane = 0; lane < lanes; lane++) out[lane] = {call};\n}}\n"


def bits(values: np.ndarray) -> np.ndarray:
    """The bits of the values, those of every NaN alike."""
    return np.where(np.isnan(values), np.nan, values).view(np.int64)
