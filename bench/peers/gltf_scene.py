"""What the peers' scripts need of a .gltf or .glb file: triangles in world space, materials, the first camera.

Knows what the benchmark's scenes hold and no more: triangles with float attributes, textures of separate files.
SPDX-License-Identifier: MIT
"""

import json
import math
import os
import struct
from dataclasses import dataclass, field

import numpy as np

COMPONENTS = {5121: np.uint8, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


@dataclass
class Mesh:
    name: str
    material: int
    positions: np.ndarray        # float32 (n, 3), world space, y up [m]
    triangles: np.ndarray        # uint32 (m, 3)
    normals: np.ndarray | None   # float32 (n, 3), world space
    uv: np.ndarray | None        # float32 (n, 2), v downwards as in glTF


@dataclass
class Material:
    name: str
    diffuse: tuple | None = None      # albedo of a Lambertian surface
    alpha: float | None = None        # of a GGX mirror of the reflectance `mirror`
    mirror: tuple | None = None
    emission: tuple | None = None     # radiance
    textures: dict = field(default_factory=dict)  # of glTF's material: "base", "rough_metal", "normal": files


@dataclass
class Scene:
    meshes: list
    materials: list
    camera_to_world: np.ndarray  # (4, 4); the camera looks along its -z
    yfov: float                  # [radian]


def read(path):
    """The scene of a file."""
    with open(path, "rb") as stream:
        data = stream.read()
    folder = os.path.dirname(path)
    if data[:4] == b"glTF":
        length, = struct.unpack("<I", data[12:16])
        document, blobs = json.loads(data[20:20 + length]), [data[20 + length + 8:]]
    else:
        document, blobs = json.loads(data), []
    for buffer in document.get("buffers", []):
        if "uri" in buffer:
            with open(os.path.join(folder, buffer["uri"]), "rb") as stream:
                blobs.append(stream.read())
    scene = Scene([], [material(document, m, folder) for m in document["materials"]], np.eye(4), math.radians(40))
    roots = document["scenes"][document.get("scene", 0)]["nodes"]
    for root in roots:
        walk(document, blobs, root, np.eye(4), scene)
    return scene


def accessor(document, blobs, index):
    a = document["accessors"][index]
    view = document["bufferViews"][a["bufferView"]]
    width, kind = WIDTHS[a["type"]], np.dtype(COMPONENTS[a["componentType"]])
    begin = view.get("byteOffset", 0) + a.get("byteOffset", 0)
    stride = view.get("byteStride", 0) or width*kind.itemsize
    raw = np.frombuffer(blobs[view["buffer"]], np.uint8, (a["count"] - 1)*stride + width*kind.itemsize, begin)
    rows = np.lib.stride_tricks.as_strided(raw, (a["count"], width*kind.itemsize), (stride, 1))
    values = np.ascontiguousarray(rows).view(kind)
    return values if width > 1 else values[:, 0]


def local_matrix(node):
    if "matrix" in node:
        return np.array(node["matrix"], float).reshape(4, 4).T
    x, y, z, w = node.get("rotation", [0, 0, 0, 1])
    turn = np.array([[1 - 2*(y*y + z*z), 2*(x*y - z*w), 2*(x*z + y*w)],
                     [2*(x*y + z*w), 1 - 2*(x*x + z*z), 2*(y*z - x*w)],
                     [2*(x*z - y*w), 2*(y*z + x*w), 1 - 2*(x*x + y*y)]])
    m = np.eye(4)
    m[:3, :3] = turn*np.array(node.get("scale", [1, 1, 1]))
    m[:3, 3] = node.get("translation", [0, 0, 0])
    return m


def walk(document, blobs, index, parent, scene):
    node = document["nodes"][index]
    to_world = parent @ local_matrix(node)
    if node.get("camera") == 0:
        scene.camera_to_world = to_world
        scene.yfov = document["cameras"][node["camera"]]["perspective"]["yfov"]
    for primitive in document["meshes"][node["mesh"]]["primitives"] if "mesh" in node else []:
        get = {name: accessor(document, blobs, i) for name, i in primitive["attributes"].items()}
        positions = get["POSITION"] @ to_world[:3, :3].T + to_world[:3, 3]
        normals = None
        if "NORMAL" in get:
            normals = get["NORMAL"] @ np.linalg.inv(to_world[:3, :3])
            normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-20)
            normals = normals.astype(np.float32)
        scene.meshes.append(Mesh(f"mesh{len(scene.meshes)}", primitive["material"], positions.astype(np.float32),
                                 accessor(document, blobs, primitive["indices"]).astype(np.uint32).reshape(-1, 3),
                                 normals, get.get("TEXCOORD_0")))
    for child in node.get("children", []):
        walk(document, blobs, child, to_world, scene)


def material(document, m, folder):
    """Lambert and GGX from plain numbers, or the files of the textures."""
    result = Material(m.get("name", "material"))
    extensions = m.get("extensions", {})
    strength = extensions.get("KHR_materials_emissive_strength", {}).get("emissiveStrength", 1)
    if any(m.get("emissiveFactor", [])):
        result.emission = tuple(strength*c for c in m["emissiveFactor"])
        return result
    pbr = m.get("pbrMetallicRoughness", {})

    def file_of(texture):
        source = document["textures"][texture["index"]]["source"]
        return os.path.join(folder, document["images"][source]["uri"])

    if "baseColorTexture" in pbr:
        given = {"base": pbr.get("baseColorTexture"), "rough_metal": pbr.get("metallicRoughnessTexture"),
                 "normal": m.get("normalTexture")}
        result.textures = {name: file_of(texture) for name, texture in given.items() if texture}
    elif "FACET_materials_bsdf" in extensions:
        kd = extensions["FACET_materials_bsdf"]["kd"]
        result.diffuse = tuple(kd) if isinstance(kd, list) else (kd,)*3
    elif pbr.get("metallicFactor", 1) == 1:
        result.alpha, result.mirror = pbr["roughnessFactor"]**2, tuple(pbr["baseColorFactor"][:3])
    else:
        result.diffuse = tuple(pbr["baseColorFactor"][:3])
    return result
