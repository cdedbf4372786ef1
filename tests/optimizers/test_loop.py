"""The one loop: budgets, reasons, history, callbacks, and searches over things that are not vectors."""

import subprocess
import sys
from dataclasses import dataclass, replace

import numpy as np
import pytest

from gpsynth.errors import OptimizerError
from gpsynth.optimizers import PSO, minimize
from gpsynth.seeds import stream
from tests.optimizers.helpers import SPHERE, same_state

SWARM = PSO(SPHERE.lower, SPHERE.upper, size=32)


@pytest.mark.parametrize("budget", [32, 33, 63, 64, 1000])
def test_the_budget_is_never_exceeded_and_used_in_whole_generations(budget):
    calls = []
    result = minimize(lambda x: calls.append(len(x)) or SPHERE.cost(x), SWARM, seed=1, budget=budget)
    assert sum(calls) == result.evaluations == budget // 32 * 32
    assert result.generations == len(calls)
    assert result.reason == "budget spent"


def test_the_target_ends_the_run_at_once():
    result = minimize(SPHERE.cost, SWARM, seed=1, budget=10_000, target=0.5)
    assert result.reason == "target reached"
    assert result.history[-1] == (result.evaluations, result.cost)
    assert result.history[-2][1] > 0.5 >= result.cost


def test_history_falls_strictly_and_ends_at_the_best():
    result = minimize(SPHERE.cost, SWARM, seed=1, budget=3_000)
    evaluations, costs = zip(*result.history, strict=True)
    assert (np.diff(evaluations) > 0).all()
    assert (np.diff(costs) < 0).all()
    assert costs[-1] == result.cost


def test_costs_above_their_limits_do_not_matter():
    def cut(x, limits):
        costs = SPHERE.cost(x)
        return np.where(costs > limits, 1.5 * costs + 1.0, costs)

    whole = minimize(SPHERE.cost, SWARM, seed=1, budget=3_000)
    same = minimize(cut, SWARM, seed=1, budget=3_000, limits=SWARM.limits)
    assert same_state(whole.state, same.state)
    assert whole.history == same.history


def test_callback_sees_each_generation_after_its_checkpoint_and_can_stop():
    events = []

    def callback(now):
        events.append(("callback", now.generation))
        return now.generation == 3

    result = minimize(
        SPHERE.cost,
        SWARM,
        seed=1,
        budget=10_000,
        callback=callback,
        checkpoint=lambda now: events.append(("checkpoint", now.generation)),
    )
    assert events == [(kind, g) for g in (1, 2, 3) for kind in ("checkpoint", "callback")]
    assert result.reason == "stopped by callback"
    assert result.evaluations == 96


def test_a_run_resumed_from_a_checkpoint_equals_one_that_never_stopped():
    saved = []
    whole = minimize(SPHERE.cost, SWARM, seed=1, budget=2_000, checkpoint=saved.append)
    for now in saved[::13]:
        rest = minimize(SPHERE.cost, SWARM, seed=1, budget=2_000, resume=now)
        assert same_state(rest.state, whole.state)
        assert rest.history == whole.history


def test_resuming_a_finished_run_evaluates_nothing():
    done = minimize(SPHERE.cost, SWARM, seed=1, budget=2_000, target=0.5)
    again = minimize(SPHERE.cost, SWARM, seed=1, budget=2_000, target=0.5, resume=done.progress)
    assert (again.evaluations, again.reason) == (done.evaluations, done.reason)


def test_the_optimizer_ends_the_run_with_its_reason():
    swarm = PSO(SPHERE.lower, SPHERE.upper, size=8, inertia=0.0, cognitive=0.0, social=1.0)
    result = minimize(SPHERE.cost, swarm, seed=1, budget=1_000_000)
    assert result.reason == "the swarm has come to rest"
    assert result.evaluations < 1_000_000


