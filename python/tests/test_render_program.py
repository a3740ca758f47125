"""facet.render runs the program, reads its picture, and passes its messages on.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

import os
import pathlib
import stat
import sys

import numpy as np
import pytest

import facet

OpenEXR = pytest.importorskip("OpenEXR", reason="the package OpenEXR is not installed")

# Two spheres in a white world: one material has its own name.
SCENE = {
    "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
    "extensionsUsed": ["FACET_shape", "FACET_materials_bsdf"],
    "nodes": [{"extensions": {"FACET_shape": {"sphere": {"radius": 1.0}, "material": 0}}}],
    "materials": [{"name": "ball", "extensions": {"FACET_materials_bsdf": {"model": "lambert", "kd": 0.5}}}],
}


@pytest.fixture(autouse=True)
def _named(program: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("FACET", program)


def test_the_demo_scene_is_a_picture() -> None:
    picture = facet.render(size=(32, 20), spp=4)
    assert picture.shape == (20, 32, 3) and picture.dtype == np.float32
    assert np.isfinite(picture).all() and picture.max() > 0.1
    alone = facet.render(size=(32, 20), spp=4, gradients=False)  # else few samples may be below 0
    assert np.isfinite(alone).all() and (alone >= 0).all() and alone.max() > 0.1


def test_a_document_under_a_white_sky_shows_its_albedo() -> None:
    """A convex Lambertian body in a uniform world has the radiance of its reflectance everywhere, exactly."""
    # Directions drawn by the cosine have the weight 0.5, all of them: no noise.
    picture = facet.render(SCENE, size=(24, 24), spp=16, env=1, strategy="implicit")
    middle = picture[10:14, 10:14]
    np.testing.assert_allclose(middle, 0.5, rtol=1e-5)
    np.testing.assert_allclose(picture[0, 0], 1, rtol=1e-6)
    other = facet.render(SCENE, size=(24, 24), spp=16, env=(1, 2, 4), strategy="implicit",
                         materials={"ball": facet.lambert(kd=(0.2, 0.4, 0.8))})
    np.testing.assert_allclose(other[10:14, 10:14], np.broadcast_to([0.2, 0.8, 3.2], (4, 4, 3)), rtol=1e-5)
    text = facet.render(SCENE, size=(24, 24), spp=16, env=1.0, materials={"ball": "lambert kd=.25"},
                        options=["--strategy=implicit"])
    np.testing.assert_allclose(text[10:14, 10:14], 0.25, rtol=1e-5)


def test_arguments_are_the_programs_options() -> None:
    whole = facet.render(SCENE, size=(24, 24), spp=4, seed=5, threads=1, depth=2, strategy="implicit")
    part = facet.render(SCENE, size=(24, 24), spp=4, seed=5, crop=(4, 6, 10, 8), depth=2, strategy="implicit")
    assert part.shape == (8, 10, 3)
    np.testing.assert_array_equal(part, whole[6:14, 4:14])
    assert not np.array_equal(whole, facet.render(SCENE, size=(24, 24), spp=4, seed=6, depth=2, strategy="implicit"))


def test_gradients_compare_pixels_of_the_same_mean() -> None:
    compared = facet.render(size=(48, 32), spp=16, gradients=True)
    alone = facet.render(size=(48, 32), spp=16, gradients=False)
    np.testing.assert_array_equal(compared, facet.render(size=(48, 32), spp=16, options=["--gradients=on"]))
    np.testing.assert_array_equal(alone, facet.render(size=(48, 32), spp=16, options=["--gradients=off"]))
    assert not np.array_equal(compared, alone)
    chosen = facet.render(size=(48, 32), spp=16)
    assert np.array_equal(chosen, compared) or np.array_equal(chosen, alone)


def test_progress_is_told() -> None:
    seen: list[float] = []
    facet.render(SCENE, size=(16, 16), spp=4, progress=seen.append)
    assert seen and seen[-1] == 1 and seen == sorted(seen)


def test_progress_is_shown(capsys: pytest.CaptureFixture[str]) -> None:
    facet.render(SCENE, size=(16, 16), spp=4, progress=True)
    assert "] 100 %\n" in capsys.readouterr().err


def test_errors_carry_the_programs_own_words(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    missing = tmp_path / "missing.gltf"
    with pytest.raises(FileNotFoundError, match=r"missing.gltf: cannot open"):
        facet.render(missing)
    with pytest.raises(FileNotFoundError, match=r"sky.hdr"):
        facet.render(SCENE, env=tmp_path / "sky.hdr")
    broken = tmp_path / "broken.gltf"
    broken.write_text("{")
    with pytest.raises(ValueError, match=r"broken.gltf"):
        facet.render(broken)
    with pytest.raises(ValueError, match="the scene has no material `body`; it has `ball`"):
        facet.render(SCENE, materials={"body": "lambert"})
    with pytest.raises(ValueError, match="--spp"):
        facet.render(SCENE, spp=0)
    with pytest.raises(ValueError, match="--wibble"):
        facet.render(SCENE, options=["--wibble"])
    with pytest.raises(FileNotFoundError, match="picture.exr: cannot open"):
        facet.read_exr(tmp_path / "picture.exr")
    monkeypatch.setenv("FACET", str(tmp_path / "nothing"))
    with pytest.raises(FileNotFoundError, match=r"\$FACET is .*nothing, which is no program"):
        facet.render()
    monkeypatch.delenv("FACET")
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setattr("sysconfig.get_path", lambda name: str(tmp_path))
    with pytest.raises(FileNotFoundError, match="the program `facet` was not found"):
        facet.render()


def stand_in(folder: pathlib.Path, body: str) -> str:
    """A program in place of facet that prints and ends as it is told."""
    path = folder / "facet"
    path.write_text(f"#!{sys.executable}\nimport sys\n{body}\n")
    path.chmod(path.stat().st_mode | stat.S_IXUSR)
    return os.fspath(path)


@pytest.mark.parametrize("status, kind, text", [
    (4, OSError, "out.exr: cannot write: No space left on device"), (4, MemoryError, "out of memory"),
    (2, ValueError, "--spp: no"), (3, ValueError, "accessors[0]: wrong"), (130, KeyboardInterrupt, "stopped"),
    (77, RuntimeError, "what")])
def test_each_status_has_its_exception(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch, status: int,
                                       kind: type[BaseException], text: str) -> None:
    monkeypatch.setenv("FACET", stand_in(tmp_path, f"print('facet: error: {text}', file=sys.stderr); sys.exit({status})"))
    with pytest.raises(kind, match=text.replace("[", r"\[").replace("]", r"\]")):
        facet.render(SCENE)


def test_a_crash_without_words_is_an_error(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("FACET", stand_in(tmp_path, "import os, signal; os.kill(os.getpid(), signal.SIGSEGV)"))
    with pytest.raises(RuntimeError, match="facet render ended with status -11"):
        facet.render(SCENE)


def test_warnings_are_warnings() -> None:
    scene = {**SCENE, "extensionsUsed": [*SCENE["extensionsUsed"], "EXT_unheard_of"]}
    with pytest.warns(RuntimeWarning, match="EXT_unheard_of"):
        facet.render(scene, size=(8, 8), spp=1)


def test_layers_are_read_by_name(tmp_path: pathlib.Path) -> None:
    path, rng = tmp_path / "layers.exr", np.random.default_rng(1)
    pixels = {n: rng.random((5, 7), dtype=np.float32) for n in ("R", "G", "B", "albedo.R", "albedo.G", "albedo.B", "depth.Z",
                                                                "normal.X", "normal.Y", "normal.Z")}
    with OpenEXR.File({"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage},
                      {n: OpenEXR.Channel(p) for n, p in pixels.items()}) as file:
        file.write(str(path))
    layers = facet.read_exr(path)
    assert set(layers) == {"", "albedo", "depth", "normal"}
    np.testing.assert_array_equal(layers[""], np.stack([pixels[c] for c in "RGB"], axis=-1))
    np.testing.assert_array_equal(layers["normal"], np.stack([pixels[f"normal.{c}"] for c in "XYZ"], axis=-1))
    np.testing.assert_array_equal(layers["depth"], pixels["depth.Z"])


def test_further_pictures_come_as_a_dict() -> None:
    """With `aov`, all layers by name; the scene is a sphere of radius 1 that fills the middle of the picture."""
    layers = facet.render(SCENE, size=(24, 24), spp=16, env=1, strategy="implicit",
                          aov=["albedo", "normal", "distance", "samples"])
    assert set(layers) == {"", "albedo", "normal", "distance", "samples"}
    assert layers[""].shape == layers["albedo"].shape == layers["normal"].shape == (24, 24, 3)
    assert layers["distance"].shape == layers["samples"].shape == (24, 24)
    np.testing.assert_array_equal(layers["samples"], 16)
    np.testing.assert_allclose(layers["albedo"][10:14, 10:14], 0.5, rtol=1e-3)  # halves of 11 bits
    normals = layers["normal"][10:14, 10:14]
    np.testing.assert_allclose(np.linalg.norm(normals.mean(axis=(0, 1))), 1, atol=0.05)  # they all point to the camera
    distance = layers["distance"]
    seen = np.isfinite(distance)
    assert distance[10:14, 10:14].max() < distance[seen].max() < distance[10:14, 10:14].min() + 1  # less than the radius behind
    assert not seen[0, 0] and not layers["normal"][0, 0].any() and (layers["albedo"][0, 0] == 1).all()  # the sky
    alone = facet.render(SCENE, size=(24, 24), spp=16, env=1, strategy="implicit")
    np.testing.assert_array_equal(layers[""], alone)


def test_a_layer_that_there_is_not_is_an_error() -> None:
    with pytest.raises(ValueError, match="--aov"):
        facet.render(SCENE, size=(8, 8), spp=1, aov=["warmth"])
