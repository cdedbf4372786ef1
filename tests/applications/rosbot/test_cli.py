"""The command `python -m applications.rosbot`: plans anybody can replay, exit codes, and one sentence for bad input."""

import errno
import json
import math
import os
import signal
import subprocess
import sys
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from applications.rosbot import show, stages
from applications.rosbot.__main__ import cli, main
from applications.rosbot.model import unicycle, wheel_coupled
from applications.rosbot.planner import Effort, plan_scenario
from applications.rosbot.polar_law import polar_law
from gpsynth.law import Law
from gpsynth.planning import PlanSettings
from gpsynth.record import Run, read_progress

SCENARIO = {
    "format": "rosbot-scenario/1",
    "limits": {"v": [-0.5, 0.5], "omega": [-0.5, 0.5]},
    "robot": {"footprint": {"type": "circle", "radius": 0.1}},
    "bounds": {"x": [-3.0, 3.0], "y": [-3.0, 3.0]},
    "start": [0.0, 0.0, 0.0],
    "goal": [1.0, 0.5, 0.0],
    "goal_tolerance": {"position": 0.05, "heading": 0.1},
    "time_limit": 20.0,
    "obstacles": [],
}
CIRCLE = {"type": "circle", "x": 0.5, "y": -0.5, "r": 0.2}
RING = [
    {"type": "circle", "x": 1.0 + 0.6 * math.cos(a), "y": 0.5 + 0.6 * math.sin(a), "r": 0.2}
    for a in np.linspace(0.0, 2.0 * np.pi, 12, endpoint=False)
]


@pytest.fixture
def scenario_file(tmp_path):
    def write(text=None, **changes):
        path = tmp_path / "room.json"
        path.write_text(json.dumps({**SCENARIO, **changes}) if text is None else text)
        return path

    return write


@pytest.fixture
def quick(monkeypatch):
    """A search that takes a fraction of a second; what is given is called when it is over."""

    def search(after=lambda: None):
        def planned(scenario, laws, **options):
            small = PlanSettings(particles=16, iterations=8, rounds=2)
            options["effort"] = Effort(
                scouts=small, chasers=small, refiners=small, chased=1, refined=1, attempts=1
            )
            report = plan_scenario(scenario, laws, **options)
            after()
            return report

        monkeypatch.setattr(stages, "plan_scenario", planned)

    return search


@pytest.fixture
def law_file(tmp_path):
    path = tmp_path / "some_law.json"
    polar_law(unicycle()).save(path)
    return path


def _run(*arguments):
    return main([str(argument) for argument in arguments])


def _fails(capsys, *arguments, sentence):
    """The command ends with 2 and one line on stderr that holds all of `sentence`."""
    assert _run(*arguments) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith("error: ")
    assert captured.err.count("\n") == 1
    for words in sentence:
        assert words in captured.err


def _arcs(start, controls, period, pieces=20):
    """Poses (N, 3) of a unicycle under held controls, by circular arcs: the exact solution."""
    poses = [start]
    for v, omega in controls:
        for _ in range(pieces):
            (x, y, theta), step = poses[-1], period / pieces
            chord = v * step * np.sinc(0.5 * omega * step / np.pi)
            middle = theta + 0.5 * omega * step
            poses.append((x + chord * math.cos(middle), y + chord * math.sin(middle), theta + omega * step))
    return np.array(poses)


def _replays(plan, scenario):
    """The controls of a plan, driven by arcs, do what the plan says."""
    controls, period = np.array(plan["controls"]), plan["control_period"]
    (v_low, v_high), (omega_low, omega_high) = scenario["limits"]["v"], scenario["limits"]["omega"]
    assert np.all((controls >= [v_low, omega_low]) & (controls <= [v_high, omega_high]))
    poses = _arcs(tuple(scenario["start"]), controls, period)
    radius = scenario["robot"]["footprint"]["radius"]
    gaps = [
        np.hypot(*(poses[:, :2] - (c["x"], c["y"])).T).min() - c["r"] - radius for c in scenario["obstacles"]
    ]
    if gaps:
        # the arcs are sampled every 2.5 ms, in which the robot moves 1.25 mm
        assert plan["clearance"] == pytest.approx(min(gaps), abs=1.5e-3)
        assert min(gaps) >= 0.0
    error = poses - np.array(scenario["goal"])
    tolerance = scenario["goal_tolerance"]
    arrived = (np.hypot(error[:, 0], error[:, 1]) <= tolerance["position"]) & (
        np.abs(np.remainder(error[:, 2] + np.pi, 2.0 * np.pi) - np.pi) <= tolerance["heading"]
    )
    assert arrived.any()
    first = int(np.argmax(arrived)) * period / 20
    assert plan["arrival_time"] == pytest.approx(first, abs=period)


