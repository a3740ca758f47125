#!/usr/bin/env python3
"""Writes what the pages docs/models/NAME.md have from the program itself: the table of parameters and the plot.

    tools/make_model_pages.py FACET            write the tables and docs/images/models/NAME.svg
    tools/make_model_pages.py FACET --check    compare; exit status 1 if a page is missing or differs

FACET is the program `facet`.  A table is compared exactly.  Of a plot it is checked that it is there and that the page
shows it with words for those who cannot see it; its last digits depend on the machine's sine.
Needs nothing but Python.
SPDX-License-Identifier: MIT
"""
import csv
import io
import json
import math
import re
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple
from xml.sax.saxutils import escape

import tree

BEGIN = "<!-- parameters: begin (tools/make_model_pages.py) -->\n"
END = "<!-- parameters: end -->"
BYTES = 30000                  # of one picture, at most


# Tables

def number_text(value):
    return f"{value:.10g}"


def range_text(parameter):
    if parameter["kind"] == "choice":
        return ", ".join(parameter["choices"])
    ends = f"{number_text(parameter['low'])} to {number_text(parameter['high'])}"
    return ends + ", colour" if parameter["kind"] == "colour" else ends


def default_text(parameter):
    if parameter["kind"] == "choice":
        return parameter["default"]
    values = [number_text(value) for value in parameter["default"]]
    return values[0] if len(set(values)) == 1 else ",".join(values)


def table_text(parameters):
    """A row for each parameter.  A choice has no unit."""
    rows = [("parameter", "range or choices", "default", "unit", "meaning"), ("---",)*5]
    rows += [(p["name"], range_text(p), default_text(p), p.get("unit", ""), p["description"]) for p in parameters]
    return "".join("| " + " | ".join(cell.replace("|", "\\|") for cell in row) + " |\n" for row in rows)


def with_table(page, parameters):
    """The page with the table between its marks; None if it lacks them."""
    head, begin, rest = page.partition(BEGIN)
    _, end, tail = rest.partition(END)
    return head + BEGIN + "\n" + table_text(parameters) + "\n" + END + tail if begin and end else None


# Pictures

@dataclass(frozen=True)
class Axis:
    label: str
    low: float
    high: float
    step: float = 0            # between ticks; 0: logarithmic, a tick each decade

    def at(self, value):
        """Where a value lies, 0 to 1 from low to high; what a logarithm cannot show is far below."""
        if self.step:
            return (value - self.low)/(self.high - self.low)
        bounded = min(max(value, self.low*1e-3), self.high*1e3)
        return math.log(bounded/self.low)/math.log(self.high/self.low)

    def ticks(self):
        if self.step:
            return [self.low + k*self.step for k in range(round((self.high - self.low)/self.step) + 1)]
        first, last = round(math.log10(self.low)), round(math.log10(self.high))
        return [10.0**k for k in range(first, last + 1)]


# Okabe and Ito's colours, which those who confuse some colours tell apart; dashes say it a second time.
BLUE, RED, GREEN, ORANGE, PURPLE = "#0072B2", "#D55E00", "#009E73", "#E69F00", "#CC79A7"
SOLID, DASHED, DOTTED = "", "7 4", "2 3"


class Curve(NamedTuple):
    label: str
    spec: str
    colour: str
    dash: str = SOLID
    view: float = -45          # where the viewer is, degrees from the normal


@dataclass(frozen=True)
class Picture:
    title: str
    curves: tuple
    y: Axis
    x: Axis = Axis("θi, angle of the light to the normal [degrees]", -90, 90, 30)
    column: str = "fcos_g"     # of `facet eval`, or of `facet terms`
    mark: float | None = -45   # where the viewer is


def value_axis(low, high, step=0):
    return Axis("f cos θi [1/sr]", low, high, step)


def three(parameter, values, rest=""):
    """Curves for three values of one parameter."""
    styles = ((BLUE, SOLID), (RED, DASHED), (GREEN, DOTTED))
    return tuple((f"{parameter}={value}", f"{parameter}={value}{rest}", *style)
                 for value, style in zip(values, styles))


