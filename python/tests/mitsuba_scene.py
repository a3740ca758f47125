"""A sphere under a sky and a lamp, rendered by Mitsuba with facet's plugin: run in a process of its own, since a variant whose
LLVM is too old ends its process.

    mitsuba_scene.py VARIANT 'JSON of the plugin' N_RENDERS SPP SIZE OUT.npy

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

import json
import sys
from typing import Any

import numpy as np


def scene(mi: Any, bsdf: dict[str, Any], size: int) -> Any:
    """What glTF's document of the test describes."""
    eye = mi.ScalarTransform4f().look_at([0, 0, 4], [0, 0, 0], [0, 1, 0])
    return mi.load_dict({
        "type": "scene", "integrator": {"type": "path", "max_depth": 9},
        "ball": {"type": "sphere", "radius": 1.0, "bsdf": bsdf},
        "sky": {"type": "constant", "radiance": {"type": "rgb", "value": [0.3, 0.3, 0.3]}},
        "lamp": {"type": "point", "position": [3.0, 2.0, 4.0], "intensity": {"type": "rgb", "value": [30.0, 20.0, 10.0]}},
        "sensor": {"type": "perspective", "fov": 40.0, "fov_axis": "y", "to_world": eye,
                   "film": {"type": "hdrfilm", "width": size, "height": size, "rfilter": {"type": "box"},
                            "pixel_format": "rgb"},
                   "sampler": {"type": "independent"}}})


def main() -> None:
    variant, plugin, n, spp, size, out = sys.argv[1:]
    import mitsuba as mi
    mi.set_variant(variant)
    import facet.mitsuba
    facet.mitsuba.register()
    made = scene(mi, json.loads(plugin), int(size))
    np.save(out, np.array([np.array(facet.mitsuba.render(made, spp=int(spp), seed=k)) for k in range(int(n))]))


if __name__ == "__main__":
    main()
