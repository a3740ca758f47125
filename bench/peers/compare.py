#!/usr/bin/env python3
"""Renders the benchmark's scenes by facet and by other renderers in turn: time to equal error.

    bench/peers/compare.py RELEASE_BUILD ASSETS [--blender PROGRAM] [--bpy PYTHON] [--mitsuba PYTHON]
                           [--scenes 70k,2M,veach,helmet,car] [--spp 64] [--rounds 2] [--csv FILE] [--pictures FOLDER]

PYTHON is an interpreter that has the module; a peer that is not named is left out.  ASSETS is the folder with
scenes/veach_mis, models/FlightHelmet_1k and models/ToyCar; without them, their scenes are left out.

512 x 512 pixels, eight events, one thread.  A round is two pictures of each renderer with different seeds, one after the
other; errors are the root of half the mean square difference of the two, of values clipped to 1, so that no
reference is needed and no renderer is measured against another's picture.  Time is processor time of the whole process
less that of a picture of one sample: neither reading nor building counts.  The table has the medians over the rounds.

SPDX-License-Identifier: MIT
"""

import argparse
import csv
import json
import math
import os
import statistics
import subprocess
import sys
import tempfile

import numpy as np
import OpenEXR

HERE = os.path.dirname(os.path.abspath(__file__))
SIZE = 512
TARGET = 0.02  # clipped RMSE that times are given for
CANNOT = {("car", "mitsuba")}  # clear coat, sheen and transmission are beyond mitsuba_peer.py


def run(command, log):
    """Processor seconds of a command, whose words go to the log."""
    with open(log, "w", encoding="utf-8") as stream:
        child = subprocess.Popen(command, stdout=stream, stderr=subprocess.STDOUT)
        _, status, usage = os.wait4(child.pid, 0)
    if status != 0:
        with open(log, encoding="utf-8", errors="replace") as stream:
            sys.exit(f"compare: {' '.join(command)}\n{stream.read()[-2000:]}")
    return usage.ru_utime + usage.ru_stime


class Facet:
    def __init__(self, build):
        self.program = os.path.join(build, "facet")

    def command(self, scene, sky, spp, seed, out):
        return [self.program, "render", scene, "--allow-outside", "--size", f"{SIZE}x{SIZE}", "--threads", "1", "--quiet",
                "--spp", str(spp), "--seed", str(seed), "-o", out + ".exr", *(["--env", sky] if sky != "-" else [])]

    def picture(self, out):
        return OpenEXR.File(out + ".exr").channels()["RGB"].pixels


class Peer:
    def __init__(self, words):
        self.words = words

    def command(self, scene, sky, spp, seed, out):
        return [*self.words, scene, sky, str(SIZE), str(spp), str(seed), out + ".npy"]

    def picture(self, out):
        return np.load(out + ".npy")


def with_camera(program, path, folder):
    """A scene without a camera gets the one that facet frames it by, as a copy that names its files by their paths."""
    info = json.loads(subprocess.run([program, "info", "--json", path], check=True, capture_output=True).stdout)
    if info["cameras"]:
        return path
    low, high = np.array(info["bounds_low"]), np.array(info["bounds_high"])
    yfov, tilt = math.radians(40), math.radians(15)
    distance = 1.05*np.linalg.norm(high - low)/2/math.sin(yfov/2)
    sn, cs = math.sin(tilt), math.cos(tilt)
    eye = (low + high)/2 + distance*np.array([0, sn, cs])
    with open(path, encoding="utf-8") as stream:
        document = json.load(stream)
    for part in document.get("images", []) + document["buffers"]:
        part["uri"] = os.path.join(os.path.dirname(os.path.abspath(path)), part["uri"])
    document["cameras"] = [{"type": "perspective", "perspective": {"yfov": yfov, "znear": 1e-3}}]
    document["scenes"][0]["nodes"].append(len(document["nodes"]))
    document["nodes"].append({"camera": 0, "matrix": [1, 0, 0, 0, 0, cs, -sn, 0, 0, sn, cs, 0, *eye.tolist(), 1]})
    made = os.path.join(folder, os.path.basename(path))
    with open(made, "w", encoding="utf-8") as stream:
        json.dump(document, stream)
    return made


