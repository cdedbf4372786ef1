"""The command line that all examples share."""

import pytest

from examples.command import Finding, command
from gpsynth.command_line import run


def test_a_folder_that_cannot_be_made_is_said_before_the_search(tmp_path, capsys) -> None:
    (tmp_path / "file").touch()

    def found(*_: int) -> Finding:
        pytest.fail("the search began")

    main = command(found, budget=1, tuning=0, reference="")
    assert run(main, [str(tmp_path / "file")], name="example") == 2
    assert "file cannot be made" in capsys.readouterr().err
