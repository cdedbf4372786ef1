"""Plans through places that must be passed on the way, one leg after the other."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from applications.rosbot.certificate import certify
from applications.rosbot.planner import PlanReport, plan_scenario
from applications.rosbot.problems import PERIOD
from applications.rosbot.reachability import reachability
from applications.rosbot.replay import replay
from applications.rosbot.scenario import MOST, Scenario
from applications.rosbot.sensing import moved
from applications.rosbot.swarms import Effort
from applications.rosbot.vehicles import steered
from gpsynth.arrays import Floats
from gpsynth.checks import check_kind
from gpsynth.errors import ScenarioError
from gpsynth.law import Law
from gpsynth.planning import Plan
from gpsynth.schedule import Schedule
from gpsynth.simulation import Trajectory

ANY_HEADING = 4.0  # rad, more than half a turn


@dataclass(frozen=True, eq=False)
class _Leg:
    """What one leg adds: a schedule whose last point is where it leads, and the path at the ticks up to there."""

    points: Floats  # (k, 3)
    dwell: Floats  # (k,) s; in all as long as the leg
    path: Trajectory


def plan_through(
    scenario: Scenario,
    via: npt.ArrayLike,
    law: Law,
    *,
    seed: int = 0,
    effort: Effort = Effort(),
    threads: int = 1,
) -> PlanReport:
    """A plan that comes within the third number (m) of every place in `via` (m, 3), in their order, and then arrives.

    Each leg is planned by itself, in least time and with any heading at its end; the whole is replayed and certified.
    What `effort` allows is for all legs: each gets an equal share of what is left. Where a leg has no plan, the reason
    says which. Raises ScenarioError if a place is out of bounds or its tolerance not positive, and KeyboardInterrupt if
    Ctrl-C ends a leg.
    """
    through = check_via(scenario, via)
    check_kind("law", law, Law, error=ScenarioError)
    check_kind("effort", effort, Effort, error=ScenarioError)
    headings = _headings(scenario, through)
    legs, spent, now = list[_Leg](), 0, scenario
    places = tuple(map(tuple, through.tolist()))
    report = PlanReport("not_found", "", 0.0, 0, scenario, seed, via=places)
    for number in range(len(through) + 1):
        goal = scenario.goal if number == len(through) else np.append(through[number, :2], headings[number])
        widths = (through[number, 2], ANY_HEADING) if number < len(through) else _tolerance(scenario)
        leg = replace(now, goal=goal, position_tolerance=float(widths[0]), heading_tolerance=widths[1])
        share = _share(effort, report, len(through) + 1 - number)
        found = plan_scenario(leg, [law], seed=seed, effort=share, threads=threads)
        spent += found.evaluations
        report = replace(
            report,
            evaluations=spent,
            planning_time=report.planning_time + found.planning_time,
            ended=found.ended,
        )
        if found.ended == "interrupted":
            raise KeyboardInterrupt
        if found.plan is None:
            where = f"via-point {number}" if number < len(through) else "the goal"
            status, reason = found.status, f"on the way to {where}: {found.reason.replace('the goal', where)}"
            if number and reachability(leg).status != "unreachable":
                status = "not_found"  # too late is only what the legs so far have left no time for
            return replace(report, status=status, reason=reason, plan=None, law=None)
        legs.append(_leg(found, goal))
        now = _later(now, legs[-1])
        report = replace(report, plan=found.plan, law=found.law)
    return _joined(report, legs, through)


def check_via(scenario: Scenario, via: npt.ArrayLike) -> Floats:
    """The places as an array (m, 3); raises ScenarioError if one cannot be passed."""
    check_kind("scenario", scenario, Scenario, error=ScenarioError)
    if scenario.model == "dynamic_unicycle":
        raise ScenarioError("via-points are for robots without lags")
    try:
        places = np.asarray(via, dtype=np.float64)
    except (TypeError, ValueError):
        places = np.empty(0)
    if places.ndim != 2 or places.shape[1] != 3:
        raise ScenarioError(f"via-points are rows of x, y and tolerance in m, got {via!r}")
    low, high = scenario.bounds[[0, 2]], scenario.bounds[[1, 3]]
    for number, (x, y, tolerance) in enumerate(places):
        if not np.all(np.abs(places[number]) <= MOST):
            raise ScenarioError(
                f"via-point {number} is {places[number].tolist()}; expected finite numbers within ±{MOST:g}"
            )
        if not tolerance > 0.0:
            raise ScenarioError(f"via-point {number} has tolerance {tolerance:g} m; expected more than 0")
        if np.any((places[number, :2] < low) | (places[number, :2] > high)):
            raise ScenarioError(f"via-point {number} ({x:g}, {y:g}) lies outside the bounds")
    return places


def _share(effort: Effort, report: PlanReport, legs: int) -> Effort:
    """The effort for the next of so many legs, after what the report says has been spent."""
    return replace(
        effort,
        rollouts=max(1.0, (effort.rollouts - report.evaluations) / legs),
        deadline=max(1e-3, (effort.deadline - report.planning_time) / legs),
    )


def _headings(scenario: Scenario, via: Floats) -> Floats:
    """Headings (m,) to aim at: along the line from the place before to the place after."""
    places = np.vstack([scenario.start[:2], via[:, :2], scenario.goal[:2]])
    along = places[2:] - places[:-2]
    headings: Floats = np.arctan2(along[:, 1], along[:, 0])
    return headings


def _tolerance(scenario: Scenario) -> tuple[float, float]:
    return scenario.position_tolerance, scenario.heading_tolerance


def _leg(found: PlanReport, goal: Floats) -> _Leg:
    """The plan of a leg up to the tick at which its end is reached."""
    assert found.plan is not None
    path, schedule = found.plan.trajectory, found.plan.schedule
    ends = np.minimum(np.append(schedule.ends, np.inf), PERIOD * len(path.u))
    return _Leg(
        points=np.vstack([schedule.points, goal]),
        dwell=np.diff(ends, prepend=0.0),
        path=path,
    )


def _later(scenario: Scenario, leg: _Leg) -> Scenario:
    """What is left after a leg: the robot where it is then, circles where they are, less time."""
    elapsed = PERIOD * len(leg.path.u)
    circles = moved(scenario.circles, elapsed)
    left = max(scenario.time_limit - elapsed, PERIOD)
    return replace(scenario, start=leg.path.x[-1], circles=circles, time_limit=left)


def _joined(report: PlanReport, legs: Sequence[_Leg], via: Floats) -> PlanReport:
    """The legs as one plan, if the other simulator confirms it and the certificate clears it."""
    scenario, last = report.scenario, report.plan
    assert last is not None
    paths = [leg.path for leg in legs]
    raw = np.concatenate([path.u for path in paths])
    controls = steered(scenario, raw)
    check = replay(scenario, controls, PERIOD, via=via)
    proof = certify(scenario, controls, PERIOD, until=check.arrival_time)
    if not (check.solves and proof.is_clear):
        reason = f"the legs make no plan within {scenario.time_limit:g} s; the goal may still be reachable"
        return replace(report, status="not_found", reason=reason, plan=None, law=None)
    poses = np.vstack([paths[0].x[:1], *(path.x[1:] for path in paths)])
    trajectory = Trajectory(
        plant=last.trajectory.plant,
        t=PERIOD * np.arange(len(poses), dtype=np.float64),
        x=poses,
        u=raw,
        target=np.vstack([paths[0].target[:1], *(path.target[1:] for path in paths)]),
        arrival=check.arrival_time,
        cost=check.arrival_time,
        clearance=check.clearance,
    )
    plan = _as_one(last, legs, trajectory)
    history = ((report.evaluations, plan.arrival_time, report.planning_time),)
    return replace(report, status="planned", plan=plan, replay=check, certificate=proof, history=history)


def _as_one(last: Plan, legs: Sequence[_Leg], trajectory: Trajectory) -> Plan:
    points = np.vstack([leg.points for leg in legs])[
        :-1
    ]  # the goal is the target after the last point anyway
    return replace(
        last,
        schedule=Schedule(points, np.concatenate([leg.dwell for leg in legs])[:-1]),
        trajectory=trajectory,
        arrival_time=trajectory.arrival,
        value=trajectory.arrival,
        clearance=trajectory.clearance,
    )
