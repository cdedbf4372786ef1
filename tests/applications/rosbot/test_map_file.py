"""Maps of map_server, written by hand here and read as its documentation says."""

import os

import numpy as np
import pytest
from PIL import Image

from applications.rosbot.map_file import read_map
from gpsynth.errors import ScenarioError

SETTINGS = {
    "image": "room.pgm",
    "resolution": "0.05",
    "origin": "[-1.5, 2, 0.0]",
    "negate": "0",
    "occupied_thresh": "0.65",
    "free_thresh": "0.196",
}


@pytest.fixture(name="folder")
def _folder(tmp_path):
    """Three shades, black, white and map_saver's unknown; the first row of an image is the last of the map."""
    (tmp_path / "room.pgm").write_bytes(b"P5\n# by hand\n3 2\n255\n" + bytes([0, 254, 205, 255, 90, 88]))
    return tmp_path


def written(folder, **changes):
    """The YAML file of a map; a change to None leaves a field out."""
    fields = {name: value for name, value in (SETTINGS | changes).items() if value is not None}
    path = folder / "room.yaml"
    path.write_text("".join(f"{name}: {value}\n" for name, value in fields.items()))
    return path


def test_pixels_become_occupancy_bottom_row_first(folder):
    found = read_map(written(folder))
    assert np.array_equal(found.cells, [[0, -1, 100], [100, 0, -1]])  # 88: p = 0.6549, above 0.65; 90: below
    assert (found.resolution, found.origin) == (0.05, (-1.5, 2.0))
    assert np.array_equal(found.occupied(unknown_is_free=True), [[False, False, True], [True, False, False]])
    assert np.array_equal(found.occupied(unknown_is_free=False), [[False, True, True], [True, False, True]])


def test_negate_exchanges_black_and_white(folder):
    assert np.array_equal(read_map(written(folder, negate=1)).cells, [[100, -1, -1], [0, 100, 100]])


def test_scale_keeps_what_lies_between_the_thresholds(folder):
    cells = read_map(written(folder, mode="scale")).cells
    assert np.array_equal(
        cells, [[0, 99, 100], [100, 0, 1]]
    )  # (0.6471 - 0.196) / 0.454; never free or occupied


def test_raw_takes_the_pixel_itself(folder):
    assert np.array_equal(read_map(written(folder, mode="raw")).cells, [[-1, 90, 88], [0, -1, -1]])


def test_a_png_may_be_colored_and_transparent(folder):
    pixels = np.array(
        [[[0, 0, 0, 255], [255, 255, 255, 255], [255, 255, 255, 0], [10, 20, 0, 255]]], np.uint8
    )
    Image.fromarray(pixels).save(folder / "room.png")
    scale, trinary = (read_map(written(folder, image="room.png", mode=mode)) for mode in ("scale", "trinary"))
    assert np.array_equal(scale.cells, [[100, 0, -1, 100]])
    assert np.array_equal(
        trinary.cells, [[100, 0, -1, 100]]
    )  # alpha counts as a color: p = 0.75, 0, 0.25, 0.72


def test_a_palette_and_sixteen_bits_are_read(folder):
    Image.fromarray(np.array([[0, 65535, 50000]], np.uint16)).save(folder / "deep.png")
    Image.fromarray(np.array([[0, 255, 200]], np.uint8)).convert("P").save(folder / "palette.png")
    for name in ("deep.png", "palette.png"):
        assert np.array_equal(read_map(written(folder, image=name)).cells, [[100, 0, -1]])


def test_plain_text_images_comments_quotes_and_lists_are_read(folder):
    (folder / "a b.pgm").write_text("P2\n2 1\n4\n0 4\n")
    (folder / "room.yaml").write_text(
        "---\n# by map_saver\nimage: 'a b.pgm'  # beside\nmode: trinary\nresolution: 5e-2\n"
        "origin:\n- -1.5\n- 2\n- 0\nnegate: false\noccupied_thresh: .65\nfree_thresh: 0.25\n\n"
    )
    found = read_map(folder / "room.yaml")
    assert np.array_equal(found.cells, [[100, 0]])
    assert found.origin == (-1.5, 2.0)


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"resolution": "0"}, "resolution is 0; expected a number of meters above 0"),
        ({"resolution": "-0.05"}, "resolution is -0.05"),
        ({"resolution": "wide"}, "resolution is wide; expected a number"),
        ({"resolution": ".nan"}, "resolution is .nan; expected a number"),
        ({"resolution": "nan"}, "resolution is nan; expected a finite number"),
        ({"free_thresh": "0.7"}, "free_thresh is 0.7 and occupied_thresh 0.65; expected 0 <= free_thresh <"),
        ({"occupied_thresh": "65"}, "occupied_thresh 65; expected"),
        ({"origin": "[0, 0, 0.3]"}, "origin has the yaw 0.3; expected 0"),
        ({"origin": "[0, 0]"}, "origin is [0, 0]; expected [x, y, yaw]"),
        ({"origin": "[1e5, 0, 0]"}, "expected x and y within"),
        ({"negate": "2"}, "negate is 2; expected 0 or 1"),
        ({"mode": "rgb"}, "mode is rgb; expected trinary, scale, raw"),
        ({"image": None}, "the field image is missing"),
        ({"origin": None}, "the field origin is missing"),
        ({"size": "3"}, "there is no field size in a map"),
        ({"image": '""'}, 'image is ""; expected the name of a file'),
        ({"image": "../room.pgm"}, "image is ../room.pgm; expected the name of a file in the map's folder"),
        ({"negate": "0\nnegate: 1"}, "the field negate stands twice"),
        ({"negate": "0\n  nested"}, "is no field of a map"),
    ],
)
def test_what_is_wrong_with_a_map_is_one_sentence(folder, changes, sentence):
    path = written(folder, **changes)
    with pytest.raises(ScenarioError, match=r"^[^\n]*$") as caught:
        read_map(path)
    assert str(caught.value).startswith(f"{path}: ")
    assert sentence in str(caught.value)


def test_files_that_are_missing_or_no_images_are_named(folder):
    (folder / "text.pgm").write_text("not an image")
    (folder / "cut.pgm").write_bytes(b"P5\n30 20\n255\n" + bytes(7))
    Image.fromarray(np.zeros((40, 40), np.uint8)).save(folder / "whole.png")
    (folder / "cut.png").write_bytes((folder / "whole.png").read_bytes()[:50])
    (folder / "huge.pgm").write_bytes(b"P5\n6000 5000\n255\n")
    os.mkfifo(folder / "pipe.pgm")
    for name, reason in (
        ("none.pgm", "cannot be read: No such file"),
        ("text.pgm", "is not an image; expected PGM or PNG"),
        ("cut.pgm", "cannot be read"),
        ("cut.png", "cannot be read"),
        ("huge.pgm", "the image has 6000 x 5000 pixels; expected at most"),
        ("pipe.pgm", "it is not a regular file"),
        (".", "directory"),
    ):
        with pytest.raises(ScenarioError, match=r"^[^\n]*$") as caught:
            read_map(written(folder, image=name))
        assert reason in str(caught.value)
        assert str(folder / name) in str(caught.value)
    (folder / "binary.yaml").write_bytes(bytes([0x81, 0xFF]))
    for name, reason in (("none.yaml", "cannot be read: No such file"), ("binary.yaml", "is no text")):
        with pytest.raises(ScenarioError, match=reason):
            read_map(folder / name)
