"""What users get wrong in calls of the application: each is one sentence that names the argument, and no traceback."""

from dataclasses import replace

import numpy as np
import pytest

from applications.rosbot.certificate import certify
from applications.rosbot.controls import held
from applications.rosbot.fleet import plan_fleet
from applications.rosbot.fleet_file import read_fleet
from applications.rosbot.loop import drive_scenario
from applications.rosbot.others import Other
from applications.rosbot.planner import Effort, PlanReport, plan_scenario
from applications.rosbot.replanning import Replanning
from applications.rosbot.replay import replay
from applications.rosbot.room import Room
from applications.rosbot.scenario import Scenario
from applications.rosbot.scenario_file import read_scenario
from applications.rosbot.stabilizer import default_law
from applications.rosbot.through import plan_through
from gpsynth.errors import GpsynthError

LAW = default_law()
ENDS = ([0.0, 0.0, 0.0], [1.0, 0.0, 0.0])
SCENE = Scenario(*ENDS)
EARLIER = PlanReport("not_found", "", 0.0, 0, SCENE, 0)


def plan(**settings):
    return plan_scenario(SCENE, [LAW], **settings)


def drive(**settings):
    return drive_scenario(SCENE, LAW, **settings)


def scene(**changes):
    return Scenario(*ENDS, **changes)


def through(via, **changes):
    return plan_through(replace(SCENE, **changes), via, LAW)