@pytest.mark.slow
@pytest.mark.parametrize("obstacles", [[], [CIRCLE]], ids=["empty", "circle"])
def test_a_plan_can_be_replayed(capsys, scenario_file, law_file, tmp_path, obstacles):
    out = tmp_path / "out"
    scenario = {**SCENARIO, "obstacles": obstacles}
    path = scenario_file(obstacles=obstacles)
    assert _run("plan", path, "--out", out, "--law", law_file, "--seed", "3") == 0
    plan = json.loads((out / "plan.json").read_text())
    assert plan["status"] == "planned"
    assert plan["planning_time"] > 0.0
    assert plan["trajectory"][0] == [0.0, *SCENARIO["start"]]
    _replays(plan, scenario)
    assert f"{plan['arrival_time']:.2f}" in capsys.readouterr().out
    assert (out / "scenario.json").read_bytes() == path.read_bytes()
    assert (out / "plan.png").read_bytes().startswith(b"\x89PNG")
    assert read_progress(out)[-1]["stage"] == "plan room"
    elapsed = [entry["elapsed"] for entry in read_progress(out)]
    assert elapsed == sorted(elapsed)
    assert elapsed[-1] - elapsed[0] < plan["planning_time"]  # when it was found, not when it was written


@pytest.mark.slow
def test_the_same_seed_gives_the_same_controls(scenario_file, law_file, tmp_path):
    plans = []
    for number in (1, 2):
        out = tmp_path / f"out{number}"
        _run("plan", scenario_file(), "--out", out, "--law", law_file, "--seed", "5", "--threads", number)
        plans.append(json.loads((out / "plan.json").read_text()))
    assert plans[0]["controls"] == plans[1]["controls"]
    assert plans[0]["schedule"] == plans[1]["schedule"]


def test_a_deadline_ends_the_search_with_what_is_there(scenario_file, law_file, tmp_path):
    out = tmp_path / "out"
    assert _run("plan", scenario_file(), "--out", out, "--law", law_file, "--deadline", "0.001") in (0, 4)
    assert json.loads((out / "plan.json").read_text())["ended"] == "deadline"


@pytest.mark.slow
def test_a_plan_needs_no_law_of_one_s_own(scenario_file, tmp_path):
    assert _run("plan", scenario_file(), "--out", tmp_path / "out") == 0
    _replays(json.loads((tmp_path / "out" / "plan.json").read_text()), SCENARIO)


def test_a_drive_among_movers_can_be_replayed(capsys, scenario_file, law_file, tmp_path):
    coming = {**CIRCLE, "x": 1.6, "y": 1.1, "vx": -0.3, "vy": -0.3}
    path, out = scenario_file(obstacles=[coming]), tmp_path / "out"
    assert _run("drive", path, "--out", out, "--law", law_file, "--seed", "3") == 0
    drive = json.loads((out / "drive.json").read_text())
    assert drive["status"] == "arrived"
    poses = _arcs(tuple(SCENARIO["start"]), drive["speeds"], drive["control_period"])
    times = drive["control_period"] / 20 * np.arange(len(poses))
    places = np.array([[coming["x"], coming["y"]]]) + times[:, np.newaxis] * [coming["vx"], coming["vy"]]
    gaps = np.hypot(*(poses[:, :2] - places).T) - coming["r"] - SCENARIO["robot"]["footprint"]["radius"]
    assert drive["clearance"] == pytest.approx(gaps.min(), abs=2.5e-3)  # both move between the samples
    assert gaps.min() > 0.0
    assert len(drive["courses"]) == math.ceil(len(drive["speeds"]) / 2)
    assert f"room: arrived, {drive['arrival_time']:.2f} s" in capsys.readouterr().out
    assert (out / "drive.png").read_bytes().startswith(b"\x89PNG")
    assert (out / "scenario_drive.json").read_bytes() == path.read_bytes()


