#!/usr/bin/env python3
"""Measures the processor time of each tile of the demo scene, for tools/simulate_ranks.py: tiles.csv.

    bench/measure_tiles.py build/release/facet > bench/results/MACHINE/tiles.csv

Each tile is a render of its own with --crop, at 8 and at 40 samples per pixel; the difference is free of the start.
SPDX-License-Identifier: MIT
"""

import os
import sys

WIDTH, HEIGHT, TILE = 960, 540, 32
FEW, MANY = 8, 40


def cpu_seconds(program, crop, spp):
    null = os.open(os.devnull, os.O_WRONLY)
    pid = os.posix_spawn(program, [program, "render", "--size", f"{WIDTH}x{HEIGHT}", "--crop", crop, "--spp", str(spp),
                                   "--threads", "1", "--quiet", "-o", f"/tmp/tile-{os.getpid()}.exr"], os.environ,
                         file_actions=[(os.POSIX_SPAWN_DUP2, null, 2)])
    os.close(null)
    _, status, usage = os.wait4(pid, 0)
    if status != 0:
        sys.exit(f"measure_tiles: {program} ended with status {status}")
    return usage.ru_utime + usage.ru_stime


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    print("x,y,seconds_per_sample_of_each_pixel")
    for y in range(0, HEIGHT, TILE):
        for x in range(0, WIDTH, TILE):
            crop = f"{x},{y},{min(TILE, WIDTH - x)},{min(TILE, HEIGHT - y)}"
            times = [cpu_seconds(sys.argv[1], crop, spp) for spp in (FEW, MANY)]
            print(f"{x},{y},{max(times[1] - times[0], 1e-6)/(MANY - FEW):.6g}", flush=True)
    os.unlink(f"/tmp/tile-{os.getpid()}.exr")


if __name__ == "__main__":
    main()
