"""Docstrings, the guide, README and the example say what the package says today."""

from __future__ import annotations

import doctest
import importlib
import pathlib
import runpy

import pytest

from conftest import PROJECT

MODULES = ["rodcal", "rodcal.functions", "rodcal.inputs", "rodcal.results"]


@pytest.mark.parametrize("name", MODULES)
def test_docstrings(name: str) -> None:
    found = doctest.testmod(importlib.import_module(name))
    assert found.failed == 0
    assert found.attempted > 0 or name == "rodcal.results"


@pytest.mark.parametrize("page", ["README.md", "docs/python.md", "docs/distributed.md", "python/README.md"])
def test_what_the_pages_show(page: str) -> None:
    if page == "docs/distributed.md":
        pytest.importorskip("distributed")
    text = (PROJECT / page).read_text(encoding="utf-8")
    blocks = [block.split("```")[0] for block in text.split("```python\n")[1:]]
    shown = "\n\n".join(block for block in blocks if ">>>" in block)
    parser, runner = doctest.DocTestParser(), doctest.DocTestRunner(optionflags=doctest.ELLIPSIS)
    test = parser.get_doctest(shown, {}, page, page, 0)
    assert len(test.examples) >= 3, f"{page} shows {len(test.examples)} lines of Python"
    assert runner.run(test).failed == 0


def test_the_example_runs(folder: pathlib.Path, capsys: pytest.CaptureFixture[str]) -> None:
    runpy.run_path(str(PROJECT / "examples" / "library.py"), run_name="__main__")
    said = capsys.readouterr().out
    assert "c_rod = 402.0 µm" in said and "r_rod = 1.015" in said and "validation: mean 46.1 µm" in said
