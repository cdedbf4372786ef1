"""The clearance that a search asks for: what is wanted, or as much as the start and the shortest way leave."""

import numpy as np

from applications.rosbot.gaps import gaps_at, gaps_to_room
from applications.rosbot.routes import Route, routes
from applications.rosbot.scenario import Scenario
from gpsynth.arrays import Floats

FINER = 4.0  # a margin that leaves too little is divided by this
FINEST = 1e-5  # m; for a shorter way no less is tried
DETOUR = 1.05  # a way that is longer by less is not worth a smaller margin


def ways_within(scenario: Scenario, wanted: float) -> tuple[float, list[Route]]:
    """The margin (m), at most the one wanted, and the routes that keep it.

    Half of what the start leaves; and where obstacles leave passages that are too narrow for the margin, the largest
    one that does not shut the shortest way. In a room, whose routes take long, passages are left to further attempts.
    """
    margin = min(wanted, 0.5 * start_gap(scenario))
    found = routes(scenario, margin=margin)
    if scenario.field is not None:
        return margin, found
    if found and (margin <= FINEST or not _has_passages(scenario, 2.0 * margin)):
        return margin, found
    shortest = min((way.length for way in routes(scenario, count=1, margin=FINEST)), default=np.inf)
    finer, ways = margin, found
    while finer > FINEST and not (ways and ways[0].length <= DETOUR * shortest):
        finer = finer / FINER
        ways = routes(scenario, margin=finer)
    if not ways or finer == margin:
        return margin, found
    return 0.5 * finer, ways  # where the whole margin leaves a line, half of it leaves some room


def start_gap(scenario: Scenario) -> float:
    """How far (m) the robot is from obstacles, other robots and its bounds at the start."""
    x, y, _ = scenario.start
    low_x, high_x, low_y, high_y = scenario.bounds
    gaps = [x - low_x, high_x - x, y - low_y, high_y - y]
    gaps += gaps_at(scenario.body, scenario.circles, scenario.start).tolist()
    if scenario.room is not None:
        gaps += gaps_to_room(scenario.body, scenario.room, scenario.start[np.newaxis]).tolist()
    for other in scenario.others:
        apart = np.hypot(*(scenario.start - other.start)[:2])
        gaps.append(float(apart) - scenario.radius - other.radius)
    return max(float(min(gaps)), 0.0)


def _has_passages(scenario: Scenario, width: float) -> bool:
    """Whether two discs, or one and a bound, leave a way for the robot's center that is less than `width` (m) wide."""
    discs = scenario.discs
    apart = np.hypot(*(discs[:, None, :2] - discs[None, :, :2]).transpose(2, 0, 1))
    gaps: Floats = apart - discs[:, 2] - discs[:, None, 2]
    rooms = np.abs(discs[:, [0, 0, 1, 1]] - scenario.bounds) - discs[:, 2:]
    narrow = [np.any((each > 2.0 * FINEST) & (each < width)) for each in (gaps, rooms)]
    return bool(any(narrow))
