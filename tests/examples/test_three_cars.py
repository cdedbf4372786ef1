"""The cars that park: how far bodies overlap, and what their paths depend on."""

import numpy as np
import pytest

import gpsynth as gs
from examples import car_like, parking, swing_up, three_cars
from examples.rectangles import overlap
from gpsynth.arrays import Floats
from gpsynth.builder import Builder
from gpsynth.command_line import run
from tests.bench.three_cars_contact import body, common_area


@pytest.fixture(scope="module")
def park() -> gs.Law:
    """A steering law that turns into the lane, as the search might find it."""

    def steer(seen):
        return 6.0 * np.maximum(np.minimum(seen.begin, seen.heading) + 50.0 * seen.turn, seen.heading)

    program = gs.trace(steer, [("seen", parking.problem.features.names)], ("steer",))
    return gs.Law(parking.plant, parking.problem.features, program, np.empty(0))


def placed(x: Floats, y: Floats, theta: Floats) -> Floats:
    """The depth of a body at many poses in one at the origin."""
    poses = np.column_stack([x, y, theta])
    traced = gs.trace(
        lambda a: overlap((a.x, a.y, a.theta), (0.0, 0.0, 0.3), (2.0, 1.0), (2.0, 1.0)),
        [("a", ("x", "y", "theta"))],
    )
    return traced(poses)[:, 0]


def test_bodies_overlap_where_clipped_polygons_have_a_common_area():
    rng = np.random.default_rng(0)
    x, y, theta = rng.uniform(-5.0, 5.0, 500), rng.uniform(-4.0, 4.0, 500), rng.uniform(-np.pi, np.pi, 500)
    areas = [common_area(body(*pose), body(0.0, 0.0, 0.3)) for pose in zip(x, y, theta, strict=True)]
    np.testing.assert_array_equal(placed(x, y, theta) > 0.0, np.array(areas) > 0.0)
    assert 0.2 < np.mean(np.array(areas) > 0.0) < 0.8


def test_common_area_of_shifted_bodies_is_that_of_a_rectangle():
    assert common_area(body(0.0, 0.0, 0.0), body(1.0, 0.5, 0.0)) == pytest.approx(3.0 * 1.5)
    assert common_area(body(0.0, 0.0, 0.0), body(0.0, 2.0, 0.0)) == 0.0


def test_three_cars_move_as_one_car_does_times_their_share(park):
    plant, rng = three_cars.cars(park), np.random.default_rng(1)
    states, shares = rng.uniform(-8.0, 8.0, (50, 9)), rng.uniform(0.0, 1.0, (50, 3))
    rates = plant.dynamics(np.hstack([states, shares, np.zeros((50, 1))]))
    for k, place in enumerate(three_cars.PLACES):
        pose = states[:, 3 * k : 3 * k + 3] - (place, 0.0, 0.0)
        alone = parking.plant.dynamics(np.hstack([pose, park(pose, np.zeros(3)), np.zeros((50, 1))]))
        np.testing.assert_allclose(
            rates[:, 3 * k : 3 * k + 3], alone * shares[:, [k]], rtol=1e-12, atol=1e-12
        )


def test_car_from_the_right_is_the_mirror_image(park):
    rng = np.random.default_rng(2)
    poses = rng.uniform((-9.0, 1.0, -1.0), (-1.0, 5.0, 1.0), (50, 3))
    mirrored = poses * (-1.0, 1.0, -1.0)
    rates, others = (
        parking.plant.dynamics(np.hstack([pose, park(pose, np.zeros(3)), np.zeros((50, 1))]))
        for pose in (poses, mirrored)
    )
    np.testing.assert_allclose(rates * (-1.0, 1.0, -1.0), others, rtol=1e-12, atol=1e-12)


def test_other_side_of_the_lane_changes_the_signs_that_the_search_is_told():
    rng = np.random.default_rng(4)
    errors = rng.uniform((-9.0, 0.01, -3.0), (9.0, 6.0, 3.0), (50, 3))
    seen, mirrored = (
        np.column_stack(list(parking.sight(*pose.T).values()))
        for pose in (errors, errors * (1.0, -1.0, -1.0))
    )
    signs = [1.0 if parking.SIGNS[name] == "+" else -1.0 for name in parking.problem.features.names]
    np.testing.assert_allclose(mirrored, seen * signs, rtol=1e-12, atol=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize(
    "module", [swing_up, parking, three_cars, car_like], ids=lambda module: module.__name__
)
def test_short_run_writes_the_exports_of_every_law(module, tmp_path):
    assert run(module.main, [str(tmp_path), "--budget", "400", "--tuning", "10"], name="example") == 0
    laws = {path.name for path in tmp_path.glob("*.json")}
    assert "law.json" in laws
    assert len(list(tmp_path.iterdir())) == 6 * len(laws)
    for name in laws:
        assert gs.Law.load(tmp_path / name).parameters.dtype == np.float64


def test_weak_force_cannot_lift_the_pole_at_once():
    """From hanging, a steady push: the pole turns back long before it is level with the cart."""
    builder = Builder(("position", "speed", "angle", "rate"))
    program = builder.build([builder.constant(1.0)], ("push",))
    problem = gs.Problem(
        swing_up.plant,
        [(0, 0, np.pi, 0)],
        np.zeros(4),
        tolerance=0.05,
        horizon=1.0,
        period=0.01,
        features=swing_up.motion,
    )
    law = gs.Law(swing_up.plant, problem.features, program, np.empty(0))
    path = gs.simulate(problem, law)
    hanging = np.abs(gs.wrap_angle(path.x[:, 2] - np.pi))
    assert hanging.max() < np.pi / 2
    assert hanging.argmax() < len(hanging) - 1


def test_push_changes_the_energy_by_its_work():
    """Kinetic and potential energy of cart and pole, differentiated numerically, against force times speed."""
    heavy, light, rod, g = swing_up.CART, swing_up.POLE, swing_up.LENGTH, swing_up.GRAVITY

    def energy(x: Floats) -> Floats:
        _, v, theta, omega = x.T
        along, up = v + rod * omega * np.cos(theta), -rod * omega * np.sin(theta)
        return heavy * v**2 / 2 + light * (along**2 + up**2) / 2 + light * g * rod * np.cos(theta)

    rng = np.random.default_rng(3)
    states, push = rng.uniform(-2.0, 2.0, (50, 4)), rng.uniform(-1.0, 1.0, (50, 1))
    rates = swing_up.plant.dynamics(np.hstack([states, push, np.zeros((50, 1))]))
    power = (energy(states + 1e-6 * rates) - energy(states - 1e-6 * rates)) / 2e-6
    np.testing.assert_allclose(power, swing_up.FORCE * push[:, 0] * states[:, 1], rtol=1e-6, atol=1e-6)
