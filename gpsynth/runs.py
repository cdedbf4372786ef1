"""A search that survives what ends it: checkpoints while it runs, going on from one, Ctrl-C keeps what was found."""

import os
import time
from collections.abc import Callable, Mapping
from importlib.metadata import version
from pathlib import Path
from typing import Any, NamedTuple

from gpsynth.checkpoint import Checkpoint, fingerprint
from gpsynth.checks import check_kind
from gpsynth.errors import FileError
from gpsynth.optimizers import Progress, Search, minimize

FILE = "checkpoint.json"
EVERY = 2.0  # s between two checkpoints at least, so that writing them does not count
INTERRUPTED = "interrupted"
Callback = Callable[[Progress[Any]], bool | None]


class Outcome(NamedTuple):
    """Where a search has come, and why it ended."""

    progress: Any  # with state, evaluations and history
    reason: str


def run_search(
    cost: Callable[[Any], Any],
    search: Search[Any, Any, Any],
    checkpoint: Checkpoint | None = None,
    *,
    run: Callable[..., Any] = minimize,
    resume: bool = False,
    seed: int,
    budget: int,
    path: tuple[int, ...],
    progress: bool = False,
    callback: Callback | None = None,
) -> Outcome:
    """`minimize`, or a `run` like it, with a checkpoint in a file every few seconds and at the end.

    With `resume` it goes on from that file, and finds bit for bit what a run without interruption finds. Ctrl-C ends
    the search after its first generation and raises KeyboardInterrupt before. Raises FileError if the checkpoint cannot
    be read, is of another run, or would be overwritten.
    """
    if resume and checkpoint is None:
        raise FileError("there is no folder to resume from; name it, folder=...")
    if checkpoint is not None and checkpoint.path.exists() and not resume:
        raise FileError(
            f"{checkpoint.path} is of an earlier run: go on with resume=True, or name another folder"
        )
    latest: list[Any] = [checkpoint.read()] if checkpoint is not None and resume else []
    written = time.monotonic()

    def keep(now: Any) -> None:
        nonlocal written
        latest[:] = [now]
        if checkpoint is not None and time.monotonic() - written > EVERY:
            checkpoint.write(now)
            written = time.monotonic()

    try:
        found = run(
            cost,
            search,
            seed=seed,
            budget=budget,
            path=path,
            progress=progress,
            callback=callback,
            checkpoint=keep,
            resume=latest[0] if latest else None,
        )
        outcome = Outcome(found.progress, found.reason)
    except KeyboardInterrupt:
        if not latest:
            raise
        outcome = Outcome(latest[0], INTERRUPTED)
    if checkpoint is not None:
        checkpoint.write(outcome.progress)
    return outcome


def checkpoint_in(
    folder: str | os.PathLike[str] | None, parts: Mapping[str, Any], seed: int
) -> Checkpoint | None:
    """The checkpoint of a run folder, if there is one, for a run that has all `parts`, the seed and the release."""
    if folder is None:
        return None
    check_kind("folder", folder, str, os.PathLike)
    hashes = {name: fingerprint(part) for name, part in parts.items()}
    return Checkpoint(Path(folder) / FILE, {**hashes, "seed": str(seed), "release": version("gpsynth")})
