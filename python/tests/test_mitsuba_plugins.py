"""Mitsuba with facet's plugins and facet's own path tracer agree within noise on the same scene.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

import glob
import json
import os
import pathlib
import subprocess
import sys
from typing import Any

import numpy as np
import pytest

import facet

mi = pytest.importorskip("mitsuba", reason="Mitsuba 3 is not installed: pip install mitsuba")
pytest.importorskip("OpenEXR", reason="the package OpenEXR is not installed")

SIZE, BLOCK = 24, 6
# Welch's t of 16 blocks and 2 models, each of 32 renders: Sidak's level of 1e-3 is p = 3e-5, |t| = 4.6 with 31 degrees of
# freedom.  The seeds are fixed.
MOST_T = 4.6


def llvm() -> str | None:
    """The newest LLVM of the system that Mitsuba's wheel can use; 16 and older lack what it compiles to."""
    found = {}
    for path in glob.glob("/usr/lib/*/libLLVM*.so*") + glob.glob("/usr/lib/llvm-*/lib/libLLVM*.so*"):
        digits = os.path.basename(path).replace("libLLVM", "").lstrip("-.").removeprefix("so.").split(".")[0]
        if digits.isdigit() and int(digits) >= 17:
            found[int(digits)] = path
    return found[max(found)] if found else None


def by_mitsuba(variant: str, plugin: dict[str, Any], n: int, spp: int, folder: pathlib.Path) -> np.ndarray:
    out = folder / "pictures.npy"
    environment = dict(os.environ)
    if variant.startswith("llvm"):
        path = llvm()
        if path is None:
            pytest.skip("no LLVM from 17 on for Mitsuba's llvm variants: apt-get install libllvm19")
        environment["DRJIT_LIBLLVM_PATH"] = path
    script = pathlib.Path(__file__).with_name("mitsuba_scene.py")
    done = subprocess.run([sys.executable, str(script), variant, json.dumps(plugin), str(n), str(spp), str(SIZE), str(out)],
                          capture_output=True, text=True, env=environment, check=False)
    assert done.returncode == 0, done.stderr[-4000:]
    pictures: np.ndarray = np.load(out)
    return pictures


def by_facet(model: dict[str, Any], n: int, spp: int) -> np.ndarray:
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2]}],
        "extensionsUsed": ["FACET_shape", "FACET_materials_bsdf", "KHR_lights_punctual"],
        "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "color": [1, 2 / 3, 1 / 3], "intensity": 30}]}},
        "cameras": [{"type": "perspective", "perspective": {"yfov": float(np.deg2rad(40)), "znear": 0.1, "aspectRatio": 1}}],
        "nodes": [{"extensions": {"FACET_shape": {"sphere": {"radius": 1.0}, "material": 0}}},
                  {"camera": 0, "translation": [0, 0, 4]},
                  {"translation": [3, 2, 4], "extensions": {"KHR_lights_punctual": {"light": 0}}}],
        "materials": [{"name": "ball", "extensions": {"FACET_materials_bsdf": model}}]}
    return np.array([facet.render(document, size=(SIZE, SIZE), spp=spp, seed=k, env=0.3, depth=8) for k in range(n)])


