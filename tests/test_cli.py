"""The command `gpsynth`: what it writes, and one sentence for whatever a user gets wrong."""

import json
import subprocess
import sys

import numpy as np
import pytest

import gpsynth
from gpsynth.cli import ENCODINGS, FORMATS, cli, main
from gpsynth.command_line import run
from gpsynth.law import Law
from gpsynth.record import read_progress

PLANT = """
from gpsynth import Plant, Problem

plant = Plant({dynamics}, states={{"x": "m", "v": "m/s"}}, controls={{"u": ("m/s^2", {limits})}})
problem = Problem(plant, starts=[[1.0, 0.0], [-1.0, 0.5]], goal=[0.0, 0.0], tolerance=0.1, horizon=5.0)
"""


@pytest.fixture
def plant_file(tmp_path):
    def write(dynamics="lambda x, u: (x.v, u.u)", limits="-1.0, 1.0", after=""):
        path = tmp_path / "double_integrator.py"
        path.write_text(PLANT.format(dynamics=dynamics, limits=limits) + after)
        return path

    return write


@pytest.fixture
def law_file(tmp_path):
    plant = gpsynth.Plant(
        lambda x, u: (x.v, u.u), states={"x": "m", "v": "m/s"}, controls={"u": ("m/s^2", -1.0, 1.0)}
    )
    problem = gpsynth.Problem(plant, starts=[[1.0, 0.0]], goal=[0.0, 0.0], tolerance=0.1)
    program = gpsynth.trace(
        lambda seen: (2.0 * seen.error_x + 3.0 * seen.error_v,), [("seen", problem.features.names)], ("u",)
    )
    path = tmp_path / "some_law.json"
    Law(plant, problem.features, program, np.empty(0)).save(path)
    return path


def _fails(capsys, arguments, *sentence):
    """The command ends with 2 and one line on stderr that holds all of `sentence`."""
    assert main([str(argument) for argument in arguments]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith("error: ")
    assert captured.err.count("\n") == 1
    for words in sentence:
        assert words in captured.err


def test_a_law_is_synthesized_from_a_plant_file(capsys, plant_file, tmp_path):
    out = tmp_path / "run"
    assert main(["synthesize", str(plant_file()), "--out", str(out), "--budget", "1500", "--seed", "3"]) == 0
    law = Law.load(out / "law.json")
    assert "\n".join(law.formulas()).splitlines()[-1] in capsys.readouterr().out
    front = json.loads((out / "front.json").read_text())["laws"]
    assert Law.from_dict(front[-1]["law"]) == law
    assert [entry["cost"] for entry in front] == sorted((entry["cost"] for entry in front), reverse=True)
    assert {"law.c", "law.h", "law.tex", "law.py", "law.txt", "run.json"} <= {
        path.name for path in out.iterdir()
    }
    assert json.loads((out / "run.json").read_text())["versions"]["gpsynth"] == gpsynth.__version__
    progress = read_progress(out)
    assert progress[-1]["evaluations"] <= 1500
    assert [entry["generation"] for entry in progress] == list(range(1, len(progress) + 1))


def test_the_encoding_of_the_plant_file_is_used_unless_another_is_named(capsys, plant_file, tmp_path):
    own = "from gpsynth import TreeEncoding\nencoding = TreeEncoding(('wrong',), ('u',), ('add',))\n"
    path = plant_file(after=own)
    _fails(capsys, ["synthesize", path, "--out", tmp_path / "a"], "the encoding maps", "wrong")
    assert not (tmp_path / "a").exists()
    for encoding in ENCODINGS:
        arguments = [
            "synthesize",
            path,
            "--out",
            tmp_path / encoding,
            "--budget",
            "600",
            "--encoding",
            encoding,
        ]
        assert main([str(argument) for argument in arguments]) == 0


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"dynamics": "lambda x, u: (x.v, u.u, 0.0)"}, ("returns 3 values", "expected 2: x, v")),
        ({"dynamics": "lambda x, u: (x.v,)"}, ("returns 1 values", "expected 2: x, v")),
        ({"limits": "float('nan'), 1.0"}, ("limits of u", "nan")),
        ({"limits": "1.0, -1.0"}, ("limits of u", "lower < upper")),
        ({"dynamics": "lambda x, u: (x.w, u.u)"}, ("line 4", "w")),
        ({"after": "problem = None"}, ("must define `problem`", "NoneType")),
        ({"after": "1 / 0"}, ("line 6", "ZeroDivisionError")),
        ({"after": "a b"}, ("line 6: SyntaxError: invalid syntax\n",)),
        ({"after": "raise SystemExit(0)"}, ("line 6", "SystemExit")),
        ({"after": "raise ValueError('one\\n\\n  two')"}, ("line 6", "ValueError: one two\n")),
        ({"after": "encoding = 3"}, ("must define `encoding`", "defines it as 3")),
        ({"after": "from gpsynth import TreeEncoding as encoding"}, ("must define `encoding`",)),
    ],
)
def test_a_wrong_plant_file_is_one_sentence_and_leaves_nothing(
    capsys, plant_file, tmp_path, changes, sentence
):
    out = tmp_path / "run"
    _fails(capsys, ["synthesize", plant_file(**changes), "--out", out], "double_integrator.py", *sentence)
    assert not out.exists()


