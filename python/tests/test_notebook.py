"""The notebook on real measurements runs, where they are and where they are not."""

from __future__ import annotations

import os
import pathlib

import pytest

from conftest import PROJECT

nbformat = pytest.importorskip("nbformat")
nbclient = pytest.importorskip("nbclient")
pytest.importorskip("ipykernel")
REAL = pathlib.Path(os.environ.get("RODCAL_REAL", PROJECT.parent / "shared" / "real"))


def shown(folder: pathlib.Path) -> list[str]:
    """What the notebook shows where it is run in a folder."""
    notebook = nbformat.read(PROJECT / "examples" / "ur5.ipynb", as_version=4)
    # kept without what it shows: that is the measurements'
    assert not any(cell.get("outputs") for cell in notebook.cells)
    nbclient.NotebookClient(notebook, timeout=120, resources={"metadata": {"path": os.fspath(folder)}}).execute()
    return [str(output) for cell in notebook.cells for output in cell.get("outputs", ())]


@pytest.mark.skipif(not REAL.is_dir(), reason="no measurements in RODCAL_REAL or ../shared/real")
def test_the_notebook_of_the_ur5(monkeypatch: pytest.MonkeyPatch, tmp_path: pathlib.Path) -> None:
    monkeypatch.setenv("RODCAL_REAL", os.fspath(REAL))
    outputs = shown(tmp_path)
    assert any("parameters fitted to 150 poses" in output for output in outputs)
    assert any('<div class="rodcal">' in output for output in outputs)
    assert any("transmission_error" in output and "joint 2" in output for output in outputs)


def test_the_notebook_without_the_recording(monkeypatch: pytest.MonkeyPatch, tmp_path: pathlib.Path) -> None:
    monkeypatch.setenv("RODCAL_REAL", os.fspath(tmp_path))
    outputs = shown(PROJECT / "examples")
    assert any("the simulated TX90" in output for output in outputs)
    assert any("parameters fitted to" in output for output in outputs)
    assert any('<div class="rodcal">' in output for output in outputs)
