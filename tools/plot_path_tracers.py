#!/usr/bin/env python3
"""Writes docs/images/plots/path_tracers.svg: a floor under a lamp by TracePath as CS500 prints it, by `facet render`, and
as it really is.

    tools/plot_path_tracers.py build/dev/facet [--size WxH] [--spp N] [-o OUT.svg]

The radiance of the floor is known: a ball of radius r and radiance 1 at the distance d from a point, all of it above the
point's horizon, gives kd (r/d)^2 cos, whatever hides behind it.  Nothing is brighter than the lamp, so that no picture is
clipped.  Ends with status 1 if facet is not within 1 % of the truth (bytes are rounded by 0.2 %), or
the printed algorithm within 3 % of 1.8 of it (three standard deviations at the 80000 paths of the test).
Needs nothing but Python and the program.
SPDX-License-Identifier: MIT
"""

import argparse
import base64
import json
import math
import random
import struct
import subprocess
import sys
import tempfile
import zlib
from pathlib import Path

TREE = Path(__file__).resolve().parent.parent
LAMP, RADIUS = (0.0, 0.9, 0.0), 0.6
TILE, HALF = 0.5, 4           # the floor has 2 HALF by 2 HALF tiles
EYE, TARGET, FIELD = (0.0, 1.9, 3.4), (0.0, 0.35, 0.0), math.radians(40)
TILES = ((0.8, 0.5, 0.25), (0.3, 0.45, 0.7))   # kd
RR = 0.8
SUPER = 4                     # samples along the side of a pixel, of the truth


def add(a, b, s=1.0):
    return tuple(x + s*y for x, y in zip(a, b))


def dot(a, b):
    return sum(x*y for x, y in zip(a, b))


def unit(a):
    return tuple(x/math.sqrt(dot(a, a)) for x in a)


def cross(a, b):
    return (a[1]*b[2] - a[2]*b[1], a[2]*b[0] - a[0]*b[2], a[0]*b[1] - a[1]*b[0])


BACK = unit(add(EYE, TARGET, -1))
RIGHT = unit(cross((0, 1, 0), BACK))
UP = cross(BACK, RIGHT)

# ---- The scene ---------------------------------------------------------------------------------------


def meets_lamp(origin, direction):
    to = add(LAMP, origin, -1)
    along = dot(to, direction)
    return along > 0 and dot(to, to) - along*along <= RADIUS*RADIUS


def seen(x, y, width, height):
    """What the camera sees: "lamp", a point of the floor, or None."""
    scale = 2*math.tan(FIELD/2)/height
    direction = add(add(add((0, 0, 0), RIGHT, scale*(x - width/2)), UP, scale*(height/2 - y)), BACK, -1)
    direction = unit(direction)
    if meets_lamp(EYE, direction):
        return "lamp"
    if direction[1] >= 0:
        return None
    point = add(EYE, direction, -EYE[1]/direction[1])
    return point if max(abs(point[0]), abs(point[2])) < HALF*TILE else None


def kd(point):
    return TILES[(math.floor(point[0]/TILE) + math.floor(point[2]/TILE))%2]


def true_share(point):
    d2 = dot(add(LAMP, point, -1), add(LAMP, point, -1))
    return RADIUS**2/d2*LAMP[1]/math.sqrt(d2)


def trace_path_as_printed(point, draw):
    """The radiance at the point of the floor over kd.  Every second hit is the lamp, or nothing."""
    if draw() > RR:                                                  # while random() <= RR
        return 0
    c = 0.0
    z, turn = 2*draw() - 1, 2*math.pi*draw()                         # L = SampleLight(), uniform by area
    side = math.sqrt(1 - z*z)
    normal = (side*math.cos(turn), z, side*math.sin(turn))
    to = add(add(LAMP, normal, RADIUS), point, -1)
    d2 = dot(to, to)
    wi = unit(to)
    cos_light = -dot(normal, wi)
    if cos_light > 0:                                                # L is visible
        p = 1/(4*math.pi*RADIUS**2)*d2/cos_light                     # PdfLight/GeometryFactor
        c += 1/math.pi*wi[1]/p
    z2, turn = draw(), 2*math.pi*draw()                              # SampleBrdf
    side = math.sqrt(1 - z2)
    wi = (side*math.cos(turn), math.sqrt(z2), side*math.sin(turn))
    f, p = 1/math.pi*wi[1], 1/math.pi*wi[1]*RR                       # EvalScattering, PdfBrdf RR
    if p >= 1e-6 and meets_lamp(point, wi):
        c += f/p                                                     # W Radiance(Q)
    return c