def test_a_robot_that_is_not_driven_leaves_nothing(capsys, scenario_file, law_file, tmp_path):
    car, out = scenario_file(model="car", robot=SCENARIO["robot"] | {"turning_radius": 0.5}), tmp_path / "out"
    _fails(
        capsys,
        "drive",
        car,
        "--out",
        out,
        "--law",
        law_file,
        sentence=["the robot is a car; the loop drives"],
    )
    assert not out.exists()


def test_a_drive_that_does_not_arrive_is_4(scenario_file, law_file, tmp_path):
    late = scenario_file(time_limit=0.5)
    assert _run("drive", late, "--out", tmp_path / "out", "--law", law_file) == 4
    assert json.loads((tmp_path / "out" / "drive.json").read_text())["status"] == "late"


def test_a_drive_to_an_enclosed_goal_does_not_set_off_and_is_3(capsys, scenario_file, law_file, tmp_path):
    path, out = scenario_file(obstacles=[*RING, {**CIRCLE, "vx": 0.1}]), tmp_path / "out"
    assert _run("drive", path, "--out", out, "--law", law_file) == 3
    drive = json.loads((out / "drive.json").read_text())
    assert (drive["status"], drive["arrival_time"]) == ("unreachable", None)
    assert drive["speeds"] == drive["courses"] == []
    assert "shut the goal off from the start" in drive["reason"]
    assert drive["reason"] in capsys.readouterr().out
    assert drive["trajectory"] == [[0.0, *SCENARIO["start"]]]
    assert (out / "drive.png").read_bytes().startswith(b"\x89PNG")
    assert (out / "scenario_drive.json").read_bytes() == path.read_bytes()


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        (["--reach", "0"], ["the sensor's reach is 0.0 m; expected more than 0"]),
        (["--margin", "-1"], ["the margin is -1.0 m", "expected 0 <= least <= margin"]),
    ],
)
def test_a_drive_with_wrong_numbers_is_one_sentence(
    capsys, scenario_file, law_file, tmp_path, options, sentence
):
    path = scenario_file()
    _fails(capsys, "drive", path, "--out", tmp_path / "out", "--law", law_file, *options, sentence=sentence)
    assert not (tmp_path / "out").exists()


def test_more_movers_than_can_be_told_apart_is_one_sentence(capsys, scenario_file, law_file, tmp_path):
    path = scenario_file(obstacles=[{**CIRCLE, "vx": 0.1}] * 33)
    sentence = ["33 circles move; the sensor can tell 32 apart"]
    _fails(capsys, "drive", path, "--out", tmp_path / "out", "--law", law_file, sentence=sentence)


def test_an_unreachable_goal_is_3_with_the_reason(capsys, scenario_file, law_file, tmp_path):
    out = tmp_path / "out"
    out.mkdir()
    (out / "plan.png").touch()  # of an earlier plan
    assert _run("plan", scenario_file(obstacles=RING), "--out", out, "--law", law_file) == 3
    plan = json.loads((out / "plan.json").read_text())
    assert plan["status"] == "unreachable"
    assert plan["reason"]
    assert "unreachable" in capsys.readouterr().out
    assert not (out / "plan.png").exists()
    assert _run("show", out) == 0


def test_a_time_limit_that_no_plan_can_keep_is_3_and_one_that_no_plan_was_found_for_is_4(
    capsys, scenario_file, law_file, quick, tmp_path
):
    quick()
    for limit, code, status, words in (
        (1.0, 3, "unreachable", "too late: no plan arrives before"),
        (2.6, 4, "not_found", "the goal may still be reachable"),  # 1 % above the bound
    ):
        out = tmp_path / status
        assert _run("plan", scenario_file(time_limit=limit), "--out", out, "--law", law_file) == code
        plan = json.loads((out / "plan.json").read_text())
        assert plan["lower_bound"] == pytest.approx(2.576, abs=1e-3)
        assert (plan["status"], plan["controls"], plan["certificate"]) == (status, [], None)
        assert words in plan["reason"]
        assert words in capsys.readouterr().out


