"""Rows of a workspace that are used again: a stack of the free ones.

`free` holds how many rows are free, how many rows there are, and then which are free.
"""

from typing import Any

from gpsynth.kernels.compile import part


@part
def take(free: Any) -> Any:
    """The row given back last, or a new one."""
    if free[0] > 0:
        free[0] -= 1
        return free[2 + free[0]]
    free[1] += 1
    return free[1] - 1


@part
def give_back(row: Any, free: Any) -> None:
    """Let the row be taken again."""
    free[2 + free[0]] = row
    free[0] += 1
