"""The numbers of Shmalko and Yamshanov beside ours, as the Markdown of docs/paper_numbers.md.

`python -m tests.bench.paper_numbers` prints the bounds that the paper's limits imply, `--experiments` the paper's two
experiments for ten seeds, of which `--plot FILE.png` draws T+ and cost, and run folders of
`python -m applications.rosbot demo` as arguments the plans found in them.
"""

import argparse
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from applications.rosbot.bounds import lower_bound
from applications.rosbot.figures import save_figure
from applications.rosbot.reeds_shepp import distance
from applications.rosbot.scenario_file import read_scenario
from applications.rosbot.show import plan_files, read_plan, scenario_beside
from gpsynth.arrays import Floats
from gpsynth.optimizers import PSO
from tests.bench.paper_experiments import SCENARIOS, convergence_figure, experiments, run_cases, table

GOAL = (2.0, 2.0)  # m, from (0, 0) with heading 0
LIMIT = 0.5  # m/s and rad/s
CLAIMED = (4.5, 3.0)  # s, experiments 1 and 2
WAYPOINTS = ((0.0, 0.0), (-0.46, -0.3), (-0.9, 0.24), (-0.37, 0.4), (-0.3, 0.64), (0.0, 1.7), (2.0, 2.0))  # m


def straight() -> float:
    """s: the distance at full speed; turning is free."""
    return float(np.hypot(*GOAL)) / LIMIT


def arc_and_tangent() -> float:
    """s: a turn of the least radius, then the tangent to the goal; the heading at the goal is free."""
    radius, (x, y) = LIMIT / LIMIT, GOAL
    far = np.hypot(x, y - radius)  # from the center of the turn
    tangent = np.sqrt(far**2 - radius**2)
    angle = np.arctan2(y - radius, x) + np.pi / 2 - np.arccos(radius / far)
    return float(radius * angle + tangent) / LIMIT


def two_quarter_circles() -> float:
    """s: to the left, then to the right, so that the goal is reached with heading 0."""
    return np.pi / LIMIT


def turn_then_drive(limit: float) -> float:
    """s: |v| + |omega| <= limit, as for two wheel commands that share it."""
    return float(np.arctan2(GOAL[1], GOAL[0]) + np.hypot(*GOAL)) / limit


def polyline() -> float:
    """m: through the waypoints that the paper prints."""
    return float(np.sum(np.hypot(*np.diff(WAYPOINTS, axis=0).T)))


def growth(swarm: PSO) -> float:
    """The factor by which a free particle's distance from its attractors grows a generation (root mean square)."""
    half, w = 0.5 * (swarm.cognitive + swarm.social), swarm.inertia
    square = half**2 + (swarm.cognitive**2 + swarm.social**2) / 12.0  # mean of (c1 r1 + c2 r2)^2
    moments = np.array(  # of x^2, x v, v^2 under v' = w v - phi x, x' = x + v'
        [
            [1.0 - 2.0 * half + square, 2.0 * w * (1.0 - half), w**2],
            [square - half, w * (1.0 - 2.0 * half), w**2],
            [square, -2.0 * w * half, w**2],
        ]
    )
    return float(np.sqrt(np.max(np.abs(np.linalg.eigvals(moments)))))


def bounds() -> str:
    """The table of least times from the start to the point (2, 2), without obstacles."""
    free, facing = _reeds_shepp(np.linspace(-np.pi, np.pi, 20_001)), _reeds_shepp(np.zeros(1))
    rows = [
        (r"\|v\| <= 0.5", "straight line", "2 sqrt(2) / 0.5", straight(), None),
        (r"\|v\|, \|omega\| <= 0.5", "arc, then tangent", "2 (atan(4/3) + 2)", arc_and_tangent(), free),
        (
            r"\|v\|, \|omega\| <= 0.5, heading 0",
            "two quarter circles",
            "2 pi",
            two_quarter_circles(),
            facing,
        ),
        *(
            (
                rf"\|v\| + \|omega\| <= {limit:g}",
                "turn, then drive",
                f"(pi/4 + 2 sqrt(2)) / {limit:g}",
                least,
                None,
            )
            for limit, least in ((limit, turn_then_drive(limit)) for limit in (0.5, 1.0, 2.0, 10.0))
        ),
    ]
    cells = (
        (
            f"`{what}`",
            how,
            f"`{form}`",
            f"{least:.3f}",
            _optional(check),
            *(_verdict(t, least) for t in CLAIMED),
        )
        for what, how, form, least, check in rows
    )
    titles = ("limits", "fastest way", "closed form", "least time (s)", "Reeds-Shepp (s)", "4.5 s", "3 s")
    return table(titles, cells)


