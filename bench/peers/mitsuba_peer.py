"""Renders a benchmark's scene by Mitsuba 3: bench/peers/compare.py runs it.

    python mitsuba_peer.py SCENE SKY SIZE SPP SEED OUT.npy        SKY: an .hdr file, or -

The variant llvm_ad_rgb on one thread, the path integrator, eight events, a box filter, multi-jittered samples.
SPDX-License-Identifier: MIT
"""

import math
import os
import sys
import tempfile

import drjit as dr
import mitsuba as mi
import numpy as np

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import gltf_scene  # noqa: E402

mi.set_variant(os.environ.get("MITSUBA_VARIANT", "llvm_ad_rgb"))
if "llvm" in mi.variant():
    dr.set_thread_count(1)


def rgb(c):
    return {"type": "rgb", "value": list(c)}


def texture(array, raw):
    return {"type": "bitmap", "bitmap": mi.Bitmap(np.ascontiguousarray(array)), "raw": raw}


def bsdf(m):
    if m.mirror:
        return {"type": "roughconductor", "material": "none", "distribution": "ggx", "alpha": m.alpha,
                "specular_reflectance": rgb(m.mirror)}
    if not m.textures:
        return {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": rgb(m.diffuse or (0, 0, 0))}}
    base, rough_metal, normal = (np.array(mi.Bitmap(m.textures[key])) for key in ("base", "rough_metal", "normal"))
    surface = {"type": "principled", "base_color": texture(base[:, :, :3], False),
               "roughness": texture(rough_metal[:, :, 1:2], True), "metallic": texture(rough_metal[:, :, 2:3], True)}
    surface = {"type": "normalmap", "normalmap": texture(normal[:, :, :3], True), "bsdf": surface}
    surface = {"type": "twosided", "bsdf": surface}
    if base.shape[2] == 4:
        surface = {"type": "mask", "opacity": texture(base[:, :, 3:4], True), "bsdf": surface}
    return surface


def shape(m, materials, folder):
    mesh = mi.Mesh(m.name, len(m.positions), len(m.triangles), has_vertex_normals=m.normals is not None,
                   has_vertex_texcoords=m.uv is not None)
    values = mi.traverse(mesh)
    values["vertex_positions"] = m.positions.ravel()
    values["faces"] = m.triangles.ravel()
    if m.normals is not None:
        values["vertex_normals"] = m.normals.ravel()
    if m.uv is not None:
        values["vertex_texcoords"] = m.uv.astype(np.float32).ravel()
    values.update()
    path = os.path.join(folder, m.name + ".ply")
    mesh.write_ply(path)
    made = {"type": "ply", "filename": path, "face_normals": m.normals is None, "bsdf": bsdf(materials[m.material])}
    if materials[m.material].emission:
        made["emitter"] = {"type": "area", "radiance": rgb(materials[m.material].emission)}
    return made


def main():
    path, sky, size, spp, seed, out = sys.argv[1:]
    read = gltf_scene.read(path)
    turn = mi.ScalarTransform4f(read.camera_to_world) @ mi.ScalarTransform4f().rotate([0, 1, 0], 180)
    with tempfile.TemporaryDirectory() as folder:
        scene = {m.name: shape(m, read.materials, folder) for m in read.meshes}
        scene.update(type="scene", integrator={"type": "path", "max_depth": 9}, sensor={
            "type": "perspective", "fov_axis": "y", "fov": math.degrees(read.yfov), "to_world": turn, "near_clip": 1e-4,
            "film": {"type": "hdrfilm", "width": int(size), "height": int(size), "rfilter": {"type": "box"},
                     "component_format": "float32", "pixel_format": "rgb"},
            "sampler": {"type": "multijitter", "sample_count": int(spp)}})
        if sky != "-":  # Mitsuba's u begins a quarter of a turn later
            scene["sky"] = {"type": "envmap", "filename": sky,
                            "to_world": mi.ScalarTransform4f().rotate([0, 1, 0], 90)}
        loaded = mi.load_dict(scene)
    picture = mi.render(loaded, spp=int(spp), seed=int(seed))
    np.save(out, np.array(picture))


main()