def test_a_plan_that_cannot_be_written_is_printed(
    capsys, monkeypatch, scenario_file, law_file, quick, tmp_path
):
    def full(descriptor):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    quick(after=lambda: monkeypatch.setattr(os, "fsync", full))
    assert _run("plan", scenario_file(), "--out", tmp_path / "out", "--law", law_file) == 2
    captured = capsys.readouterr()
    assert captured.err.count("\n") == 1
    assert (
        "plan.json cannot be written: No space left on device; what was found is on standard output"
        in captured.err
    )
    _replays(json.loads(captured.out), SCENARIO)
    assert not (tmp_path / "out" / "plan.json").exists()


@pytest.mark.parametrize(
    ("place", "name", "error", "what", "gone"),
    [
        (show, "save_figure", RuntimeError("no font"), "its picture is not: no font", "plan.png"),
        (show, "draw_plan", MemoryError(), "its picture is not: MemoryError", "plan.png"),
        (stages, "write_bytes", OSError(errno.ENOSPC, "full"), "its scenario is not: ", "scenario.json"),
        (Run, "log", OSError(errno.ENOSPC, "full"), "its log is not: ", None),
    ],
)
def test_a_plan_is_kept_whatever_fails_after_it(
    capsys, monkeypatch, scenario_file, law_file, quick, tmp_path, place, name, error, what, gone
):
    def fails(*_, **__):
        raise error

    quick()
    monkeypatch.setattr(place, name, fails)
    out = tmp_path / "out"
    out.mkdir()
    if gone:
        (out / gone).write_text("of an earlier plan")
    assert _run("plan", scenario_file(), "--out", out, "--law", law_file) == 0
    captured = capsys.readouterr()
    assert captured.err.startswith(f"warning: {out / 'plan.json'} is written, {what}")
    assert captured.err.count("\n") == 1
    assert "planned" in captured.out
    _replays(json.loads((out / "plan.json").read_text()), SCENARIO)
    assert gone is None or not (out / gone).exists()


def _interrupted(monkeypatch, when):
    """Ctrl-C at the first report of which `when` holds."""

    def note(report):
        if when(report):
            signal.raise_signal(signal.SIGINT)

    monkeypatch.setattr(stages, "plan_scenario", partial(plan_scenario, callback=note))


def test_ctrl_c_keeps_the_best_plan_so_far(capsys, monkeypatch, scenario_file, law_file, tmp_path):
    out = tmp_path / "out"
    _interrupted(monkeypatch, lambda report: len(report.history) == 2)
    assert _run("plan", scenario_file(), "--out", out, "--law", law_file) == 130
    plan = json.loads((out / "plan.json").read_text())
    assert (plan["status"], plan["ended"]) == ("planned", "interrupted")
    assert plan["evaluations"] < 10_000
    _replays(plan, SCENARIO)
    captured = capsys.readouterr()
    assert "planned" in captured.out
    assert "interrupted" in captured.err
    assert (out / "plan.png").exists()


def test_ctrl_c_while_a_plan_is_written_comes_too_late(monkeypatch, scenario_file, law_file, quick, tmp_path):
    replace, pressed = os.replace, []

    def interrupted(self, target):
        if not pressed and target.name == "plan.json":
            pressed.append(True)
            raise KeyboardInterrupt
        replace(self, target)

    quick()
    monkeypatch.setattr(Path, "replace", interrupted)
    assert _run("plan", scenario_file(), "--out", tmp_path / "out", "--law", law_file) == 130
    _replays(json.loads((tmp_path / "out" / "plan.json").read_text()), SCENARIO)


@pytest.mark.slow
def test_places_are_passed_on_the_way(scenario_file, law_file, tmp_path):
    out, places = tmp_path / "out", ("--via", "0.3", "0.8", "0.1", "--via", "-0.2", "0.2", "0.1")
    assert _run("plan", scenario_file(), "--out", out, "--law", law_file, *places) == 0
    plan = json.loads((out / "plan.json").read_text())
    assert plan["via"] == [[0.3, 0.8, 0.1], [-0.2, 0.2, 0.1]]
    path = np.array(plan["trajectory"])
    # the trajectory has a pose a period, in which the robot moves 0.025 m at most
    first = np.hypot(path[:, 1] - 0.3, path[:, 2] - 0.8) <= 0.1 + 0.0125
    then = np.hypot(path[:, 1] + 0.2, path[:, 2] - 0.2) <= 0.1 + 0.0125
    assert np.argmax(first) < len(path) - np.argmax(then[::-1])
    assert np.any(first)
    assert np.any(then)