def facts() -> str:
    """What else follows from the printed numbers."""
    length = polyline()
    rows = [
        ("length of the polyline through the printed waypoints", f"{length:.3f} m"),
        ("the same at 0.5 m/s", f"{length / LIMIT:.2f} s"),
        ("mean speed along it in 4.5 s", f"{length / CLAIMED[0]:.2f} m/s"),
        ("mean speed on the straight line in 4.5 s", f"{straight() * LIMIT / CLAIMED[0]:.3f} m/s"),
        ("mean speed on the straight line in 3 s", f"{straight() * LIMIT / CLAIMED[1]:.3f} m/s"),
        (
            "growth of a free swarm per generation, omega 1.0, c1 = c2 = 0.65",
            f"{growth(PSO.seed([0.0], [1.0])):.4f}",
        ),
        ("the same with the preset `clerc`", f"{growth(PSO.clerc([0.0], [1.0])):.4f}"),
        *(
            (f"lower bound of `{name}.json`: tolerance and obstacles counted", f"{_bound(name):.3f} s")
            for name in ("paper", "paper_empty")
        ),
    ]
    return table(("quantity", "value"), rows)


def plans(folders: Sequence[Path]) -> str:
    """The plans of run folders beside what the paper claims."""
    rows = []
    for path in (path for folder in folders for path in plan_files(folder)):
        saved, scenario = read_plan(path), read_scenario(scenario_beside(path))
        claimed = CLAIMED[0] if len(scenario.circles) else CLAIMED[1]
        numbers = (scenario.time_limit, claimed, saved.lower_bound, saved.arrival_time, saved.clearance)
        rows.append((f"`{scenario.name}`", saved.status, *map(_optional, numbers)))
    titles = ("scenario", "status", "time limit (s)", "paper (s)", "bound (s)", "ours (s)", "clearance (m)")
    return table(titles, rows)


def _reeds_shepp(headings: Floats) -> float:
    goals = np.column_stack([np.full(len(headings), GOAL[0]), np.full(len(headings), GOAL[1]), headings])
    return float(distance(np.zeros(3), goals, 1.0).min()) / LIMIT


def _bound(name: str) -> float:
    return lower_bound(read_scenario(SCENARIOS / f"{name}.json"))


def _verdict(claimed: float, least: float) -> str:
    return "not excluded" if claimed >= least else "ruled out"


def _optional(value: float | None) -> str:
    return "-" if value is None else f"{value:.3f}"


def main() -> None:
    """Print the tables that are asked for."""
    parser = argparse.ArgumentParser(description="The numbers of the paper beside ours, as Markdown.")
    parser.add_argument(
        "--experiments", action="store_true", help="run the paper's experiments for ten seeds"
    )
    parser.add_argument("--plot", type=Path, help="draw T+ and cost of the experiments as they run")
    parser.add_argument("folders", nargs="*", type=Path, help="run folders with plans")
    asked = parser.parse_args()
    print(bounds(), facts(), sep="\n\n")
    if asked.experiments or asked.plot:
        found = run_cases()
        print("", experiments(found), sep="\n")
        if asked.plot:
            save_figure(convergence_figure(found), asked.plot)
    if asked.folders:
        print("", plans(asked.folders), sep="\n")


if __name__ == "__main__":
    main()