def of_model(name, curves):
    return tuple(Curve(label, f"{name} {spec}", *style) for label, spec, *style in curves)


FROM_45 = "in the plane of incidence, viewer at −45°"
PICTURES = {
    "lambert": Picture(f"lambert {FROM_45}", of_model("lambert", three("kd", (".8", ".5", ".2"))),
                       Axis("f [1/sr]", 0, 0.3, 0.05), column="f_g"),
    "phong": Picture(f"phong {FROM_45}", of_model("phong", three("exponent", ("500", "50", "5"))),
                     value_axis(1e-4, 1e2)),
    "beckmann": Picture(f"beckmann {FROM_45}", of_model("beckmann", three("alpha", (".1", ".3", ".6"))),
                        value_axis(1e-4, 1e2)),
    "ggx": Picture(f"ggx {FROM_45}", of_model("ggx", three("alpha", (".1", ".3", ".6"))), value_axis(1e-4, 1e2)),
    "gtr": Picture(f"gtr, alpha=.1, {FROM_45}", of_model("gtr", (
        ("gamma=10", "alpha=.1 gamma=10", ORANGE, SOLID), ("gamma=4", "alpha=.1 gamma=4", RED, DASHED),
        ("gamma=2 (GGX)", "alpha=.1 gamma=2", BLUE, SOLID), ("gamma=1.5", "alpha=.1 gamma=1.5", GREEN, DOTTED),
        ("gamma=1", "alpha=.1 gamma=1", PURPLE, DASHED))), value_axis(1e-4, 1e3)),
    "glass": Picture("glass, ior=1.5, viewer outside at −45°: reflection within ±90°, refraction beyond",
                     of_model("glass", three("alpha", (".05", ".15", ".4"))), value_axis(1e-4, 1e3),
                     Axis("θi, angle of the light to the normal [degrees]", -180, 180, 45)),
    "metallic_roughness": Picture(f"metallic_roughness {FROM_45}", of_model("metallic_roughness", (
        ("metal, roughness=.3", "metallic=1 roughness=.3", BLUE, SOLID),
        ("metal, roughness=.6", "metallic=1 roughness=.6", BLUE, DASHED),
        ("dielectric, roughness=.3", "roughness=.3", RED, SOLID),
        ("dielectric, roughness=.6", "roughness=.6", RED, DASHED))), value_axis(1e-3, 1e2)),
    "ward": Picture("ward, alpha=.3, viewer near grazing, at −80°",
                    tuple(Curve(f"variant={variant}", f"ward alpha=.3 variant={variant}", colour, dash, -80)
                          for variant, colour, dash in (("ward92", RED, DASHED), ("duer", GREEN, DOTTED),
                                                        ("gmd", BLUE, SOLID))),
                    value_axis(0, 6, 1), mark=-80),
    "cs500": Picture(f"cs500, kd=.2, ks=.6, alpha=.3, {FROM_45}",
                     of_model("cs500", three("ndf", ("ggx", "beckmann", "phong"), " kd=.2 ks=.6 alpha=.3")),
                     value_axis(1e-3, 1e1)),
    "disney": Picture("disney, base_color=.2 clearcoat_gloss=0, viewer at −60°, without the cosine", tuple(
        Curve(label, f"disney base_color=.2 clearcoat_gloss=0 {spec}", colour, dash, -60)
        for label, spec, colour, dash in (
            ("otherwise the defaults", "", BLUE, SOLID), ("roughness=.4", "roughness=.4", RED, SOLID),
            ("subsurface=1", "subsurface=1", GREEN, DOTTED), ("sheen=1", "sheen=1", PURPLE, DASHED),
            ("clearcoat=1", "clearcoat=1", ORANGE, DASHED))),
                      Axis("f [1/sr]", 0, 1.5, 0.25), column="f_g", mark=-60),
    "vray": Picture("vray, sharpness=.7764 (alpha .05): masking as published, and exact", tuple(
        Curve(f"gamma={gamma}, {masking}", f"vray sharpness=.7764 gamma={gamma} masking={masking}", colour, dash)
        for gamma, colour in ((".5", BLUE), ("1.5", RED), ("8", GREEN))
        for masking, dash in (("exact", SOLID), ("published", DASHED))),
                    Axis("G1 [1]", 0, 1.2, 0.2), Axis("θ, angle to the normal [degrees]", 60, 90, 5), "G1", None),
}


