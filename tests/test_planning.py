"""Stage 2 for any plant: the cost, its rounds, and what a plan promises."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from gpsynth.draws import Draws
from gpsynth.errors import ProblemError
from gpsynth.evaluate import Evaluator
from gpsynth.law import Law
from gpsynth.obstacles import Obstacles
from gpsynth.optimizers import PSO, DifferentialEvolution, minimize
from gpsynth.planning import Objective, PlanSettings, plan, plans
from gpsynth.planning.literal import plan_literally
from gpsynth.planning.rounds import rescored, vectors_of
from gpsynth.plant import Plant
from gpsynth.problem import Problem
from gpsynth.rollouts import Rollouts
from gpsynth.schedule import Schedule, Schedules
from gpsynth.simulation import simulate
from gpsynth.tracing import trace

SMALL = PlanSettings(points=2, particles=32, iterations=10, rounds=6)


def point_robot() -> tuple[Problem, Law]:
    """A point with bounded velocity, drawn to its target; a disc stands in the straight way to the goal."""
    plant = Plant(
        lambda x, u: (u.a, u.b),
        states={"x": "m", "y": "m"},
        controls={"a": ("m/s", -1.0, 1.0), "b": ("m/s", -1.0, 1.0)},
        name="point",
    )
    obstacles = Obstacles(circles=np.array([[2.0, 0.0, 0.0, 0.0, 0.5]]), radius=0.1)
    problem = Problem(
        plant, [0.0, 0.0], [4.0, 0.0], tolerance=[0.05, 0.05], horizon=12.0, period=0.05, obstacles=obstacles
    )
    names = problem.features.names
    program = trace(lambda seen: (4.0 * seen[0], 4.0 * seen[1]), [("seen", names)], ("a", "b"))
    return problem, Law(plant, problem.features, program, np.empty(0))


@pytest.fixture(name="setting")
def _setting() -> tuple[Problem, Law]:
    return point_robot()


def objective(setting: tuple[Problem, Law], settings: PlanSettings, budget: float) -> Objective:
    return Objective(Evaluator(setting[0], margin=settings.margin), setting[1], settings, budget)


def test_a_round_that_is_broken_off_gives_the_best_of_what_was_tried(setting):
    settings = replace(SMALL, particles=300, rounds=1)
    rng = np.random.default_rng(1)
    tried = Schedules(rng.uniform(-1.0, 5.0, (300, 2, 2)), rng.uniform(0.0, 2.0, (300, 2)))
    costs = objective(setting, settings, 12.0)(vectors_of(tried, settings))
    for asked, evaluations in enumerate((0, 128, 256, 300)):
        answers = iter([False] * asked + [True] * 9)
        [found] = plans(*setting, settings, initial=tried, budget=12.0, stop=lambda: next(answers))  # noqa: B023
        assert found.evaluations == evaluations
        assert found.cost == (costs[:evaluations].min() if evaluations else costs[0])


def test_a_search_that_is_never_stopped_is_the_same(setting):
    free = list(plans(*setting, SMALL, seed=1))
    asked = list(plans(*setting, SMALL, seed=1, stop=lambda: False))
    assert [each.cost for each in free] == [each.cost for each in asked]
    assert np.array_equal(free[-1].schedule.points, asked[-1].schedule.points)


def test_a_plan_reaches_the_goal_around_the_obstacle(setting):
    found = plan(*setting, SMALL, seed=1)
    assert found.is_free
    assert found.clearance >= SMALL.margin
    # the shortest way around a disc of 0.6 m at 1 m/s along each axis cannot beat the straight 3.95 m along x
    assert 3.95 <= found.arrival_time < 4.3
    assert found.trajectory.t[-1] - setting[0].period <= found.arrival_time <= found.trajectory.t[-1]


def test_the_plan_is_what_its_schedule_does(setting):
    found = plan(*setting, SMALL, seed=1)
    again = simulate(*setting, schedule=found.schedule)
    assert np.array_equal(again.u, found.trajectory.u)
    assert again.clearance == found.clearance


def test_a_plan_holds_under_the_draw_it_was_made_for(setting):
    problem, law = setting
    late = replace(problem, draws=Draws(delay=[0.1], noise=np.full((1, 1, 2), 0.01)))
    found = plan(late, law, SMALL, seed=1)
    assert found.is_free
    assert found.trajectory.arrival - 0.05 < found.arrival_time <= found.trajectory.arrival
    again = simulate(late, law, schedule=found.schedule)
    assert np.array_equal(again.x, found.trajectory.x)
    assert not np.any(again.x[:3])  # nothing moves before the first command arrives
    assert np.all(again.x[3])


def test_the_same_seed_gives_the_same_plan_for_any_number_of_threads(setting):
    one = plan(*setting, replace(SMALL, particles=200, rounds=2), seed=3)
    two = plan(*setting, replace(SMALL, particles=200, rounds=2), seed=3, threads=2)
    assert np.array_equal(one.schedule.points, two.schedule.points)
    assert one.history == two.history


def test_the_time_budget_only_tightens_and_ends_at_the_plan(setting):
    found = plan(*setting, SMALL, seed=2)
    times = [budget for _, budget in found.history]
    assert times[0] == setting[0].horizon
    assert all(later <= earlier for earlier, later in pairwise(times))
    assert times[-1] == found.arrival_time


@pytest.mark.parametrize("seed", range(8))
def test_a_plan_once_found_is_never_lost(setting, seed):
    seen = []
    # with equal dwell times a new T+ moves the switching times, so that old plans can fail
    equal = replace(SMALL, dwell=None, particles=12, iterations=4, rounds=8)
    plan(*setting, equal, seed=seed, callback=lambda each: seen.append(each.rank))
    assert len(seen) == 10  # of 1, 2 and 7 times 4 generations, and one is left
    assert all(later <= earlier for earlier, later in pairwise(seen))


def test_personal_bests_are_scored_anew_under_a_tighter_budget(setting):
    settings = replace(PlanSettings.paper(2, particles=16), obstacles="path")  # equal dwell times follow T+
    loose, tight = (objective(setting, settings, budget) for budget in (12.0, 6.0))
    lower, upper = np.tile([-1.0, -3.0], 2), np.tile([5.0, 3.0], 2)
    found = minimize(loose, PSO(lower, upper, size=16), seed=1, budget=64)
    start = rescored(found, tight)
    assert np.array_equal(start.state.best_costs, tight(found.state.best_x))
    assert not np.array_equal(start.state.best_costs, found.state.best_costs)
    assert start.evaluations == 64 + 16
    assert start.history == ()


def test_the_callback_stops_the_search(setting):
    found = plan(*setting, SMALL, seed=1, callback=lambda each: True)
    assert len(found.history) == 2


def test_an_initial_schedule_is_not_made_worse(setting):
    good = plan(*setting, SMALL, seed=1)
    again = plan(*setting, replace(SMALL, rounds=1, iterations=1), seed=9, initial=[good.schedule])
    assert again.arrival_time <= good.arrival_time


def test_cma_es_refines_as_well(setting):
    good = plan(*setting, replace(SMALL, rounds=1), seed=1)
    refiner = replace(SMALL, optimizer="cmaes", particles=12, iterations=20, rounds=2)
    refined = plan(*setting, refiner, seed=1, initial=[good.schedule])
    assert refined.is_free
    assert refined.arrival_time <= good.arrival_time


def test_differential_evolution_plans_as_well(setting):
    found = plan(*setting, replace(SMALL, optimizer="shade"), seed=1)
    assert found.is_free
    assert found.arrival_time < 4.3
    assert len(found.particles.costs) == SMALL.particles


def test_a_population_is_scored_anew_under_a_tighter_budget(setting):
    settings = replace(PlanSettings.paper(2, particles=16), obstacles="path")
    loose, tight = (objective(setting, settings, budget) for budget in (12.0, 6.0))
    lower, upper = np.tile([-1.0, -3.0], 2), np.tile([5.0, 3.0], 2)
    found = minimize(loose, DifferentialEvolution(lower, upper, size=16), seed=1, budget=64)
    start = rescored(found, tight)
    assert np.array_equal(start.state.costs, tight(found.state.x))
    assert not np.array_equal(start.state.costs, found.state.costs)
    assert start.evaluations == 64 + 16


def test_algorithm_1_taken_literally_scores_one_candidate_after_the_other(setting):
    """The same as a loop over single candidates that lowers T+ whenever one arrives sooner."""
    settings = PlanSettings.paper(2, particles=16)
    swarm = PSO.seed(np.tile([-1.0, -3.0], 2), np.tile([5.0, 3.0], 2), size=16)
    now, spent, history, best = objective(setting, settings, 12.0), 0, [(0, 12.0)], (np.inf, None)

    def one_by_one(vectors):
        nonlocal now, spent, best
        costs = np.empty(len(vectors))
        for index, vector in enumerate(vectors):
            costs[index] = now(vector[np.newaxis])[0]
            best = min(best, (costs[index], now.schedule(vector)), key=lambda pair: pair[0])
            used = now.rollouts(*now.schedules(vector[np.newaxis])).arrival[0, 0]
            spent += 1
            if used < now.budget:
                now = replace(now, budget=float(used))
                history.append((spent, used))
        return costs

    minimize(one_by_one, swarm, seed=3, path=(0,), budget=320)
    found = plan_literally(objective(setting, settings, 12.0), swarm, seed=3, evaluations=320)
    assert len(history) > 3
    assert found.history == tuple(history)
    assert found.budget == now.budget
    assert found.cost == best[0]
    assert np.array_equal(found.schedule.points, best[1].points)
    assert np.array_equal(found.schedule.dwell, best[1].dwell)


def test_the_paper_cost_is_equation_17(setting):
    settings = PlanSettings.paper(2)
    cost = objective(setting, settings, budget=6.0)
    inside, outside = [2.0, 0.1], [2.0, 1.0]
    vectors = np.array([[*inside, *outside], [*outside, *outside]])
    points, dwell = cost.schedules(vectors)
    assert np.array_equal(dwell, np.full((2, 2), 2.0))  # T+ / 3, the goal being the third point
    rollouts = cost.rollouts(points, dwell)
    used = np.where(np.isinf(rollouts.arrival), rollouts.end, cost.arrivals(rollouts)[:, None])[:, 0]
    error = np.linalg.norm(rollouts.final[:, 0] - [4.0, 0.0], axis=1)
    expected = 10.0 * error + 0.25 * (np.maximum(0.0, used - 6.0) + used / 6.0) + 5.0 * np.array([1.0, 0.0])
    assert np.allclose(cost(vectors), expected, rtol=1e-15, atol=0.0)


def test_equation_17_by_hand_when_late_and_with_the_heading_wrapped():
    plant = Plant(
        lambda x, u: (u.a, u.b, u.c),
        states={"x": "m", "y": "m", "theta": "rad"},
        controls=dict.fromkeys(("a", "b", "c"), ("1/s", -1.0, 1.0)),
        angles=("theta",),
        name="turning point",
    )
    problem = Problem(plant, [0.0, 0.0, 0.0], [1.0, 1.0, 3.0], tolerance=[0.1, 0.1, 0.1])
    names = problem.features.names
    program = trace(lambda seen: (seen[0], seen[1], seen[2]), [("seen", names)], ("a", "b", "c"))
    law = Law(plant, problem.features, program, np.empty(0))
    cost = objective((problem, law), PlanSettings(points=1), budget=5.0)
    one = np.ones((1, 1))
    rollouts = Rollouts(
        arrival=np.inf * one,
        end=8.0 * one,  # T_used, 3 s more than T+
        cost=0.0 * one,
        clearance=-0.1 * one,
        exposure=0.5 * one,
        depth=0.02 * one,
        diverged=0.0 * one,
        share=0.0 * one,
        terminal=np.zeros((1, 1, 0)),
        final=np.array([[[4.0, 5.0, -3.0]]]),  # 3 m and 4 m off, and -6 rad, which is 2 pi - 6
    )
    by_hand = 10.0 * np.sqrt(25.0 + (2.0 * np.pi - 6.0) ** 2) + 0.25 * (3.0 + 8.0 / 5.0) + 5.0 * 1.96
    assert cost.costs(rollouts, np.zeros((1, 1, 3)))[0] == pytest.approx(by_hand, rel=1e-14)


def test_the_path_counts_where_points_are_clear(setting):
    straight = np.array([[1.0, 0.0, 3.0, 0.0, 1.0, 2.0]])
    detour = np.array([[2.0, 0.9, 3.0, 0.7, 1.5, 1.0]])
    on_path = objective(setting, SMALL, budget=6.0)
    on_points = objective(setting, replace(SMALL, obstacles="points"), budget=6.0)
    assert on_path(straight) > on_path(detour) + SMALL.gamma
    assert (
        on_points(straight) < 1.0 < SMALL.gamma
    )  # arrived straight through the disc, and no point lies in it


def test_arrival_is_found_between_the_control_periods(setting):
    problem, law = setting
    settings = replace(SMALL, points=1)
    vector = np.array([[1.0, 3.0, 1.6]])
    coarse = objective((problem, law), settings, budget=12.0)
    points, dwell = coarse.schedules(vector)
    fine_problem = Problem(
        problem.plant,
        problem.starts,
        problem.goal,
        tolerance=problem.tolerance,
        horizon=12.0,
        period=0.05,
        step=0.05,
    )
    fine = simulate(fine_problem, law, schedule=Schedule(points[0], dwell[0]))
    time = coarse.arrivals(coarse.rollouts(points, dwell))[0]
    # the last period is replayed by hand: the state is linear in time while the control is held
    share = np.linspace(0.0, 1.0, 100_001)[:, None]
    last = fine.x[-2] + share * (fine.x[-1] - fine.x[-2])
    inside = np.max(np.abs(last - problem.goal) / problem.tolerance, axis=1) <= 1.0
    exact = fine.t[-2] + 0.05 * share[np.argmax(inside), 0]
    assert abs(time - exact) < 1e-4  # the largest error is linear in time once the point moves along one axis


def test_cost_does_not_depend_on_what_else_is_evaluated(setting):
    cost = objective(setting, SMALL, budget=6.0)
    vectors = np.random.default_rng(4).uniform(0.1, 3.0, (70, 6))
    together = cost(vectors)
    assert np.array_equal(together[17:18], cost(vectors[17:18]))


@pytest.mark.parametrize("top_speed", [np.inf, np.sqrt(2.0)])
def test_a_rollout_that_is_cut_short_costs_more_than_its_limit_and_others_the_same(setting, top_speed):
    cost = objective(setting, replace(SMALL, top_speed=top_speed), budget=4.5)
    vectors = np.random.default_rng(5).uniform(
        [-1.0, -2.0] * 2 + [0.0] * 2, [5.0, 2.0] * 2 + [3.0] * 2, (400, 6)
    )
    full = cost(vectors)
    limits = np.random.default_rng(6).permutation(full)
    cut = cost(vectors, limits)
    assert np.array_equal(cut[full <= limits], full[full <= limits])
    assert np.all(cut[full > limits] > limits[full > limits])
    points, dwell = cost.schedules(vectors)
    ends = [cost.rollouts(points, dwell, given).end.sum() for given in (None, limits)]
    assert ends[1] < 0.9 * ends[0]


def test_swarms_side_by_side_find_what_one_finds(setting):
    first = plan(*setting, replace(SMALL, swarms=3), seed=1)
    assert first.is_free
    assert len(first.particles.schedules) == len(first.particles.costs) == 3 * SMALL.particles
    # the last T+ is the arrival time of the best, whose cost is beta under it
    assert first.particles.costs.min() == pytest.approx(SMALL.beta, rel=1e-12)


def test_what_does_not_fit_is_said(setting):
    problem, law = setting
    with pytest.raises(
        ProblemError, match=r"an initial schedule has points of shape \(1, 2\); expected \(2, 2\)"
    ):
        plan(problem, law, SMALL, initial=[Schedule(np.zeros((1, 2)), np.ones(1))])
    with pytest.raises(ProblemError, match="a plan begins at one start; the problem has 2"):
        plan(Problem(problem.plant, np.zeros((2, 2)), [4.0, 0.0], tolerance=[0.1, 0.1]), law, SMALL)
    with pytest.raises(ProblemError, match=r"adapt the law by law.with_limits"):
        plan(problem, law.with_limits([-2.0, -2.0], [2.0, 2.0]), SMALL)
    with pytest.raises(ProblemError, match="rounds of a plan must be an integer of at least 1, not 0"):
        PlanSettings(rounds=0)
    with pytest.raises(ProblemError, match="dwell is"):
        PlanSettings(dwell=(2.0, 1.0))
