"""The report: counts and bounds against what is known by hand, on lines where every arrival can be computed."""

import re
from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from gpsynth.draws import Draws, crossed
from gpsynth.errors import ProblemError
from gpsynth.law import Law
from gpsynth.plant import Plant
from gpsynth.problem import Problem
from gpsynth.proportions import lower_bound
from gpsynth.tracing import trace, where
from gpsynth.verify.robustness import assess
from gpsynth.verify.stress import Stress, noisy, refined, scaled

LINE = Plant(
    lambda x, u, p: (p.gain * u.v,),
    {"x": "m"},
    {"v": ("m/s", -1.0, 1.0)},
    parameters={"gain": ("", 0.5, 2.0, 1.0), "unused": ("kg", 1.0, 3.0)},
    name="line",
)
STARTS = np.array([[0.5], [-1.0], [1.5], [-2.0]])


def problem(starts=STARTS, **choices):
    settings = {"horizon": 3.0, "period": 0.1, "tolerance": 0.05} | choices
    return Problem(LINE, starts, [0.0], **settings)


def law(formula, on=None):
    features = (on or problem()).features
    return Law(LINE, features, trace(formula, [("e", features.names)], ("v",)), np.empty(0))


TOWARDS = law(lambda e: 8.0 * e.error_x)


@pytest.mark.parametrize(("successes", "runs"), [(1, 1), (7, 10), (99, 100), (1000, 1000), (1, 1000)])
def test_at_the_bound_so_many_successes_are_just_too_unlikely(successes, runs):
    bound = lower_bound(successes, runs, 0.95)
    assert stats.binom.sf(successes - 1, runs, bound) == pytest.approx(0.05, rel=1e-9)


def test_bounds_of_none_and_of_all():
    assert lower_bound(0, 10) == 0.0
    assert lower_bound(1000, 1000, 0.99) == pytest.approx(0.01**0.001, rel=1e-12)


def test_times_and_counts_are_those_of_the_runs():
    report = assess(TOWARDS, problem(horizon=1.2), Stress(refine=1, limits=()))
    (given,) = report.trials
    # at full speed until 1/8 m are left, of which each further period leaves a fifth: 0.1 or 0.02 m
    assert (given.name, given.runs, given.reached, given.lost) == ("as given", 4, 2, 0)
    assert (given.median, given.worst, given.held) == (pytest.approx(0.75), pytest.approx(1.0), 0.5)
    assert given.bound == lower_bound(2, 4)
    assert (report.slowest, report.sensitivities) == (None, ())


def test_slower_actuators_lose_the_far_starts():
    report = assess(TOWARDS, problem(horizon=2.0), Stress(refine=1, limits=(0.6, 2.0)))
    given, slow, fast = report.trials
    assert (given.reached, slow.reached, fast.reached) == (4, 2, 4)  # 0.6 m/s for 2 s are 1.2 m
    assert (slow.name, slow.lost, fast.lost) == ("limits x 0.6", 2, 0)


def test_a_law_that_lives_on_its_period_loses_starts_with_a_finer_one():
    lazy = law(lambda e: where(np.abs(e.error_x) < 0.06, 0.0, np.sign(e.error_x)))
    given, fine = assess(lazy, problem([[1.0], [1.07], [0.03]], tolerance=0.04), Stress(limits=())).trials
    # steps of 0.1 m jump from 0.1 to 0 and from 0.07 to -0.03; those of 0.01 m stop at 0.06 or 0.05
    assert (given.reached, fine.reached, fine.lost) == (3, 1, 2)
    assert fine.name == "period and step / 10"


def test_arriving_is_not_staying():
    through = law(lambda e: np.sign(e.error_x + 1e-3) * 0.0 - 1.0)
    (given,) = assess(through, problem([[0.5], [1.0]]), Stress(refine=1, limits=())).trials
    assert (given.reached, given.held) == (2, 0.0)


def test_noise_is_a_trial_of_its_own_and_the_same_for_a_seed():
    stress = Stress(refine=1, limits=(), noise=0.3)
    first, again = (assess(TOWARDS, problem(), stress).trials[1] for _ in range(2))
    assert first == again
    assert first.name == "noise"
    assert first.held < 1.0
    exact = assess(TOWARDS, problem(), replace(stress, noise=0.0)).trials
    assert replace(exact[1], name=exact[0].name) == exact[0]


