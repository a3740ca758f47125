"""Run by Blender: a scene whose ball has a material of facet, exported, imported and exported again.

    blender --background --factory-startup --python blender_scene.py -- ADD_ON.py 'SPEC' FOLDER

SPDX-License-Identifier: MIT
"""
import os
import sys

import bpy
import numpy

if "bool" not in vars(numpy):  # the importer of Blender 3.4 is older than Debian 12's NumPy, which has no such name
    numpy.bool = bool


def export(path):
    bpy.ops.export_scene.gltf(filepath=path, export_format="GLTF_EMBEDDED", export_cameras=True, export_lights=True)


def main():
    add_on, spec, folder = sys.argv[sys.argv.index("--") + 1:]
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module="io_scene_gltf2")
    bpy.ops.mesh.primitive_uv_sphere_add(segments=48, ring_count=24)
    ball = bpy.context.object
    bpy.ops.object.shade_smooth()
    material = bpy.data.materials.new("ball")
    material.use_nodes = True
    ball.data.materials.append(material)
    bpy.ops.object.camera_add(location=(0, -4, 0), rotation=(1.5707963, 0, 0))
    bpy.context.scene.camera = bpy.context.object
    export(os.path.join(folder, "plain.gltf"))

    bpy.ops.preferences.addon_install(filepath=add_on)
    bpy.ops.preferences.addon_enable(module="facet_materials")
    material["facet"] = spec
    export(os.path.join(folder, "marked.gltf"))

    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module="io_scene_gltf2")
    bpy.ops.preferences.addon_enable(module="facet_materials")
    bpy.ops.import_scene.gltf(filepath=os.path.join(folder, "marked.gltf"))
    print("imported:", bpy.data.materials["ball"]["facet"])
    export(os.path.join(folder, "again.gltf"))


main()