def default_picture(name):
    """Of a model that has none above: as it is without parameters, from three sides."""
    views = (((0, "0°"), BLUE, SOLID), ((-45, "−45°"), RED, DASHED), ((-75, "−75°"), GREEN, DOTTED))
    return Picture(f"{name} in the plane of incidence", tuple(
        Curve(f"viewer at {text}", name, colour, dash, view) for (view, text), colour, dash in views),
                   value_axis(1e-3, 1e2), mark=None)


def direction(degrees):
    angle = math.radians(degrees)
    return f"{math.sin(angle):.9g},0,{math.cos(angle):.9g}"


def run(program, *arguments, text=None):
    return subprocess.run([program, *arguments], input=text, capture_output=True, text=True, check=True).stdout


def curve_values(program, picture, curve, angles):
    """The values at these angles, from the program."""
    if picture.column.startswith("f"):
        command, header = "eval", "wi_x,wi_y,wi_z,wo_x,wo_y,wo_z"
        lines = [f"{direction(angle)},{direction(curve.view)}" for angle in angles]
    else:
        command, header = "terms", "cos_theta"
        lines = [f"{math.cos(math.radians(angle)):.9g}" for angle in angles]
    output = run(program, command, curve.spec, "--csv", "-", text="\n".join([header, *lines]) + "\n")
    return [float(row[picture.column]) for row in csv.DictReader(io.StringIO(output))]


def thinned(points, tolerance):
    """The points without those that lie within the tolerance of the line through their neighbours (Douglas and
    Peucker 1973)."""
    if len(points) < 3:
        return points
    (x0, y0), (x1, y1) = points[0], points[-1]
    length = math.hypot(x1 - x0, y1 - y0) or 1
    far, at = max((abs((x1 - x0)*(y - y0) - (y1 - y0)*(x - x0))/length, k)
                  for k, (x, y) in enumerate(points[1:-1], 1))
    if far <= tolerance:
        return [points[0], points[-1]]
    return thinned(points[:at + 1], tolerance)[:-1] + thinned(points[at:], tolerance)


WIDTH, HEIGHT = 760, 380
LEFT, RIGHT, TOP, BOTTOM = 70, 540, 40, 325         # of the plot


def screen(picture, x, y):
    return LEFT + (RIGHT - LEFT)*picture.x.at(x), BOTTOM - (BOTTOM - TOP)*picture.y.at(y)


def tick_text(value):
    return f"{value:.6g}".replace("-", "−")


def axes_svg(picture):
    grid, labels = [], []
    for value in picture.x.ticks():
        x, _ = screen(picture, value, picture.y.low)
        grid.append(f"M{x:.1f} {TOP}V{BOTTOM + 5}")
        labels.append(f'<text x="{x:.1f}" y="{BOTTOM + 20}" text-anchor="middle">{tick_text(value)}</text>')
    for value in picture.y.ticks():
        _, y = screen(picture, picture.x.low, value)
        grid.append(f"M{LEFT - 5} {y:.1f}H{RIGHT}")
        labels.append(f'<text x="{LEFT - 9}" y="{y + 4:.1f}" text-anchor="end">{tick_text(value)}</text>')
    middle_x, middle_y = (LEFT + RIGHT)/2, (TOP + BOTTOM)/2
    return [f'<path d="{"".join(grid)}" stroke="#ddd" fill="none"/>',
            f'<path d="M{LEFT} {TOP}V{BOTTOM}H{RIGHT}" stroke="#333" fill="none"/>', *labels,
            f'<text x="{middle_x:.0f}" y="{BOTTOM + 42}" text-anchor="middle">{escape(picture.x.label)}</text>',
            f'<text transform="translate(18 {middle_y:.0f}) rotate(-90)" text-anchor="middle">'
            f'{escape(picture.y.label)}</text>']


