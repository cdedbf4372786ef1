"""What every encoding asks of its settings; a wrong one is named in one sentence."""

import re

from gpsynth.checks import check_whole
from gpsynth.errors import EncodingError
from gpsynth.operations import CODES
from gpsynth.program import NAME

_PARAMETER = re.compile(r"q\d+\Z")


def checked_names(inputs: tuple[str, ...], outputs: tuple[str, ...]) -> None:
    """Raises EncodingError unless there are inputs and outputs, all with names a program can have."""
    for kind, names in (("inputs", inputs), ("outputs", outputs)):
        if not isinstance(names, tuple | list) or len(names) == 0:
            raise EncodingError(f"{kind} must be one name or more in a tuple, not {names!r}")
        for name in names:
            if not isinstance(name, str) or not NAME.match(name):
                raise EncodingError(
                    f"{name!r} in {kind} is not a name: a letter or _, then letters, digits and _"
                )
        if len(set(names)) < len(names):
            raise EncodingError(f"{kind} need different names, got {', '.join(names)}")
    for name in inputs:
        if _PARAMETER.match(name):
            raise EncodingError(f"input {name!r} is called like a parameter; q0, q1, ... are taken")


def checked_operations(operations: tuple[str, ...]) -> None:
    """Raises EncodingError unless these are different rows of the table of operations, at least one."""
    if not isinstance(operations, tuple | list) or len(operations) == 0:
        raise EncodingError(f"operations must be one name or more in a tuple, not {operations!r}")
    for name in operations:
        if not isinstance(name, str) or name not in CODES:
            raise EncodingError(f"there is no operation {name!r}; the table has {', '.join(CODES)}")
    if len(set(operations)) < len(operations):
        raise EncodingError(f"each operation may be named once, got {', '.join(operations)}")


def checked_at_least(name: str, value: int, least: int) -> None:
    """Raises EncodingError unless value is an integer >= least."""
    check_whole(name, value, least, EncodingError)
