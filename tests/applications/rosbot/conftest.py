import json
from pathlib import Path

import pytest

from applications.rosbot.scenario import Scenario
from applications.rosbot.scenario_file import read_scenario

SHARED = Path(__file__).parents[4] / "shared"
ABSENT = pytest.mark.skip(reason="the public scenarios are not beside the repository, in ../shared/scenarios")


def pytest_generate_tests(metafunc):
    if "public_path" in metafunc.fixturenames:
        paths = sorted((SHARED / "scenarios").glob("*.json"))
        absent = [pytest.param(None, marks=ABSENT)]
        metafunc.parametrize("public_path", paths or absent, ids=lambda path: path.stem if path else "absent")


@pytest.fixture
def public(public_path) -> Scenario:
    return read_scenario(public_path)


@pytest.fixture
def reference(public_path) -> dict:
    references = json.loads((SHARED / "reference" / "planning.json").read_text())
    if public_path.stem not in references:
        pytest.skip("an unreachable goal has no reference")
    return references[public_path.stem]
