import json
from dataclasses import dataclass
from functools import partial

import numpy as np
import pytest

from gpsynth.checkpoint import Checkpoint, fingerprint, plain
from gpsynth.encodings.variations import Variation
from gpsynth.errors import FileError
from gpsynth.optimizers import CMAES, minimize
from gpsynth.program import Program
from gpsynth.tracing import trace


@dataclass(frozen=True, eq=False)
class State:
    number: float
    inner: object = None


def kept(tmp_path, state):
    checkpoint = Checkpoint(tmp_path / "checkpoint.json", {"seed": "1"})
    checkpoint.write(state)
    return checkpoint.read()


@pytest.mark.parametrize(
    "value",
    [
        *(0.1, -0.0, 5e-324, 1e308, float("inf"), float("-inf"), 3, 2**53 - 1, True, None, "text"),
        *((), (1, (2.5, "a")), Variation(1, 2, 3, 4), {"a": 1, "b": (2.0,)}),
    ],
)
def test_values_come_back_equal_and_of_their_type(tmp_path, value):
    back = kept(tmp_path, value)
    assert type(back) is type(value)
    assert repr(back) == repr(value)


@pytest.mark.parametrize("dtype", [np.float64, np.int32, np.int64, np.bool_])
def test_arrays_come_back_bit_for_bit_and_read_only(tmp_path, dtype):
    array = np.random.default_rng(1).normal(size=(3, 0, 2) if dtype is np.bool_ else (4, 3)).astype(dtype)
    back = kept(tmp_path, State(1.0, array)).inner
    assert (back.dtype, back.shape, back.tobytes()) == (array.dtype, array.shape, array.tobytes())
    assert not back.flags.writeable


def test_a_program_and_the_state_of_an_optimizer_come_back(tmp_path):
    program = trace(lambda f: np.sin(f.x) * 0.3, [("f", ("x",))])
    back = kept(tmp_path, State(np.nan, program))
    assert isinstance(back.inner, Program)
    assert back.inner == program

    optimizer = CMAES([-1.0] * 3, [1.0] * 3)

    def cost(x):
        return (x**2).sum(axis=1)

    half = minimize(cost, optimizer, seed=1, budget=70)
    whole = minimize(cost, optimizer, seed=1, budget=140)
    rest = minimize(cost, optimizer, seed=1, budget=140, resume=kept(tmp_path, half.progress))
    assert rest.x.tobytes() == whole.x.tobytes()
    assert rest.history == whole.history


@pytest.mark.parametrize("value", [object(), {1, 2}, np.array(["a"]), lambda: 0, 1j])
def test_what_has_no_place_in_a_checkpoint_is_named(value):
    with pytest.raises(FileError, match="cannot be kept in a checkpoint"):
        plain(State(1.0, value))


def _changed(tmp_path, **changes):
    checkpoint = Checkpoint(tmp_path / "checkpoint.json", {"seed": "1", "problem": "a"})
    checkpoint.write(State(1.0))
    document = json.loads(checkpoint.path.read_text())
    checkpoint.path.write_text(json.dumps({**document, **changes}))
    return checkpoint


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"format": "gpsynth-checkpoint/0"}, "is no checkpoint of format 'gpsynth-checkpoint/1'"),
        ({"state": 1}, "does not match its hash"),
        ({"more": 1}, "does not match its hash"),
        ({"hash": "0"}, "does not match its hash"),
    ],
)
def test_a_changed_checkpoint_is_refused(tmp_path, changes, sentence):
    with pytest.raises(FileError, match=sentence):
        _changed(tmp_path, **changes).read()


@pytest.mark.parametrize(
    "reference",
    ["os:system", "builtins:eval", "subprocess:Popen", "gpsynth.nothing:Law", "tests.test_checkpoint:kept"],
)
def test_a_checkpoint_cannot_call_what_is_no_value_class(tmp_path, monkeypatch, reference):
    monkeypatch.setattr("gpsynth.checkpoint._digest", lambda document: "same")
    content = {"format": "gpsynth-checkpoint/1", "settings": {}, "hash": "same"}
    path = tmp_path / "checkpoint.json"
    path.write_text(json.dumps({**content, "state": {"class": reference, "fields": {}}}))
    with pytest.raises(FileError, match=f"there is no class '{reference}' for it"):
        Checkpoint(path, {}).read()


def test_another_run_is_refused_by_what_differs(tmp_path):
    checkpoint = Checkpoint(tmp_path / "checkpoint.json", {"seed": "1", "problem": "a", "search": "b"})
    checkpoint.write(State(1.0))
    with pytest.raises(FileError, match=r"it is of a run with another seed and another search$"):
        Checkpoint(checkpoint.path, {"seed": "2", "problem": "a", "search": "c"}).read()


def test_fingerprints_tell_settings_apart():
    assert fingerprint(State(1.0, np.zeros(3))) == fingerprint(State(1.0, np.zeros(3)))
    different = [
        State(1.0),
        State(2.0),
        State(1.0, np.zeros(2)),
        State(1.0, np.zeros(3)),
        State(1.0, cost := len),
        cost,
    ]
    assert len({fingerprint(value) for value in different}) == len(different)


def test_a_function_without_a_name_has_no_fingerprint():
    with pytest.raises(FileError, match="a partial cannot be kept in a checkpoint"):
        fingerprint(State(1.0, partial(max, 0.0)))
