#!/usr/bin/env python3
"""What light that neighbouring pixels share gives: time and error with it over those without.

    bench/gradients.py RELEASE_BUILD [--assets FOLDER] [--scenes demo,70k,...] [--spp 8] [--rounds 2] [--csv FILE]

512 x 512 pixels, eight events, one thread.  A round is two pictures of different seeds with --gradients off and two with
on, in turn; errors are the root of half the mean square difference of the two, of values clipped to 1: of pixels, and
of means over 16 x 16 of them.  Time is processor time less that of a picture of one sample.  The table has medians of
the ratios over the rounds; "to equal error" is the time ratio times the square of the pixels' error ratio.

SPDX-License-Identifier: MIT
"""

import argparse
import csv
import math
import os
import statistics
import subprocess
import tempfile

import numpy as np
import OpenEXR

from peers.compare import SIZE, run

BLOCK = 16
ASSETS = {"ajar": "ajar/ajar.glb", "cornell": "cornell_box/cornell_box.glb", "veach": "veach_mis/veach_mis.glb",
          "cornell_spheres": "cornell_box/cornell_box_spheres.glb", "instances": "instances/instances_40x40.glb"}


def picture(build, scene, gradients, spp, seed, folder):
    """Processor seconds, and the picture."""
    out = os.path.join(folder, "picture.exr")
    seconds = run([os.path.join(build, "facet"), "render", *scene, "--size", f"{SIZE}x{SIZE}", "--threads", "1",
                   "--quiet", "--spp", str(spp), "--seed", str(seed), "--gradients", gradients, "-o", out], out + ".log")
    return seconds, np.minimum(OpenEXR.File(out).channels()["RGB"].pixels.astype(np.float64), 1)


def measure(build, scene, gradients, spp, seed, folder):
    """Processor seconds of a picture, error of its pixels, error of its blocks."""
    start, _ = picture(build, scene, gradients, 1, seed, folder)
    (first, a), (second, b) = (picture(build, scene, gradients, spp, seed + k, folder) for k in range(2))
    blocks = (a - b).reshape(SIZE//BLOCK, BLOCK, SIZE//BLOCK, BLOCK, 3).mean(axis=(1, 3))
    return (first + second)/2 - start, math.sqrt(np.mean((a - b)**2)/2), math.sqrt(np.mean(blocks**2)/2)


def options_of():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build")
    parser.add_argument("--assets", help="a folder with the scenes of ajar, cornell_box, instances and veach_mis")
    parser.add_argument("--scenes", default="demo,70k,2M," + ",".join(ASSETS))
    parser.add_argument("--spp", type=int, default=8)
    parser.add_argument("--rounds", type=int, default=2)
    parser.add_argument("--csv")
    return parser.parse_args()


def find_scenes(options, folder):
    """Name and arguments of each scene that there is."""
    subprocess.run([os.path.join(options.build, "bench", "renders"), "--export", folder], check=True)
    for name in options.scenes.split(","):
        path = (os.path.join(options.assets or "", "scenes", ASSETS[name]) if name in ASSETS
                else os.path.join(folder, name + ".glb"))
        if name == "demo":
            yield name, []
        elif os.path.exists(path):
            yield name, [path]
        else:
            print(f"{name}: left out, there is no {path}")


def main():
    options = options_of()
    rows = []
    print(f"{'scene':<16}{'time':>7}{'error':>8}{'blocks':>8}{'to equal error':>16}")
    with tempfile.TemporaryDirectory() as folder:
        for name, scene in find_scenes(options, folder):
            ratios = []
            for i in range(options.rounds):
                off, on = (measure(options.build, scene, how, options.spp, 1 + 2*i, folder) for how in ("off", "on"))
                ratios.append([b/a for a, b in zip(off, on)])
            time, error, blocks = (statistics.median(column) for column in zip(*ratios))
            rows.append([name, time, error, blocks, time*error*error])
            print(f"{name:<16}{time:7.2f}{error:8.3f}{blocks:8.2f}{rows[-1][-1]:16.3f}", flush=True)
    if options.csv:
        with open(options.csv, "w", newline="", encoding="utf-8") as stream:
            csv.writer(stream, lineterminator="\n").writerows(
                [["scene", "time_ratio", "error_ratio", "block_error_ratio", "time_to_equal_error_ratio"], *rows])


if __name__ == "__main__":
    main()
