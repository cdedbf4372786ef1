"""Two trained robot laws, evaluated as published; their files stand beside the repository, not in it."""

import json
from pathlib import Path

import numpy as np
import pytest

from gpsynth.encodings.network_operator_matrix import decode_matrix
from gpsynth.encodings.network_operator_text import read_matrix
from gpsynth.encodings.parameters import ParameterSpace
from gpsynth.encodings.variational import VariationalEncoding
from gpsynth.seeds import stream

FOLDER = Path(__file__).parents[2].parent / "shared" / "golden"
LAWS = {"nom_461": 270, "nom_default": 264}
PUBLISHED = [  # x, u of NOM-461 as printed with 17 digits
    ((2.5, 2.5, 1.31), (7619.7997817352853, -9477.1230671817757)),
    ((2.5, 2.5, -1.31), (14.423954467471624, -3.9757176807666457)),
    ((2.5, -2.5, -1.31), (-5520.7311836960698, 5800.7645332198299)),
    (
        (4.6561580083458731e-3, 4.0351029521603278e-2, 8.3948216438293491e-2),
        (13.335461264421879, 8.4973200088496483),
    ),
    (
        (-0.91758697199960415, -0.44754665005156380, -0.51089064121246375),
        (-34.732514696068890, -6.2624360542277708),
    ),
    (
        (5.6599015741103036e-2, 4.1273824183417351e-2, -0.25226671345531987),
        (-0.20985952049623924, 2.6154650032382927),
    ),
]


def text_of(name):
    path = FOLDER / f"{name}.json"
    if not path.exists():
        pytest.skip(f"{path.name} is not beside the repository (shared/golden); its licence keeps it out")
    return path.read_text(encoding="utf-8")


@pytest.mark.parametrize("strict", [True, False])
@pytest.mark.parametrize("name", LAWS)
def test_every_vector_is_reproduced(name, strict):
    text = text_of(name)
    document = json.loads(text)
    x, u = (np.array([vector[key] for vector in document["vectors"]]) for key in ("x", "u"))
    values = decode_matrix(read_matrix(text), strict=strict)(x, document["q"])
    assert len(x) == LAWS[name]
    assert np.all(np.abs(values - u) <= 1e-11 * np.abs(u))


@pytest.mark.parametrize("strict", [True, False])
def test_the_published_pairs_are_reproduced(strict):
    text = text_of("nom_461")
    x, u = (np.array(column) for column in zip(*PUBLISHED, strict=True))
    values = decode_matrix(read_matrix(text), strict=strict)(x, json.loads(text)["q"])
    assert np.all(np.abs(values - u) <= 1e-11 * np.abs(u))


@pytest.mark.parametrize("name", LAWS)
def test_a_published_law_can_be_the_basic_solution(name):
    text = text_of(name)
    matrix, q = read_matrix(text), json.loads(text)["q"]
    encoding = VariationalEncoding(
        ("x0", "x1", "x2"), ("u0", "u1"), space=ParameterSpace(3, 0.0, 16.0), basis=matrix
    )
    assert encoding.decode(encoding.basic(q)) == decode_matrix(matrix, strict=False)
    neighbor = encoding.random(stream(1))
    encoding.check(neighbor)
    changed = np.count_nonzero(encoding.rebased(neighbor).basis.psi != matrix.psi)
    assert 1 <= changed <= encoding.n_variations
