"""Draws: what they hold, how they are made, and what is refused with a sentence."""

import pickle
import re
from dataclasses import replace

import numpy as np
import pytest

from gpsynth.draws import Draws, crossed, random_draws
from gpsynth.errors import PlantError, ProblemError
from gpsynth.plant import Plant
from gpsynth.problem import Problem

PARAMETERS = {"mass": ("kg", 1.0, 2.0), "drag": ("1/s", 0.0, 0.5, 0.1)}


def cart(parameters=PARAMETERS, dynamics=lambda x, u, p: (x.v, u.f / p.mass - p.drag * x.v)):
    return Plant(
        dynamics, {"x": "m", "v": "m/s"}, {"f": ("N", -1.0, 1.0)}, parameters=parameters, name="cart"
    )


def problem(count=3, **settings):
    return Problem(cart(), np.ones((count, 2)), [0.0, 0.0], tolerance=0.1, **settings)


def test_parameters_are_those_of_the_dynamics():
    plant = cart()
    assert plant.dynamics.inputs == ("x", "v", "f", "t")
    assert plant.dynamics.parameters == plant.parameter_names == ("mass", "drag")
    assert plant.nominal.tolist() == [1.5, 0.1]
    assert plant.dynamics(np.array([[0.0, 2.0, 3.0, 9.0]]), [1.5, 0.1]).tolist() == [
        [2.0, 3.0 / 1.5 - 0.1 * 2.0]
    ]


def test_dynamics_with_parameters_may_depend_on_time():
    plant = cart(dynamics=lambda x, u, p, t: (p.drag, t))
    assert plant.dynamics(np.array([[0.0, 0.0, 0.0, 7.0]]), [1.0, 3.0]).tolist() == [[3.0, 7.0]]


def test_a_plant_with_parameters_comes_back_from_its_document():
    assert Plant.from_dict(cart().to_dict()) == replace(cart()) == cart()
    assert cart() != cart({**PARAMETERS, "mass": ("kg", 1.0, 2.0, 1.25)})
    slow = cart().with_limits([-0.5], [0.5])
    assert slow.parameters == cart().parameters


WRONG_PARAMETERS = {
    "state": ({"x": ("m", 0.0, 1.0)}, "x is both a state and a parameter of cart"),
    "control": ({"f": ("N", 0.0, 1.0)}, "f is both a control and a parameter of cart"),
    "reversed": ({"mass": ("kg", 2.0, 1.0)}, "expected finite numbers, lower <= nominal <= upper"),
    "outside": ({"mass": ("kg", 1.0, 2.0, 3.0)}, "mass of cart is 3.0 in [1.0, 2.0]"),
    "infinite": ({"mass": ("kg", 1.0, np.inf)}, "expected finite numbers"),
    "text": ({"mass": ("kg", "1", "2")}, "the limits of mass in cart are numbers"),
    "short": ({"mass": (1.0, 2.0)}, "given as (unit, lower, upper, nominal)"),
    "list": (["mass"], "the parameters of cart are given as a dictionary"),
}


@pytest.mark.parametrize(("parameters", "message"), WRONG_PARAMETERS.values(), ids=WRONG_PARAMETERS)
def test_a_wrong_parameter_is_an_error(parameters, message):
    with pytest.raises(PlantError, match=re.escape(message)):
        cart(parameters)


def test_what_is_left_out_is_nominal_immediate_and_exact():
    draws = Draws(delay=[0.1, 0.2])
    assert (draws.parameters.shape, draws.noise.shape, draws.tables.tolist()) == ((2, 0), (0, 0, 0), [0, 0])
    assert Draws(np.ones((4, 2)), delay=0.1).delay.tolist() == [0.1] * 4
    assert Draws(np.ones((4, 2)), noise=np.zeros((3, 5, 2))).tables.tolist() == [0, 1, 2, 0]
    assert len(Draws(noise=np.zeros((3, 5, 2)))) == 3
    assert len(Draws()) == 1


def test_nominal_parameters_stand_for_all_starts():
    assert problem().plant_parameters.tolist() == [[1.5, 0.1]] * 3
    assert problem(draws=Draws(delay=[0.1] * 3)).plant_parameters.tolist() == [[1.5, 0.1]] * 3


