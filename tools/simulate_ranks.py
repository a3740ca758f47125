#!/usr/bin/env python3
"""Predicts how well renders by many ranks scale, and draws docs/images/scaling.svg.

    tools/simulate_ranks.py            # writes bench/results/epyc-2vcpu/scaling.csv and the picture
    tools/simulate_ranks.py --quick    # up to 64 ranks, prints only

A discrete simulation of render/crew.c with ranks of one thread: the leader's grants, its time for each request, the
messages' latency, the wait for the last unit before films are added up, and the way of the films to the leader.  The
work is measured: processor time of each tile of the demo scene (bench/measure_tiles.py).  So are the times of a request
and of a pixel's sum (bench/messages.c).  The network is assumed: 10 Gbit/s and 20 us.

Needs nothing but Python.
SPDX-License-Identifier: MIT
"""

import csv
import heapq
import math
import sys
from pathlib import Path

TREE = Path(__file__).resolve().parent.parent
RESULTS = TREE/"bench"/"results"/"epyc-2vcpu"
PICTURE = TREE/"docs"/"images"/"scaling.svg"

PIXELS, PIXEL_BYTES = 960*540, 72
REQUEST = 10e-6    # the leader's time for a request and its answer [s]  (bench/messages)
ADDED = 15e-9      # ... for a pixel's sum [s]  (bench/messages)
LATENCY = 20e-6    # of a message [s], assumed
BANDWIDTH = 1.1e9  # of each rank's link [bytes/s], assumed
STARTUP = 0.25     # start of a process, the scene, its tree [s]  (facet render --json: setup_seconds, and mpirun)
PAUSE = 1e-3       # the leader and the followers look at their messages so often [s]  (part_pause)
RANKS = [1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1000]
CASES = [("64 samples", 64, False, "#c0392b"), ("1024 samples", 1024, False, "#1f6fb2"),
         ("4096 samples", 4096, False, "#2e8b57"), ("1024 samples, --noise", 1024, True, "#8e6bbf")]


