"""Rows of named values as a CSV file."""

import csv
import io
import os
from collections.abc import Mapping, Sequence
from typing import Any

from gpsynth.files import write_text


def write_csv(
    path: str | os.PathLike[str], columns: Sequence[str], rows: Sequence[Mapping[str, Any]]
) -> None:
    """Write the rows below a header; raises FileError if that is not possible."""
    text = io.StringIO()
    writer = csv.DictWriter(text, columns, lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    write_text(path, text.getvalue())