def test_paths_separate_runs_of_one_seed():
    a, b = (minimize(SPHERE.cost, SWARM, seed=1, budget=320, path=path) for path in ((1, 0), (1, 1)))
    assert not same_state(a.state, b.state)


def test_the_streams_are_those_of_the_generations():
    state = SWARM.init(stream(9, 4, 0))
    for g in range(1, 11):
        x, state = SWARM.ask(state, stream(9, 4, g))
        state = SWARM.tell(state, x, SPHERE.cost(x))
    assert same_state(minimize(SPHERE.cost, SWARM, seed=9, budget=320, path=(4,)).state, state)


@dataclass(frozen=True)
class WordState:
    words: tuple[str, ...]
    best: str
    cost: float


class WordSearch:
    """A search over texts: each generation changes one letter of the best word."""

    def init(self, rng):
        return WordState(("aaaa",) * 20, "", np.inf)

    def ask(self, state, rng):
        words = [state.best or state.words[0]] * 20
        for i, word in enumerate(words):
            spot, letter = rng.integers(4), "loveaxyz"[rng.integers(8)]
            words[i] = word[:spot] + letter + word[spot + 1 :]
        return tuple(words), replace(state, words=tuple(words))

    def tell(self, state, words, costs):
        i = int(costs[:, 0].argmin())
        return replace(state, best=words[i], cost=float(costs[i, 0])) if costs[i, 0] < state.cost else state

    def best(self, state):
        return state.best, state.cost

    def stop(self, state):
        return ""


def test_the_loop_searches_structures_as_well():
    def cost(words):
        return [(sum(a != b for a, b in zip(word, "love", strict=True)), len(word)) for word in words]

    result = minimize(cost, WordSearch(), seed=1, budget=5_000, target=0)
    assert (result.x, result.reason) == ("love", "target reached")


@pytest.mark.parametrize(
    ("settings", "sentence"),
    [
        ({"seed": -1, "budget": 100}, "seed must be an integer of at least 0, not -1"),
        ({"seed": 1, "budget": 0}, "budget must be an integer of at least 1, not 0"),
        ({"seed": 1, "budget": 31}, "budget of 31 evaluations is less than one generation of 32"),
        ({"seed": 1, "budget": 100, "target": np.nan}, "target must be a number, not NaN"),
    ],
)
def test_settings_that_cannot_work_are_refused(settings, sentence):
    with pytest.raises(OptimizerError, match=sentence):
        minimize(SPHERE.cost, SWARM, **settings)


@pytest.mark.parametrize("wrong", [lambda x: 1.0, lambda x: np.zeros(3)])
def test_costs_that_do_not_fit_their_batch_are_refused(wrong):
    with pytest.raises(OptimizerError, match="one row per candidate: 32 expected"):
        minimize(wrong, SWARM, seed=1, budget=100)


def test_errors_of_the_cost_pass_through():
    def broken(x):
        raise ZeroDivisionError("mine")

    with pytest.raises(ZeroDivisionError, match="mine"):
        minimize(broken, SWARM, seed=1, budget=100)


def test_no_progress_is_drawn_where_stderr_is_no_terminal(capfd):
    minimize(SPHERE.cost, SWARM, seed=1, budget=320, progress=True)
    assert capfd.readouterr() == ("", "")


def test_progress_is_drawn_on_a_terminal(capfd, monkeypatch):
    monkeypatch.setattr("sys.stderr.isatty", lambda: True)
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("COLUMNS", "100")
    monkeypatch.setenv("FORCE_COLOR", "1")
    quiet = minimize(SPHERE.cost, SWARM, seed=1, budget=320)
    result = minimize(SPHERE.cost, SWARM, seed=1, budget=320, progress=True)
    assert "320/320" in capfd.readouterr().err
    assert same_state(result.state, quiet.state)


def test_importing_the_optimizers_loads_neither_deap_nor_rich():
    code = (
        "import sys, gpsynth.optimizers; print(sorted({'deap', 'rich', 'scipy', 'numba'} & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
