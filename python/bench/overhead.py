#!/usr/bin/env python3
"""How much longer 10^6 pairs of directions take through the package than in C: a table for docs/python.md.

    python3 python/bench/overhead.py

C is the batch function itself, on arrays of all x, all y and all z, without checks.

SPDX-License-Identifier: MIT
"""
import time

import numpy as np

import facet
from facet._library import ffi, lib

N, REPEATS = 1_000_000, 41
SPECS = ["ggx alpha=.3", "gtr alpha=.1 gamma=1.5", "disney", "phong"]


def directions(rng):
    """All x, then all y, then all z, as an array (N, 3)."""
    w = rng.standard_normal((3, N)).astype(np.float32)
    w[2] = np.abs(w[2])
    return (w / np.sqrt((w * w).sum(axis=0))).T


def best(*calls):
    """The least time of each call [s], in turns, so that what else runs disturbs all alike."""
    least = [np.inf] * len(calls)
    for _ in range(REPEATS):
        for k, call in enumerate(calls):
            start = time.perf_counter()
            call()
            least[k] = min(least[k], time.perf_counter() - start)
    return least


def parts(a):
    """Pointers to x, y and z."""
    return [ffi.cast("float *", a[:, k].__array_interface__["data"][0]) for k in range(3)]


def main():
    rng = np.random.default_rng(1)
    wi, wo, u = directions(rng), directions(rng), rng.random((3, N), np.float32).T
    rows_i, rows_o, rows_u = (np.ascontiguousarray(a) for a in (wi, wo, u))
    f, rows_f = np.empty((3, N), np.float32).T, np.empty((N, 3), np.float32)
    drawn = np.empty((7, N), np.float32)
    samples = ffi.new("facet_samples *", [ffi.cast("float *", row.__array_interface__["data"][0]) for row in drawn])
    print("| material | call | C [ns] | columns | rows (n, 3) |\n|---|---|---|---|---|")
    for spec in SPECS:
        m = facet.material(spec)
        kept, rows_kept = m.sample(wo, u), m.sample(rows_o, rows_u)
        c, columns, rows = best(
            lambda: lib.facet_bsdf_eval_batch(m._bsdf, N, parts(wi), parts(wo), parts(f)),
            lambda: m.eval(wi, wo, out=f), lambda: m.eval(rows_i, rows_o, out=rows_f))
        print(f"| `{spec}` | eval | {1e9 * c / N:.2f} | {columns / c:.2f} | {rows / c:.2f} |")
        c, columns, rows = best(
            lambda: lib.facet_bsdf_sample_batch(m._bsdf, N, parts(wo), parts(u), samples[0]),
            lambda: m.sample(wo, u, out=kept), lambda: m.sample(rows_o, rows_u, out=rows_kept))
        print(f"| `{spec}` | sample | {1e9 * c / N:.2f} | {columns / c:.2f} | {rows / c:.2f} |")


if __name__ == "__main__":
    main()
