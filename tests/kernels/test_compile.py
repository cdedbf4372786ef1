"""The cache of machine code: named by the sources it came from, the user's own, and never needed."""

import os
import shutil
import stat
import subprocess
import sys
from pathlib import Path

import pytest

import gpsynth
from gpsynth.kernels import compile as compilation

PACKAGE = Path(gpsynth.__file__).parent
DECLARE = """
from numba import types
from gpsynth.kernels.compile import cache_folder, kernel

@kernel(types.float64(types.float64))
def double(x):
    return 2.0 * x

print(double(21.0), cache_folder())
"""
ASK = "from gpsynth.kernels.compile import cache_folder; print(cache_folder())"


def _run(code: str, cache: Path, folder: Path, package: Path = PACKAGE.parent) -> str:
    script = folder / "script.py"
    script.write_text(code)
    environment = {**os.environ, "GPSYNTH_CACHE": str(cache), "PYTHONPATH": str(package)}
    done = subprocess.run(
        [sys.executable, str(script)], env=environment, capture_output=True, text=True, check=True
    )
    return done.stdout


def test_a_changed_source_changes_the_folder(tmp_path: Path) -> None:
    shutil.copytree(PACKAGE, tmp_path / "gpsynth", ignore=shutil.ignore_patterns("__pycache__"))
    before = _run(ASK, tmp_path, tmp_path, tmp_path)
    assert _run(ASK, tmp_path, tmp_path, tmp_path) == before
    with (tmp_path / "gpsynth" / "kernels" / "arithmetic.py").open("a") as source:
        source.write("\n")
    assert _run(ASK, tmp_path, tmp_path, tmp_path) != before


def test_the_folder_is_closed_to_others(tmp_path: Path) -> None:
    value, folder = _run(DECLARE, tmp_path / "cache", tmp_path).split()
    assert float(value) == 42.0
    assert stat.S_IMODE(Path(folder).stat().st_mode) == 0o700
    assert Path(folder).is_relative_to(tmp_path)


def test_without_a_usable_folder_kernels_compile_all_the_same(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("not a folder")
    assert float(_run(DECLARE, tmp_path / "file", tmp_path).split()[0]) == 42.0


def test_a_folder_of_somebody_else_is_not_trusted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("GPSYNTH_CACHE", str(tmp_path))
    compilation.cache_folder().mkdir(parents=True)
    with compilation._cache_folder() as usable:
        assert usable
    monkeypatch.setattr(os, "getuid", lambda: 12345)
    with compilation._cache_folder() as usable:
        assert not usable


def test_importing_the_package_loads_nothing_heavy() -> None:
    code = (
        "import sys, gpsynth\n"
        "print([name for name in ('numba', 'sympy', 'matplotlib', 'deap') if name in sys.modules])"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=PACKAGE.parent, capture_output=True, text=True, check=True
    )
    assert done.stdout.strip() == "[]"
