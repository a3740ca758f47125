"""What README.md and docs/ show of Python is what happens: every block is run, in order, in a folder of its own.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

import doctest
import importlib.util
import pathlib
import re

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
DOCUMENTS = [p for p in [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))] if "\n```python\n" in p.read_text()]


def test_there_are_documents() -> None:
    assert ROOT / "docs/python.md" in DOCUMENTS and ROOT / "README.md" in DOCUMENTS


@pytest.mark.parametrize("path", DOCUMENTS, ids=lambda p: p.stem)
def test_blocks_do_what_they_show(path: pathlib.Path, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch,
                                  request: pytest.FixtureRequest) -> None:
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    runner = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE | doctest.ELLIPSIS)
    n_run = 0
    for block in re.findall(r"\n```python\n(.*?)\n```", path.read_text(), re.S):
        if "facet.render(" in block:
            if not importlib.util.find_spec("OpenEXR"):
                continue
            monkeypatch.setenv("FACET", request.getfixturevalue("program"))
        if "import mitsuba" in block and not importlib.util.find_spec("mitsuba"):
            continue
        if block.startswith(">>>"):
            test = doctest.DocTestParser().get_doctest(block + "\n", names, path.name, str(path), 0)
            runner.run(test, clear_globs=False)
            names = test.globs
        else:
            exec(compile(block, str(path), "exec"), names)
        n_run += 1
    assert n_run and runner.summarize(verbose=False).failed == 0
