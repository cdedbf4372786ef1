import json

import numpy as np
import pytest

from gpsynth.encodings.network_operator_text import read_matrix
from gpsynth.errors import EncodingError

ROWS = [[0, 0, 12], [0, 0, 1], [0, 0, 2]]
NODES = {"inputs": (0,), "parameters": (1,), "outputs": (2,)}
DOCUMENT = {"matrix": ROWS, "inputs": [0], "parameters": [1], "outputs": [2]}


@pytest.mark.parametrize(
    "text",
    [
        "[0,0,12]\n[0,0,1]\n[0,0,2]",
        "[[0, 0, 12],\n [0, 0, 1],\n [0, 0, 2]]",
        "0 0 12\n\n0 0 1\r\n0 0 2\n",
        "0,0,12\n0,0,1\n0,0,2",
    ],
)
def test_printed_rows_are_read(text):
    assert np.array_equal(read_matrix(text, **NODES).psi, ROWS)


def test_a_json_document_names_its_nodes_and_may_say_more():
    matrix = read_matrix(json.dumps({"name": "law", **DOCUMENT, "note": [1, 2]}))
    assert matrix == read_matrix("0 0 12\n0 0 1\n0 0 2", **NODES)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "1 to 512 rows, not 0"),
        ("0 0 12\n0 0 1\n0 0", "row 2 has 2 entries; the matrix has 3 rows"),
        ("0 0 12\n0 0 sin\n0 0 2", "line 2 of the matrix has 'sin'"),
        ("0 0 12\n0 0 1.0\n0 0 2", "line 2 of the matrix has '1.0'"),
        ("0 0 12\n0 0 -1\n0 0 2", "line 2 of the matrix has '-1'"),
        ("0 0 12\n0 0 9999999999999999\n0 0 2", "line 2 of the matrix has '9999"),
        ("0 0 ١\n0 0 1\n0 0 2", "line 1 of the matrix has"),
        ("\n".join(["0 0"] * 600), "1 to 512 rows, not 600"),
        ("0" * 5_000_000, "at most 4000000 are read"),
    ],
)
def test_malformed_rows_are_refused(text, sentence):
    with pytest.raises(EncodingError, match=sentence):
        read_matrix(text, **NODES)


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"matrix": [[0, 1.5, 2]]}, "malformed"),
        ({"matrix": [[0, True], [0, 1]]}, "malformed"),
        ({"matrix": "0 1"}, "malformed"),
        ({"matrix": [[0, 0, 2**40], [0, 0, 1], [0, 0, 2]]}, "not a function number"),
        ({"matrix": [[0, 0, 12], [0, 0, 1], [0, 2]]}, "row 2 has 2 entries"),
        ({"inputs": None}, "malformed"),
        ({"outputs": [7]}, "node 7 does not exist"),
        ({"outputs": [2**70]}, "malformed|does not exist"),
    ],
)
def test_malformed_documents_are_refused(changes, sentence):
    with pytest.raises(EncodingError, match=sentence):
        read_matrix(json.dumps({**DOCUMENT, **changes}))


def test_missing_fields_and_nodes_are_named():
    with pytest.raises(EncodingError, match="missing required field `outputs`"):
        read_matrix(json.dumps({key: value for key, value in DOCUMENT.items() if key != "outputs"}))
    with pytest.raises(EncodingError, match="malformed"):
        read_matrix('{"matrix": [[0, 1], [0')
    with pytest.raises(EncodingError, match="needs the node numbers"):
        read_matrix("0 1\n0 1")
    with pytest.raises(EncodingError, match="names its own inputs"):
        read_matrix(json.dumps(DOCUMENT), outputs=(1,))
