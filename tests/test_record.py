"""Run folders: the description, and a progress log that survives whatever ends the run."""

import json
import math

import pytest

from gpsynth.errors import FileError
from gpsynth.record import begin, read_progress, versions


def _log(run, evaluations=10, best_cost=1.5):
    run.log("synthesis", generation=1, evaluations=evaluations, best_cost=best_cost)


def test_a_run_describes_itself(tmp_path):
    begin(tmp_path / "new" / "run", ["gpsynth", "synthesize"], seed=7, release="1.2.3")
    description = json.loads((tmp_path / "new" / "run" / "run.json").read_text())
    assert description["command"] == ["gpsynth", "synthesize"]
    assert description["seed"] == 7
    assert description["versions"]["gpsynth"] == "1.2.3"
    assert {"numpy", "numba", "python", "machine"} <= set(versions("1.2.3"))


def test_each_entry_is_in_the_file_as_soon_as_it_is_logged(tmp_path):
    run = begin(tmp_path, [], seed=0, release="1.2.3")
    for number in range(3):
        _log(run, evaluations=number)
        lines = (tmp_path / "progress.jsonl").read_text().splitlines()
        assert [json.loads(line)["evaluations"] for line in lines] == list(range(number + 1))


def test_entries_are_read_as_they_were_logged(tmp_path):
    _log(begin(tmp_path, [], seed=0, release="1.2.3"), evaluations=12, best_cost=0.1)
    (entry,) = read_progress(tmp_path)
    assert (entry["stage"], entry["generation"], entry["evaluations"]) == ("synthesis", 1, 12)
    assert entry["best_cost"] == 0.1
    assert entry["elapsed"] >= 0.0


@pytest.mark.parametrize("cost", [math.inf, math.nan])
def test_a_cost_that_is_no_number_is_null(tmp_path, cost):
    _log(begin(tmp_path, [], seed=0, release="1.2.3"), best_cost=cost)
    assert read_progress(tmp_path)[0]["best_cost"] is None


def test_a_line_that_a_killed_run_left_unfinished_is_left_out(tmp_path):
    run = begin(tmp_path, [], seed=0, release="1.2.3")
    _log(run)
    with (tmp_path / "progress.jsonl").open("a") as file:
        file.write('{"stage": "synth')
    assert len(read_progress(tmp_path)) == 1


def test_a_damaged_line_is_named(tmp_path):
    begin(tmp_path, [], seed=0, release="1.2.3")
    (tmp_path / "progress.jsonl").write_text("{}\nnothing\n")
    with pytest.raises(FileError, match=r"progress\.jsonl, line 2 is not JSON"):
        read_progress(tmp_path)


def test_a_new_run_in_the_same_folder_begins_a_new_log(tmp_path):
    _log(begin(tmp_path, [], seed=0, release="1.2.3"))
    begin(tmp_path, [], seed=1, release="1.2.3")
    assert read_progress(tmp_path) == []


def test_a_folder_that_cannot_be_made_is_an_error(tmp_path):
    (tmp_path / "file").touch()
    with pytest.raises(FileError, match="cannot be made"):
        begin(tmp_path / "file" / "run", [], seed=0, release="1.2.3")


def test_a_log_that_cannot_be_written_is_an_error(tmp_path):
    run = begin(tmp_path, [], seed=0, release="1.2.3")
    (tmp_path / "progress.jsonl").unlink()
    (tmp_path / "progress.jsonl").mkdir()
    with pytest.raises(FileError, match=r"progress\.jsonl cannot be written"):
        _log(run)


def test_a_log_that_is_not_there_is_an_error(tmp_path):
    with pytest.raises(FileError, match="does not exist"):
        read_progress(tmp_path)
