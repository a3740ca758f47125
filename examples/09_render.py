"""Rendering from Python: balls of GTR, rougher to the right, with shorter tails downwards.

Needs the program `facet` and `pip install facet-brdf[render]`.
SPDX-License-Identifier: MIT
"""
import numpy as np
from svg_file import png

import facet

ALPHAS, GAMMAS = [0.05, 0.1, 0.2, 0.4], [0.8, 1.5, 3.0]

nodes, materials = [], []
for row, gamma in enumerate(GAMMAS):
    for column, alpha in enumerate(ALPHAS):
        bsdf = {"model": "gtr", "alpha": alpha, "gamma": gamma, "metal": "Cu"}
        materials.append({"name": f"ball-{row}-{column}", "extensions": {"FACET_materials_bsdf": bsdf}})
        ball = {"sphere": {"radius": 0.45}, "material": len(materials) - 1}
        nodes.append({"translation": [column - 1.5, 1 - row, 0], "extensions": {"FACET_shape": ball}})
nodes.append({"camera": 0, "translation": [0, 0, 10]})
# A directional light shines along its own -z: half a turn about y - x sends it from the upper left.
nodes.append({"rotation": [-0.33, -0.27, 0.1, 0.9], "extensions": {"KHR_lights_punctual": {"light": 0}}})

scene = {
    "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(nodes)))}],
    "extensionsUsed": ["FACET_shape", "FACET_materials_bsdf", "KHR_lights_punctual"],
    "extensions": {"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 2}]}},
    "cameras": [{"type": "perspective", "perspective": {"yfov": 0.32, "znear": 0.1}}],
    "nodes": nodes, "materials": materials,
}
picture = facet.render(scene, size=(400, 300), spp=32, depth=2, env=(0.12, 0.14, 0.18))
png("09_render.png", picture)
print(f"{picture.shape[1]} x {picture.shape[0]} pixels, mean radiance {np.round(picture.mean((0, 1)), 3)}")
