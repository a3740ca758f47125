#!/usr/bin/env python3
"""Writes docs/images/lights.svg and triangles.svg from the measurements of bench/many_lights and bench/many_triangles:
time to equal error over the number of lights and of triangles.

    tools/plot_growth.py

Needs nothing but Python.
SPDX-License-Identifier: MIT
"""

import csv
import math
from pathlib import Path
from typing import NamedTuple

TREE = Path(__file__).resolve().parent.parent
RESULTS = TREE/"bench"/"results"
PICTURES = TREE/"docs"/"images"

LEFT, TOP, WIDTH, HEIGHT = 60, 20, 460, 260


class Figure(NamedTuple):
    what: str      # the column that is counted, and the name of the axis
    curves: list   # file, words, colour
    counts: tuple  # decades
    seconds: tuple

    def x_of(self, count):
        return LEFT + WIDTH*(math.log10(count) - self.counts[0])/(self.counts[1] - self.counts[0])

    def y_of(self, seconds):
        return TOP + HEIGHT*(1 - (math.log10(seconds) - self.seconds[0])/(self.seconds[1] - self.seconds[0]))


FIGURES = [
    Figure("lights", [("epyc-2vcpu/many_lights_by_power.csv", "by power", "#c0392b"),
                      ("epyc-2vcpu-avx2/many_lights_alone.csv", "tree", "#1f6fb2"),
                      ("epyc-2vcpu-avx2/many_lights.csv", "shared", "#27864a"),
                      ("epyc-2vcpu-avx2/many_lights_ceiling.csv", "ceiling", "#b8860b"),
                      ("epyc-2vcpu-avx2/many_lights_meshes.csv", "ten lamps", "#8e5ea2")], (1, 5), (-2, 3)),
    Figure("triangles", [("epyc-2vcpu/many_triangles.csv", "alone", "#1f6fb2"),
                         ("epyc-2vcpu-avx2/many_triangles.csv", "shared", "#27864a")], (4, 7), (1, 4)),
]


def text(x, y, words, anchor="middle", color="#333"):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" fill="{color}">{words}</text>'


def line(x1, y1, x2, y2):
    return f'<path d="M{x1:.1f} {y1:.1f}L{x2:.1f} {y2:.1f}" stroke="#ddd"/>'


def draw(figure):
    out = ['<svg xmlns="http://www.w3.org/2000/svg" width="620" height="330" font-family="sans-serif" font-size="13">',
           '<rect width="620" height="330" fill="#fff"/>']
    for decade in range(figure.counts[0], figure.counts[1] + 1):
        x = figure.x_of(10**decade)
        out += [line(x, TOP, x, TOP + HEIGHT), text(x, TOP + HEIGHT + 18, f"{10**decade}")]
    for decade in range(figure.seconds[0], figure.seconds[1] + 1):
        y = figure.y_of(10**decade)
        out += [line(LEFT, y, LEFT + WIDTH, y), text(LEFT - 8, y + 4, f"{10**decade:g}", "end")]
    out += [text(LEFT + WIDTH/2, TOP + HEIGHT + 38, figure.what),
            text(LEFT + 8, TOP + 14, "CPU seconds to an error of 2 %", "start")]
    labels = []
    for name, words, color in figure.curves:
        with open(RESULTS/name, newline="", encoding="ascii") as file:
            points = [(figure.x_of(float(row[figure.what])), figure.y_of(float(row["seconds_to_2_percent"])))
                      for row in csv.DictReader(file)]
        path = "L".join(f"{x:.1f} {y:.1f}" for x, y in points)
        out += [f'<path d="M{path}" fill="none" stroke="{color}" stroke-width="2"/>']
        out += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="{color}"/>' for x, y in points]
        labels += [(points[-1][1], words, color)]
    lowest = 0  # labels of curves that end near each other are moved apart
    for y, words, color in sorted(labels):
        lowest = max(y + 4, lowest + 14)
        out += [text(LEFT + WIDTH + 10, lowest, words, "start", color)]
    return "\n".join(out + ["</svg>", ""])


def main():
    for figure in FIGURES:
        (PICTURES/f"{figure.what}.svg").write_text(draw(figure), encoding="ascii")


if __name__ == "__main__":
    main()