def largest_t(a: np.ndarray, b: np.ndarray) -> float:
    """Welch's t of the means over blocks, the largest of all blocks that show some of the ball."""

    def blocks(x: np.ndarray) -> np.ndarray:
        cut = x.mean(axis=-1).reshape(len(x), SIZE // BLOCK, BLOCK, SIZE // BLOCK, BLOCK)
        return cut.mean(axis=(2, 4)).reshape(len(x), -1)

    p, q = blocks(a), blocks(b)
    error = np.sqrt(p.var(axis=0, ddof=1) / len(p) + q.var(axis=0, ddof=1) / len(q))
    off = np.abs(p.mean(axis=0) - q.mean(axis=0))
    is_sky = error < 1e-7  # without noise: equal but for rounding
    assert (off[is_sky] < 1e-6).all()
    return float((off[~is_sky] / error[~is_sky]).max())


@pytest.fixture(autouse=True)
def _named(program: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("FACET", program)


@pytest.mark.parametrize("name, values", [("gtr", {"alpha": 0.3, "gamma": 1.5, "ks": 0.8}), ("glass", {"ior": 1.5, "alpha": 0.3})])
def test_wavefronts_render_as_facet_does(tmp_path: pathlib.Path, name: str, values: dict[str, float]) -> None:
    theirs = by_mitsuba("llvm_ad_rgb", {"type": f"facet_{name}", **values}, 32, 32, tmp_path)
    assert largest_t(theirs, by_facet({"model": name, **values}, 32, 32)) < MOST_T
    if name == "gtr":  # the test sees another gamma
        assert largest_t(theirs, by_facet({"model": name, **values, "gamma": 1.7}, 32, 32)) > MOST_T


def test_single_rays_render_as_facet_does(tmp_path: pathlib.Path) -> None:
    values = {"alpha": 0.3, "gamma": 1.5, "ks": {"type": "rgb", "value": [0.8, 0.4, 0.2]}}
    theirs = by_mitsuba("scalar_rgb", {"type": "facet_gtr", **values}, 16, 4, tmp_path)
    ours = by_facet({"model": "gtr", "alpha": 0.3, "gamma": 1.5, "ks": [0.8, 0.4, 0.2]}, 16, 4)
    # 15 degrees of freedom: |t| = 5.6 is p = 6e-5, Sidak's level of 1e-3 for 16 blocks.
    assert largest_t(theirs, ours) < 5.6


USES = """\
import mitsuba as mi, numpy as np
import facet, facet.mitsuba
try: facet.mitsuba.register()
except ValueError as why: print("1", why)
mi.set_variant("scalar_rgb")
facet.mitsuba.register()
def message(plugin):
    try: return mi.load_dict(plugin)
    except Exception as why: return why
print("2", message({"type": "facet", "spec": "ggx alpha=.2"}))
print("3", message({"type": "facet_ggx", "alpha": 7.0}))
print("4", message({"type": "facet_ggx", "roughness": 0.3}))
print("5", message({"type": "facet", "text": "ggx"}))
print("6", message({"type": "facet_ggx", "g2": "separable", "ks": {"type": "rgb", "value": [0.9, 0.5, 0.1]}}))
b = mi.load_dict({"type": "facet_gtr", "alpha": 0.3, "gamma": 1.5})
si = mi.SurfaceInteraction3f()
si.wi = mi.Vector3f(0, 0.6, 0.8)
wo = mi.Vector3f(0, -0.6, 0.8)
m = facet.gtr(alpha=0.3, gamma=1.5)
ctx = mi.BSDFContext()
f, p = b.eval_pdf(ctx, si, wo)
assert np.array_equal(np.array(f, np.float32), m.eval([0, -.6, .8], [0, .6, .8])) and p == m.pdf([0, -.6, .8], [0, .6, .8])
assert np.array_equal(np.array(b.eval(ctx, si, wo)), np.array(f)) and b.pdf(ctx, si, wo) == p
s, weight = b.sample(ctx, si, 0.3, mi.Point2f(0.2, 0.7))
mine = m.sample([0, .6, .8], np.float32([.2, .7, .3]))
assert np.array_equal(np.array(s.wo, np.float32), mine.wi) and s.pdf == mine.pdf
assert np.array_equal(np.array(weight, np.float32), mine.weight) and s.eta == 1
assert mi.has_flag(s.sampled_type, mi.BSDFFlags.GlossyReflection) and not mi.has_flag(s.sampled_type, mi.BSDFFlags.Delta)
mirror = mi.load_dict({"type": "facet_glass"})
s, weight = mirror.sample(ctx, si, 0.999, mi.Point2f(0.2, 0.7))
assert mi.has_flag(s.sampled_type, mi.BSDFFlags.DeltaTransmission) and abs(s.eta - 1.5) < 1e-6 and s.wo.z < 0
assert np.array(b.eval(ctx, si, wo, False)).sum() == 0
"""


def test_plugins_take_parameters_and_give_the_librarys_numbers() -> None:
    done = subprocess.run([sys.executable, "-c", USES], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-3000:]
    for words in ["1 Mitsuba's variant is None; call mi.set_variant with one of scalar_rgb, llvm_ad_rgb",
                  "2 FacetBSDF[ggx alpha=0.2]", "alpha: 7 is out of range; give a number in [0.0001, 4]",
                  "ggx() has no parameter 'roughness'", "the plugin facet has one property, spec",
                  "6 FacetBSDF[ggx ks=0.9,0.5,0.1 g2=separable]"]:
        assert words in done.stdout, done.stdout
