"""The notebooks run, and are made from the sources beside them.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

import importlib.util
import json
import pathlib
import xml.etree.ElementTree as xml

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SOURCES = sorted((ROOT / "python/notebooks").glob("*.py"))
spec = importlib.util.spec_from_file_location("make_notebook", ROOT / "python/tools/make_notebook.py")
assert spec and spec.loader
make_notebook = importlib.util.module_from_spec(spec)
spec.loader.exec_module(make_notebook)


@pytest.mark.parametrize("path", SOURCES, ids=lambda p: p.stem)
def test_a_notebook_runs_and_is_that_of_its_source(path: pathlib.Path) -> None:
    made = make_notebook.notebook(path.read_text(), path.name)
    kept = json.loads(path.with_suffix(".ipynb").read_text())
    assert [(c["cell_type"], c["source"]) for c in made["cells"]] == [(c["cell_type"], c["source"]) for c in kept["cells"]]
    assert kept["nbformat"] == 4 and all(c["id"] for c in kept["cells"])
    pictures = 0
    for new, old in zip(made["cells"], kept["cells"]):
        shown = [sorted(o.get("data", {"stream": 0})) for o in new.get("outputs", [])]
        assert shown == [sorted(o.get("data", {"stream": 0})) for o in old.get("outputs", [])]
        for output in new.get("outputs", []):
            if "image/svg+xml" in output.get("data", {}):
                xml.fromstring("".join(output["data"]["image/svg+xml"]))
                pictures += 1
    assert pictures >= 5


def test_cells_are_cut_where_they_begin() -> None:
    cells = list(make_notebook.cells_of('"""x"""\n# %% [markdown]\n# # Title\n#\n# text\n# %%\na = 1\na + 1\n'))
    assert cells == [("markdown", "# Title\n\ntext"), ("code", "a = 1\na + 1")]
    assert make_notebook.run("print(2)\n3 * 4", {}, "cell") == ("2\n", 12)
    with pytest.raises(ZeroDivisionError):
        make_notebook.run("1 / 0", {}, "cell")
