"""Renders a benchmark's scene by Cycles: bench/peers/compare.py runs it in Blender or with the module bpy.

    blender -b -t 1 -P cycles_peer.py -- SCENE SKY SIZE SPP SEED OUT.npy        SKY: an .hdr file, or -
    python cycles_peer.py -- SCENE SKY SIZE SPP SEED OUT.npy

Cycles' own defaults, but for what would change the picture's mean: no clamping, no blur of glossy paths, no denoiser, no
adaptive sampling, eight events, a box filter.
SPDX-License-Identifier: MIT
"""

import math
import os
import sys

import bpy
import numpy as np

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import gltf_scene  # noqa: E402  (Blender does not look beside the script)


def set_up(size, spp, seed, out):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    settings = {"device": "CPU", "samples": spp, "seed": seed, "use_adaptive_sampling": False, "use_denoising": False,
                "max_bounces": 7, "diffuse_bounces": 7, "glossy_bounces": 7, "transmission_bounces": 7,
                "sample_clamp_direct": 0, "sample_clamp_indirect": 0, "blur_glossy": 0, "caustics_reflective": True,
                "caustics_refractive": True, "pixel_filter_type": "BOX", "use_auto_tile": False}
    for name, value in settings.items():
        setattr(scene.cycles, name, value)
    render = scene.render
    render.threads_mode, render.threads = "FIXED", 1
    render.resolution_x = render.resolution_y = size
    render.resolution_percentage = 100
    render.image_settings.file_format = "OPEN_EXR"
    render.image_settings.color_depth = "32"
    render.filepath, render.use_file_extension = out, False
    return scene


def node_material(m):
    made = bpy.data.materials.new(m.name)
    made.use_nodes = True
    tree = made.node_tree
    tree.nodes.clear()
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    if m.emission:
        node = tree.nodes.new("ShaderNodeEmission")
        node.inputs["Color"].default_value = (*(c/max(m.emission) for c in m.emission), 1)
        node.inputs["Strength"].default_value = max(m.emission)
        if hasattr(made.cycles, "emission_sampling"):
            made.cycles.emission_sampling = "FRONT"
    elif m.mirror:
        node = tree.nodes.new("ShaderNodeBsdfAnisotropic" if bpy.app.version >= (4, 0, 0) else "ShaderNodeBsdfGlossy")
        node.distribution = "GGX"
        node.inputs["Color"].default_value = (*m.mirror, 1)
        node.inputs["Roughness"].default_value = math.sqrt(m.alpha)
    else:
        node = tree.nodes.new("ShaderNodeBsdfDiffuse")
        node.inputs["Color"].default_value = (*m.diffuse, 1)
    tree.links.new(node.outputs[0], output.inputs[0])
    return made


def z_up(v):
    return np.stack([v[:, 0], -v[:, 2], v[:, 1]], axis=1)


def add_meshes(scene, read):
    materials = [node_material(m) for m in read.materials]
    for m in read.meshes:
        mesh = bpy.data.meshes.new(m.name)
        n = len(m.triangles)
        mesh.vertices.add(len(m.positions))
        mesh.vertices.foreach_set("co", z_up(m.positions).astype(np.float32).ravel())
        mesh.loops.add(3*n)
        mesh.loops.foreach_set("vertex_index", m.triangles.astype(np.int32).ravel())
        mesh.polygons.add(n)
        mesh.polygons.foreach_set("loop_start", np.arange(0, 3*n, 3, dtype=np.int32))
        if bpy.app.version < (3, 6, 0):
            mesh.polygons.foreach_set("loop_total", np.full(n, 3, dtype=np.int32))
        mesh.polygons.foreach_set("use_smooth", np.full(n, m.normals is not None))
        mesh.materials.append(materials[m.material])
        mesh.update(calc_edges=True)
        if m.normals is not None:
            if bpy.app.version < (4, 1, 0):
                mesh.use_auto_smooth = True
            mesh.normals_split_custom_set_from_vertices(z_up(m.normals).tolist())
        scene.collection.objects.link(bpy.data.objects.new(m.name, mesh))


def add_camera(scene, read):
    camera = bpy.data.cameras.new("camera")
    camera.sensor_fit, camera.angle = "VERTICAL", read.yfov
    camera.clip_start, camera.clip_end = 1e-4, 1e4
    seen = bpy.data.objects.new("camera", camera)
    turn = np.array([[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1.0]])
    seen.matrix_world = (turn @ read.camera_to_world).T.tolist()
    scene.collection.objects.link(seen)
    scene.camera = seen


def add_world(scene, sky):
    world = bpy.data.worlds.new("world")
    world.use_nodes = True
    background = world.node_tree.nodes["Background"]
    background.inputs["Strength"].default_value = 0 if sky == "-" else 1
    if sky != "-":
        texture = world.node_tree.nodes.new("ShaderNodeTexEnvironment")
        texture.image = bpy.data.images.load(sky)
        world.node_tree.links.new(texture.outputs[0], background.inputs["Color"])
    scene.world = world


def main():
    path, sky, size, spp, seed, out = sys.argv[sys.argv.index("--") + 1:]
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = set_up(int(size), int(spp), int(seed), out + ".exr")
    read = gltf_scene.read(path)
    if any(m.textures for m in read.materials):  # Blender's own reader knows glTF's materials best
        if not hasattr(np, "bool"):  # Debian's is older than its NumPy
            np.bool = bool
        bpy.ops.import_scene.gltf(filepath=path)
        for o in [o for o in scene.objects if o.type == "CAMERA"]:
            bpy.data.objects.remove(o)
    else:
        add_meshes(scene, read)
    add_camera(scene, read)
    add_world(scene, sky)
    bpy.ops.render.render(write_still=True)
    picture = bpy.data.images.load(out + ".exr")
    pixels = np.empty(4*int(size)**2, np.float32)
    picture.pixels.foreach_get(pixels)
    np.save(out, pixels.reshape(int(size), int(size), 4)[::-1, :, :3])
    os.unlink(out + ".exr")


main()
