"""The main job: both stages on the paper's scenario, with obstacles and without, from scratch, into one run folder."""

from pathlib import Path

import click

from applications.rosbot.planner import Effort
from applications.rosbot.saved import SavedPlan, read_plan
from applications.rosbot.show import print_plans
from applications.rosbot.stages import run_plan, run_synthesis
from gpsynth.planning import PlanSettings
from gpsynth.run_files import begin
from gpsynth.runs import FILE

SCENARIOS = Path(__file__).with_name("scenarios")
JOBS = (("paper.json", "plan.json"), ("paper_empty.json", "plan_empty.json"))  # figures 3 and 4 of the paper
SHORT_BUDGET = 6_000  # evaluations of stage 1
SHORT_EFFORT = Effort(
    scouts=PlanSettings(particles=24, iterations=8, rounds=2),
    chasers=PlanSettings(particles=24, iterations=8, rounds=2),
    refiners=PlanSettings(particles=16, iterations=10, rounds=2),
    chased=2,
    refined=1,
)


def run_demo(out: Path, *, seed: int, short: bool, resume: bool, threads: int) -> list[SavedPlan]:
    """Synthesize a stabilizer, plan both scenarios with it, draw and print; the plans, as they are in the folder.

    With `resume` the synthesis goes on from its checkpoint in the folder; the plans are made anew. The checkpoint goes
    when all is done, so that the demo can be run again.
    """
    run = begin(out, seed, resume=resume)
    click.echo("stage 1: synthesis of the stabilizer")
    budget = SHORT_BUDGET if short else None
    result = run_synthesis(run, seed=seed, budget=budget, resume=resume, threads=threads)
    click.echo("\n".join(["", *result.law.formulas(), ""]))
    best = result.best
    click.echo(
        f"size {best.complexity}, reaches {best.reached:.1%} of its starts (probability at least "
        f"{best.reached_at_least:.3f}), median {best.median_time:.2f} s, worst {best.worst_time:.2f} s\n"
    )
    click.echo("stage 2: optimal equilibrium points")
    plans = []
    for scenario_name, plan_name in JOBS:
        path = run_plan(
            *(run, SCENARIOS / scenario_name, result.law),
            plan_file=plan_name,
            seed=seed,
            effort=SHORT_EFFORT if short else Effort(),
            threads=threads,
        )
        plans.append((scenario_name.removesuffix(".json"), read_plan(path)))
        if plans[-1][1].ended == "interrupted":
            break
    print_plans(plans)
    if plans[-1][1].ended == "interrupted":
        raise KeyboardInterrupt
    (run.folder / FILE).unlink(missing_ok=True)
    click.echo(f"everything is in {out}")
    return [plan for _, plan in plans]
