"""GTR with any gamma in Mitsuba 3.  Needs `pip install facet-brdf[mitsuba]`.

SPDX-License-Identifier: MIT
"""
import mitsuba as mi

mi.set_variant("scalar_rgb")  # or llvm_ad_rgb, many times faster: it needs LLVM 17 or later

import facet.mitsuba  # noqa: E402

facet.mitsuba.register()

look_at = mi.ScalarTransform4f().look_at([0, 0, 6], [0, 0, 0], [0, 1, 0])
scene = {
    "type": "scene", "integrator": {"type": "path", "max_depth": 4},
    "sky": {"type": "constant", "radiance": {"type": "rgb", "value": [0.12, 0.14, 0.18]}},
    "lamp": {"type": "point", "position": [-3.0, 3.0, 5.0], "intensity": {"type": "rgb", "value": [40.0, 36.0, 30.0]}},
    "sensor": {"type": "perspective", "fov": 32.0, "to_world": look_at,
               "film": {"type": "hdrfilm", "width": 150, "height": 50, "pixel_format": "rgb"}},
}
for k, gamma in enumerate((0.8, 1.5, 3.0)):
    scene[f"ball{k}"] = {"type": "sphere", "center": [k - 1.0, 0.0, 0.0], "radius": 0.45,
                         "bsdf": {"type": "facet_gtr", "alpha": 0.1, "gamma": gamma, "metal": "Cu"}}

picture = facet.mitsuba.render(mi.load_dict(scene), spp=6)
mi.util.write_bitmap("10_mitsuba.png", picture, write_async=False)
print("three balls:", *(scene[f"ball{k}"]["bsdf"]["gamma"] for k in range(3)))