@pytest.mark.parametrize(("name", "sentence"), [("nowhere.py", "does not exist"), (".", "is not a file")])
def test_a_plant_that_is_no_file_is_one_sentence(capsys, tmp_path, name, sentence):
    _fails(capsys, ["synthesize", tmp_path / name, "--out", tmp_path / "run"], sentence)
    assert not (tmp_path / "run").exists()


def test_a_run_folder_that_cannot_be_made_is_one_sentence(capsys, plant_file, tmp_path):
    (tmp_path / "file").touch()
    _fails(capsys, ["synthesize", plant_file(), "--out", tmp_path / "file" / "run"], "cannot be made")


def test_a_law_is_exported_in_every_format(law_file, tmp_path):
    assert main(["export", str(law_file), "--out", str(tmp_path / "all")]) == 0
    names = {path.name for path in (tmp_path / "all").iterdir()}
    assert names == {"law.json", "law.txt", "law.tex", "law.c", "law.h", "law.py"}
    assert Law.load(tmp_path / "all" / "law.json") == Law.load(law_file)


@pytest.mark.parametrize(
    ("chosen", "names"),
    [("c", {"f.c", "f.h"}), ("json", {"f.json"}), ("latex", {"f.tex"}), ("text", {"f.txt"})],
)
def test_one_format_is_the_same_alone_as_among_all(law_file, tmp_path, chosen, names):
    alone, together = tmp_path / "alone", tmp_path / "all"
    assert main(["export", str(law_file), "--out", str(alone), "--name", "f", "--format", chosen]) == 0
    assert main(["export", str(law_file), "--out", str(together), "--name", "f"]) == 0
    assert {path.name for path in alone.iterdir()} == names
    for name in names:
        assert (alone / name).read_bytes() == (together / name).read_bytes()


def test_assess_prints_the_report(capsys, law_file, plant_file):
    assert main(["assess", str(law_file), str(plant_file()), "--threads", "1"]) == 0
    assert capsys.readouterr().out.count(" 2 of 2") == 4


def test_a_law_for_another_problem_is_one_sentence(capsys, law_file, plant_file):
    other = (
        "from dataclasses import replace\nproblem = replace(problem, features=lambda x, target: {'a': x.x})"
    )
    _fails(capsys, ["assess", law_file, plant_file(after=other)], "expected u from the features a")


def test_info_says_what_a_law_is(capsys, law_file):
    assert main(["info", str(law_file)]) == 0
    text = capsys.readouterr().out
    law = Law.load(law_file)
    for words in (law.hash, law.formulas()[-1], "-1 <= u <= 1 m/s^2", f"{law.complexity} instructions"):
        assert words in text
    assert f"gpsynth {gpsynth.__version__}" in text


def _damaged(text):
    document = json.loads(text)
    return {
        "empty": "",
        "cut": text[:100],
        "not JSON": "law",
        "a list": "[]",
        "an unknown field": json.dumps({**document, "more": 1}),
        "another format": json.dumps({**document, "format": "gpsynth-law/0"}),
        "another hash": json.dumps({**document, "hash": "0" * 64}),
        "NaN": text.replace('"parameters": []', '"parameters": [NaN]'),
    }


@pytest.mark.parametrize("damage", list(_damaged("{}")))
@pytest.mark.parametrize("command", ["info", "export"])
def test_a_damaged_law_is_one_sentence_and_leaves_nothing(capsys, law_file, tmp_path, damage, command):
    law_file.write_text(_damaged(law_file.read_text())[damage])
    out = tmp_path / "out"
    _fails(capsys, [command, law_file, *(["--out", out] if command == "export" else [])], "some_law.json")
    assert not out.exists()


@pytest.mark.parametrize("name", ["nowhere.json", "."])
def test_a_law_that_is_no_file_is_one_sentence(capsys, tmp_path, name):
    _fails(capsys, ["info", tmp_path / name], str(tmp_path))


def test_a_name_that_c_does_not_allow_is_one_sentence(capsys, law_file, tmp_path):
    for formats in ([], ["--format", "json"]):
        _fails(capsys, ["export", law_file, "--out", tmp_path / "out", "--name", "a b", *formats], "a b")
    assert not (tmp_path / "out").exists()


