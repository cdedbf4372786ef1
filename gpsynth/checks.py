"""What a public function checks of its arguments before anything else: kinds and plain numbers, one sentence each."""

from collections.abc import Iterable
from typing import Any

import numpy as np

from gpsynth.errors import GpsynthError, ProblemError


def check_kind(
    name: str, value: Any, *kinds: type[Any], error: type[GpsynthError] = ProblemError, optional: bool = False
) -> None:
    """Raises the error unless the value is of one of the kinds, or None where it is `optional`; a class is of none."""
    if (isinstance(value, kinds) and not isinstance(value, type)) or (optional and value is None):
        return
    wanted = " or ".join([_one(kind) for kind in kinds] + ["None"] * optional)
    plain = value is None or isinstance(value, str | bool | int | float | type)
    raise error(f"{name} must be {wanted}, got {repr(value) if plain else _one(type(value))}")


def check_whole(name: str, value: Any, least: int, error: type[GpsynthError] = ProblemError) -> None:
    """Raises the error unless the value is an integer of at least `least`."""
    if not isinstance(value, int | np.integer) or isinstance(value, bool) or value < least:
        raise error(f"{name} must be an integer of at least {least}, not {value!r}")


def check_number(name: str, value: Any, error: type[GpsynthError] = ProblemError) -> None:
    """Raises the error unless the value is a number; NaN and infinity are."""
    if not isinstance(value, int | float | np.integer | np.floating) or isinstance(value, bool):
        raise error(f"{name} must be a number, got {value!r}")


def check_function(
    name: str, value: Any, error: type[GpsynthError] = ProblemError, *, optional: bool = False
) -> None:
    """Raises the error unless the value can be called, or is None where it is `optional`."""
    if not callable(value) and not (optional and value is None):
        raise error(f"{name} must be a function{' or None' if optional else ''}, got {value!r}")


def check_names(name: str, value: Any, error: type[GpsynthError] = ProblemError) -> tuple[Any, ...]:
    """The items of a tuple or other row of names; raises the error if it is none, one text among others."""
    if isinstance(value, str) or not isinstance(value, Iterable):
        raise error(f"{name} must be names in a tuple, got {value!r}")
    return tuple(value)


def _one(kind: type[Any]) -> str:
    return f"{'an' if kind.__name__[0] in 'AEIO' else 'a'} {kind.__name__}"
