"""Every example runs, and its picture is the one that examples/README.md shows.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

import importlib.util
import os
import pathlib
import re
import struct
import subprocess
import sys

import numpy as np
import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
EXAMPLES = sorted((ROOT / "examples").glob("[0-9][0-9]_*"))
SHOWN = {p.stem: p for p in (ROOT / "examples" / "pictures").iterdir()}
# What an example imports that is no part of the package's own needs.
NEEDS = {"09_render": "OpenEXR", "10_mitsuba": "mitsuba"}
NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e-?\d+)?")


def same_picture(made: pathlib.Path, shown: pathlib.Path) -> None:
    """SVG: the same but for numbers off by one in their last digit, as other sines may do.  PNG: the same size."""
    if made.suffix == ".svg":
        a, b = made.read_text(), shown.read_text()
        assert NUMBER.sub("#", a) == NUMBER.sub("#", b)
        off = np.abs(np.array(NUMBER.findall(a), float) - np.array(NUMBER.findall(b), float))
        assert off.max() <= 1.001 and (off > 0).mean() < 0.05
    else:
        head = [p.read_bytes()[:24] for p in (made, shown)]
        assert head[0][:8] == b"\x89PNG\r\n\x1a\n" and struct.unpack(">II", head[0][16:]) == struct.unpack(">II", head[1][16:])
        assert made.stat().st_size > shown.stat().st_size / 2  # not one colour


def test_there_are_enough_in_order_and_short() -> None:
    assert [p.name[:2] for p in EXAMPLES] == [f"{k + 1:02}" for k in range(len(EXAMPLES))] and len(EXAMPLES) >= 8
    listed = (ROOT / "examples/README.md").read_text()
    for p in EXAMPLES:
        assert len(p.read_text().splitlines()) < 100, p
        assert f"[{p.name}]({p.name})" in listed and f"(pictures/{SHOWN[p.stem].name})" in listed


@pytest.mark.parametrize("path", [p for p in EXAMPLES if p.suffix == ".py"], ids=lambda p: p.stem)
def test_python_examples_run(path: pathlib.Path, tmp_path: pathlib.Path, request: pytest.FixtureRequest) -> None:
    needed = NEEDS.get(path.stem)
    if needed and not importlib.util.find_spec(needed):
        pytest.skip(f"{needed} is not installed")
    environment = {**os.environ, "PYTHONDONTWRITEBYTECODE": "1"}
    if needed == "OpenEXR":
        environment["FACET"] = request.getfixturevalue("program")
    done = subprocess.run([sys.executable, str(path)], capture_output=True, text=True, cwd=tmp_path, env=environment,
                          check=False)
    assert done.returncode == 0 and not done.stderr, done.stderr
    assert done.stdout
    shown = SHOWN[path.stem]
    same_picture(tmp_path / shown.name, shown)
    if path.stem == "08_verify_yours":
        assert "wrong: albedo 1.1" in done.stdout and "all checks hold" in done.stdout


@pytest.mark.parametrize("path", [p for p in EXAMPLES if p.suffix == ".c" and "plugin" not in p.stem], ids=lambda p: p.stem)
def test_c_examples_draw_what_is_shown(path: pathlib.Path, tmp_path: pathlib.Path, program: str) -> None:
    built = pathlib.Path(program).parent / "examples" / path.stem
    if not built.exists():
        pytest.skip(f"{built} is not built")
    done = subprocess.run([str(built)], capture_output=True, text=True, cwd=tmp_path, check=True)
    assert done.stdout and not done.stderr
    shown = SHOWN[path.stem]
    if shown.suffix == ".png":  # by the command that examples/README.md names
        subprocess.run([program, "plot", "ggx alpha=.3 ks=.9,.7,.3", "--of", "lobe", "--size", "480x320", "-o", shown.name],
                       cwd=tmp_path, check=True)
    same_picture(tmp_path / shown.name, shown)


def test_the_plugin_is_drawn_by_verify(tmp_path: pathlib.Path, program: str) -> None:
    plugin = pathlib.Path(program).parent / "examples" / "plugin_phong.so"
    if not plugin.exists():
        pytest.skip(f"{plugin} is not built")
    subprocess.run([program, "verify", "--plugin", str(plugin), "exponent=20", "--check", "chi-square", "--plot", "pictures"],
                   cwd=tmp_path, check=True, capture_output=True)
    same_picture(tmp_path / "pictures" / "1-chi-square.png", SHOWN["07_plugin_phong"])
