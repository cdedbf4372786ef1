"""`python -m tests.bench.rooms`: plans and drives through the synthetic office, and what a distance field costs.

Processor seconds of one core, kernels compiled before. `--seeds N` sets how many plans there are, `--drives N` how many
drives among movers; 12 of them cross the shortest way at any angle, timed to meet the robot, and pass through walls.
"""

import argparse
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np

import applications.rosbot
from applications.rosbot import planner
from applications.rosbot.crossings import JITTER, PACE, ROOM, SOONEST, mover
from applications.rosbot.drive_file import status_of
from applications.rosbot.loop import drive_scenario
from applications.rosbot.planner import PlanReport, plan_scenario
from applications.rosbot.problems import problem_of
from applications.rosbot.reachability import reachability
from applications.rosbot.routes import routes
from applications.rosbot.scenario import Scenario
from applications.rosbot.scenario_file import read_scenario
from applications.rosbot.stabilizer import default_law
from applications.rosbot.swarms import Effort
from gpsynth.arrays import Floats
from gpsynth.evaluate import Evaluator
from gpsynth.seeds import stream

OFFICE = Path(applications.rosbot.__file__).parent / "scenarios" / "office.json"
WITHIN = 2.0  # s
MOVERS = 12
DEADLINES = (0.1, 0.2, 0.5, 0.8, 1.0, 2.0)  # s
LANES, POINTS, HORIZON = 256, 6, 12.0


def fresh() -> Scenario:
    """The office, its field not yet computed."""
    return read_scenario(OFFICE)


def timed(work: Callable[[], object], repeats: int = 5) -> float:
    """Median processor time (s)."""
    spent = []
    for _ in range(repeats):
        began = time.process_time()
        work()
        spent.append(time.process_time() - began)
    return float(np.median(spent))


def parts() -> str:
    """What is done once for a room."""
    scenario = fresh()
    rows = {
        "read map and scenario": timed(fresh),
        "distance field, 2.5 cm": timed(lambda: scenario.room and replace(scenario.room).field(0.025)),
        "reachability": timed(lambda: reachability(scenario)),
        "routes": timed(lambda: routes(scenario, margin=0.004)),
    }
    return "\n".join(f"{name:26} {1e3 * seconds:8.1f} ms" for name, seconds in rows.items())


def office(seed: int) -> str:
    """One plan: when the first one was certified, what there was after WITHIN, and what came of it all."""
    began, times, arrivals = time.process_time(), list[float](), list[float]()

    def note(report: PlanReport) -> None:
        if report.replay is not None:
            times.append(time.process_time() - began)
            arrivals.append(report.replay.arrival_time)

    scenario = fresh()
    report = plan_scenario(scenario, [default_law()], seed=seed, callback=note)
    if report.replay is None or report.certificate is None:
        return f"{seed:4} {report.status}"
    soon = [arrival for spent, arrival in zip(times, arrivals, strict=True) if spent <= WITHIN]
    total, clear = time.process_time() - began, 1e3 * report.certificate.clearance
    return (
        f"{seed:4} {times[0]:8.2f} {arrivals[0]:8.2f} {min(soon, default=np.nan):10.2f} "
        f"{report.replay.arrival_time:8.2f} {total:8.2f} {clear:9.1f}"
    )


def busy(seed: int) -> Scenario:
    """The office with MOVERS on its shortest way."""
    scenario, rng = fresh(), stream(seed)
    way, circles = routes(scenario, margin=0.05)[0], list[Floats]()
    while len(circles) < MOVERS:
        driven = float(rng.uniform(0.05, 0.95) * way.length)
        when = max(SOONEST, driven / PACE + JITTER * rng.normal())
        circle = mover(way.poses(np.array([driven]))[0, :2], when, rng)
        if np.hypot(*(circle[:2] - scenario.start[:2])) - circle[4] - scenario.radius >= ROOM:
            circles.append(circle)
    return replace(scenario, circles=np.array(circles))


def driven(scenario: Scenario, seed: int) -> str:
    """One drive: what came of it, and how long its cycles took."""
    run = drive_scenario(scenario, default_law(), seed=seed)
    cycles, what = 1e3 * np.quantile(run.cycles, (0.5, 0.99, 1.0)), status_of(run)
    return (
        f"{len(scenario.circles):6} {seed:4} {what:>10} {run.replay.arrival_time:8.2f} {run.replay.clearance:8.3f} "
        + " ".join(f"{each:8.1f}" for each in cycles)
    )


def overrun(deadline: float, seed: int) -> str:
    """How much later than its deadline (s) a search ends, processor time being its clock."""
    clock, planner.time = planner.time, SimpleNamespace(perf_counter=time.process_time)
    report = plan_scenario(fresh(), [default_law()], seed=seed, effort=Effort(deadline=deadline))
    planner.time = clock
    late = report.planning_time - deadline
    return f"{deadline:10.2f} {seed:4} {report.status:>10} {report.evaluations:8} {1e3 * late:8.1f}"


def rollouts() -> str:
    """The time of a lane's period without obstacles, beside a field, and among circles."""
    scenario, rng = fresh(), np.random.default_rng(1)
    law = default_law().with_limits(*zip(scenario.speed_limits, scenario.turn_limits, strict=True))
    problem = replace(problem_of(scenario, law), stop=False)
    assert problem.obstacles is not None
    points = rng.uniform([2.0, 2.0, -3.0], [18.0, 13.0, 3.0], (LANES, POINTS, 3))
    dwell = rng.uniform(0.5, 3.0, (LANES, POINTS))
    scattered = rng.uniform([0.0, 0.0, 0.0, 0.0, 0.2], [20.0, 15.0, 0.0, 0.0, 0.4], (160, 5))
    away = scattered[np.hypot(*(scattered[:, :2] - scenario.start[:2]).T) > 1.0]
    worlds = {"nothing": replace(problem.obstacles, field=None), "the office's field": problem.obstacles}
    for count in (10, 40, 140):
        worlds[f"{count} circles"] = replace(problem.obstacles, field=None, circles=away[:count])
    lines, periods = [], LANES * HORIZON / problem.period
    for name, obstacles in worlds.items():
        evaluator = Evaluator(replace(problem, obstacles=obstacles), margin=0.004)
        evaluator.of_schedules(law, points, dwell, HORIZON)
        spent = timed(lambda each=evaluator: each.of_schedules(law, points, dwell, HORIZON), 9)  # type: ignore[misc]
        lines.append(f"{name:26} {1e9 * spent / periods:8.1f} ns a period")
    return "\n".join(lines)


def main() -> None:
    """Print all tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--drives", type=int, default=8)
    asked = parser.parse_args()
    plan_scenario(fresh(), [default_law()], effort=Effort(rollouts=1_000))  # compiles
    print(parts(), "", rollouts(), "", sep="\n")
    print(f"seed  first s  arrival  after {WITHIN:g} s    final  total s  clear mm")
    for seed in range(asked.seeds):
        print(office(seed), flush=True)
    print("\ndeadline s seed     status rollouts  late ms")
    for deadline in DEADLINES:
        for seed in range(2):
            print(overrun(deadline, seed), flush=True)
    drive_scenario(replace(busy(0), time_limit=0.3), default_law())  # compiles
    print("\nmovers seed     status  arrival  clear m  median     p99      max ms a cycle")
    for seed in range(3):
        print(driven(fresh(), seed), flush=True)
    for seed in range(asked.drives):
        print(driven(busy(seed), seed), flush=True)


if __name__ == "__main__":
    main()
