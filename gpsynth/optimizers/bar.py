"""The progress bar of `minimize`; it shows on terminals only."""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def bar(budget: int, shown: bool) -> Iterator[Callable[[int, float], None]]:
    """A function (evaluations, best cost) that moves the bar, or does nothing where stderr is no terminal."""
    if not (shown and sys.stderr.isatty()):
        yield lambda evaluations, cost: None
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    columns = (
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn("best {task.description}"),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=Console(stderr=True), transient=True) as progress:
        task = progress.add_task("", total=budget)
        yield lambda evaluations, cost: progress.update(
            task, completed=evaluations, description=f"{cost:.6g}"
        )
