"""A material that Blender's user wrote as a custom property is the one that facet renders, there and back.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

import json
import os
import pathlib
import shutil
import subprocess

import numpy as np
import pytest

import facet

pytest.importorskip("OpenEXR", reason="the package OpenEXR is not installed")
BLENDER = shutil.which("blender")
SPEC = "gtr alpha=.1 gamma=1.5 ks=.9,.7,.3 g2=separable"


@pytest.mark.skipif(BLENDER is None, reason="Blender is not installed: apt-get install blender")
def test_a_material_goes_through_blender_and_back(tmp_path: pathlib.Path, root: pathlib.Path, program: str,
                                                  monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("FACET", program)
    home = tmp_path / "home"
    home.mkdir()
    environment = {**os.environ, "HOME": str(home), "XDG_CONFIG_HOME": str(home / "config"),
                   "BLENDER_USER_SCRIPTS": str(home / "scripts"), "BLENDER_USER_CONFIG": str(home / "config")}
    for name in ("PYTHONPATH", "PYTHONHOME", "VIRTUAL_ENV"):
        environment.pop(name, None)
    probe = subprocess.run([str(BLENDER), "--background", "--factory-startup", "--python-exit-code", "1", "--python-expr",
                            "import numpy"], capture_output=True, text=True, env=environment, check=False)
    if "No module named 'numpy'" in probe.stderr + probe.stdout:
        pytest.skip("Blender's glTF exporter lacks NumPy: apt-get install python3-numpy")
    done = subprocess.run([str(BLENDER), "--background", "--factory-startup", "--python-exit-code", "1", "--python",
                           str(root / "python/tests/blender_scene.py"), "--",
                           str(root / "examples/blender/facet_materials.py"), SPEC, str(tmp_path)],
                          capture_output=True, text=True, env=environment, check=False)
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    assert "imported: gtr alpha=0.1 gamma=1.5 ks=0.9,0.7,0.3 g2=separable" in done.stdout

    expected = {"model": "gtr", "alpha": 0.1, "gamma": 1.5, "ks": [0.9, 0.7, 0.3], "g2": "separable"}
    for name in ("marked", "again"):
        document = json.loads((tmp_path / f"{name}.gltf").read_text())
        assert document["materials"][0]["extensions"]["FACET_materials_bsdf"] == expected
        assert "FACET_materials_bsdf" in document["extensionsUsed"]
        assert "FACET_materials_bsdf" not in document.get("extensionsRequired", [])

    arguments = {"size": (32, 32), "spp": 4, "env": 1.0}
    marked = facet.render(tmp_path / "marked.gltf", **arguments)  # type: ignore[call-overload]
    plain = facet.render(tmp_path / "plain.gltf", **arguments)  # type: ignore[call-overload]
    given = facet.render(tmp_path / "plain.gltf", materials={"ball": SPEC}, **arguments)  # type: ignore[call-overload]
    np.testing.assert_array_equal(marked, given)
    assert np.abs(marked - plain).max() > 0.1
