"""Tests of the installed package, from a folder that is not the project's."""

from __future__ import annotations

import json
import os
import pathlib
import shutil
import subprocess
from collections.abc import Callable, Iterator
from typing import Any

import pytest

PROJECT = pathlib.Path(__file__).resolve().parents[2]
#: Inputs that the tests name as the project's own pages do.
INPUTS = ("rods", "stiffness_data", "campaigns", "robots", "examples")


@pytest.fixture(scope="session")
def folder(tmp_path_factory: pytest.TempPathFactory) -> pathlib.Path:
    """A folder with the project's inputs, and nothing to import."""
    folder = tmp_path_factory.mktemp("elsewhere")
    for name in INPUTS:
        shutil.copytree(PROJECT / name, folder / name)
    return folder


@pytest.fixture(autouse=True)
def elsewhere(folder: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.chdir(folder)
    yield


@pytest.fixture(scope="session")
def command(folder: pathlib.Path) -> Callable[[str], dict[str, Any]]:
    """The JSON of a command; its program is named by RODCAL, or on the path."""
    program = os.environ.get("RODCAL") or shutil.which("rodcal")
    if program is None:
        pytest.skip("no program rodcal: name it by RODCAL")

    def run(line: str) -> dict[str, Any]:
        done = subprocess.run([program, *line.split(), "--json"], cwd=folder, capture_output=True, text=True)
        assert done.returncode in (0, 1), done.stderr
        answer: dict[str, Any] = json.loads(done.stdout)
        return answer

    return run