def test_every_start_is_crossed_with_every_draw():
    draws = Draws(np.array([[1.0, 0.0], [2.0, 0.5]]), delay=[0.0, 0.1], noise=np.zeros((2, 4, 2)))
    starts, rows = crossed([[1.0, 0.0], [2.0, 0.0], [3.0, 0.0]], draws)
    assert starts[:, 0].tolist() == [1.0, 2.0, 3.0] * 2
    assert rows.parameters[:, 0].tolist() == [1.0] * 3 + [2.0] * 3
    assert rows.delay.tolist() == [0.0] * 3 + [0.1] * 3
    assert rows.tables.tolist() == [0] * 3 + [1] * 3
    assert rows.noise.shape == (2, 4, 2)


def test_random_draws_take_every_part_of_every_range_once():
    draws = random_draws(cart(), np.random.default_rng(3), 20, delay=(0.0, 0.1), noise=[0.1, 0.0])
    shares = np.column_stack([draws.parameters, draws.delay])
    for values, (low, high) in zip(shares.T, [(1.0, 2.0), (0.0, 0.5), (0.0, 0.1)], strict=True):
        assert sorted(np.floor((values - low) / (high - low) * 20).astype(int)) == list(range(20))
    assert draws.noise.shape == (20, 1_000, 2)
    assert abs(draws.noise[..., 0].std() - 0.1) < 2e-3  # 20000 samples: 5 standard errors are 2.5e-3
    assert not draws.noise[..., 1].any()
    again = random_draws(cart(), np.random.default_rng(3), 20, delay=(0.0, 0.1), noise=[0.1, 0.0])
    assert again.parameters.tobytes() == draws.parameters.tobytes()
    assert again.noise.tobytes() == draws.noise.tobytes()


def test_arrays_are_read_only_and_copied():
    vectors = np.ones((3, 2))
    draws = pickle.loads(pickle.dumps(Draws(vectors)))
    vectors[0] = 9.0
    assert draws.parameters.max() == 1.0
    with pytest.raises(ValueError, match="read-only"):
        Draws(vectors).parameters[0] = 1.0


WRONG = {
    "delays": (lambda: Draws(np.ones((3, 2)), delay=[0.1]), "the draws' delay has shape (1,); expected (3,)"),
    "negative": (lambda: Draws(delay=[-0.1]), "delay must be at least 0 s, got -0.1"),
    "nan": (lambda: Draws(np.full((3, 2), np.nan)), "the draws' parameters holds NaN or infinity"),
    "flat": (lambda: Draws([1.0, 2.0]), "the draws' parameters has shape (2,)"),
    "text": (lambda: Draws(delay="soon"), "the draws' delay must hold numbers"),
    "table": (lambda: Draws(tables=[2, 0], noise=np.zeros((2, 1, 2))), "2 integers from 0 to 1"),
    "fraction": (lambda: Draws(tables=[0.5], noise=np.zeros((2, 1, 2))), "1 integers from 0 to 1"),
    "no ticks": (lambda: Draws(noise=np.zeros((2, 0, 2))), "at least one tick and one state"),
    "count": (lambda: problem(draws=Draws(np.ones((2, 2)))), "2 draws for 3 starts"),
    "width": (lambda: problem(draws=Draws(np.ones((3, 1)))), "1 plant parameters; cart has 2"),
    "states": (lambda: problem(draws=Draws(noise=np.zeros((3, 1, 3)))), "expected (K, T, 2)"),
    "held": (lambda: problem(draws=Draws(delay=[0.1] * 3), hold=False), "a delay needs hold=True"),
    "ragged delay": (
        lambda: Draws(delay=[[0.1], [0.1, 0.2]]),
        "delay must hold numbers in rows of equal length",
    ),
    "ragged table": (lambda: Draws(tables=[[0], [0, 1]]), "tables must hold numbers in rows of equal length"),
    "ragged starts": (lambda: crossed([[0.0], [0.0, 1.0]], Draws()), "starts must hold numbers"),
    "nan table": (lambda: Draws(tables=[np.nan]), "1 integers from 0 to 0"),
    "endless": (lambda: problem(draws=Draws(delay=[1e12] * 3)), "longer than the horizon, 30.0 s"),
    "other": (lambda: problem(draws=0.1), "draws must be Draws or None, got 0.1"),
    "noise": (
        lambda: random_draws(cart(), np.random.default_rng(1), 2, noise=[-1.0, 0.0]),
        "standard deviation must be at least 0",
    ),
    "noises": (lambda: random_draws(cart(), np.random.default_rng(1), 2, noise=[1.0]), "expected (2,)"),
}


@pytest.mark.parametrize(("make", "message"), WRONG.values(), ids=WRONG)
def test_wrong_draws_are_an_error(make, message):
    with pytest.raises(ProblemError, match=re.escape(message)):
        make()