def test_a_place_out_of_bounds_is_one_sentence_and_leaves_nothing(capsys, scenario_file, law_file, tmp_path):
    out = tmp_path / "out"
    given = ("plan", scenario_file(), "--out", out, "--law", law_file, "--via", "9", "0", "0.1")
    _fails(capsys, *given, sentence=["via-point 0 (9, 0) lies outside the bounds"])
    assert not out.exists()


def test_ctrl_c_before_a_plan_leaves_none(monkeypatch, scenario_file, law_file, tmp_path):
    _interrupted(monkeypatch, lambda report: report.status == "not_found")
    late = scenario_file(time_limit=2.6)
    assert _run("plan", late, "--out", tmp_path / "out", "--law", law_file) == 130
    assert not (tmp_path / "out" / "plan.json").exists()


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"text": "not JSON"}, ["JSON"]),
        ({"text": ""}, ["JSON"]),
        ({"text": json.dumps([SCENARIO])}, ["the document"]),
        ({"speed": 1.0}, ["speed", "no such field"]),
        ({"limits": {"v": [math.nan, 0.5], "omega": [-0.5, 0.5]}}, ["limits.v[0]", "nan", "finite"]),
        ({"limits": {"v": [0.5, -0.5], "omega": [-0.5, 0.5]}}, ["limits of v", "less than"]),
        ({"limits": {"v": [-0.5, 0.5]}}, ["limits.omega", "missing"]),
        ({"obstacles": [{**CIRCLE, "x": 0.0, "y": 0.1}]}, ["start", "obstacles[0]"]),
        ({"start": [9.0, 0.0, 0.0]}, ["start", "outside the bounds"]),
        ({"goal": [0.0, 3.1, 0.0]}, ["goal (0, 3.1)", "outside the bounds"]),
        ({"bounds": {"x": [-3.0, 3.0], "y": [3.0, -3.0]}}, ["bounds of y are [3, -3]", "less than"]),
        (
            {"limits": {"v": [-0.5, 0.5], "omega": [0.5, 0.5]}},
            ["limits of omega are [0.5, 0.5]", "less than"],
        ),
        ({"obstacles": [{**CIRCLE, "r": -0.2}]}, ["obstacles[0] has radius -0.2", "at least 0"]),
        ({"robot": {"footprint": {"type": "circle", "radius": -0.1}}}, ["the robot's radius is -0.1"]),
        ({"obstacles": [CIRCLE, {**CIRCLE, "vx": math.nan}]}, ["obstacles[1].vx is nan", "finite"]),
        ({"obstacles": [{**CIRCLE, "vy": -math.inf}]}, ["obstacles[0].vy is -inf", "finite"]),
        (
            {"text": json.dumps({**SCENARIO, "obstacles": [{**CIRCLE, "vx": 7.7}]}).replace("7.7", "1e999")},
            ["finite"],
        ),
        ({"format": "rosbot-scenario/2"}, ["format", "rosbot-scenario/1"]),
        ({"time_limit": 0.0}, ["time_limit"]),
    ],
)
def test_a_wrong_scenario_is_one_sentence_and_leaves_nothing(
    capsys, scenario_file, tmp_path, changes, sentence
):
    out = tmp_path / "out"
    _fails(capsys, "plan", scenario_file(**changes), "--out", out, sentence=["room.json", *sentence])
    assert not out.exists()


@pytest.mark.parametrize("name", ["nowhere.json", "."])
def test_a_scenario_that_is_no_file_is_one_sentence(capsys, tmp_path, name):
    _fails(
        capsys, "plan", tmp_path / name, "--out", tmp_path / "out", sentence=[str(tmp_path), "cannot be read"]
    )
    assert not (tmp_path / "out").exists()