def picture(width, height, n, share):
    """Means over n by n places in each pixel, in rows of RGB."""
    rows = []
    for y in range(height):
        rows.append([])
        for x in range(width):
            total = [0.0, 0.0, 0.0]
            for i in range(n*n):
                what = seen(x + (i%n + 0.5)/n, y + (i//n + 0.5)/n, width, height)
                if what == "lamp":
                    total = [t + 1 for t in total]
                elif what:
                    s = share(what)
                    total = [t + k*s for t, k in zip(total, kd(what))]
            rows[y].append([t/(n*n) for t in total])
    return rows


def gltf():
    numbers, meshes = [], []
    for colour in (0, 1):
        for ix in range(-HALF, HALF):
            for iz in range(-HALF, HALF):
                if (ix + iz)%2 == colour:
                    x, z = TILE*ix, TILE*iz
                    a, b, c, d = (x, 0, z), (x, 0, z + TILE), (x + TILE, 0, z + TILE), (x + TILE, 0, z)
                    numbers += [k for corner in (a, b, c, a, c, d) for k in corner]
    data = struct.pack(f"<{len(numbers)}f", *numbers)
    count = len(numbers)//6       # vertices of each colour
    edge = HALF*TILE
    views = [{"buffer": 0, "byteOffset": 12*count*k, "byteLength": 12*count} for k in (0, 1)]
    accessors = [{"bufferView": k, "componentType": 5126, "count": count, "type": "VEC3", "min": [-edge, 0, -edge],
                  "max": [edge, 0, edge]} for k in (0, 1)]
    meshes = [{"primitives": [{"attributes": {"POSITION": k}, "material": k}]} for k in (0, 1)]
    lambert = [{"extensions": {"FACET_materials_bsdf": {"model": "lambert", "kd": list(c)}}} for c in (*TILES, (0, 0, 0))]
    lambert[2]["emissiveFactor"] = [1, 1, 1]
    columns = [*RIGHT, 0, *UP, 0, *BACK, 0, *EYE, 1]
    return {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2, 3]}],
        "extensionsUsed": ["FACET_materials_bsdf", "FACET_shape"],
        "nodes": [{"mesh": 0}, {"mesh": 1}, {"camera": 0, "matrix": columns},
                  {"translation": LAMP, "extensions": {"FACET_shape": {"sphere": {"radius": RADIUS}, "material": 2}}}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": FIELD, "znear": 0.01}}],
        "meshes": meshes, "materials": lambert, "accessors": accessors, "bufferViews": views,
        "buffers": [{"byteLength": len(data), "uri": "data:application/octet-stream;base64,"
                     + base64.b64encode(data).decode()}]}

# ---- PNG of 8 bits, sRGB -----------------------------------------------------------------------------


def linear(byte):
    v = byte/255
    return v/12.92 if v <= 0.04045 else ((v + 0.055)/1.055)**2.4


def encoded(v):
    return round(255*min(1, 12.92*v if v <= 0.0031308 else 1.055*v**(1/2.4) - 0.055))


def png(rows):
    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    data = b"".join(b"\0" + bytes(encoded(v) for pixel in row for v in pixel) for row in rows)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 2, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(data, 9)) + chunk(b"IEND", b""))


def paeth(a, b, c):
    return min((abs(b - c), 0, a), (abs(a - c), 1, b), (abs(a + b - 2*c), 2, c))[2]