MISTAKES = {
    "plan: one law": (lambda: plan_scenario(SCENE, LAW), "laws must be a list or a tuple, got a Law"),
    "plan: no law": (lambda: plan_scenario(SCENE, []), "a plan needs at least one law"),
    "plan: a file": (lambda: plan_scenario(SCENE, ["law.json"]), "one of the laws must be a Law, got 'law.json'"),
    "plan: swapped": (lambda: plan_scenario([LAW], SCENE), "scenario must be a Scenario, got a list"),
    "plan: effort": (lambda: plan(effort=3), "effort must be an Effort, got 3"),
    "plan: callback": (lambda: plan(callback=3), "callback must be a function or None, got 3"),
    "plan: previous": (lambda: plan(previous=3), "previous must be a PlanReport or None, got 3"),
    "plan: NaN": (lambda: plan(previous=EARLIER, elapsed=np.nan), "elapsed is nan s; expected a finite number, at"),
    "plan: before": (lambda: plan(previous=EARLIER, elapsed=-1), "elapsed is -1 s; expected a finite number"),
    "plan: a text": (lambda: plan(previous=EARLIER, elapsed="1"), "elapsed must be a number, got '1'"),
    "plan: seed": (lambda: plan(seed=1.5), "seed must be an integer of at least 0, not 1.5"),
    "plan: threads": (lambda: plan(threads=0), "threads must be an integer of at least 1, not 0"),
    "effort: points": (lambda: Effort(points=1.5), "points of an effort must be an integer of at least 1, not 1.5"),
    "effort: chased": (lambda: Effort(chased=-1), "chased of an effort must be an integer of at least 0, not -1"),
    "effort: scouts": (lambda: Effort(scouts=3), "scouts of an effort must be a PlanSettings, got 3"),
    "via: one place": (lambda: through([1.0, 0.0, 0.1]), "rows of x, y and tolerance in m, got [1.0, 0.0, 0.1]"),
    "via: no tolerance": (lambda: through([[1.0, 0.0]]), "rows of x, y and tolerance in m, got [[1.0, 0.0]]"),
    "via: ragged": (lambda: through([[1.0, 0.0, 0.1], [1.0]]), "rows of x, y and tolerance in m, got [[1.0, 0.0"),
    "via: a text": (lambda: through("ab"), "rows of x, y and tolerance in m, got 'ab'"),
    "via: none": (lambda: through([]), "rows of x, y and tolerance in m, got []"),
    "via: NaN": (lambda: through([[np.nan, 0.0, 0.1]]), "via-point 0 is [nan, 0.0, 0.1]; expected finite numbers"),
    "via: tolerance": (lambda: through([[0.5, 0.0, 0.0]]), "via-point 0 has tolerance 0 m; expected more than 0"),
    "via: with lags": (lambda: through([[0.5, 0.0, 0.1]], model="dynamic_unicycle"), "for robots without lags"),
    "via: laws": (lambda: plan_through(SCENE, [[0.5, 0.0, 0.1]], [LAW]), "law must be a Law, got a list"),
    "drive: laws": (lambda: drive_scenario(SCENE, [LAW]), "law must be a Law, got a list"),
    "drive: flaws": (lambda: drive(flaws=0.1), "flaws must be a Flaws, got 0.1"),
    "drive: sensor": (lambda: drive(sensor=3.0), "sensor must be a Sensor, got 3.0"),
    "drive: settings": (lambda: drive(settings=3), "settings must be a Replanning or None, got 3"),
    "drive: schedule": (lambda: drive(schedule=[1]), "schedule must be a Schedule or None, got a list"),
    "drive: margin": (lambda: Replanning.keeping("1"), "margin of replanning must be a number, got '1'"),
    "fleet: one": (lambda: plan_fleet(SCENE, [LAW]), "scenarios must be a list or a tuple, got a Scenario"),
    "fleet: a name": (lambda: plan_fleet(["a", "b"], [LAW]), "one of the scenarios must be a Scenario, got 'a'"),
    "certify: NaN": (lambda: certify(SCENE, [[np.nan, 0.0]], 0.05), "hold NaN or infinity; expected finite"),
    "certify: backwards": (lambda: certify(SCENE, [[0.1, 0.0]], -0.05), "the shortest duration is -0.05 s; expected"),
    "replay: a text": (lambda: replay(SCENE, "ab", 0.05), "controls are rows of v and omega, with one duration"),
    "controls: columns": (lambda: held([[1.0, 2.0, 3.0]], 0.1), "controls have shape (1, 3); expected (n, 2)"),
    "controls: durations": (lambda: held([[1.0, 2.0]], [0.1, 0.1]), "with one duration for all or one for each"),
    "scenario: a text": (lambda: Scenario("abc", ENDS[1]), "start must hold numbers in rows of equal length, got 'a"),
    "scenario: circles": (lambda: scene(circles=[[1.0], [1.0, 2.0]]), "circles must hold numbers in rows of equal"),
    "scenario: radius": (lambda: scene(radius="wide"), "radius must be a number, got 'wide'"),
    "scenario: time": (lambda: scene(time_limit=None), "time_limit must be a number, got None"),
    "scenario: room": (lambda: scene(room="office"), "room must be a Room or None, got 'office'"),
    "scenario: others": (lambda: scene(others=(3,)), "one of the others must be an Other, got 3"),
    "scenario: no file": (lambda: read_scenario(None), "a scenario is read from a str or a Path, got None"),
    "fleet: no file": (lambda: read_fleet({}), "a fleet is read from a str or a Path, got {}"),
    "room: polygon": (lambda: Room(polygons=([[0.0, 0.0], [1.0, 1.0]],)), "a polygon has 2 corners; expected at"),
    "room: polygons": (lambda: Room(polygons=3), "polygons must be a list or a tuple, got 3"),
    "room: segments": (lambda: Room(segments=[[1.0, 2.0]]), "segments has shape (1, 2); expected (any number, 4)"),
    "other: radius": (lambda: Other(ENDS[0], [[1.0, 0.0]], [0.1], -0.1), "the radius of another robot is -0.1 m"),
}  # fmt: skip


@pytest.mark.parametrize(("call", "sentence"), MISTAKES.values(), ids=list(MISTAKES))
def test_a_mistake_is_one_sentence(call, sentence):
    with pytest.raises(GpsynthError) as raised:
        call()
    assert sentence in str(raised.value)
    assert "\n" not in str(raised.value)
