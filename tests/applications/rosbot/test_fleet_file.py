"""Fleet files: what all robots share and what each has of its own, the command, and one sentence for bad input."""

import json
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from applications.rosbot import fleet, fleet_search
from applications.rosbot.__main__ import main
from applications.rosbot.arcs import arcs
from applications.rosbot.encounters import least_distance
from applications.rosbot.fleet_file import parse_fleet, read_fleet
from gpsynth.errors import ScenarioError
from tests.applications.rosbot.test_fleet import QUICK

SCENARIOS = Path("applications/rosbot/scenarios")
FLEET = {
    "format": "rosbot-fleet/1",
    "name": "two",
    "limits": {"v": [-0.5, 0.5], "omega": [-0.5, 0.5]},
    "robot": {"footprint": {"type": "circle", "radius": 0.15}},
    "bounds": {"x": [-1.0, 4.0], "y": [-0.45, 0.45]},
    "goal_tolerance": {"position": 0.05, "heading": 0.1},
    "time_limit": 30.0,
    "obstacles": [],
    "robots": [
        {"start": [0.0, 0.0, 0.0], "goal": [2.0, 0.0, 0.0]},
        {"start": [2.0, 0.0, 3.14], "goal": [0.0, 0.0, 3.14], "time_limit": 20.0},
    ],
}


@pytest.fixture
def quick(monkeypatch):
    """A search of a fraction of a second."""
    monkeypatch.setattr(fleet, "plan_fleet", partial(fleet.plan_fleet, effort=QUICK))


def test_what_a_robot_has_of_its_own_comes_before_what_all_share():
    found = parse_fleet(json.dumps(FLEET))
    assert found.name == "two"
    assert [each.start.tolist() for each in found.scenarios] == [[0.0, 0.0, 0.0], [2.0, 0.0, 3.14]]
    assert [each.time_limit for each in found.scenarios] == [30.0, 20.0]
    assert [each.radius for each in found.scenarios] == [0.15, 0.15]


@pytest.mark.parametrize("name", ["corridor_exchange", "street_crossing"])
def test_the_fleets_that_come_along_can_be_planned(name):
    fleet.check_fleet(read_fleet(SCENARIOS / f"{name}.json").scenarios)


def changed(**changes):
    return json.dumps(FLEET | changes)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("[]", "format is 'list'; expected \"rosbot-fleet/1\""),
        (changed(format="rosbot-scenario/1"), "format is 'rosbot-scenario/1'; expected"),
        (changed(robots=FLEET["robots"][:1]), "robots is 1 of them; expected a list of 2 to 100"),
        (changed(robots="two"), "robots is str; expected a list"),
        (changed(robots=[FLEET["robots"][0], 7]), "robots[1] is no object"),
        (changed(robots=[{"goal": [0, 0, 0]}] * 2), "robots[0]: start is missing"),
        (
            changed(robots=[FLEET["robots"][0], FLEET["robots"][1] | {"speed": 3}]),
            "robots[1]: speed is 3; the",
        ),
        (changed(start=[0, 0, 0], limits=7), "robots[0]: limits is 7"),
        (
            changed(robots=[FLEET["robots"][0] | {"start": [9, 0, 0]}] * 2),
            "robots[0]: start (9, 0) lies outside",
        ),
    ],
)
def test_wrong_files_are_refused(text, sentence):
    with pytest.raises(ScenarioError) as caught:
        parse_fleet(text)
    assert sentence in str(caught.value)


def test_the_command_writes_plans_that_anybody_can_check(quick, tmp_path, capsys):
    file = tmp_path / "two.json"
    file.write_text(json.dumps(FLEET))
    assert main(["fleet", str(file), "--out", str(tmp_path / "run")]) == 0
    assert capsys.readouterr().out.startswith("two: planned, last arrival ")
    found = json.loads((tmp_path / "run" / "fleet.json").read_text())
    assert (tmp_path / "run" / "fleet.png").read_bytes().startswith(b"\x89PNG")
    assert json.loads((tmp_path / "run" / "scenario_fleet.json").read_text()) == FLEET
    paths = []
    for own, plan in zip(FLEET["robots"], found["robots"], strict=True):
        begins = plan["control_period"] * np.arange(len(plan["controls"]))
        held = np.clip(plan["arrival_time"] - begins, 0.0, plan["control_period"])
        paths.append(arcs(np.array(own["start"]), np.array(plan["controls"]), held))
    [encounter] = found["encounters"]
    assert encounter["robots"] == [0, 1]
    assert encounter["clearance"] == found["clearance"] >= 0.0
    assert least_distance(*paths)[0] - 0.3 == pytest.approx(found["clearance"], abs=1e-9)
    assert found["last_arrival"] == max(plan["arrival_time"] for plan in found["robots"])


def test_a_goal_that_cannot_be_reached_has_a_code_of_its_own(tmp_path, capsys):
    file = tmp_path / "shut.json"
    file.write_text(
        changed(
            obstacles=[{"type": "circle", "x": 2.0, "y": 0.1, "r": 0.2}],
            robots=[
                FLEET["robots"][0],
                {"start": [0.5, 0.0, 0.0], "goal": [0.0, 0.0, 0.0]},
            ],
        )
    )
    assert main(["fleet", str(file), "--out", str(tmp_path / "run")]) == 3
    assert "unreachable, robot 0, alone: " in capsys.readouterr().out
    assert json.loads((tmp_path / "run" / "fleet.json").read_text())["robots"] == []
    assert not (tmp_path / "run" / "fleet.png").exists()


def test_overlapping_starts_are_one_sentence(tmp_path, capsys):
    file = tmp_path / "near.json"
    near = {"start": [0.2, 0.0, 0.0], "goal": [1.0, 0.0, 0.0]}
    file.write_text(changed(robots=[FLEET["robots"][0], near]))
    assert main(["fleet", str(file), "--out", str(tmp_path / "run")]) == 2
    assert "the starts of robots 0 and 1 overlap by 0.1 m" in capsys.readouterr().err


def test_what_was_found_when_a_search_is_interrupted_is_kept(quick, monkeypatch, tmp_path):
    def broken_off(self, alone):
        yield from run(self, alone)
        raise KeyboardInterrupt

    run = fleet_search.FleetSearch.run
    monkeypatch.setattr(fleet_search.FleetSearch, "run", broken_off)
    file = tmp_path / "two.json"
    file.write_text(json.dumps(FLEET))
    assert main(["fleet", str(file), "--out", str(tmp_path / "run")]) == 130
    found = json.loads((tmp_path / "run" / "fleet.json").read_text())
    assert (found["status"], found["ended"]) == ("planned", "interrupted")
