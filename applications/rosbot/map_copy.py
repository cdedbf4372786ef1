"""The map of a scenario beside a copy of it, so that the copy can be read."""

import json
from pathlib import Path

from applications.rosbot.map_yaml import read_settings
from gpsynth.errors import FileError
from gpsynth.files import make_folder, write_bytes


def copy_map(scenario_file: Path, folder: Path) -> None:
    """Copy the YAML file and the image of a scenario or fleet that has been read, but those named by a whole path.

    Raises FileError if that is not possible.
    """
    document = json.loads(_content(scenario_file))
    for part in filter(None, (each.get("map") for each in (document, *document.get("robots", ())))):
        described = Path(part["file"])
        image = described.parent / read_settings(scenario_file.parent / described).image
        for name in (described, image):
            if not name.is_absolute():
                make_folder((folder / name).parent)
                write_bytes(folder / name, _content(scenario_file.parent / name))


def _content(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as error:
        raise FileError(f"{path} cannot be read: {error.strerror}") from None
