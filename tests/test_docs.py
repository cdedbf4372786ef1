"""What the documentation says is so: code blocks run, named files, functions and commands exist, tables are current."""

import ast
import re
import shlex
import shutil
import subprocess
from functools import cache
from importlib.util import find_spec
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib import pyplot

from applications.rosbot.__main__ import cli as rosbot
from docs.generate import architecture_page, operations_page
from gpsynth.cli import cli as gpsynth
from gpsynth.operations import OPERATIONS
from tests.bench.paper_numbers import bounds, facts

ROOT = Path(__file__).parents[1]
DOCS = ROOT / "docs"
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted(DOCS.rglob("*.md"))]
DECISIONS = sorted((DOCS / "decisions").glob("[0-9]*.md"))
PLACE = re.compile(r"`((?:[\w.]+/)+[\w.]+)(?::([\w.]+))?`")
FENCE = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
COMPILER = shutil.which("cc") or shutil.which("gcc")


def blocks(page: str, language: str) -> list[str]:
    return [text for kind, text in FENCE.findall((DOCS / page).read_text("utf-8")) if kind == language]


@cache
def names(path: Path) -> frozenset[str]:
    """Functions, classes, methods and assigned names of a module, methods as Class.method."""
    found = set()
    for node in ast.parse(path.read_text("utf-8")).body:
        found |= own_names(node)
        if isinstance(node, ast.ClassDef):
            found |= {f"{node.name}.{name}" for inner in node.body for name in own_names(inner)}
    return frozenset(found)


def own_names(node: ast.stmt) -> set[str]:
    if isinstance(node, ast.FunctionDef | ast.ClassDef):
        return {node.name}
    targets = getattr(node, "targets", [getattr(node, "target", None)])
    return {target.id for target in targets if isinstance(target, ast.Name)}


def run_as_printed(page):
    """The names that all Python blocks of a page, run in their order, leave behind."""
    place: dict[str, object] = {}
    for block in blocks(page, "python"):
        exec(compile(block, page, "exec"), place)
    return place


