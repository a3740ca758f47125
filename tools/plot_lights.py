#!/usr/bin/env python3
"""Writes docs/images/lights.svg from the measurements of bench/many_lights: time to equal error over the number of lights.

    tools/plot_lights.py

Needs nothing but Python.
SPDX-License-Identifier: MIT
"""

import csv
import math
from pathlib import Path

TREE = Path(__file__).resolve().parent.parent
RESULTS = TREE/"bench"/"results"/"epyc-2vcpu"
PICTURE = TREE/"docs"/"images"/"lights.svg"

CURVES = [("many_lights_by_power.csv", "by power", "#c0392b"), ("many_lights.csv", "tree", "#1f6fb2")]
LEFT, TOP, WIDTH, HEIGHT = 60, 20, 460, 260
LIGHTS, SECONDS = (1, 5), (-1, 3)  # decades


def x_of(lights):
    return LEFT + WIDTH*(math.log10(lights) - LIGHTS[0])/(LIGHTS[1] - LIGHTS[0])


def y_of(seconds):
    return TOP + HEIGHT*(1 - (math.log10(seconds) - SECONDS[0])/(SECONDS[1] - SECONDS[0]))


def text(x, y, words, anchor="middle", color="#333"):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" fill="{color}">{words}</text>'


def line(x1, y1, x2, y2):
    return f'<path d="M{x1:.1f} {y1:.1f}L{x2:.1f} {y2:.1f}" stroke="#ddd"/>'


def main():
    out = ['<svg xmlns="http://www.w3.org/2000/svg" width="620" height="330" font-family="sans-serif" font-size="13">',
           '<rect width="620" height="330" fill="#fff"/>']
    for decade in range(LIGHTS[0], LIGHTS[1] + 1):
        x = x_of(10**decade)
        out += [line(x, TOP, x, TOP + HEIGHT), text(x, TOP + HEIGHT + 18, f"{10**decade}")]
    for decade in range(SECONDS[0], SECONDS[1] + 1):
        y = y_of(10**decade)
        out += [line(LEFT, y, LEFT + WIDTH, y), text(LEFT - 8, y + 4, f"{10**decade:g}", "end")]
    out += [text(LEFT + WIDTH/2, TOP + HEIGHT + 38, "lights"),
            text(LEFT + 8, TOP + 14, "CPU seconds to an error of 2 %", "start")]
    for name, words, color in CURVES:
        with open(RESULTS/name, newline="", encoding="ascii") as file:
            points = [(x_of(float(row["lights"])), y_of(float(row["seconds_to_2_percent"])))
                      for row in csv.DictReader(file)]
        path = "L".join(f"{x:.1f} {y:.1f}" for x, y in points)
        out += [f'<path d="M{path}" fill="none" stroke="{color}" stroke-width="2"/>']
        out += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="{color}"/>' for x, y in points]
        out += [text(points[-1][0] + 10, points[-1][1] + 4, words, "start", color)]
    PICTURE.write_text("\n".join(out + ["</svg>", ""]), encoding="ascii")


if __name__ == "__main__":
    main()