def test_ctrl_c_is_130_and_the_run_can_be_resumed(capsys, monkeypatch, plant_file, tmp_path):
    from gpsynth.record import Run

    log = Run.log

    def interrupted(self, stage, *, generation, evaluations, best_cost):
        log(self, stage, generation=generation, evaluations=evaluations, best_cost=best_cost)
        if generation == 4:
            raise KeyboardInterrupt

    monkeypatch.setattr(Run, "log", interrupted)
    out = tmp_path / "run"
    assert main(["synthesize", str(plant_file()), "--out", str(out), "--budget", "1500"]) == 130
    assert capsys.readouterr().err.strip() == "interrupted"
    assert len(read_progress(out)) == 4
    front = json.loads((out / "front.json").read_text())["laws"]
    assert Law.from_dict(front[-1]["law"]) == Law.load(out / "law.json")
    monkeypatch.setattr(Run, "log", log)
    assert main(["resume", str(out)]) == 0
    assert [entry["generation"] for entry in read_progress(out)] == list(
        range(1, len(read_progress(out)) + 1)
    )
    assert main(["synthesize", str(plant_file()), "--out", str(tmp_path / "whole"), "--budget", "1500"]) == 0
    for name in ("law.json", "front.json"):
        assert (out / name).read_bytes() == (tmp_path / "whole" / name).read_bytes()


def test_a_run_is_not_overwritten(capsys, plant_file, tmp_path):
    out = tmp_path / "run"
    arguments = ["synthesize", str(plant_file()), "--out", str(out), "--budget", "450"]
    assert main(arguments) == 0
    before = {path.name: path.read_bytes() for path in out.iterdir()}
    capsys.readouterr()
    _fails(
        capsys, arguments, f"{out} holds the checkpoint of an earlier run: resume it, or name another folder"
    )
    assert {path.name: path.read_bytes() for path in out.iterdir()} == before


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (lambda run: (run / "synthesis.json").unlink(), "synthesis.json does not exist"),
        (lambda run: (run / "synthesis.json").write_text("{}"), "is no task of format"),
        (lambda run: (run / "checkpoint.json").unlink(), "checkpoint.json does not exist"),
        (
            lambda run: (run.parent / "double_integrator.py").write_text(
                PLANT.format(dynamics="lambda x, u: (x.v, u.u)", limits="-2.0, 1.0")
            ),
            "it is of a run with another problem",
        ),
    ],
)
def test_a_run_that_cannot_be_resumed_is_one_sentence(capsys, plant_file, tmp_path, change, sentence):
    out = tmp_path / "run"
    assert main(["synthesize", str(plant_file()), "--out", str(out), "--budget", "450"]) == 0
    capsys.readouterr()
    change(out)
    _fails(capsys, ["resume", out], sentence)


@pytest.mark.parametrize("command", [[], *([name] for name in cli.commands)])
def test_every_command_explains_itself(capsys, command):
    assert main([*command, "--help"]) == 0
    assert capsys.readouterr().out.startswith(" ".join(["Usage: gpsynth", *command]))


def test_help_lists_the_commands_without_loading_what_they_need():
    code = (
        "import sys; from gpsynth.cli import main; code = main(['--help']); "
        "sys.exit(code or any(name in sys.modules for name in ('numba', 'sympy', 'matplotlib', 'deap', 'numpy')))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0
    for name in ("synthesize", "export", "info"):
        assert name in done.stdout


def test_the_version_is_the_package_s(capsys):
    assert main(["--version"]) == 0
    assert capsys.readouterr().out == f"gpsynth, version {gpsynth.__version__}\n"


def test_a_seed_that_a_result_cannot_hold_is_refused_first(capsys, plant_file, tmp_path):
    out = tmp_path / "run"
    arguments = ["synthesize", str(plant_file()), "--out", str(out), "--budget", "600", "--seed"]
    assert main([*arguments, str(2**53)]) == 2
    assert "9007199254740992 is not in the range" in capsys.readouterr().err
    assert not out.exists()
    assert main([*arguments, str(2**53 - 1)]) == 0
    assert json.loads((out / "run.json").read_text())["seed"] == 2**53 - 1


@pytest.mark.parametrize("arguments", [["nothing"], ["info"], ["export", "law.json"], ["info", "--no"]])
def test_wrong_usage_is_2(capsys, arguments):
    assert main(arguments) == 2
    assert "Usage:" in capsys.readouterr().err


def test_formats_are_those_of_the_export(law_file, tmp_path):
    arguments = [item for name in FORMATS for item in ("--format", name)]
    assert (
        run(cli, ["export", str(law_file), "--out", str(tmp_path / "some"), *arguments], name="gpsynth") == 0
    )
    assert main(["export", str(law_file), "--out", str(tmp_path / "all")]) == 0
    some, every = ({path.name for path in (tmp_path / name).iterdir()} for name in ("some", "all"))
    assert some == every
