import copy
import json
import os
from pathlib import Path

import numpy as np
import pytest

import applications.rosbot
from applications.rosbot.scenario_file import LARGEST_FILE, parse_scenario, read_scenario
from gpsynth.errors import ScenarioError

OWN = Path(applications.rosbot.__file__).parent / "scenarios"
DOCUMENT = {
    "format": "rosbot-scenario/1",
    "model": "unicycle",
    "limits": {"v": [-0.2, 0.5], "omega": [-0.5, 0.4]},
    "robot": {"name": "rosbot", "footprint": {"type": "circle", "radius": 0.15}},
    "bounds": {"x": [-2, 3], "y": [-1, 4], "applies_to": "robot_centre"},
    "start": [0.0, 0.0, 0.0],
    "goal": [2.0, 2.0, 1],
    "goal_tolerance": {"position": 0.05, "heading": 0.1},
    "time_limit": 60.0,
    "obstacles": [
        {"type": "circle", "x": 0.75, "y": 0.1, "r": 0.35},
        {"type": "circle", "x": -1, "y": 1, "r": 0.3, "vx": 0.1, "vy": -0.2},
    ],
}


def changed(place: str, value: object) -> str:
    document = copy.deepcopy(DOCUMENT)
    *path, last = [int(key) if key.isdigit() else key for key in place.split(".")]
    inner = document
    for key in path:
        inner = inner[key]
    inner[last] = value
    return json.dumps(document)


def test_every_field_arrives():
    scenario = parse_scenario(json.dumps(DOCUMENT), name="given")
    assert scenario.speed_limits == (-0.2, 0.5)
    assert scenario.turn_limits == (-0.5, 0.4)
    assert np.array_equal(scenario.bounds, [-2.0, 3.0, -1.0, 4.0])
    assert np.array_equal(scenario.goal, [2.0, 2.0, 1.0])
    assert np.array_equal(scenario.circles, [[0.75, 0.1, 0.0, 0.0, 0.35], [-1.0, 1.0, 0.1, -0.2, 0.3]])
    assert (scenario.radius, scenario.position_tolerance, scenario.heading_tolerance) == (0.15, 0.05, 0.1)
    assert (scenario.time_limit, scenario.name, scenario.expect_feasible) == (60.0, "given", None)


def test_public_scenarios_are_read(public, public_path):
    document = json.loads(public_path.read_text())
    assert public.name == document["name"]
    assert public.expect_feasible == document["expect_feasible"]
    assert len(public.circles) == len(document["obstacles"])


@pytest.mark.parametrize(("name", "obstacles", "time_limit"), [("paper", 2, 18.0), ("paper_empty", 0, 15.0)])
def test_the_papers_scenarios_are_read(name, obstacles, time_limit):
    scenario = read_scenario(OWN / f"{name}.json")
    assert (scenario.name, len(scenario.circles), scenario.time_limit) == (name, obstacles, time_limit)
    assert "Inferred" in scenario.note


@pytest.mark.parametrize(
    ("place", "value", "sentence"),
    [
        ("format", "rosbot-scenario/2", 'format is "rosbot-scenario/2"; expected rosbot-scenario/1'),
        ("model", "boat", 'model is "boat"; expected unicycle, dynamic_unicycle, car'),
        ("colour", "red", 'colour is "red"; the format has no such field'),
        ("obstacles.1.z", 3, "obstacles[1].z is 3; the format has no such field"),
        ("obstacles.0.type", "square", 'obstacles[0].type is "square"; expected circle, segment, polygon'),
        ("obstacles.0.r", "wide", 'obstacles[0].r is "wide"; expected float, got str'),
        ("obstacles.0.r", -0.35, "obstacles[0] has radius -0.35; expected at least 0"),
        ("obstacles.0.x", True, "obstacles[0].x is true; expected float, got bool"),
        ("obstacles.0.x", 10**400, "number out of range"),
        ("limits.v", [float("nan"), 0.5], "limits.v[0] is nan; expected a finite number"),
        ("limits.omega", [-0.5, float("inf")], "limits.omega[1] is inf; expected a finite number"),
        ("limits.omega", [0.5, -0.5], "limits of omega are [0.5, -0.5]"),
        ("limits.v", [0.5], "limits.v is [0.5]; expected array of length 2, got 1"),
        ("start", [0.75, 0.1, 0.0], "start (0.75, 0.1) overlaps obstacles[0] by 0.5 m"),
        ("goal", [9.0, 0.0, 0.0], "goal (9, 0) lies outside the bounds"),
        ("robot.footprint.radius", -1, "the robot's radius is -1.0"),
        ("time_limit", None, "time_limit is null; expected float, got null"),
    ],
)
def test_what_is_wrong_is_named_with_field_and_value(tmp_path, place, value, sentence):
    path = tmp_path / "wrong.json"
    path.write_text(changed(place, value))
    with pytest.raises(ScenarioError) as caught:
        read_scenario(path)
    assert str(caught.value).startswith(f"{path}: ")
    assert sentence in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("place", ["goal", "limits.v", "robot.footprint.radius", "obstacles.0.r"])
def test_a_missing_field_is_named(place):
    document = json.loads(changed(place, None))
    *path, last = [int(key) if key.isdigit() else key for key in place.split(".")]
    inner = document
    for key in path:
        inner = inner[key]
    del inner[last]
    named = place.replace(".0.", "[0].") + " is missing"
    with pytest.raises(ScenarioError) as caught:
        parse_scenario(json.dumps(document))
    assert str(caught.value) == named


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (b"", "is not JSON"),
        (b"{", "is not JSON"),
        (b"\x81", "is not JSON"),
        (b"[]", "the document is []; expected object, got array"),
        (b'{"goal": 1, "goal": 2}', 'field "goal" stands twice'),
        (b"[" * 100_000, "nested too deeply"),
        (b"1" * 5000, "is not JSON"),
        (b"[" * 3000 + b"]" * 3000, "nested too deeply"),
        (changed("name", "\ud800"), r'name is "\ud800"; half of a surrogate pair'),
        (changed("\ud800", 1), r'"\ud800" is 1; the format has no such field'),
        (changed("robot.a\nb", "c\nd"), r'robot."a\nb" is "c\nd"; the format has no such field'),
        (changed("x` - at `$", 1), '"x` - at `$" is 1; the format has no such field'),
        (changed("time_limit", 10**400), "number out of range"),
    ],
)
def test_what_is_no_scenario_is_refused(text, sentence):
    with pytest.raises(ScenarioError, match=r"^[^\n]*$") as caught:
        parse_scenario(text)
    assert sentence in str(caught.value)


def test_a_missing_file_a_folder_and_a_huge_file_are_refused(tmp_path):
    huge = tmp_path / "huge.json"
    huge.write_bytes(b" " * (LARGEST_FILE + 1))
    for path, reason in (
        (tmp_path / "none.json", "No such file"),
        (tmp_path, "directory"),
        (huge, "too large"),
    ):
        with pytest.raises(ScenarioError, match=reason) as caught:
            read_scenario(path)
        assert str(caught.value).startswith(f"{path}: ")


def test_a_pipe_and_a_device_are_refused_and_not_waited_for(tmp_path):
    os.mkfifo(tmp_path / "pipe.json")
    for path in (tmp_path / "pipe.json", Path("/dev/zero")):
        with pytest.raises(ScenarioError, match="cannot be read: it is not a regular file"):
            read_scenario(path)
