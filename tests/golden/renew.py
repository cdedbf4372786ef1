"""The golden files of the exporters; `python -m tests.golden.renew` writes them anew, to be read before a commit."""

from pathlib import Path

from gpsynth.export import write
from tests.export.helpers import robot_law

FOLDER = Path(__file__).parent
FILES = ("law.json", "law.txt", "law.tex", "law.c", "law.h", "law.py")


def renew(folder: Path) -> None:
    """Write the exports of the fixed law into `folder`."""
    for path in write(robot_law(), folder):
        print(path.name)


if __name__ == "__main__":
    renew(FOLDER)
