"""`python -m tests.bench.choices [NAME ...]`: the figures behind decisions of docs/decisions, each choice beside what
it was chosen over."""

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path
from statistics import median
from types import MappingProxyType
from unittest.mock import patch

import numpy as np

from applications.rosbot.experiments import experiment
from applications.rosbot.scenario_file import read_scenario
from gpsynth.evaluate import Evaluator
from gpsynth.kernels.pack import pack
from gpsynth.loop_arrays import instructions
from gpsynth.planning import plan
from tests.bench.setting import setting

SCENARIO = Path(__file__).parents[2] / "applications" / "rosbot" / "scenarios" / "paper.json"
SEEDS = range(1, 11)


def rounds() -> Iterator[str]:
    """Arrival times on the paper's scenario, physical limits: T+ tightened in rounds, and the other readings."""
    case = experiment(read_scenario(SCENARIO), "physical")
    for name, reading in (
        ("rounds, bests scored anew", nullcontext()),
        ("rounds, bests keep their old cost", patch("gpsynth.planning.rounds.rescored", _unchanged)),
        ("T+ stays at 18 s", patch("gpsynth.planning.rounds.lengths", _one_round)),
    ):
        with reading:
            found = [plan(case.problem, case.law, case.settings, seed=seed, threads=2) for seed in SEEDS]
        times = sorted(each.arrival_time if each.is_free else np.inf for each in found)
        yield f"{name:36} median {median(times):6.3f} s, best {times[0]:6.3f} s, worst {times[-1]:6.3f} s"


def packing() -> Iterator[str]:
    """What a law costs before its first rollout, beside 64 rollouts of it."""
    case = setting()
    evaluator = Evaluator(case.problem)
    laws = [instructions(law) for law in case.laws]
    none = np.empty((1, 0))
    packed = _microseconds(lambda: [pack(evaluator.frame, law, 0) for law in laws]) / len(laws)
    rolled = _microseconds(lambda: [evaluator.of_program(law, none) for law in case.laws]) / len(laws)
    yield f"{'packing a law of 20 operations':36} {packed:8.1f} us"
    yield f"{'64 rollouts of it, 5 s each':36} {rolled:8.1f} us"


def _unchanged(found, objective):
    return replace(found.progress, history=())


def _one_round(settings):
    return [settings.rounds * settings.iterations]


def _microseconds(work: Callable[[], object], repeats: int = 15) -> float:
    times = []
    for _ in range(repeats):
        began = time.perf_counter()
        work()
        times.append(time.perf_counter() - began)
    return 1e6 * median(times)


CHOICES = MappingProxyType({"rounds": rounds, "packing": packing})

if __name__ == "__main__":
    for name in sys.argv[1:] or CHOICES:
        print(name)
        for line in CHOICES[name]():
            print(f"  {line}", flush=True)
