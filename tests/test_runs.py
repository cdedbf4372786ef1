"""Searches that are killed, interrupted and resumed."""

import signal
import subprocess
import sys
import time

import pytest

from gpsynth import runs
from gpsynth.errors import FileError
from gpsynth.synthesis import synthesize
from tests.test_synthesis import encoding, quadratic

PROBLEM = quadratic()
SETTINGS = {"seed": 1, "budget": 1_500, "tuning": 20}
SCRIPT = """
import sys
from gpsynth import runs
from gpsynth.synthesis import synthesize
from tests.test_runs import PROBLEM, SETTINGS, encoding
runs.EVERY = 0.0
synthesize(PROBLEM, encoding(PROBLEM), folder=sys.argv[1], **SETTINGS)
"""


@pytest.fixture(scope="module")
def whole():
    return synthesize(PROBLEM, encoding(PROBLEM), **SETTINGS)


def same(first, second):
    assert [entry.law for entry in first.front] == [entry.law for entry in second.front]
    assert [entry.cost for entry in first.front] == [entry.cost for entry in second.front]
    assert (first.history, first.evaluations) == (second.history, second.evaluations)


def resumed(folder, **changes):
    return synthesize(PROBLEM, encoding(PROBLEM), folder=folder, resume=True, **{**SETTINGS, **changes})


@pytest.mark.parametrize("generation", [1, 5])
def test_a_resumed_search_equals_one_without_interruption(tmp_path, whole, generation):
    stopped = synthesize(
        PROBLEM,
        encoding(PROBLEM),
        folder=tmp_path,
        callback=lambda progress: progress.generation == generation,
        **SETTINGS,
    )
    assert stopped.reason == "stopped by callback"
    seen = []
    same(resumed(tmp_path, callback=lambda progress: seen.append(progress.generation)), whole)
    assert seen[0] == generation + 1  # it goes on, and does not begin again
    same(resumed(tmp_path), whole)  # once more, from its end


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="there is no SIGKILL here")
def test_a_killed_search_goes_on_where_it_was(tmp_path, whole):
    command = [sys.executable, "-c", SCRIPT, str(tmp_path)]
    process = subprocess.Popen(command)
    deadline = time.monotonic() + 120.0
    while not (tmp_path / runs.FILE).exists() and process.poll() is None and time.monotonic() < deadline:
        time.sleep(0.01)
    process.kill()
    assert process.wait() == -signal.SIGKILL
    same(resumed(tmp_path), whole)


def test_ctrl_c_gives_what_was_found_so_far(tmp_path, whole):
    seen = []

    def interrupt(progress):
        seen.append(progress.evaluations)
        if progress.generation == 4:
            raise KeyboardInterrupt

    result = synthesize(PROBLEM, encoding(PROBLEM), callback=interrupt, folder=tmp_path, **SETTINGS)
    assert result.reason == "interrupted"
    assert result.evaluations == seen[3]
    assert result.history == tuple(entry for entry in whole.history if entry[0] <= result.evaluations)
    assert result.front
    same(resumed(tmp_path), whole)


def test_ctrl_c_before_anything_was_found_ends_the_run(monkeypatch):
    def interrupt(*arguments, **settings):
        raise KeyboardInterrupt

    monkeypatch.setattr("gpsynth.law_cost.score", interrupt)
    with pytest.raises(KeyboardInterrupt):
        synthesize(PROBLEM, encoding(PROBLEM), **SETTINGS)


def test_another_run_is_not_resumed(tmp_path):
    synthesize(PROBLEM, encoding(PROBLEM), folder=tmp_path, **{**SETTINGS, "budget": 450})
    with pytest.raises(FileError, match=r"it is of a run with another seed$"):
        resumed(tmp_path, seed=2)
    with pytest.raises(FileError, match="another objective"):
        resumed(tmp_path, objective=lambda rollouts: rollouts.end)
    other = quadratic(period=0.1)
    with pytest.raises(FileError, match="another problem"):
        synthesize(other, encoding(other), folder=tmp_path, resume=True, **SETTINGS)
    with pytest.raises(FileError, match=r"checkpoint\.json does not exist"):
        resumed(tmp_path / "elsewhere")
    assert not (tmp_path / "elsewhere").exists()
    with pytest.raises(FileError, match="there is no folder to resume from"):
        resumed(None)


def test_a_checkpoint_is_not_overwritten(tmp_path, whole):
    stop = {"callback": lambda progress: progress.generation == 2}
    synthesize(PROBLEM, encoding(PROBLEM), folder=tmp_path, **SETTINGS, **stop)
    with pytest.raises(FileError, match=r"checkpoint\.json is of an earlier run: go on with resume=True, or"):
        synthesize(PROBLEM, encoding(PROBLEM), folder=tmp_path, **SETTINGS)
    same(resumed(tmp_path), whole)
