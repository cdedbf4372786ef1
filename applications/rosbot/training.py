"""What the ROSbot's laws are judged on for planning: small scenarios of every kind that plans find hard, generated."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType

import numpy as np

from applications.rosbot.bounds import lower_bound
from applications.rosbot.guides import Guide, direct_guides, guides_along
from applications.rosbot.model import unicycle
from applications.rosbot.polar_law import polar_law
from applications.rosbot.problems import problem_of
from applications.rosbot.reachability import reachability
from applications.rosbot.routes import routes
from applications.rosbot.scenario import Scenario
from applications.rosbot.seeds import repeated, schedules_along
from applications.rosbot.stabilization import stabilization
from gpsynth.arrays import Floats
from gpsynth.checks import check_kind, check_whole
from gpsynth.errors import ScenarioError
from gpsynth.planning import PlanCost, PlanSettings, Task, Worth
from gpsynth.program import Program
from gpsynth.seeds import stream

SEARCH = PlanSettings(particles=32, iterations=10, rounds=5)
GUIDED = 3 / 4  # of the particles begin along guides, as in the planner
LOOSE = 2.0  # T+ at first, in durations of the best guide
ROOM = (-1.5, 4.5, -2.5, 2.5)  # m, bounds of the robot's center
FIRST, ROUGH = 16, 0.1  # schedules of a law without a search, and s of their control and steps
_SCENARIOS, _INITIAL, _TRIED = 105, 106, 107  # streams

_Drawn = tuple[Floats, Floats, Floats]  # start (3,), goal (3,), circles (c, 3) x, y, radius


def training_scenarios(count: int, *, seed: int = 0) -> list[Scenario]:
    """`count` scenarios whose goal can be reached, the kinds in turn; the same seed gives the same ones."""
    check_whole("count of training scenarios", count, 1)
    kinds = tuple(KINDS)
    return [next(_drawn(kinds[number % len(kinds)], seed, number)) for number in range(count)]


def plan_worth(scenarios: list[Scenario], *, seed: int = 0, settings: PlanSettings = SEARCH) -> Worth:
    """The worth of laws in scenarios: searches that begin along the guides, against the lower bounds of their times."""
    check_kind("settings", settings, PlanSettings)
    count = int(GUIDED * settings.particles)
    return Worth(_tasks(scenarios, count, settings.points, (seed, _INITIAL)), settings, seed)


def plan_cost(scenarios: list[Scenario], *, seed: int = 0, weight: float = 1.0) -> PlanCost:
    """What plans of scenarios cost with a law, in s: the best of FIRST schedules along the guides, in rough steps."""
    tasks = _tasks(scenarios, FIRST, SEARCH.points, (seed, _TRIED))
    terminal = stabilization(np.zeros((1, 3))).terminal
    return PlanCost([_roughly(task, terminal) for task in tasks], weight)


def _tasks(scenarios: Sequence[Scenario], count: int, points: int, path: tuple[int, int]) -> tuple[Task, ...]:
    """One for each scenario, with random numbers of its own from the seed and stream of the path."""
    check_kind("scenarios", scenarios, list, tuple)
    for scenario in scenarios:
        check_kind("a scenario", scenario, Scenario)
    seed, which = path
    return tuple(
        _task(each, count, points, stream(seed, which, number)) for number, each in enumerate(scenarios)
    )


def _task(scenario: Scenario, count: int, points: int, rng: np.random.Generator) -> Task:
    """The scenario with `count` schedules along its guides to begin with."""
    guides = _guides(scenario)
    initial = repeated(schedules_along(guides, points), count, rng)
    limits = zip(scenario.speed_limits, scenario.turn_limits, strict=True)
    problem = problem_of(
        scenario, polar_law(unicycle()).with_limits(*limits)
    )  # plant and features are any law's
    return Task(problem, lower_bound(scenario), initial, min(LOOSE * guides[0].duration, problem.horizon))


def _roughly(task: Task, terminal: Program | None) -> Task:
    """In longer steps, and what does not arrive pays for it, as in stage 1."""
    rough = replace(task.problem, period=ROUGH, step=ROUGH, method="heun", terminal=terminal)
    return replace(task, problem=rough)


def _guides(scenario: Scenario) -> list[Guide]:
    """The best of every way and of the direct curves, the most promising first."""
    found = guides_along(scenario, routes(scenario))
    return sorted((way[0] for way in (*found, direct_guides(scenario)) if way), key=lambda guide: guide.score)


def _drawn(kind: str, seed: int, number: int) -> Iterator[Scenario]:
    """Scenarios of a kind that are in order and can be solved."""
    rng = stream(seed, _SCENARIOS, number)
    while True:
        start, goal, circles = KINDS[kind](rng)
        try:
            scenario = Scenario(
                start=start,
                goal=goal,
                bounds=np.array(ROOM),
                circles=np.insert(circles, 2, np.zeros((2, 1)), axis=1),
                name=f"{kind}-{number}",
            )
        except ScenarioError:
            continue  # start or goal in an obstacle
        if reachability(scenario).status == "reachable" and lower_bound(scenario) > 1.0:
            yield scenario


def _open(rng: np.random.Generator) -> _Drawn:
    """Nothing in the way: any two poses, most often with cusps."""
    start, goal = (np.append(rng.uniform(-1.0, 1.0, 2), rng.uniform(-np.pi, np.pi)) for _ in range(2))
    return start, goal, np.empty((0, 3))


def _aside(rng: np.random.Generator) -> _Drawn:
    """Beside or behind the start, between two circles: parking, and half turns."""
    x, y = rng.uniform(-0.3, 0.3), rng.choice([-1.0, 1.0]) * rng.uniform(0.5, 1.0)
    gap, radius = rng.uniform(0.5, 0.7), rng.uniform(0.15, 0.25)
    parked = [[x - gap, y, radius], [x + gap, y, radius]]
    return np.zeros(3), np.array([x, y, rng.choice([0.0, np.pi])]), np.array(parked)


def _scattered(rng: np.random.Generator) -> _Drawn:
    """Eight circles between start and goal."""
    circles = np.column_stack(
        [rng.uniform(0.6, 2.9, 8), rng.uniform(-1.2, 1.2, 8), rng.uniform(0.12, 0.25, 8)]
    )
    return (
        np.append(rng.uniform(-0.2, 0.2, 2), rng.uniform(-1.0, 1.0)),
        np.array([3.5, rng.uniform(-1.0, 1.0), rng.uniform(-1.0, 1.0)]),
        circles,
    )


def _walled(rng: np.random.Generator) -> _Drawn:
    """A wall between start and goal, to be passed at the nearer end."""
    middle, half = rng.uniform(-0.4, 0.4), rng.uniform(0.8, 1.1)
    return _across(rng, [circles_in_a_row([1.3, middle - half], [1.3, middle + half])])


def _trapped(rng: np.random.Generator) -> _Drawn:
    """The start within three walls, the goal behind the middle one."""
    x, half, depth = rng.uniform(0.9, 1.3), rng.uniform(0.6, 0.75), rng.uniform(0.7, 1.0)
    corners = [x, -half], [x, half]
    arms = [circles_in_a_row(corner, [x - depth, corner[1]]) for corner in corners]
    return _across(rng, [circles_in_a_row(*corners), *arms])


def _across(rng: np.random.Generator, rows: list[Floats]) -> _Drawn:
    start = np.array([rng.uniform(-0.1, 0.3), rng.uniform(-0.1, 0.1), rng.uniform(-0.5, 0.5)])
    goal = np.array([rng.uniform(2.2, 2.8), rng.uniform(-0.3, 0.3), rng.uniform(-0.5, 0.5)])
    return start, goal, np.vstack(rows)


def circles_in_a_row(first: Sequence[float], last: Sequence[float], radius: float = 0.15) -> Floats:
    """Circles (c, 3) of a radius from one place (m) to another, each less than a radius and a half from the next."""
    count = 2 + int(np.hypot(*np.subtract(last, first)) / (1.5 * radius))
    return np.column_stack([np.linspace(first, last, count), np.full(count, radius)])


KINDS: Mapping[str, Callable[[np.random.Generator], _Drawn]] = MappingProxyType(
    {"open": _open, "aside": _aside, "scattered": _scattered, "walled": _walled, "trapped": _trapped}
)