def test_a_damaged_law_is_one_sentence_and_leaves_nothing(capsys, scenario_file, law_file, tmp_path):
    law_file.write_text(law_file.read_text().replace("0x1.", "0x0.", 1))
    arguments = ("plan", scenario_file(), "--out", tmp_path / "out", "--law", law_file)
    _fails(capsys, *arguments, sentence=["some_law.json", "hash"])
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("content", "sentence"), [(None, "does not exist"), ("u = x", "is not JSON"), ("{}", "law")]
)
def test_a_law_that_is_none_is_one_sentence_and_leaves_nothing(
    capsys, scenario_file, tmp_path, content, sentence
):
    path = tmp_path / "no_law.json"
    if content is not None:
        path.write_text(content)
    _fails(
        capsys,
        "plan",
        scenario_file(),
        "--out",
        tmp_path / "out",
        "--law",
        path,
        sentence=["no_law.json", sentence],
    )
    assert not (tmp_path / "out").exists()


def test_a_law_for_another_plant_is_one_sentence_and_leaves_nothing(capsys, scenario_file, tmp_path):
    polar_law(wheel_coupled()).save(tmp_path / "wheels.json")
    arguments = ("plan", scenario_file(), "--out", tmp_path / "out", "--law", tmp_path / "wheels.json")
    _fails(capsys, *arguments, sentence=["wheels.json", "u1, u2", "v, omega"])
    assert not (tmp_path / "out").exists()


def test_a_folder_that_cannot_be_made_is_one_sentence(capsys, scenario_file, law_file, tmp_path):
    (tmp_path / "file").touch()
    arguments = ("plan", scenario_file(), "--out", tmp_path / "file" / "out", "--law", law_file)
    _fails(capsys, *arguments, sentence=["cannot be made"])


@pytest.mark.filterwarnings("error")
def test_a_start_within_the_tolerance_is_a_plan_to_stay(capsys, scenario_file, law_file, tmp_path):
    out = tmp_path / "out"
    assert _run("plan", scenario_file(goal=[0.03, 0.0, 0.05]), "--out", out, "--law", law_file) == 0
    plan = json.loads((out / "plan.json").read_text())
    assert (plan["status"], plan["arrival_time"], plan["evaluations"]) == ("planned", 0.0, 0)
    assert (plan["controls"], plan["trajectory"]) == ([], [[0.0, 0.0, 0.0, 0.0]])
    assert _run("show", out) == 0
    assert "0.00" in capsys.readouterr().out
    assert not (out / "plan.png").exists()


@pytest.mark.slow
def test_show_draws_the_picture_anew(capsys, scenario_file, law_file, tmp_path):
    out = tmp_path / "out"
    _run("plan", scenario_file(), "--out", out, "--law", law_file)
    for place in (out, out / "plan.json"):
        (out / "plan.png").unlink(missing_ok=True)
        capsys.readouterr()
        assert _run("show", place) == 0
        assert "planned" in capsys.readouterr().out
        assert (out / "plan.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("content", "sentence"),
    [("{", "is not JSON"), ("{}", "is not a plan"), ('{"status": 1}', "is not a plan")],
)
def test_a_damaged_plan_is_one_sentence(capsys, tmp_path, content, sentence):
    (tmp_path / "plan.json").write_text(content)
    _fails(capsys, "show", tmp_path, sentence=["plan.json", sentence])


@pytest.mark.parametrize(
    "changes",
    [
        {"status": "great"},
        {"control_period": 0.0},
        {"control_period": -0.05},
        {"planning_time": -1.0},
        {"arrival_time": None},
        {"arrival_time": -1.0},
        {"trajectory": []},
        {"trajectory": [[0.0, 1e300, 0.0, 0.0]]},
        {"trajectory": [[0.0, 0.0, 0.0]]},
        {"controls": [[0.0, 1e300]]},
        {"schedule": {"points": [[0.0, 0.0, 0.0]], "dwell": []}},
        {"schedule": {"points": [[0.0, 0.0, 0.0]], "dwell": [-1.0]}},
    ],
)
def test_a_plan_that_cannot_be_is_one_sentence(capsys, tmp_path, changes):
    plan = {
        "status": "planned",
        "planning_time": 1.0,
        "control_period": 0.05,
        "arrival_time": 0.05,
        "controls": [[0.5, 0.0]],
        "trajectory": [[0.0, 0.0, 0.0, 0.0], [0.05, 0.025, 0.0, 0.0]],
        "schedule": {"points": [[1.0, 0.0, 0.0]], "dwell": [1.0]},
    }
    (tmp_path / "plan.json").write_text(json.dumps(plan))
    assert _run("show", tmp_path) == 0
    capsys.readouterr()
    (tmp_path / "plan.json").write_text(json.dumps(plan | changes))
    _fails(capsys, "show", tmp_path, sentence=["plan.json is not a plan: "])


