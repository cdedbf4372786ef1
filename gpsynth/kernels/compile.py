"""How a kernel is compiled: eagerly, typed, strict, releasing the GIL, and cached under a hash of the kernel sources.

numba's own staleness check looks at one file only, so an edited function in another file would keep the old machine
code; a cache folder named by the hash of all kernel sources cannot go stale.
"""

import hashlib
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TypeVar, cast

import numba
from numba import types
from numba.extending import intrinsic, overload, register_jitable

Function = TypeVar("Function", bound=Callable[..., Any])

INTEGERS = types.Array(types.int32, 1, "C", readonly=True)
CODE = types.Array(types.int32, 2, "C", readonly=True)
VECTOR = types.Array(types.float64, 1, "C", readonly=True)
MATRIX = types.Array(types.float64, 2, "C", readonly=True)
TENSOR = types.Array(types.float64, 3, "C", readonly=True)
OUT_VECTOR = types.Array(types.float64, 1, "C")
OUT_INTEGERS = types.Array(types.int32, 1, "C")
OUT_CODE = types.Array(types.int32, 2, "C")
OUT_MATRIX = types.Array(types.float64, 2, "C")
OUT_TENSOR = types.Array(types.float64, 3, "C")


def kernel(signature: Any) -> Callable[[Function], Function]:
    """Compile for exactly this signature: IEEE arithmetic, no fastmath, no parallel reductions, no exceptions."""

    def compiled(function: Function) -> Function:
        with _cache_folder() as usable:
            settings = numba.njit(signature, nogil=True, error_model="numpy", cache=usable)
            machine_code: Function = settings(function)
        return machine_code

    return compiled


def part(function: Function) -> Function:
    """A part of kernels, compiled together with each of them."""
    return register_jitable(error_model="numpy", forceinline=True)(function)


def widest_vectors() -> None:
    """Called at the top of a kernel: let LLVM use vectors of 512 bits there, where by default it stops at 256.

    It changes no bit of any result; machines without such vectors ignore it, and so does the interpreter.
    """


def _prefer_512_bits(typing_context: Any) -> Any:
    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        set.add(
            builder.function.attributes, '"prefer-vector-width"="512"'
        )  # llvmlite's own add knows other names only
        return context.get_dummy_value()

    return types.void(), generate


_prefer = cast(Callable[[], None], intrinsic(_prefer_512_bits))


@overload(widest_vectors, inline="always")
def _widest_vectors() -> Callable[[], None]:
    def call() -> None:
        _prefer()

    return call


def cache_folder() -> Path:
    """The folder of this version of the kernels; GPSYNTH_CACHE moves it away from the user's cache folder."""
    digest = hashlib.sha256(numba.__version__.encode())
    for source in sorted(Path(__file__).parent.glob("*.py")):
        digest.update(source.read_bytes())
    root = os.environ.get("GPSYNTH_CACHE") or os.environ.get("XDG_CACHE_HOME") or "~/.cache"
    return Path(root).expanduser() / "gpsynth" / digest.hexdigest()[:16]


@contextmanager
def _cache_folder() -> Iterator[bool]:
    """numba's cache pointed at `cache_folder` while a kernel is declared; says whether it can be used.

    Cache files are pickles, so the folder must be the user's own: it is made with mode 0700, and another owner's
    folder is not trusted.
    """
    config: Any = numba.config
    folder, before = cache_folder(), config.CACHE_DIR
    try:
        folder.mkdir(parents=True, exist_ok=True, mode=0o700)
        usable = os.access(folder, os.W_OK) and (os.name != "posix" or folder.stat().st_uid == os.getuid())
    except OSError:
        usable = False
    config.CACHE_DIR = str(folder) if usable else before
    try:
        yield usable
    finally:
        config.CACHE_DIR = before
