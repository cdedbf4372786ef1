"""Times on one core, and the machine they were measured on."""

import os
import platform
import statistics
import subprocess
import time
from collections.abc import Callable
from importlib import metadata
from pathlib import Path
from typing import TypeVar

Result = TypeVar("Result")

REPEATS = 5
PACKAGES = ("numpy", "numba", "llvmlite", "deap")


def pin() -> None:
    """Keep this process, and whatever it starts, on one core where the system can do that."""
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})


def median_time(work: Callable[[], Result]) -> tuple[float, Result]:
    """Median processor time (s) of REPEATS runs after a first one, and the result."""
    result = work()
    times = []
    for _ in range(REPEATS):
        begin = time.process_time()
        result = work()
        times.append(time.process_time() - begin)
    return statistics.median(times), result


def machine() -> str:
    """Processor, compiler and versions, one line each."""
    packages = ", ".join(f"{name} {metadata.version(name)}" for name in PACKAGES)
    compiler = subprocess.run(["g++", "--version"], capture_output=True, text=True, check=True).stdout
    return f"{_processor()}\n{compiler.splitlines()[0]}\nPython {platform.python_version()}, {packages}"


def _processor() -> str:
    information = Path("/proc/cpuinfo")
    lines = information.read_text().splitlines() if information.exists() else []
    names = [line.partition(":")[2].strip() for line in lines if line.startswith(("model name", "model\t"))]
    widest = "AVX-512" if any("avx512f" in line for line in lines) else "no AVX-512"
    return f"{', model '.join(dict.fromkeys(reversed(names)))}, {widest}" if names else platform.processor()
