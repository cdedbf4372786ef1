"""Plans in rooms and for bodies, judged by distances that the planner does not use."""

import json
from pathlib import Path

import numpy as np
import pytest

import applications.rosbot
from applications.rosbot.__main__ import main
from applications.rosbot.footprint import placed, rectangle_circles
from applications.rosbot.map_file import read_map
from applications.rosbot.model import unicycle
from applications.rosbot.office import office
from applications.rosbot.planner import Effort, plan_scenario
from applications.rosbot.polar_law import SATURATING, polar_law
from applications.rosbot.problems import PERIOD
from applications.rosbot.replay import drive
from applications.rosbot.room import Room
from applications.rosbot.saved import read_plan
from applications.rosbot.scenario import Scenario
from applications.rosbot.scenario_file import read_scenario
from gpsynth.planning import PlanSettings

OFFICE = Path(applications.rosbot.__file__).parent / "scenarios" / "office.json"
QUICK = Effort(
    points=5,
    scouts=PlanSettings(particles=16, iterations=8, rounds=2),
    chasers=PlanSettings(particles=24, iterations=10, rounds=2),
    refiners=PlanSettings(particles=24, iterations=10, rounds=1),
    chased=2,
    refined=1,
)
BOX = [[-1.0, -1.5, 4.0, -1.5], [4.0, -1.5, 4.0, 1.5], [4.0, 1.5, -1.0, 1.5], [-1.0, 1.5, -1.0, -1.5]]
DESK = np.array([[1.0, -1.5], [1.8, -1.5], [1.8, 0.3], [1.0, 0.2]])


def room() -> Room:
    return Room(polygons=(DESK,), segments=np.array([*BOX, [2.6, 1.5, 2.6, 0.1]]))


def planned(**changes):
    scenario = Scenario(**{"start": [0.0, 0.0, 0.0], "goal": [3.3, 0.0, 0.0], "room": room()} | changes)
    report = plan_scenario(scenario, [polar_law(unicycle(), SATURATING)], seed=1, effort=QUICK)
    assert report.status == "planned"
    return scenario, report


def poses(scenario: Scenario, report) -> np.ndarray:
    controls = report.plan.trajectory.u
    path = drive(scenario.start, controls, np.full(len(controls), PERIOD))
    return path[path[:, 0] <= report.replay.arrival_time, 1:]


def test_a_plan_in_a_room_keeps_what_its_certificate_says():
    scenario, report = planned()
    gap = room().gaps(poses(scenario, report)[:, :2]).min() - scenario.radius
    assert report.certificate.is_clear
    assert report.certificate.clearance <= gap + 1e-9
    assert gap - report.certificate.clearance < 0.01
    assert report.replay.clearance == pytest.approx(gap, abs=1e-9)


def test_a_rectangle_passes_with_all_of_its_corners():
    body = rectangle_circles(0.5, 0.24, (0.05, 0.0))
    scenario, report = planned(footprint=body)
    corners = np.array([[0.3, 0.12, 0.0], [0.3, -0.12, 0.0], [-0.2, 0.12, 0.0], [-0.2, -0.12, 0.0]])
    places = placed(corners, poses(scenario, report)[::10])
    assert room().gaps(places.reshape(-1, 2)).min() >= report.certificate.clearance > 0.0


def test_a_body_passes_moving_circles():
    body = np.array([[0.15, 0.0, 0.12], [-0.15, 0.0, 0.12]])
    crossing = [[1.5, -1.0, 0.0, 0.3, 0.25]]
    scenario, report = planned(footprint=body, circles=crossing, room=None)
    track = poses(scenario, report)
    centers, times = placed(body, track), 1e-3 * np.arange(len(track))
    apart = np.hypot(centers[..., 0] - 1.5, centers[..., 1] + 1.0 - 0.3 * times[:, None]) - 0.37
    assert apart.min() >= report.certificate.clearance - 1e-3
    assert report.certificate.clearance >= 0.0


def test_the_office_is_the_one_that_is_drawn():
    found = read_map(OFFICE.with_suffix(".yaml"))
    assert np.array_equal(found.cells == 100, office()[::-1] == 0)
    assert np.array_equal(found.cells == -1, office()[::-1] == 205)
    assert found.cells.shape == (300, 400)


