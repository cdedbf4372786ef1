"""Plans for each plant, driven by integrators that know its equations and nothing else."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from applications.rosbot.certificate import certify
from applications.rosbot.model import FAMILY, car, dynamic_unicycle, unicycle
from applications.rosbot.planner import Effort, plan_scenario
from applications.rosbot.polar_law import SATURATING, polar_law
from applications.rosbot.problems import PERIOD
from applications.rosbot.replay import replay
from applications.rosbot.scenario import Scenario
from applications.rosbot.stabilizer import default_law
from applications.rosbot.vehicles import features_for, law_for
from gpsynth.errors import ScenarioError
from gpsynth.planning import PlanSettings

QUICK = Effort(
    points=6,
    scouts=PlanSettings(particles=32, iterations=12, rounds=2),
    chasers=PlanSettings(particles=32, iterations=12, rounds=3),
    refiners=PlanSettings(particles=24, iterations=10, rounds=2),
    chased=2,
    refined=1,
)
CIRCLE = [[1.5, 0.05, 0.0, 0.0, 0.3]]
CAR = {"model": "car", "turning_radius": 0.6, "turn_limits": (-1.0, 1.0)}
PLANTS = {"unicycle": {}, "lags": {"model": "dynamic_unicycle"}, "car": CAR}


def scene(**changes) -> Scenario:
    return Scenario(
        **{"start": [0.0, 0.0, 0.0], "goal": [3.0, 0.5, 0.3], "circles": CIRCLE, "time_limit": 40.0} | changes
    )


def integrated(scenario: Scenario, controls: np.ndarray) -> np.ndarray:
    """Poses (n, 3) by an adaptive method under held controls, from the plant's own equations."""
    plant = {
        "unicycle": unicycle(),
        "dynamic_unicycle": dynamic_unicycle(),
        "car": car(turning_radius=scenario.turning_radius or 1.0),
    }[scenario.model]
    state = np.append(scenario.start, scenario.speeds)[: len(plant.state_names)]
    poses = [state]
    for control in controls:
        rates = lambda _, x, u=control: plant.dynamics(np.array([[*x, *u, 0.0]]), plant.nominal)[0]  # noqa: E731
        solved = solve_ivp(
            rates, (0.0, PERIOD), state, rtol=1e-7, atol=1e-9, max_step=0.025, t_eval=[0.025, PERIOD]
        )
        poses += list(solved.y.T)
        state = solved.y[:, -1]
    return np.array(poses)[:, :3]


@pytest.mark.parametrize("speed_limits", [(-0.15, 0.5), (-0.5, 0.2)])
@pytest.mark.parametrize("plant", PLANTS.values(), ids=PLANTS)
def test_each_plant_gets_a_plan_within_unequal_limits(plant, speed_limits):
    scenario = scene(**plant | {"speed_limits": speed_limits})
    report = plan_scenario(scenario, [default_law()], seed=0, effort=QUICK)
    assert report.status == "planned", report.reason
    v, omega = report.controls.T
    assert speed_limits[0] <= v.min() <= v.max() <= speed_limits[1]
    low, high = scenario.turn_limits
    assert low <= omega.min() <= omega.max() <= high
    poses = integrated(scenario, report.controls)
    assert np.hypot(*(poses[-1] - scenario.goal)[:2]) < scenario.position_tolerance + 0.03  # a period goes by
    gaps = np.hypot(poses[:, 0] - 1.5, poses[:, 1] - 0.05) - 0.45
    assert 0.0 <= report.certificate.clearance <= gaps.min() + 1e-6
    if scenario.model == "car":
        assert np.all(np.abs(omega) <= np.abs(v) / 0.6 + 1e-12)


def test_a_robot_with_lags_is_planned_for_on_its_way_with_the_speeds_it_has():
    scenario = scene(model="dynamic_unicycle")
    report = plan_scenario(scenario, [default_law()], seed=0, effort=QUICK)
    state = report.plan.trajectory.x[20]
    here = replace(scenario, start=state[:3], speeds=tuple(state[3:]))
    assert here.speeds[0] > 0.4
    left = replay(here, report.controls[20:], PERIOD)
    assert left.trajectory[-1, 1:] == pytest.approx(report.replay.trajectory[-1, 1:], abs=1e-4)
    later = plan_scenario(here, [default_law()], effort=QUICK, previous=report, elapsed=20 * PERIOD)
    assert later.status == "planned"
    assert later.replay.arrival_time < report.replay.arrival_time - 20 * PERIOD + 1e-3
    assert later.certificate.clearance <= later.replay.clearance


