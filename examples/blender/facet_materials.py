"""An add-on for Blender (3.4 and later): materials of facet in glTF files.

A material's custom property `facet` is the text of any material of facet, such as `gtr alpha=.1 gamma=1.5 ks=.9,.7,.3`.
The glTF exporter writes it as extensions.FACET_materials_bsdf, which `facet render` renders and other programs ignore; the
importer sets the property again.  Blender itself goes on showing the material's nodes.

Install: Edit > Preferences > Add-ons > Install..., this file; tick the box.  Material properties then have a panel `facet`.

SPDX-License-Identifier: MIT
"""
import bpy
from bpy.types import Operator, Panel

bl_info = {
    "name": "facet materials",
    "blender": (3, 4, 0),
    "category": "Import-Export",
    "location": "Properties > Material > facet",
    "description": "Materials of facet in glTF, as FACET_materials_bsdf",
}

NAME = "FACET_materials_bsdf"


def to_extension(text):
    """The members of the extension: numbers, lists of three numbers, and names."""
    model, *pairs = text.split()
    extension = {"model": model}
    for pair in pairs:
        key, equals, value = pair.partition("=")
        if not equals or not value:
            raise ValueError(f"facet: `{pair}` is not KEY=VALUE")
        try:
            numbers = [float(x) for x in value.split(",")]
            extension[key] = numbers if len(numbers) > 1 else numbers[0]
        except ValueError:
            extension[key] = value
    return extension


def to_text(extension):
    """The text of an extension's members."""
    def word(value):
        return ",".join(map(word, value)) if isinstance(value, list) else value if isinstance(value, str) else f"{value:.9g}"

    return " ".join([extension["model"]] + [f"{k}={word(v)}" for k, v in extension.items() if k != "model"])


class glTF2ExportUserExtension:
    """What the exporter asks for each material."""

    def __init__(self):
        from io_scene_gltf2.io.com.gltf2_io_extensions import Extension
        self.Extension = Extension

    def gather_material_hook(self, gltf2_material, blender_material, export_settings):
        text = blender_material.get("facet")
        if text:
            extensions = dict(gltf2_material.extensions or {})
            extensions[NAME] = self.Extension(name=NAME, extension=to_extension(text), required=False)
            gltf2_material.extensions = extensions


class glTF2ImportUserExtension:
    """What the importer asks for each material."""

    def __init__(self):
        from io_scene_gltf2.io.com.gltf2_io_extensions import Extension
        self.extensions = [Extension(name=NAME, extension={}, required=False)]

    def gather_import_material_after_hook(self, gltf_material, vertex_color, blender_mat, gltf):
        extension = (gltf_material.extensions or {}).get(NAME)
        if extension:
            blender_mat["facet"] = to_text(extension)


class FACET_OT_add(Operator):
    """Make this a material of facet"""
    bl_idname = "facet.add"
    bl_label = "Use facet"

    def execute(self, context):
        context.material["facet"] = "ggx alpha=.3"
        return {"FINISHED"}


class FACET_PT_material(Panel):
    bl_label = "facet"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "material"

    @classmethod
    def poll(cls, context):
        return context.material is not None

    def draw(self, context):
        if "facet" in context.material:
            self.layout.prop(context.material, '["facet"]', text="")
        else:
            self.layout.operator(FACET_OT_add.bl_idname)


CLASSES = (FACET_OT_add, FACET_PT_material)


def register():
    for each in CLASSES:
        bpy.utils.register_class(each)


def unregister():
    for each in reversed(CLASSES):
        bpy.utils.unregister_class(each)