def read_png(path):
    data, at, packed = path.read_bytes(), 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + size]
        if kind == b"IHDR":
            width, height, *form = struct.unpack(">IIBBBBB", body)
            if form != [8, 2, 0, 0, 0]:
                sys.exit(f"{path}: not 8 bits of RGB")
        elif kind == b"IDAT":
            packed += body
        at += size + 12
    raw, stride, above, rows = zlib.decompress(packed), 3*width, [0]*3*width, []
    for y in range(height):
        how, line = raw[y*(stride + 1)], list(raw[y*(stride + 1) + 1:(y + 1)*(stride + 1)])
        for i in range(stride):
            left, corner = (line[i - 3], above[i - 3]) if i >= 3 else (0, 0)
            line[i] = (line[i] + (0, left, above[i], (left + above[i])//2, paeth(left, above[i], corner))[how])%256
        rows.append([[linear(v) for v in line[3*x:3*x + 3]] for x in range(width)])
        above = line
    return rows


def rendered(program, width, height, spp):
    with tempfile.TemporaryDirectory() as folder:
        scene, out = Path(folder)/"scene.gltf", Path(folder)/"out.png"
        scene.write_text(json.dumps(gltf()))
        subprocess.run([program, "render", scene, "-o", out, "--spp", str(spp), "--size", f"{width}x{height}", "--view",
                        "standard", "--quiet"], check=True)
        return read_png(out)

# ---- The figure --------------------------------------------------------------------------------------


def ratios(rows, truth, width, height):
    """For each column of pixels, the light of its floor over the true one; and of all of them."""
    columns, sums = [], [0.0, 0.0]
    for x in range(width):
        is_floor = [all(isinstance(seen(x + dx, y + dy, width, height), tuple) for dx in (0, 1) for dy in (0, 1))
                    for y in range(height)]
        part = [sum(sum(p[y][x]) for y in range(height) if is_floor[y]) for p in (rows, truth)]
        columns.append(part[0]/part[1] if part[1] else None)
        sums = [a + b for a, b in zip(sums, part)]
    return columns, sums[0]/sums[1]


def chart(x, y, width, height, curves):
    """Ratios from 0 to 2 over the columns; each curve has its name so far below it."""
    out = [f'<text x="{x + width/2}" y="20" text-anchor="middle">floor over its true radiance</text>']
    for value in (0, 1, 1.8):
        at = y + height*(1 - value/2)
        out += [f'<path d="M{x} {at:.1f}h{width}" stroke="#ccc"/>',
                f'<text x="{x - 6}" y="{at + 4:.1f}" text-anchor="end">{value:g}</text>']
    for (columns, mean), name, colour, below in curves:
        points = [f"{x + width*(k + 0.5)/len(columns):.1f},{y + height*(1 - v/2):.1f}" for k, v in enumerate(columns) if v]
        out += [f'<polyline points="{" ".join(points)}" fill="none" stroke="{colour}" stroke-width="1.5"/>',
                f'<text x="{x + width/2}" y="{y + height*(1 - mean/2) + below}" text-anchor="middle" fill="{colour}">'
                f'{name}: {mean:.2f}</text>']
    out.append(f'<text x="{x + width/2}" y="{y + height + 16}" text-anchor="middle">columns of the picture</text>')
    return out


def figure(panels, curves, width, height):
    gap, top = 12, 30
    total = 3*(width + gap) + 40 + width + gap
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{total}" height="{top + height + 24}" font-family="sans-serif" '
           'font-size="13" fill="#222">', '<rect width="100%" height="100%" fill="#fff"/>']
    for k, (name, rows) in enumerate(panels):
        x = gap + k*(width + gap)
        out += [f'<text x="{x + width/2}" y="20" text-anchor="middle">{name}</text>',
                f'<image x="{x}" y="{top}" width="{width}" height="{height}" href="data:image/png;base64,'
                f'{base64.b64encode(png(rows)).decode()}"/>']
    return "\n".join(out + chart(3*(width + gap) + 40, top, width, height, curves) + ["</svg>"]) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("program")
    parser.add_argument("--size", default="220x165")
    parser.add_argument("--spp", type=int, default=256, help="a square number")
    parser.add_argument("-o", "--out", type=Path, default=TREE/"docs"/"images"/"plots"/"path_tracers.svg")
    given = parser.parse_args()
    width, height = map(int, given.size.split("x"))
    draw = random.Random(1).random
    truth = picture(width, height, SUPER, true_share)
    printed = picture(width, height, math.isqrt(given.spp), lambda point: trace_path_as_printed(point, draw))
    facet = rendered(given.program, width, height, given.spp)
    wrong, right = ratios(printed, truth, width, height), ratios(facet, truth, width, height)
    print(f"mean over the truth: as printed {wrong[1]:.4f}, facet {right[1]:.4f}")
    if abs(right[1] - 1) > 0.01 or abs(wrong[1]/1.8 - 1) > 0.03:
        sys.exit("path tracers: these are not the ratios that docs/integrator.md explains")
    panels = [("TracePath as printed", printed), ("facet render", facet), ("true radiance", truth)]
    curves = [(wrong, "as printed", "#D55E00", 26), (right, "facet", "#0072B2", 20)]
    given.out.write_text(figure(panels, curves, width, height))


if __name__ == "__main__":
    main()
