"""What run folders hold is printed and drawn anew, whatever made it."""

import json

import pytest

from applications.rosbot.__main__ import main

SCENE = {
    "format": "rosbot-scenario/1",
    "name": "a crossing",
    "limits": {"v": [-0.5, 0.5], "omega": [-0.5, 0.5]},
    "robot": {"footprint": {"type": "circle", "radius": 0.15}},
    "bounds": {"x": [-1.0, 4.0], "y": [-1.0, 2.0]},
    "start": [0.0, 0.0, 0.0],
    "goal": [2.0, 1.0, 0.0],
    "goal_tolerance": {"position": 0.05, "heading": 0.1},
    "time_limit": 0.4,
    "obstacles": [{"type": "circle", "x": 2.0, "y": 0.0, "r": 0.2, "vx": 0.1, "vy": 0.1}],
}
TWO = SCENE | {
    "format": "rosbot-fleet/1",
    "name": "two",
    "robots": [{"start": [0.0, 0.0, 0.0]}, {"start": [0.0, 1.0, 0.0]}],
}


def plan(**changes):
    straight = {"trajectory": [[0.0, 0.0, 0.0, 0.0], [0.1, 0.05, 0.0, 0.0]], "controls": [[0.5, 0.0]] * 2}
    given = {"status": "planned", "planning_time": 1.0, "control_period": 0.05, "arrival_time": 0.1}
    return given | straight | changes


def fleet(**changes):
    given = {
        "status": "planned",
        "planning_time": 2.0,
        "last_arrival": 0.1,
        "clearance": 0.7,
        "alone": [0.1] * 2,
    }
    return given | {"robots": [plan(), plan()]} | changes


@pytest.fixture
def driven(tmp_path, capsys):
    (tmp_path / "scene.json").write_text(json.dumps(SCENE))
    out = tmp_path / "out"
    assert main(["drive", str(tmp_path / "scene.json"), "--out", str(out)]) == 4  # too late
    return out, capsys.readouterr().out


def test_a_drive_is_printed_and_drawn_as_when_it_was_made(driven, capsys):
    out, said = driven
    picture = (out / "drive.png").read_bytes()
    for place in (out, out / "drive.json"):
        (out / "drive.png").unlink()
        assert main(["show", str(place)]) == 0
        assert capsys.readouterr().out == f"{said}drawn: {out / 'drive.png'}\n"
        assert (out / "drive.png").read_bytes() == picture


def test_a_plan_a_drive_and_a_fleet_share_a_folder(driven, capsys):
    out, said = driven
    (out / "plan.json").write_text(json.dumps(plan()))
    (out / "scenario.json").write_text(json.dumps(SCENE | {"name": "for the plan"}))
    (out / "fleet.json").write_text(json.dumps(fleet()))
    (out / "scenario_fleet.json").write_text(json.dumps(TWO))
    assert main(["show", str(out)]) == 0
    shown = capsys.readouterr().out
    assert all(
        each in shown for each in ("for the plan", said, "two: planned, last arrival 0.10 s, alone 0.10 s")
    )
    assert shown.count("drawn: ") == 3
    assert all(
        (out / f"{name}.png").read_bytes().startswith(b"\x89PNG") for name in ("plan", "drive", "fleet")
    )


def test_without_its_scenario_a_drive_is_printed_and_an_older_picture_goes(driven, capsys):
    out, _ = driven
    (out / "scenario_drive.json").unlink()
    assert main(["show", str(out)]) == 0
    assert capsys.readouterr().out.startswith("drive: late, 0.40 s")
    assert not (out / "drive.png").exists()


@pytest.mark.parametrize(
    ("name", "content", "sentence"),
    [
        ("drive.json", "{", "drive.json is not JSON"),
        ("drive.json", "[]", "drive.json is not a drive"),
        ("drive.json", '{"status": "late"}', "drive.json is not a drive"),
        ("fleet.json", json.dumps(fleet(robots=[plan(), 3])), "fleet.json is not a plan of a fleet"),
        ("fleet.json", json.dumps(fleet(last_arrival=None)), "Expected arrivals and a plan of every robot"),
        ("fleet.json", json.dumps(fleet(robots=[plan()])), "scenario_fleet.json has 2 robots"),
        ("law.json", "{}", "law.json"),
    ],
)
def test_what_is_damaged_is_one_sentence(tmp_path, capsys, name, content, sentence):
    (tmp_path / "scenario_fleet.json").write_text(json.dumps(TWO))
    (tmp_path / name).write_text(content)
    assert main(["show", str(tmp_path)]) == 2
    shown = capsys.readouterr().err
    assert sentence in shown
    assert shown.startswith("error: ")
    assert shown.count("\n") == 1


def test_a_fleet_without_plans_says_why(tmp_path, capsys):
    found = fleet(status="unreachable", reason="no way", last_arrival=None, robots=[], clearance=None)
    (tmp_path / "fleet.json").write_text(json.dumps(found))
    (tmp_path / "fleet.png").touch()
    assert main(["show", str(tmp_path)]) == 0
    assert capsys.readouterr().out == "fleet: unreachable, no way\n"
    assert not (tmp_path / "fleet.png").exists()


def test_a_drive_that_never_began_says_why(tmp_path, capsys):
    nothing = {
        "status": "unreachable",
        "reason": "no way",
        "arrival_time": None,
        "clearance": None,
        "reach": 3.0,
    }
    nothing |= {
        "planning_ms": {"median": None, "max": None},
        "control_period": 0.05,
        "speeds": [],
        "courses": [],
    }
    (tmp_path / "drive.json").write_text(json.dumps(nothing))
    (tmp_path / "scenario_drive.json").write_text(json.dumps(SCENE))
    assert main(["show", str(tmp_path)]) == 0
    assert capsys.readouterr().out.startswith("a crossing: unreachable, no way\ndrawn: ")
