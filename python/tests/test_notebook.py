"""The notebook on real measurements runs, where they are."""

from __future__ import annotations

import os
import pathlib

import pytest

from conftest import PROJECT

nbformat = pytest.importorskip("nbformat")
nbclient = pytest.importorskip("nbclient")
pytest.importorskip("ipykernel")
REAL = PROJECT.parent / "shared" / "real"


@pytest.mark.skipif(not REAL.is_dir(), reason="no measurements in ../shared/real")
def test_the_notebook_of_the_ur5(monkeypatch: pytest.MonkeyPatch, tmp_path: pathlib.Path) -> None:
    monkeypatch.setenv("RODCAL_REAL", os.fspath(REAL))
    notebook = nbformat.read(PROJECT / "examples" / "ur5.ipynb", as_version=4)
    # kept without what it shows: that is the measurements'
    assert not any(cell.get("outputs") for cell in notebook.cells)
    nbclient.NotebookClient(notebook, timeout=120, resources={"metadata": {"path": os.fspath(tmp_path)}}).execute()
    shown = [str(output) for cell in notebook.cells for output in cell.get("outputs", ())]
    assert any("parameters fitted to 150 poses" in output for output in shown)
    assert any('<div class="rodcal">' in output for output in shown)
    assert any("transmission_error" in output and "joint 2" in output for output in shown)
