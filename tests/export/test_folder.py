import pytest

from gpsynth.errors import FileError, LawError
from gpsynth.export import write
from gpsynth.law import Law
from tests.export.helpers import robot_law
from tests.golden.renew import FILES, FOLDER, renew


@pytest.mark.parametrize("name", FILES)
def test_export_equals_the_golden_file(tmp_path, name):
    renew(tmp_path)
    assert (tmp_path / name).read_text() == (FOLDER / name).read_text()


def test_golden_law_loads():
    assert Law.load(FOLDER / "law.json") == robot_law()


def test_all_files_bear_the_name(tmp_path):
    paths = write(robot_law(), tmp_path / "new" / "folder", "drive")
    assert sorted(path.name for path in paths) == sorted(name.replace("law", "drive") for name in FILES)
    assert sorted((tmp_path / "new" / "folder").iterdir()) == sorted(paths)


def test_bad_name_writes_nothing(tmp_path):
    with pytest.raises(LawError, match="cannot name a C function"):
        write(robot_law(), tmp_path / "new", "../law")
    assert not (tmp_path / "new").exists()


def test_folder_that_is_a_file_is_refused(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(FileError, match="cannot be made"):
        write(robot_law(), tmp_path / "file")