@pytest.mark.slow
def test_the_readme_runs_as_printed(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    place = run_as_printed("../README.md")
    assert place["result"].best.reached == 1.0
    assert (tmp_path / "law.json").exists()


@pytest.mark.slow
def test_getting_started_runs_as_printed(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    run_as_printed("getting_started.md")
    assert {path.name for path in (tmp_path / "slider").iterdir()} >= {
        "law.c",
        "law.h",
        "law.tex",
        "law.json",
    }
    if COMPILER is None:
        pytest.skip("no C compiler: the C part of the page was not run")
    for block in blocks("getting_started.md", "sh"):
        for line in block.splitlines():
            if line.startswith(("cc ", "./")):
                subprocess.run(shlex.split(line), check=True, cwd=tmp_path)


@pytest.mark.slow
def test_the_examples_of_regression_run_as_printed():
    pytest.importorskip("sklearn", reason="scikit-learn is not installed")
    run_as_printed("regression.md")


def test_robustness_runs_as_printed(capsys):
    place = run_as_printed("robustness.md")
    assert len(place["problem"].starts) == 500
    assert blocks("robustness.md", "text") == [capsys.readouterr().out]


def test_the_obstacles_of_the_plants_page_run_as_printed():
    (block,) = [text for text in blocks("plants.md", "python") if "field_of_cells" in text]
    place: dict[str, object] = {}
    exec(compile(block, "plants.md", "exec"), place)
    gap = place["obstacles"].gaps(np.array([[0.0, 0.0, 0.0]]))[
        0
    ]  # to the cells from (0.5, -0.5) to (0.55, 0.5)
    assert 0.34 < gap <= 0.35


def test_a_published_matrix_is_varied_as_printed():
    run_as_printed("encodings.md")


@pytest.mark.slow
def test_the_examples_of_the_planner_run_as_printed():
    place = run_as_printed("rosbot.md")
    assert {place[name].status for name in ("report", "tour", "later", "fleet")} == {"planned"}
    assert place["tour"].certificate.is_clear


def test_the_planning_page_runs_as_printed():
    place = run_as_printed("planning.md")
    assert place["found"].is_free
    assert 0.0 < place["proved"] < place["found"].clearance
    assert place["weighed"].value > place["weighed"].arrival_time > place["found"].arrival_time


@pytest.mark.slow
def test_the_guide_runs_as_printed(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    mpl.use("agg")
    place: dict[str, object] = {}
    missing = [package for package in ("casadi", "control") if find_spec(package) is None]
    for block in blocks("guide.md", "python"):
        if not any(f"to_{package}(" in block for package in missing):
            exec(compile(block, "guide.md", "exec"), place)
    pyplot.close("all")
    if missing:
        pytest.skip(f"without {' and '.join(missing)} the blocks that need it were not run")


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_named_files_and_functions_exist(page):
    missing = [
        f"{path}:{name}" if name else path
        for path, name in PLACE.findall(page.read_text("utf-8"))
        if path.startswith(("gpsynth/", "applications/", "tests/", "docs/"))
        and not ((ROOT / path).exists() and (not name or name in names(ROOT / path)))
    ]
    assert missing == []


def test_the_pages_of_other_folders_are_found():
    pages = {page.name for page in PAGES}
    assert {"getting_started.md", "paper.md", "index.md"} <= pages
    assert len(DECISIONS) > 5


def test_every_equation_of_the_paper_has_a_place():
    rows = [line for line in (DOCS / "paper.md").read_text("utf-8").splitlines() if line.startswith("| ")]
    placed = {row.split("|")[1].strip() for row in rows if PLACE.search(row)}
    assert {*(f"({number})" for number in range(1, 18)), "Algorithm 1"} <= placed


def test_the_page_of_operations_is_current_and_covers_the_table():
    page = (DOCS / "operations.md").read_text("utf-8")
    assert page == operations_page(), "run python -m docs.generate"
    assert all(page.count(f"\n| `{operation.name}` |") == 1 for operation in OPERATIONS)


def test_the_layers_are_those_of_the_import_contract():
    page = (DOCS / "architecture.md").read_text("utf-8")
    assert "kernels | optimizers" in page
    assert page == architecture_page(), "run python -m docs.generate"


@pytest.mark.parametrize("table", [bounds, facts])
def test_the_numbers_of_the_paper_are_current(table):
    page = (DOCS / "paper_numbers.md").read_text("utf-8")
    assert table() in page, "run python -m tests.bench.paper_numbers"


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_named_commands_exist(page):
    text = page.read_text("utf-8")
    makefile = (ROOT / "Makefile").read_text("utf-8")
    for target in re.findall(r"(?:`|^ {4}|^)make (\w+)", text, re.MULTILINE):
        assert re.search(rf"^{target}:", makefile, re.MULTILINE), f"make {target}"
    for module in re.findall(r"python -m ((?:applications|docs|examples|tests)(?:\.\w+)*)", text):
        path = ROOT / module.replace(".", "/")
        assert path.with_suffix(".py").exists() or (path / "__main__.py").exists(), f"python -m {module}"
    for command in re.findall(r"-m applications\.rosbot (\w+)", text):
        assert command in rosbot.commands
    for command in re.findall(r"(?:`|^ {4}|^)gpsynth (\w+)", text, re.MULTILINE):
        assert command in gpsynth.commands


@pytest.mark.parametrize("page", DECISIONS, ids=lambda page: page.stem)
def test_a_decision_has_context_decision_consequence_and_figure(page):
    headings = re.findall(r"^## (.+)$", page.read_text("utf-8"), re.MULTILINE)
    assert headings == ["Context", "Decision", "Consequence", "Figure"]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_links_lead_to_pages(page):
    links = re.findall(r"\]\(([^)#:]+\.md)(?:#[\w-]+)?\)", page.read_text("utf-8"))
    assert [link for link in links if not (page.parent / link).exists()] == []
