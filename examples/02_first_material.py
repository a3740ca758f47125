"""The same material in Python: its table of parameters, a value, and its lobe as a picture.

SPDX-License-Identifier: MIT
"""
import facet

m = facet.ggx(alpha=0.3, ks=(0.9, 0.7, 0.3))
alpha = facet.ggx.parameters["alpha"]
print(f"{facet.ggx.summary}; {alpha.name}: {alpha.description}, {alpha.range}, default {alpha.default}")

wi, wo = [0, 0.6, 0.8], [0, -0.6, 0.8]
f, pdf = m.eval_pdf(wi, wo)
print(f"f cos = {f.round(4)}, pdf = {pdf:.4f}, albedo = {m.albedo(0.8).round(4)}")

with open("02_first_material.svg", "w", encoding="utf-8") as stream:
    stream.write(m._repr_svg_() + "\n")  # what a notebook shows of m
