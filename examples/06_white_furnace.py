"""The white furnace: one bounce between facets loses light where a surface is rough; energy=multi gives it back.

SPDX-License-Identifier: MIT
"""
import numpy as np
from svg_file import curves

import facet

cos = np.linspace(0.02, 1, 25)
rows, labels = [], []
for alpha in (0.2, 0.5, 1.0):
    rows.append(facet.ggx(alpha=alpha).albedo(cos)[:, 0])
    labels.append(f"alpha = {alpha}, one bounce")
rows.append(facet.ggx(alpha=1.0, energy="multi").albedo(cos)[:, 0])
labels.append("alpha = 1, energy=multi")
curves("06_white_furnace.svg", cos, rows, labels, "Albedo of white GGX", 1.2, "cosine of the view")

for row, label in zip(rows, labels):
    print(f"{label}: {row.min():.4f} to {row.max():.4f}")
