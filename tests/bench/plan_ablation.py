"""`python -m tests.bench.plan_ablation`: what each part of a plan's search is worth, on the public scenarios.

Each row changes one thing of the first. All are one search of as many rollouts, whose first schedules lie along the
same lines around the obstacles, so every row is far from what the planner with its several swarms reaches. Its plan is
replayed as the planner's are. "worth" is the mean over all runs of T_ref / T, with 0 for a run that found no plan: no
row can look good by solving the easy ones alone. The last row is no search of schedules but a sampling MPC along the
best of the lines.
"""

import argparse
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np

from applications.rosbot.model import unicycle
from applications.rosbot.polar_law import HOT, SATURATING, SETTLING, polar_law
from applications.rosbot.problems import PERIOD, problem_of
from applications.rosbot.replay import replay
from applications.rosbot.scenario import Scenario
from applications.rosbot.seeds import repeated, schedules_along
from applications.rosbot.stabilizer import default_law
from gpsynth.arrays import Floats
from gpsynth.evaluate import Evaluator
from gpsynth.law import Law
from gpsynth.optimizers import PSO
from gpsynth.planning import Objective, PlanSettings, plan
from gpsynth.planning.literal import plan_literally
from gpsynth.planning.rounds import default_region, vectors_of
from gpsynth.seeds import stream
from gpsynth.simulation import simulate
from tests.bench.measure import machine, pin
from tests.bench.plan_peers import Case, cases
from tests.bench.planners.attempt import Watch, guides_of
from tests.bench.planners.path_integral import path_integral

WHOLE = PlanSettings()
GENERATIONS = WHOLE.iterations * WHOLE.rounds
LOOSE = 2.0  # T+ at first, in durations of the best line


@dataclass(frozen=True)
class Variant:
    """A search of equilibrium points."""

    settings: PlanSettings = WHOLE
    law: Callable[[], Law] = default_law
    guided: bool = True
    literal: bool = False

    def controls(self, scenario: Scenario, seed: int) -> Floats:
        """Of the best schedule found, (n, 2)."""
        law = self.law().with_limits(*zip(scenario.speed_limits, scenario.turn_limits, strict=True))
        problem, guides = problem_of(scenario, law), guides_of(scenario, count=5)
        budget = min(LOOSE * guides[0].duration, problem.horizon)
        count = self.settings.particles * 3 // 4 if self.guided else 0
        exact = schedules_along(guides, self.settings.points)
        initial = repeated(exact, count, stream(seed, 0)) if count else ()
        if not self.literal:
            found = plan(problem, law, self.settings, seed=seed, initial=initial, budget=budget)
            return found.trajectory.u
        objective = Objective(Evaluator(problem, margin=self.settings.margin), law, self.settings, budget)
        k, box = self.settings.points, default_region(problem)
        lower, upper = (
            np.append(np.tile(bound, k), np.full(k, t)) for bound, t in zip(box, (0.0, 4.0), strict=True)
        )
        x0 = np.clip(vectors_of(initial, self.settings), lower, upper)
        swarm = PSO.clerc(lower, upper, size=self.settings.particles, x0=x0)
        best = plan_literally(objective, swarm, seed=seed, evaluations=self.settings.particles * GENERATIONS)
        return simulate(problem, law, schedule=best.schedule).u


def _polar(gains) -> Callable[[], Law]:
    return lambda: polar_law(unicycle(), gains)


WHOLE_NAME = "the search: swarm, T+ in rounds, 6 points"
VARIANTS: Mapping[str, Variant] = MappingProxyType(
    {
        WHOLE_NAME: Variant(),
        "T+ as at first": Variant(replace(WHOLE, iterations=GENERATIONS, rounds=1)),
        "T+ by Algorithm 1 taken literally": Variant(literal=True),
        "equal dwell times": Variant(replace(WHOLE, dwell=None)),
        "equal dwell times, T+ as at first": Variant(
            replace(WHOLE, dwell=None, iterations=GENERATIONS, rounds=1)
        ),
        "no first schedules along lines": Variant(guided=False),
        "obstacles counted at the points": Variant(replace(WHOLE, obstacles="points")),
        "swarm with omega 1.0, c1 = c2 = 0.65": Variant(replace(WHOLE, optimizer="seed")),
        "differential evolution (SHADE)": Variant(replace(WHOLE, optimizer="shade")),
        "CMA-ES": Variant(replace(WHOLE, optimizer="cmaes")),
        **{f"{k} points": Variant(replace(WHOLE, points=k)) for k in (3, 4, 5, 7, 8, 10, 12)},
        "polar law, tuned by hand": Variant(law=_polar(SATURATING)),
        "polar law, hotter": Variant(law=_polar(HOT)),
        "polar law, tuned from point to point": Variant(law=_polar(SETTLING)),
    }
)
CONTROLLER = "sampling MPC (MPPI)"


def ratio(case: Case, name: str, seed: int) -> float:
    """T / T_ref of what a variant finds; infinity if the replay does not confirm it."""
    if name == CONTROLLER:
        answers = list(path_integral(case.scenario, seed, Watch(np.inf)))
        controls, durations = answers[-1][1:] if answers else (np.empty((0, 2)), np.empty(0))
    else:
        controls = VARIANTS[name].controls(case.scenario, seed)
        durations = np.full(len(controls), PERIOD)
    check = replay(case.scenario, controls, durations)
    return check.arrival_time / case.best_known if check.solves else np.inf


def rows(seeds: int, names: tuple[str, ...], scenarios: tuple[str, ...]) -> Iterator[str]:
    """Markdown, as it is computed."""
    yield "| | solved | worth | T/T_ref median | max | s a run |\n|---|---:|---:|---:|---:|---:|"
    for name in names:
        began = time.process_time()
        found = np.array([ratio(case, name, seed) for case in cases(scenarios) for seed in range(seeds)])
        solved = found[np.isfinite(found)]
        median, most = (f"{f(solved):.3f}" if len(solved) else "-" for f in (np.median, np.max))
        spent = (time.process_time() - began) / len(found)
        yield (
            f"| {name} | {len(solved)} of {len(found)} | {np.mean(1.0 / found):.3f} "
            f"| {median} | {most} | {spent:.2f} |"
        )


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=2)
    parser.add_argument("--only", nargs="+", default=[], help="beginnings of rows")
    parser.add_argument("scenarios", nargs="*")
    asked = parser.parse_args()
    pin()
    every = (*VARIANTS, CONTROLLER)
    names = tuple(name for name in every if name.startswith(tuple(asked.only) or ""))
    print(machine())
    print(f"{asked.seeds} seeds, {WHOLE.particles * GENERATIONS} rollouts a search\n")
    ratio(cases(["p02"])[0], CONTROLLER, 0)  # compiled code
    for row in rows(asked.seeds, names, tuple(asked.scenarios)):
        print(row, flush=True)


if __name__ == "__main__":
    main()