def find_scenes(options, folder):
    """Name, file and sky of each scene that there is."""
    subprocess.run([os.path.join(options.build, "bench", "renders"), "--export", folder], check=True)
    program = os.path.join(options.build, "facet")
    there = {"70k": (os.path.join(folder, "70k.glb"), "-"), "2M": (os.path.join(folder, "2M.glb"), "-"),
             "veach": (os.path.join(options.assets, "scenes/veach_mis/veach_mis.glb"), "-"),
             "helmet": (os.path.join(options.assets, "models/FlightHelmet_1k/FlightHelmet.gltf"),
                        os.path.join(options.assets, "hdri/lebombo_1k.hdr")),
             "car": (os.path.join(options.assets, "models/ToyCar/glTF/ToyCar.gltf"),
                     os.path.join(options.assets, "hdri/studio_small_03_1k.hdr"))}
    for name in options.scenes.split(","):
        path, sky = there[name]
        if os.path.exists(path):
            yield name, with_camera(program, path, folder), sky
        else:
            print(f"{name}: left out, there is no {path}")


def measure(renderer, scene, sky, spp, seed, out):
    """Processor seconds of `spp` samples, the clipped RMSE that they leave, and a picture."""
    log = out + ".log"
    start = run(renderer.command(scene, sky, 1, seed, out), log)
    pictures, seconds = [], []
    for k in range(2):
        seconds.append(run(renderer.command(scene, sky, spp, seed + k, out), log) - start)
        pictures.append(renderer.picture(out))
    difference = np.minimum(pictures[0], 1) - np.minimum(pictures[1], 1)
    return statistics.mean(seconds)*spp/(spp - 1), math.sqrt(np.mean(difference**2)/2), pictures[0]


def options_of(words):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build")
    parser.add_argument("assets")
    parser.add_argument("--blender")
    parser.add_argument("--bpy")
    parser.add_argument("--mitsuba")
    parser.add_argument("--scenes", default="70k,2M,veach,helmet,car")
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--rounds", type=int, default=2)
    parser.add_argument("--csv")
    parser.add_argument("--pictures")
    return parser.parse_args(words)


def main():
    options = options_of(sys.argv[1:])
    cycles, mitsuba = os.path.join(HERE, "cycles_peer.py"), os.path.join(HERE, "mitsuba_peer.py")
    renderers = {"facet": Facet(options.build)}
    if options.blender:
        renderers["blender"] = Peer([options.blender, "-b", "-t", "1", "--python-exit-code", "1", "-P", cycles, "--"])
    if options.bpy:
        renderers["bpy"] = Peer([options.bpy, cycles, "--"])
    if options.mitsuba:
        renderers["mitsuba"] = Peer([options.mitsuba, mitsuba])
    rows = []
    print(f"{'scene':<8}{'renderer':<10}{'CPU s':>8}{'RMSE':>9}{'mean':>9}{'s to ' + str(TARGET):>11}{'facet / it':>12}")
    with tempfile.TemporaryDirectory() as folder:
        for scene, path, sky in find_scenes(options, folder):
            found = {name: [] for name in renderers if (scene, name) not in CANNOT}
            for i in range(options.rounds):
                for name in found:
                    found[name].append(measure(renderers[name], path, sky, options.spp, 1 + 2*i, os.path.join(folder, name)))
            for name, all_rounds in found.items():
                seconds = statistics.median(r[0] for r in all_rounds)
                rmse = math.sqrt(statistics.mean(r[1]**2 for r in all_rounds))
                mean = float(np.mean(all_rounds[0][2]))
                wanted = seconds*(rmse/TARGET)**2
                if name == "facet":
                    own = wanted
                rows.append([scene, name, f"{seconds:.2f}", f"{rmse:.5f}", f"{mean:.5f}", f"{wanted:.3f}", f"{own/wanted:.3f}"])
                print("{:<8}{:<10}{:>8}{:>9}{:>9}{:>11}{:>12}".format(*rows[-1]), flush=True)
                if options.pictures:
                    np.save(os.path.join(options.pictures, f"{scene}-{name}.npy"), all_rounds[0][2])
    if options.csv:
        with open(options.csv, "w", encoding="utf-8", newline="") as stream:
            table = csv.writer(stream, lineterminator="\n")
            table.writerow(["scene", "renderer", "cpu_seconds", "rmse_clipped", "mean", "cpu_s_to_0.02", "facet_over_it"])
            table.writerows(rows)


if __name__ == "__main__":
    main()
