"""The public names."""

import subprocess
import sys

import pytest

import gpsynth


@pytest.mark.parametrize("name", gpsynth.__all__)
def test_every_public_name_loads(name: str) -> None:
    assert getattr(gpsynth, name) is not None
    assert name in dir(gpsynth)


def test_a_name_that_is_not_there_is_named() -> None:
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        gpsynth.nothing  # noqa: B018


def test_importing_the_package_stays_light() -> None:
    heavy = "{'numba', 'sympy', 'matplotlib', 'deap', 'scipy'} & set(sys.modules)"
    code = f"import sys, gpsynth; sys.exit(bool({heavy}))"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