def pass_length(done, share):
    """As in render/render.c."""
    length = 1 if done < 4 else min(done//4, 16)
    return min(length, share - done)


def plan(spp, n_tiles, n_ranks):
    """Ranges of samples, and after which of them a pass ends: part_plan in render/crew_part.c."""
    parts = 1 + (4*n_ranks - 1)//n_tiles
    ends, pass_ends, begin = [0], [], 0
    while begin < spp:
        length = pass_length(begin, spp)
        n = min(parts, length)
        ends += [begin + length*i//n for i in range(1, n + 1)]
        begin += length
        pass_ends.append(len(ends) - 1)
    return ends, pass_ends


def gather_time(n_ranks, share_touched=1.0):
    """crew_films.c: everyone sends the others' blocks, the owners send sums to the leader."""
    if n_ranks == 1:
        return 0
    film = PIXELS*PIXEL_BYTES
    return (film*share_touched/BANDWIDTH + film*(n_ranks - 1)/n_ranks/BANDWIDTH + 2*n_ranks*LATENCY
            + ADDED*PIXELS*(share_touched + 1))


def simulate(tiles, spp, n_ranks, has_noise):
    """Seconds from start to the finished sums."""
    ends, pass_ends = plan(spp, len(tiles), n_ranks)
    n_units = (len(ends) - 1)*len(tiles)
    cost = [ends[i + 1] - ends[i] for i in range(len(ends) - 1)]
    limits = [n*len(tiles) for n in pass_ends] if has_noise else [n_units]
    free = [STARTUP]*n_ranks  # when each rank runs out of work
    leader, now, unit, looked = STARTUP, STARTUP, 0, STARTUP
    for limit in limits:
        queue = [(free[r] + (0 if r == 0 else LATENCY), r) for r in range(n_ranks)]  # requests that reach the leader
        heapq.heapify(queue)
        while unit < limit:
            at, r = heapq.heappop(queue)
            # one look at all films now and then, for the noise that people see
            if not has_noise and at - looked >= min(max(looked - STARTUP, 1), 15):
                begin = max(max(free), at)
                now = begin + PAUSE + gather_time(n_ranks)
                looked = leader = now
                free = [now]*n_ranks
                queue = [(now + (0 if k == 0 else LATENCY), k) for k in range(n_ranks)]
                heapq.heapify(queue)
                continue
            leader = max(leader, at) + (0 if r == 0 else REQUEST)
            n = min(max(1, min((limit - unit)//(4*n_ranks), 8)), limit - unit)
            work = sum(tiles[u%len(tiles)]*cost[u//len(tiles)] for u in range(unit, unit + n))
            unit += n
            begin = max(free[r], leader + (0 if r == 0 else LATENCY))
            free[r] = begin + work
            # the next request goes out when the last unit of these begins, at the follower's next look at its messages
            last = tiles[(unit - 1)%len(tiles)]*cost[(unit - 1)//len(tiles)]
            heapq.heappush(queue, (max(free[r] - last, leader) + (0 if r == 0 else LATENCY + PAUSE/2), r))
        share = min(1, 1/n_ranks*4) if has_noise else 1
        now = max(free) + PAUSE + gather_time(n_ranks, share)
        leader = now
        free = [now]*n_ranks
    return now


def text(x, y, words, anchor="middle", color="#333"):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" fill="{color}">{words}</text>'


def draw(rows):
    left, top, width, height = 60, 20, 440, 260
    x_of = lambda n: left + width*math.log10(n)/3
    y_of = lambda e: top + height*(1 - e)
    out = ['<svg xmlns="http://www.w3.org/2000/svg" width="690" height="330" font-family="sans-serif" font-size="13">',
           '<rect width="690" height="330" fill="#fff"/>']
    for n in (1, 10, 100, 1000):
        out += [f'<path d="M{x_of(n):.1f} {top}V{top + height}" stroke="#ddd"/>', text(x_of(n), top + height + 18, n)]
    for e in (0, .2, .4, .6, .8, 1):
        out += [f'<path d="M{left} {y_of(e):.1f}H{left + width}" stroke="#ddd"/>',
                text(left - 8, y_of(e) + 4, f"{100*e:.0f} %", "end")]
    out += [text(left + width/2, top + height + 38, "ranks of one thread"), ]
    labels = []
    for name, _, _, color in CASES:
        points = [(x_of(row[1]), y_of(row[3])) for row in rows if row[0] == name]
        out.append(f'<path d="M{"L".join(f"{x:.1f} {y:.1f}" for x, y in points)}" fill="none" stroke="{color}" '
                   'stroke-width="2"/>')
        out += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="{color}"/>' for x, y in points]
        labels.append([points[-1][1], name, color, points[-1][0]])
    labels.sort()
    for i in range(1, len(labels)):
        labels[i][0] = max(labels[i][0], labels[i - 1][0] + 15)
    out += [text(x + 10, y + 4, name, "start", color) for y, name, color, x in labels]
    PICTURE.write_text("\n".join(out + ["</svg>", ""]), encoding="ascii")


def main():
    is_quick = "--quick" in sys.argv[1:]
    with open(RESULTS/"tiles.csv", newline="", encoding="ascii") as file:
        tiles = [float(row["seconds_per_sample_of_each_pixel"]) for row in csv.DictReader(file)]
    rows = []
    for name, spp, has_noise, _ in CASES:
        alone = STARTUP + spp*sum(tiles)
        for n in RANKS:
            if is_quick and n > 64:
                continue
            seconds = simulate(tiles, spp, n, has_noise)
            rows.append((name, n, seconds, alone/(n*seconds)))
            print(f"{name:24s} {n:5d} ranks {seconds:10.2f} s  efficiency {100*rows[-1][3]:5.1f} %", flush=True)
    if is_quick:
        return
    with open(RESULTS/"scaling.csv", "w", newline="", encoding="ascii") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["case", "ranks", "seconds", "efficiency"])
        writer.writerows((name, n, f"{seconds:.4g}", f"{e:.4f}") for name, n, seconds, e in rows)
    draw(rows)


if __name__ == "__main__":
    main()
