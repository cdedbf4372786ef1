"""What a synthesis from the command line leaves in its run folder: log, best law so far, exports and front."""

import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gpsynth import __version__
from gpsynth.errors import FileError
from gpsynth.files import write_json

if TYPE_CHECKING:
    from gpsynth.law import Law
    from gpsynth.optimizers import Progress
    from gpsynth.problem import Problem
    from gpsynth.record import Run
    from gpsynth.structure_search import SearchState
    from gpsynth.synthesis import FrontEntry, SynthesisResult

FRONT_FORMAT = "gpsynth-front/1"


def begin(folder: Path, seed: int, *, resume: bool = False) -> "Run":
    """A run of this command line in a folder, or with `resume` the one that is there.

    Raises FileError if the folder cannot be written to, or a new run would overwrite the checkpoint of an earlier one.
    """
    from gpsynth import record
    from gpsynth.runs import FILE

    if resume:
        return record.Run(folder)
    if (folder / FILE).exists():
        raise FileError(f"{folder} holds the checkpoint of an earlier run: resume it, or name another folder")
    return record.begin(folder, sys.argv, seed=seed, release=__version__)


def export_law(law: "Law", folder: Path, *, name: str = "law", formats: Sequence[str] = ()) -> list[Path]:
    """Write a law into `folder` in all formats, or in those given."""
    from gpsynth import export as exports
    from gpsynth.files import json_text, make_folder, write_text

    if not formats:
        return exports.write(law, folder, name)
    source, header = exports.to_c(law, name)  # also the check of the name
    contents = {
        "json": {".json": json_text(law.to_dict())},
        "text": {".txt": exports.to_text(law, name)},
        "latex": {".tex": exports.to_document(law, name)},
        "c": {".c": source, ".h": header},
        "python": {".py": exports.to_python(law, name)},
    }
    place = make_folder(folder)
    texts = {
        place / f"{name}{end}": text for key in dict.fromkeys(formats) for end, text in contents[key].items()
    }
    for path, text in texts.items():
        write_text(path, text)
    return list(texts)


def recorder(folder: "Run", problem: "Problem") -> Callable[["Progress[SearchState[Any]]"], None]:
    """A callback of `synthesize` that logs each generation and keeps the best law so far in law.json."""
    from gpsynth.law import Law

    begun = False

    def record(progress: "Progress[SearchState[Any]]") -> None:
        nonlocal begun
        if not begun:
            folder.rewind("synthesis", progress.generation)
            begun = True
        evaluations, cost = progress.history[-1] if progress.history else (0, float("inf"))
        folder.log(
            "synthesis", generation=progress.generation, evaluations=progress.evaluations, best_cost=cost
        )
        if evaluations == progress.evaluations:
            best = progress.state.front[-1]
            Law(problem.plant, problem.features, best.program, best.values).save(folder.folder / "law.json")

    return record


def write_result(result: "SynthesisResult", folder: "Run") -> None:
    """Write the best law in every form and the front; raises LawError if nothing was found.

    Raises KeyboardInterrupt when that is done, if Ctrl-C has ended the search.
    """
    from gpsynth.runs import INTERRUPTED as CUT_SHORT

    export_law(result.law, folder.folder)
    front = [_described(entry) for entry in result.front]
    write_json(folder.folder / "front.json", {"format": FRONT_FORMAT, "laws": front})
    if result.reason == CUT_SHORT:
        raise KeyboardInterrupt


def _described(entry: "FrontEntry") -> dict[str, Any]:
    return {
        "complexity": entry.complexity,
        "cost": entry.cost,
        "reached": entry.reached,
        "reached_at_least": entry.reached_at_least,
        "median_time": entry.median_time if entry.reached > 0.0 else None,  # s
        "worst_time": entry.worst_time if entry.reached > 0.0 else None,  # s
        "law": entry.law.to_dict(),
    }
