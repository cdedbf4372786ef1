"""Matrices as they are printed and stored, with functions as numbers; the strict way in."""

import re
from collections.abc import Sequence

import msgspec
import numpy as np

from gpsynth.encodings.network_operator_matrix import MOST_NODES, Matrix
from gpsynth.errors import EncodingError

_LONGEST = 4_000_000  # characters, so that no file can fill the memory


class _Document(msgspec.Struct):
    """A JSON document; what else it says (notes, scores) is not ours to judge."""

    matrix: list[list[int]]
    inputs: list[int]
    parameters: list[int]
    outputs: list[int]


def read_matrix(
    text: str,
    inputs: Sequence[int] | None = None,
    parameters: Sequence[int] | None = None,
    outputs: Sequence[int] | None = None,
) -> Matrix:
    """The matrix of a JSON object with the fields matrix, inputs, parameters and outputs, or of rows of integers.

    Rows, one a line, separated by commas or blanks, with or without brackets, need the node numbers as arguments; a
    JSON object has them. Nodes count from 0, binary functions from 1. Raises EncodingError if it is anything else.
    """
    if len(text) > _LONGEST:
        raise EncodingError(f"the text of the matrix has {len(text)} characters; at most {_LONGEST} are read")
    given = (inputs, parameters, outputs)
    if text.lstrip().startswith("{"):
        if given != (None, None, None):
            raise EncodingError("a JSON matrix names its own inputs, parameters and outputs")
        return _from_json(text)
    if inputs is None or outputs is None:
        raise EncodingError("a matrix of rows needs the node numbers of its inputs, parameters and outputs")
    rows = [_row(number, line) for number, line in enumerate(text.splitlines(), 1) if line.strip()]
    return _matrix(rows, inputs, parameters or (), outputs)


def _from_json(text: str) -> Matrix:
    try:
        document = msgspec.json.decode(text, type=_Document)
    except msgspec.DecodeError as error:
        raise EncodingError(f"the matrix document is malformed: {error}") from None
    return _matrix(document.matrix, document.inputs, document.parameters, document.outputs)


def _row(number: int, line: str) -> list[int]:
    entries = re.sub(r"[\[\],]", " ", line).split()
    for entry in entries:
        if not re.fullmatch(r"[0-9]{1,3}", entry):
            raise EncodingError(f"line {number} of the matrix has {entry[:20]!r}; expected function numbers")
    return [int(entry) for entry in entries]


def _matrix(
    rows: list[list[int]], inputs: Sequence[int], parameters: Sequence[int], outputs: Sequence[int]
) -> Matrix:
    if not 0 < len(rows) <= MOST_NODES:
        raise EncodingError(f"a matrix has 1 to {MOST_NODES} rows, not {len(rows)}")
    for number, row in enumerate(rows):
        if len(row) != len(rows):
            raise EncodingError(f"row {number} has {len(row)} entries; the matrix has {len(rows)} rows")
        if not all(0 <= entry < 1000 for entry in row):
            raise EncodingError(f"row {number} has an entry that is not a function number")
    psi = np.array(rows, dtype=np.int32)
    return Matrix(psi, tuple(inputs), tuple(parameters), tuple(outputs))