@pytest.mark.parametrize("speeds", [(0.0, 0.0), (0.45, -0.5)])
def test_the_replay_of_lags_is_what_an_adaptive_integrator_finds(speeds):
    scenario = scene(model="dynamic_unicycle", goal=[50.0, 0.0, 0.0], speeds=speeds)
    rng = np.random.default_rng(3)
    controls = np.repeat(rng.uniform(-0.5, 0.5, (12, 2)), rng.integers(1, 9, 12), axis=0)
    found = replay(scenario, controls, PERIOD).trajectory
    assert found[-1, 1:] == pytest.approx(integrated(scenario, controls)[-1], abs=2e-6)
    assert np.max(np.diff(found[:, 0])) <= 1e-3 + 1e-12


def test_a_certificate_of_lags_is_below_every_sample():
    for seed in range(5):
        rng = np.random.default_rng(seed)
        scenario = scene(
            model="dynamic_unicycle",
            goal=[50.0, 0.0, 0.0],
            circles=rng.uniform(1.0, 2.0, (6, 5)) * [1, 1, 0, 0, 0.1],
        )
        controls = np.repeat(rng.uniform(-0.5, 0.5, (8, 2)), 10, axis=0)
        proof = certify(scenario, controls, PERIOD)
        track = integrated(scenario, controls)
        gaps = (
            np.hypot(*(track[:, None, :2] - scenario.circles[:, :2]).transpose(2, 0, 1))
            - scenario.discs[:, 2]
        )
        assert proof.clearance <= gaps.min() + 1e-6
        assert gaps.min() - proof.clearance < 0.013  # samples half a period apart


def test_a_car_is_not_replayed_through_turns_that_are_too_sharp():
    sharp, wide = np.array([[0.5, 0.9]]), np.array([[0.5, 0.8]])
    scenario = scene(**CAR | {"goal": [50.0, 0.0, 0.0]})
    assert not replay(scenario, sharp, 0.1).in_limits
    assert replay(scenario, wide, 0.1).in_limits


def test_a_law_sees_the_same_of_a_plant_with_more_states():
    law, plant = polar_law(unicycle(), SATURATING), dynamic_unicycle()
    carried = law_for(law, plant)
    x, target = np.array([0.1, -0.2, 0.3, 9.0, 8.0]), np.array([1.0, 2.0, -0.4, 7.0, 6.0])
    assert np.array_equal(carried(x, target), law(x[:3], target[:3]))
    assert features_for(law.features, plant).inputs[:5] == plant.state_names


def test_at_rest_the_lags_end_where_the_commands_lead():
    gain, _, most = (FAMILY[name][3] for name in ("k_omega", "tau_omega", "a_omega"))
    scenario = scene(model="dynamic_unicycle", goal=[50.0, 0.0, 0.0], circles=np.zeros((0, 5)))
    track = replay(scenario, np.array([[0.0, 0.5]] * 60), PERIOD).trajectory
    (before, _, _, turned), (after, _, _, later) = track[-200], track[-1]
    assert (later - turned) / (after - before) == pytest.approx(0.5 * gain, abs=1e-6)
    early = track[track[:, 0] <= 0.05]
    assert early[-1, 3] == pytest.approx(0.5 * most * early[-1, 0] ** 2, abs=1e-9)


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"model": "boat"}, "the model is 'boat'; expected unicycle, dynamic_unicycle, car"),
        ({"model": "car"}, "the car's turning radius is 0 m; expected more than 0"),
        ({"turning_radius": 0.5}, "a unicycle has the turning radius 0.5 m; expected none"),
    ],
)
def test_a_plant_that_makes_no_sense_is_refused(changes, sentence):
    with pytest.raises(ScenarioError, match=sentence):
        scene(**changes)


def test_a_plan_of_a_robot_with_other_states_is_no_way_to_begin():
    before = plan_scenario(scene(), [default_law()], effort=QUICK)
    lagging = scene(model="dynamic_unicycle")
    after = plan_scenario(lagging, [default_law()], effort=QUICK, previous=before, elapsed=0.5)
    anew = plan_scenario(lagging, [default_law()], effort=QUICK)
    assert np.array_equal(after.controls, anew.controls)
