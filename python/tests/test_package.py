"""The package as it is installed: types, stubs, docstrings, drawings.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

import doctest
import importlib
import pathlib
import pkgutil
import subprocess
import sys
import xml.etree.ElementTree as xml

import numpy as np
import pytest

import facet

MODULES = [m.name for m in pkgutil.iter_modules(facet.__path__) if m.name not in ("_abi", "_libfacet", "mitsuba")]


@pytest.mark.parametrize("name", ["facet", *(f"facet.{m}" for m in MODULES)])
def test_examples_in_docstrings_are_true(name: str) -> None:
    found = doctest.testmod(importlib.import_module(name), optionflags=doctest.NORMALIZE_WHITESPACE)
    assert found.failed == 0


def test_every_public_name_is_documented() -> None:
    for name in facet.__all__:
        if not name.isupper():
            assert getattr(facet, name).__doc__, name
    for name in vars(facet.Material):
        if not name.startswith("_"):
            assert getattr(facet.Material, name).__doc__, name


@pytest.mark.parametrize("spec", [*facet.models(), "glass ior=1.5 alpha=.2", "ggx alpha=.001", "lambert kd=0"])
def test_drawings_are_svg(spec: str) -> None:
    svg = facet.material(spec)._repr_svg_()
    root = xml.fromstring(svg)
    assert root.tag.endswith("svg") and "nan" not in svg and "inf" not in svg
    if spec not in ("lambert kd=0", "glass"):
        assert sum(e.tag.endswith("polygon") for e in root) == 3
    if spec == "glass":  # mirrored and refracted, for each of three views
        assert sum(e.get("stroke-width") == "2" for e in root) == 6


def test_a_lambertian_lobe_is_drawn_as_its_formula() -> None:
    """r = 150 sqrt(cos), thus y = r^3/150^2, at every vertex; coordinates are rounded to 0.05."""
    root = xml.fromstring(facet.lambert()._repr_svg_())
    polygon = next(e for e in root if e.tag.endswith("polygon"))
    points = np.array([[float(x) for x in p.split(",")] for p in (polygon.get("points") or "").split()])
    centre = points[0]
    x, y = (points[1:] - centre).T * np.array([[1], [-1]])
    np.testing.assert_allclose(y, np.hypot(x, y) ** 3 / 150**2, atol=0.05 + 3 * 0.05 * np.sqrt(2))
    assert len(points) > 300 and np.hypot(x, y).max() > 149


def test_what_reads_pictures_is_looked_for_before_they_are_rendered(tmp_path: pathlib.Path,
                                                                    monkeypatch: pytest.MonkeyPatch) -> None:
    program, started = tmp_path / "facet", tmp_path / "started"
    program.write_text(f"#!/bin/sh\ntouch '{started}'\n")
    program.chmod(0o755)
    monkeypatch.setenv("FACET", str(program))
    monkeypatch.setitem(sys.modules, "OpenEXR", None)
    with pytest.raises(ImportError, match=r"reading pictures needs the package OpenEXR: pip install"):
        facet.render(size=(8, 8), spp=1)
    assert not started.exists()


mypy = pytest.mark.skipif(not importlib.util.find_spec("mypy"), reason="mypy is not installed")


def run_mypy(*arguments: str, cwd: pathlib.Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, "-m", "mypy", "--strict", "--cache-dir", str(cwd), *arguments],
                          capture_output=True, text=True, cwd=cwd, check=False)


@mypy
def test_types_hold_in_the_package(tmp_path: pathlib.Path) -> None:
    done = run_mypy("-p", "facet", cwd=tmp_path)
    assert done.returncode == 0, done.stdout


@mypy
def test_types_of_models_are_known_to_users(tmp_path: pathlib.Path) -> None:
    """Right calls pass; each wrong line is found, and no other."""
    (tmp_path / "use.py").write_text("""\
import facet
m: facet.Material = facet.ggx(alpha=0.3, ks=(0.9, 0.7, 0.3), g2="separable")
f = m.eval([0, 0, 1], [0, 0, 1]).sum() + m.sample([0, 0, 1], [0, 0, 0]).pdf.sum()
low: float = facet.gtr.parameters["gamma"].low
facet.ggx(roughness=0.3)
facet.ggx(g2="both")
facet.ggx(alpha="rough")
facet.unheard_of()
s: str = m.albedo(1.0)
""")
    done = run_mypy("use.py", cwd=tmp_path)
    lines = sorted({int(line.split(":")[1]) for line in done.stdout.splitlines() if ": error:" in line})
    assert lines == [5, 6, 7, 8, 9], done.stdout