def test_the_slowdown_follows_what_it_depends_on():
    numbers = np.column_stack([[0.5, 0.8, 1.0, 1.25, 2.0], [1.0, 3.0, 2.0, 1.5, 2.5]])
    starts, draws = crossed(STARTS, Draws(numbers, delay=0.1))
    calm = law(lambda e: 1.5 * e.error_x)  # with the delay, a steeper one swings
    report = assess(calm, problem(starts, horizon=9.0, draws=draws), Stress(refine=1, limits=()))
    gain, unused, delay = report.sensitivities
    assert (gain.name, gain.low, gain.high, report.draws) == ("gain", 0.5, 2.0, 5)
    assert gain.correlation == pytest.approx(-1.0)
    assert unused.correlation == pytest.approx(stats.spearmanr(numbers[:, 1], -numbers[:, 0]).statistic)
    assert delay.correlation == 0.0
    assert report.slowest.values == {"gain": 0.5, "unused": 1.0, "delay": 0.1}
    assert (report.slowest.runs, report.slowest.reached) == (4, 4)
    assert 1.8 < report.slowest.slowdown < 2.6  # half the speed and a late start
    assert report.trials[-1].name == "nominal plant"


def test_the_finer_problem_has_the_same_noise_at_the_same_times():
    noise = np.arange(6.0).reshape(1, 6, 1)
    fine = refined(problem(draws=Draws(delay=[0.1] * 4, noise=noise)), 5)
    assert (fine.period, fine.step) == (pytest.approx(0.02), pytest.approx(0.02))
    assert fine.draws.noise[0, :, 0].tolist() == np.repeat(np.arange(6.0), 5).tolist()
    assert fine.draws.delay.tolist() == [0.1] * 4


def test_other_limits_and_noise_leave_the_draws():
    given = problem(draws=Draws(np.full((4, 2), 1.5), delay=0.2))
    assert scaled(given, 0.8).plant.upper.tolist() == [0.8]
    assert scaled(given, 0.8).draws is given.draws
    assert noisy(given, [0.1]).draws.delay.tolist() == [0.2] * 4
    assert noisy(given, [0.1]).draws.parameters.tolist() == given.draws.parameters.tolist()


def test_the_table_is_aligned_and_says_what_it_counts():
    starts, draws = crossed(STARTS, Draws([[0.5, 1.0], [1.0, 2.0], [2.0, 3.0]]))
    lines = assess(TOWARDS, problem(starts, draws=draws), Stress(noise=0.1)).table().splitlines()
    trials = lines[1 : lines.index("") - 1]
    assert len({len(line) for line in lines[: len(trials) + 1]}) == 1
    assert [re.split(r"  +", line)[0] for line in trials] == [
        *("as given", "period and step / 10", "limits x 0.8", "limits x 1.2", "noise", "nominal plant")
    ]
    assert "11 of 12" in trials[0]
    assert "confidence 0.95" in lines[len(trials) + 1]
    assert lines[-1].startswith("slowest draw: 3 of 4 reached")


WRONG = {
    "refine": (lambda: Stress(refine=0), "refine must be an integer of at least 1, not 0"),
    "limits": (lambda: Stress(limits=(0.8, -1.0)), "limits are scaled by positive factors"),
    "confidence": (
        lambda: assess(TOWARDS, problem(), confidence=1.0),
        "the confidence must lie between 0 and 1",
    ),
    "noise": (lambda: assess(TOWARDS, problem(), Stress(noise=[1.0, 2.0])), "expected (1,)"),
    "law": (
        lambda: assess(TOWARDS, problem(features=lambda x, target: {"gap": target.x - x.x})),
        "expected v from the features gap",
    ),
}


@pytest.mark.parametrize(("make", "message"), WRONG.values(), ids=WRONG)
def test_what_makes_no_sense_is_an_error(make, message):
    with pytest.raises(ProblemError, match=re.escape(message)):
        make()