def test_unknown_space_is_occupied_or_free_as_the_scenario_says(tmp_path):
    rooms = {}
    for unknown in ("occupied", "free"):
        part = {"file": str(OFFICE.with_suffix(".yaml")), "unknown": unknown}
        (tmp_path / "office.json").write_text(json.dumps(json.loads(OFFICE.read_text()) | {"map": part}))
        rooms[unknown] = read_scenario(tmp_path / "office.json").room
    places = np.array(
        [[7.5, 12.0], [-0.02, 5.0], [7.5, 7.5], [0.1, 0.1]]
    )  # unmapped, beyond the map, free, a wall
    assert np.array_equal(rooms["occupied"].gaps(places) > 0.0, [False, False, True, False])
    assert np.array_equal(rooms["free"].gaps(places) > 0.0, [True, True, True, False])


@pytest.mark.slow
def test_a_plan_through_the_office_comes_soon():
    scenario = read_scenario(OFFICE)
    found = plan_scenario(scenario, [polar_law(unicycle(), SATURATING)], effort=Effort(rollouts=10_000))
    assert (found.status, found.ended) == ("planned", "rollouts")
    assert found.certificate.clearance >= 0.0


@pytest.mark.slow
def test_a_run_folder_keeps_the_map(tmp_path):
    document = json.loads(OFFICE.read_text())
    document |= {"goal": [3.5, 5.0, 0.0], "map": {"file": "maps/office.yaml"}}
    (tmp_path / "in" / "maps").mkdir(parents=True)
    for name in ("office.yaml", "office.png"):
        (tmp_path / "in" / "maps" / name).write_bytes(OFFICE.with_name(name).read_bytes())
    (tmp_path / "in" / "near.json").write_text(json.dumps(document))
    assert main(["plan", str(tmp_path / "in" / "near.json"), "--out", str(tmp_path / "out")]) == 0
    again = read_scenario(tmp_path / "out" / "scenario.json")
    assert np.array_equal(again.room.cells, read_scenario(tmp_path / "in" / "near.json").room.cells)
    assert read_plan(tmp_path / "out" / "plan.json").is_found
    assert (tmp_path / "out" / "plan.png").exists()


def test_a_drive_keeps_the_map_too(tmp_path):
    short = tmp_path / "short.json"
    short.write_text(json.dumps(json.loads(OFFICE.read_text()) | {"time_limit": 0.1}))
    for name in ("office.yaml", "office.png"):
        (tmp_path / name).write_bytes(OFFICE.with_name(name).read_bytes())
    assert main(["drive", str(short), "--out", str(tmp_path / "out")]) == 4
    again = read_scenario(tmp_path / "out" / "scenario_drive.json")
    assert np.array_equal(again.room.cells, read_scenario(short).room.cells)


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"map": {"file": "none.yaml"}}, "none.yaml: the map cannot be read: No such file"),
        (
            {"map": {"file": "../office.yaml"}},
            'map.file is "../office.yaml"; expected the name of a file in the',
        ),
        (
            {"map": {"file": "office.yaml", "unknown": "grey"}},
            'map.unknown is "grey"; expected occupied, free',
        ),
        ({"start": [0.1, 3.0, 0.0]}, "overlaps the map, a polygon or a segment by"),
        (
            {"obstacles": [{"type": "polygon", "corners": [[0, 0], [1, 1]]}]},
            "has 2 corners; expected at least 3",
        ),
        (
            {"obstacles": [{"type": "segment", "start": [0, 0], "end": [1e5, 1]}]},
            "expected finite numbers within",
        ),
        (
            {"robot": {"footprint": {"type": "square"}}},
            'type is "square"; expected circle, circles, rectangle',
        ),
        ({"robot": {"footprint": {"type": "rectangle", "length": -1, "width": 1}}}, "length is -1; expected"),
        ({"robot": {"footprint": {"type": "circles", "circles": []}}}, "circles are 0; expected 1 to 100"),
    ],
)
def test_what_is_wrong_is_one_sentence_and_exit_code_2(tmp_path, capsys, change, sentence):
    for name in ("office.yaml", "office.png"):
        (tmp_path / name).write_bytes(OFFICE.with_name(name).read_bytes())
    (tmp_path / "wrong.json").write_text(json.dumps(json.loads(OFFICE.read_text()) | change))
    assert main(["plan", str(tmp_path / "wrong.json"), "--out", str(tmp_path / "out")]) == 2
    assert sentence in capsys.readouterr().err.replace("\n", " ")
    assert not (tmp_path / "out").exists()
