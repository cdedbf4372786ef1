"""All files of a law in one folder."""

import os
from pathlib import Path

from gpsynth.export.c import to_c
from gpsynth.export.formula import to_text
from gpsynth.export.latex import to_document
from gpsynth.export.python_form import to_python
from gpsynth.files import json_text, make_folder, write_text
from gpsynth.law import Law


def write(law: Law, folder: str | os.PathLike[str], name: str = "law") -> list[Path]:
    """Write NAME.json, .txt, .tex, .c, .h and .py into `folder`, each whole or not at all, and give their paths.

    Everything is made before the first file is written. Raises LawError if `name` cannot name a C function, and
    FileError if a file cannot be written.
    """
    source, header = to_c(law, name)
    contents = {
        f"{name}.json": json_text(law.to_dict()),
        f"{name}.txt": to_text(law, name),
        f"{name}.tex": to_document(law, name),
        f"{name}.c": source,
        f"{name}.h": header,
        f"{name}.py": to_python(law, name),
    }
    place = make_folder(folder)
    paths = [place / file for file in contents]
    for path, content in zip(paths, contents.values(), strict=True):
        write_text(path, content)
    return paths
