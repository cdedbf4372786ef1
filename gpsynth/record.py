"""Run folders: what was run, with which versions, and how it went, one line of JSON at a time."""

import json
import math
import os
import platform
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path
from typing import Any

from gpsynth.errors import FileError
from gpsynth.files import make_folder, parse_json, write_json, write_text

FORMAT = "gpsynth-run/1"
DESCRIPTION, PROGRESS = "run.json", "progress.jsonl"
PACKAGES = ("numpy", "numba")  # whose versions can change the bits of a result


@dataclass(frozen=True)
class Run:
    """A folder that one run writes into."""

    folder: Path
    began: float = field(default_factory=time.monotonic)

    @property
    def elapsed(self) -> float:
        """The time (s) since the run began, or this command went on with it."""
        return time.monotonic() - self.began

    def log(
        self,
        stage: str,
        *,
        generation: int,
        evaluations: int,
        best_cost: float,
        elapsed: float | None = None,
    ) -> None:
        """Append a line to the progress log; it is on its way to the disk when this returns.

        `elapsed` (s) is when that was so, by default now. A cost that is not finite is logged as null. Raises FileError
        if the log cannot be written.
        """
        entry = {
            "stage": stage,
            "generation": generation,
            "evaluations": evaluations,
            "best_cost": best_cost if math.isfinite(best_cost) else None,
            "elapsed": round(self.elapsed if elapsed is None else elapsed, 3),  # s
        }
        path = self.folder / PROGRESS
        try:
            with path.open("a", encoding="utf-8") as file:
                file.write(json.dumps(entry) + "\n")
        except OSError as error:
            raise FileError(f"{path} cannot be written: {error.strerror}") from None

    def rewind(self, stage: str, generation: int = 1) -> None:
        """Drop what the log says of a stage from this generation on: a run that was killed logged more than it kept."""
        entries = [
            entry
            for entry in read_progress(self.folder)
            if entry["stage"] != stage or entry["generation"] < generation
        ]
        write_text(self.folder / PROGRESS, "".join(json.dumps(entry) + "\n" for entry in entries))


def begin(folder: str | os.PathLike[str], command: Sequence[str], *, seed: int, release: str) -> Run:
    """A run of gpsynth `release` in `folder`, made if need be, with its description and an empty progress log.

    Raises FileError if the folder cannot be written to.
    """
    run = Run(make_folder(folder))
    started = datetime.now(UTC).isoformat(timespec="seconds")
    description = {"format": FORMAT, "command": list(command), "seed": seed, "started": started}
    write_json(run.folder / DESCRIPTION, {**description, "versions": versions(release)})
    write_text(run.folder / PROGRESS, "")
    return run


def versions(release: str) -> dict[str, str]:
    """What produces results here: this `release` of gpsynth, the packages under it, Python and the machine."""
    return {
        "gpsynth": release,
        **{package: version(package) for package in PACKAGES},
        "python": platform.python_version(),
        "machine": f"{platform.system()} {platform.machine()}",
    }


def read_progress(folder: str | os.PathLike[str]) -> list[Mapping[str, Any]]:
    """The entries of a run's progress log; a last line that a killed run left unfinished is left out.

    Raises FileError if the log is missing or damaged.
    """
    path = Path(folder) / PROGRESS
    try:
        lines = path.read_text(encoding="utf-8").split("\n")
    except FileNotFoundError:
        raise FileError(f"{path} does not exist") from None
    except (OSError, UnicodeDecodeError) as error:
        raise FileError(f"{path} cannot be read: {error}") from None
    return [parse_json(line, f"{path}, line {number}") for number, line in enumerate(lines[:-1], start=1)]
