import contextlib
import errno
import json
import os
from pathlib import Path

import numpy as np
import pytest

from gpsynth.errors import FileError
from gpsynth.files import make_folder, parse_json, read_json, write_json, write_text

DOCUMENT = {"a": [1, 2.5, "text", None, True], "b": {"c": 9007199254740991}}


def test_document_comes_back(tmp_path):
    write_json(tmp_path / "file.json", DOCUMENT)
    assert read_json(tmp_path / "file.json") == DOCUMENT


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        ('{"a": 1, "a": 2}', "the key 'a' stands twice"),
        ('{"a": {"b": 1, "b": 1}}', "the key 'b' stands twice"),
        ("[NaN]", "NaN is not a JSON number"),
        ("[-Infinity]", "-Infinity is not a JSON number"),
        ("[1e400]", "1e400 is too large for a double"),
        ("[-1e999]", "too large for a double"),
        ("[9007199254740992]", r"not below 2\*\*53"),
        ("[-9007199254740992]", r"not below 2\*\*53"),
        ("1" * 5000, r"not below 2\*\*53"),
        ("[" * 33 + "]" * 33, "more than 32 levels"),
        ("[" * 400_000, "more than 32 levels|not JSON"),
        ("[1,]", "not JSON.*line 1, column"),
        ("", "not JSON"),
        ("{} {}", "not JSON"),
        ("\ufeff{}", "not JSON"),
        (b'{"a": "\xff"}', "not UTF-8"),
        ('["\\ud800"]', "half of a surrogate pair"),
        ('{"\\udfff": 1}', "half of a surrogate pair"),
    ],
)
def test_what_is_not_strict_json_is_refused_with_one_sentence(content, reason):
    with pytest.raises(FileError, match=rf"^the text .*(?:{reason})") as caught:
        parse_json(content)
    assert "\n" not in str(caught.value)


def test_depth_of_32_is_allowed():
    assert parse_json("[" * 32 + "1" + "]" * 32) is not None


def test_no_content_raises_anything_but_file_error():
    rng = np.random.default_rng(8)
    good = b'{"a": [1, -2.5e-3, "text \\u00e9\\n", null, true], "b": {"c": 9007199254740991, "": []}}'
    parts = [bytes([code]) for code in range(256)] + [
        b"\\ud800",
        b"1e999",
        b"NaN",
        b"[[[[",
        b"1" * 400,
        b'"a":',
    ]
    for _ in range(3000):
        content = good
        for _ in range(rng.integers(1, 4)):
            start, end = sorted(rng.integers(len(content) + 1, size=2))
            content = content[:start] + parts[rng.integers(len(parts))] + content[min(end, start + 3) :]
        with contextlib.suppress(FileError):
            parse_json(content)


def test_missing_file_is_named(tmp_path):
    with pytest.raises(FileError, match=r"nothing\.json does not exist"):
        read_json(tmp_path / "nothing.json")


def test_a_number_is_no_path(tmp_path):
    for function in (read_json, make_folder, lambda path: write_text(path, "")):
        with pytest.raises(FileError, match="a path must be text or a Path, got 3"):
            function(3)


def test_folder_is_not_a_file(tmp_path):
    with pytest.raises(FileError, match="cannot be read"):
        read_json(tmp_path)


def test_large_file_is_refused_before_it_is_parsed(tmp_path):
    (tmp_path / "large.json").write_text(" " * 101)
    with pytest.raises(FileError, match="larger than the 100 bytes"):
        read_json(tmp_path / "large.json", most_bytes=100)


@pytest.mark.skipif(not Path("/dev/zero").exists(), reason="there is no /dev/zero")
def test_endless_file_is_refused():
    with pytest.raises(FileError, match="not a regular file"):
        read_json("/dev/zero")


@pytest.mark.parametrize("value", [float("nan"), float("inf"), object()])
def test_what_json_cannot_say_is_not_written(tmp_path, value):
    with pytest.raises(FileError, match="cannot be written as JSON"):
        write_json(tmp_path / "file.json", [value])
    assert list(tmp_path.iterdir()) == []


def test_failed_write_keeps_the_old_file_and_leaves_nothing(tmp_path, monkeypatch):
    write_text(tmp_path / "file.txt", "old")

    def full(descriptor):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(FileError, match=r"file\.txt cannot be written: No space left on device"):
        write_text(tmp_path / "file.txt", "new")
    assert [path.name for path in tmp_path.iterdir()] == ["file.txt"]
    assert (tmp_path / "file.txt").read_text() == "old"


def test_open_reader_keeps_the_old_content(tmp_path):
    write_text(tmp_path / "file.txt", "old")
    with (tmp_path / "file.txt").open() as reader:
        write_text(tmp_path / "file.txt", "new")
        assert reader.read() == "old"
    assert (tmp_path / "file.txt").read_text() == "new"


def test_interrupted_write_leaves_nothing(tmp_path, monkeypatch):
    def interrupted(descriptor):
        raise KeyboardInterrupt

    monkeypatch.setattr(os, "fsync", interrupted)
    with pytest.raises(KeyboardInterrupt):
        write_text(tmp_path / "file.txt", "new")
    assert list(tmp_path.iterdir()) == []


def test_write_into_a_missing_folder_is_refused(tmp_path):
    with pytest.raises(FileError, match="cannot be written: No such file or directory"):
        write_text(tmp_path / "missing" / "file.txt", "text")


def test_line_ends_and_characters_are_kept(tmp_path):
    write_text(tmp_path / "file.txt", "a\nθ\r\n")
    assert (tmp_path / "file.txt").read_bytes() == "a\nθ\r\n".encode()


def test_folder_is_made_with_its_parents(tmp_path):
    assert make_folder(tmp_path / "a" / "b").is_dir()
    (tmp_path / "file").write_text("")
    with pytest.raises(FileError, match="cannot be made"):
        make_folder(tmp_path / "file" / "b")


def test_json_is_read_as_the_standard_library_reads_it():
    text = json.dumps(DOCUMENT)
    assert parse_json(text) == json.loads(text)