def test_a_pipe_is_no_plan_and_is_not_waited_for(capsys, tmp_path):
    os.mkfifo(tmp_path / "plan.json")
    _fails(capsys, "show", tmp_path / "plan.json", sentence=["plan.json cannot be read", "regular file"])


def test_a_folder_without_a_run_is_one_sentence(capsys, tmp_path):
    _fails(capsys, "show", tmp_path, sentence=["none of law.json, plan.json, drive.json and fleet.json"])
    _fails(capsys, "show", tmp_path / "nowhere.json", sentence=["does not exist"])


@pytest.mark.slow
def test_the_demo_leaves_a_whole_run_folder(capsys, tmp_path):
    assert _run("demo", "--short", "--out", tmp_path, "--threads", "2") == 0
    names = {path.name for path in tmp_path.iterdir()}
    assert names >= {"law.json", "law.tex", "law.c", "law.h", "plan.json", "plan.png", "progress.jsonl"}
    assert names >= {"plan_empty.json", "plan_empty.png", "scenario.json", "scenario_empty.json", "run.json"}
    assert not any(name.startswith(".") for name in names)
    assert "checkpoint.json" not in names  # it can be run again
    text = capsys.readouterr().out
    assert Law.load(tmp_path / "law.json").formulas()[-1] in text
    for suffix in ("", "_empty"):
        plan = json.loads((tmp_path / f"plan{suffix}.json").read_text())
        _replays(plan, json.loads((tmp_path / f"scenario{suffix}.json").read_text()))
        assert f"{plan['arrival_time']:.2f}" in text
    stages = {entry["stage"] for entry in read_progress(tmp_path)}
    assert stages == {"synthesis", "plan paper", "plan paper_empty"}


@pytest.mark.slow
def test_a_synthesis_that_was_interrupted_goes_on_and_nothing_overwrites_it(capsys, monkeypatch, tmp_path):
    log, out = Run.log, tmp_path / "run"
    short = ("--budget", "900", "--seed", "3", "--threads", "1")

    def interrupted(self, stage, *, generation, evaluations, best_cost):
        log(self, stage, generation=generation, evaluations=evaluations, best_cost=best_cost)
        if generation == 2:
            raise KeyboardInterrupt

    monkeypatch.setattr(Run, "log", interrupted)
    assert _run("synthesize", "--out", out, *short) == 130
    monkeypatch.setattr(Run, "log", log)
    capsys.readouterr()
    for command in ("synthesize", "demo"):
        _fails(capsys, command, "--out", out, sentence=["holds the checkpoint of an earlier run: resume it"])
    _fails(
        capsys,
        *("synthesize", "--out", out, "--resume", "--seed", "4"),
        sentence=["checkpoint.json", "another seed"],
    )
    assert _run("synthesize", "--out", out, "--resume", *short) == 0
    assert _run("synthesize", "--out", tmp_path / "whole", *short) == 0
    for name in ("law.json", "front.json"):
        assert (out / name).read_bytes() == (tmp_path / "whole" / name).read_bytes()


def test_there_is_nothing_to_resume_in_an_empty_folder(capsys, tmp_path):
    _fails(capsys, "synthesize", "--out", tmp_path, "--resume", sentence=["checkpoint.json does not exist"])


@pytest.mark.parametrize("command", [[], *([name] for name in cli.commands)])
def test_every_command_explains_itself(capsys, command):
    assert main([*command, "--help"]) == 0
    assert capsys.readouterr().out.startswith(" ".join(["Usage: python -m applications.rosbot", *command]))


def test_help_lists_the_commands_without_loading_what_they_need():
    code = (
        "import sys; from applications.rosbot.__main__ import main; code = main(['--help']); "
        "sys.exit(code or any(name in sys.modules for name in ('numba', 'sympy', 'matplotlib', 'deap', 'numpy')))"
    )
    root = Path(__file__).parents[3]
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False, cwd=root)
    assert done.returncode == 0
    for name in ("demo", "synthesize", "plan", "export", "show"):
        assert name in done.stdout
