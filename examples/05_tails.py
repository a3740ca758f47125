"""GTR's tail: the same roughness with five gammas, and what exact masking does beside V-Ray's published spline.

SPDX-License-Identifier: MIT
"""
import numpy as np
from svg_file import curves

import facet

GAMMAS = [0.5, 1.0, 1.5, 2.0, 6.0]
theta = np.linspace(0, np.pi / 2 - 1e-3, 200)
v = facet.direction(theta)

G1 = [facet.gtr(alpha=0.3, gamma=g).G1(v) for g in GAMMAS]
curves("05_tails.svg", np.rad2deg(theta), G1, [f"gamma = {g}" for g in GAMMAS],
       "G1 of GTR, alpha = 0.3, exact for any gamma", 1.0, "angle of the view [degree]")

for g in GAMMAS:
    exact, spline = (facet.gtr(alpha=0.3, gamma=g, masking=m).G1(v) for m in ("exact", "published"))
    print(f"gamma {g}: the published spline is off by at most {np.abs(exact - spline).max():.4f}")