def picture_svg(program, picture):
    steps = round(4*(picture.x.high - picture.x.low))
    angles = [picture.x.low + k/4 for k in range(steps + 1)]
    lines = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" '
             f'height="{HEIGHT}" font-family="sans-serif" font-size="13" fill="#222">',
             f"<title>{escape(picture.title)}</title>",
             f'<clipPath id="plot"><path d="M{LEFT} {TOP}H{RIGHT}V{BOTTOM}H{LEFT}z"/></clipPath>',
             f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#fff"/>',
             f'<text x="{LEFT}" y="24" font-size="15">{escape(picture.title)}</text>', *axes_svg(picture)]
    if picture.mark is not None:
        x, _ = screen(picture, picture.mark, picture.y.low)
        lines += [f'<path d="M{x:.1f} {TOP}V{BOTTOM}" stroke="#666" stroke-dasharray="1 4"/>',
                  f'<text x="{x + 4:.1f}" y="{TOP + 14}" fill="#555">viewer</text>']
    for k, curve in enumerate(picture.curves):
        points = [screen(picture, *pair) for pair in zip(angles, curve_values(program, picture, curve, angles))]
        path = " ".join(f"{x:.1f},{y:.1f}" for x, y in thinned(points, 0.15))
        style = f'stroke="{curve.colour}" stroke-width="2" fill="none"'
        style += f' stroke-dasharray="{curve.dash}"' if curve.dash else ""
        y = TOP + 10 + 22*k
        lines += [f'<polyline clip-path="url(#plot)" {style} points="{path}"/>',
                  f'<path d="M{RIGHT + 12} {y}h28" {style}/>',
                  f'<text x="{RIGHT + 46}" y="{y + 4}">{escape(curve.label)}</text>']
    return "\n".join([*lines, "</svg>", ""])


# Pages

def page_path(root, name):
    return Path(root)/"docs"/"models"/f"{name}.md"


def picture_path(root, name):
    return Path(root)/"docs"/"images"/"models"/f"{name}.svg"


def check_page(root, model):
    name = model["name"]
    path, picture = page_path(root, name), picture_path(root, name)
    where = f"docs/models/{name}.md"
    if not path.is_file():
        return [f"{where}: the model has no page"]
    page = path.read_text(encoding="utf-8")
    written = with_table(page, model["parameters"])
    problems = []
    if written is None:
        problems.append(f"{where}: no marks for the table of parameters: {BEGIN.strip()} and {END}")
    elif written != page:
        problems.append(f"{where}: the table of parameters is not the program's: run tools/make_model_pages.py")
    if not picture.is_file():
        problems.append(f"{where}: docs/images/models/{name}.svg is missing: run tools/make_model_pages.py")
    elif picture.stat().st_size > BYTES:
        problems.append(f"{where}: docs/images/models/{name}.svg has more than {BYTES} bytes")
    if not re.search(rf"!\[[^\]]*\w[^\]]*\]\(\.\./images/models/{re.escape(name)}\.svg\)", page):
        problems.append(f"{where}: does not show ../images/models/{name}.svg with a text for it")
    return problems


def check(root, models):
    return [problem for model in models for problem in check_page(root, model)]


def write(root, program, models):
    for model in models:
        name = model["name"]
        path, picture = page_path(root, name), picture_path(root, name)
        picture.parent.mkdir(parents=True, exist_ok=True)
        picture.write_text(picture_svg(program, PICTURES.get(name) or default_picture(name)), encoding="utf-8")
        page = path.read_text(encoding="utf-8") if path.is_file() else ""
        written = with_table(page, model["parameters"])
        if written is not None and written != page:
            path.write_text(written, encoding="utf-8")
    return check(root, models)


def main(arguments):
    options = [a for a in arguments if a.startswith("-")]
    programs = [a for a in arguments if not a.startswith("-")]
    if len(programs) != 1 or options not in ([], ["--check"]):
        print(__doc__, file=sys.stderr)
        return 2
    root = tree.default_root()
    models = json.loads(run(programs[0], "materials", "--json"))
    return tree.report(check(root, models) if options else write(root, programs[0], models))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
